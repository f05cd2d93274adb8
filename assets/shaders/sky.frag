#include frame.glsl
in vec3 v_ray;
out vec4 colour;

void main() {
    float h = max(v_ray.y * inversesqrt(dot(v_ray, v_ray)), 0.0);
    colour = vec4(display(mix(HORIZON, ZENITH, h / (h + 0.35))), 1.0);
}
