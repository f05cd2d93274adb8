#include frame.glsl
in vec4 v_tint;
in vec3 v_shape;    // z: what it is; xy: place in it, −1 … 1, or along x in dashes
out vec4 colour;

const float DISC = 0.0, BAND = 1.0, DASHES = 2.0, RIMMED = 3.0, HEAD = 4.0, DOT = 5.0, QUARTERS = 6.0, FILL = 7.0,
    BALL = 8.0, RING = 9.0;

void main() {
    float x = v_shape.x, y = abs(v_shape.y), r = length(v_shape.xy);
    float wx = fwidth(x) + 1e-5, wy = fwidth(v_shape.y) + 1e-5, wr = fwidth(r) + 1e-5;
    float tip = 1.0 - x - y, wt = fwidth(tip) + 1e-5;
    float kind = floor(v_shape.z + 0.5), cover = 1.0;
    vec3 tint = v_tint.rgb, dark = 0.16 * tint;
    if (kind == DISC) {
        cover = clamp((1.0 - r) / wr, 0.0, 1.0) * (0.35 + 0.65 * clamp((r - 0.78) / wr, 0.0, 1.0));
    } else if (kind == HEAD) {
        cover = clamp(tip / wt, 0.0, 1.0);
        tint = mix(tint, dark, clamp((0.16 - min(tip, x)) / max(wt, 1e-3), 0.0, 1.0));
    } else if (kind == DOT || kind == QUARTERS) {
        cover = clamp((1.0 - r) / wr, 0.0, 1.0);
        if (kind == QUARTERS) {
            vec2 across = clamp(v_shape.xy / (fwidth(v_shape.xy) + 1e-5) + 0.5, 0.0, 1.0);
            float even = across.x * across.y + (1.0 - across.x) * (1.0 - across.y);
            tint = mix(vec3(0.01), tint, even);
        }
        tint = mix(tint, dark, clamp((r - 0.80) / wr + 0.5, 0.0, 1.0));
    } else if (kind == BALL) {
        cover = clamp((1.0 - r) / wr, 0.0, 1.0);
        vec3 n = vec3(v_shape.xy, sqrt(max(1.0 - r * r, 0.0)));  // lit from over the left shoulder
        float facing = dot(n, vec3(-0.40, 0.66, 0.63));
        tint = tint * (0.35 + 0.75 * max(facing, 0.0)) + 0.5 * pow(max(facing, 0.0), 24.0);
        tint = mix(tint, dark, clamp((r - 0.88) / wr + 0.5, 0.0, 1.0));
    } else if (kind == RING) {
        cover = clamp((1.0 - r) / wr, 0.0, 1.0) * clamp((r - 0.66) / wr + 0.5, 0.12, 1.0);
    } else if (kind != FILL) {
        cover = clamp((1.0 - y) / wy, 0.0, 1.0) * min(2.0 / wy, 1.0);
        if (kind == DASHES) {
            float d = abs(fract(x) - 0.5);
            cover *= mix(clamp((0.3 - d) / wx + 0.5, 0.0, 1.0), 0.6, clamp(wx, 0.0, 1.0));
        } else if (kind == RIMMED) {
            tint = mix(tint, dark, clamp((y - 0.62) / wy + 0.5, 0.0, 1.0) * clamp(2.0 - 4.0 * wy, 0.0, 1.0));
        }
    }
    colour = vec4(display(tint), v_tint.a * cover);
}
