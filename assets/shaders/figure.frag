#include frame.glsl
#include shadow.glsl
#include lit.glsl
in vec3 v_at;
in vec3 v_normal;
in vec3 v_paint;     // x: distance to the border of the dark parts [m], positive inside; y: openness to the sky;
                     // z: distance to the seams between limbs and trunk [m]
flat in vec3 v_tint;
out vec4 colour;

void main() {
    vec3 n = normalize(v_normal);
    vec2 edge = abs(v_paint.xz), blur = fwidth(v_paint.xz) + 1e-5;
    float dark = clamp(0.5 + v_paint.x / blur.x, 0.0, 1.0);
    // grooves between the parts, too fine to model: 3 mm wide, fainter where a pixel is wider
    vec2 groove = clamp((0.0015 - edge) / blur + 0.5, 0.0, 1.0) * min(0.003 / blur, 1.0);
    float seam = max(groove.x, groove.y * (1.0 - dark));
    vec3 base = mix(v_tint, vec3(0.035, 0.038, 0.045) + 0.05 * v_tint, dark) * (1.0 - 0.75 * seam);
    colour = vec4(display(shaded(v_at, n, base, v_paint.y, mix(0.10, 0.22, dark))), 1.0);
}
