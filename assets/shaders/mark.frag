#include frame.glsl
in vec4 v_tint;
in vec3 v_shape;    // z = 0: a disc, xy −1 … 1; z = 1: a band, y −1 … 1 across; z = 2: dashes, x in dashes
out vec4 colour;

void main() {
    float cover;
    if (v_shape.z < 0.5) {
        float r = length(v_shape.xy), w = fwidth(r) + 1e-5;
        float disc = clamp((1.0 - r) / w, 0.0, 1.0);
        float ring = clamp((r - 0.78) / w, 0.0, 1.0);
        cover = disc * (0.35 + 0.65 * ring);
    } else {
        float y = abs(v_shape.y), w = fwidth(v_shape.y) + 1e-5;
        cover = clamp((1.0 - y) / w, 0.0, 1.0) * min(2.0 / w, 1.0);
        if (v_shape.z > 1.5) {
            float x = abs(fract(v_shape.x) - 0.5), v = fwidth(v_shape.x) + 1e-5;
            cover *= mix(clamp((0.3 - x) / v + 0.5, 0.0, 1.0), 0.6, clamp(v, 0.0, 1.0));
        }
    }
    colour = vec4(display(v_tint.rgb), v_tint.a * cover);
}
