#include frame.glsl
in vec3 v_normal;
flat in vec3 v_tint;
out vec4 colour;

void main() {
    float facing = 0.5 + 0.5 * dot(normalize(v_normal), normalize(sun.xyz + vec3(0.0, 0.6, 0.0)));
    colour = vec4(display(v_tint * (0.35 + 1.3 * facing * facing)), 1.0);
}
