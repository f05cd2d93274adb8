#include frame.glsl
#include shadow.glsl
#include lit.glsl
in vec3 v_at;
in vec3 v_normal;
in vec2 v_paint;     // x: distance to the border of the dark parts [m], positive inside; y: openness to the sky
flat in vec3 v_tint;
out vec4 colour;

void main() {
    vec3 n = normalize(v_normal);
    float blur = fwidth(v_paint.x) + 1e-5;
    float dark = clamp(0.5 + v_paint.x / blur, 0.0, 1.0);
    // the seam between the two materials: a groove, too fine to model
    float seam = clamp(1.0 - (abs(v_paint.x) - 0.0012) / blur, 0.0, 1.0) * min(0.0024 / blur, 1.0);
    vec3 base = mix(v_tint, vec3(0.035, 0.038, 0.045) + 0.05 * v_tint, dark) * (1.0 - 0.7 * seam);
    colour = vec4(display(shaded(v_at, n, base, v_paint.y, mix(0.10, 0.22, dark))), 1.0);
}
