#include frame.glsl
#include shadow.glsl
#include lit.glsl
#include paint.glsl
in vec3 v_at;
in vec3 v_normal;
in vec3 v_rest;      // where the point lies in T-pose [m]
in float v_open;     // how open it is to the sky, 0 … 1
flat in vec3 v_tint;
out vec4 colour;

void main() {
    vec3 n = normalize(v_normal);
    vec2 field = paint(v_rest), blur = fwidth(field) + 1e-5;
    float dark = clamp(0.5 + field.x / blur.x, 0.0, 1.0);
    // grooves between the parts, too fine to model: 3 mm wide, fainter where a pixel is wider
    vec2 groove = clamp((0.0015 - abs(field)) / blur + 0.5, 0.0, 1.0) * min(0.003 / blur, 1.0);
    float seam = max(groove.x, groove.y * (1.0 - dark));
    vec3 base = mix(v_tint, vec3(0.045, 0.049, 0.058) + 0.05 * v_tint, dark) * (1.0 - 0.75 * seam);
    colour = vec4(display(shaded(v_at, n, base, v_open, mix(0.10, 0.35, dark))), 1.0);
}
