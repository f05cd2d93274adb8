#include frame.glsl
in vec3 v_local;
in vec3 v_at;
flat in vec3 v_tint;
out vec4 colour;

void main() {
    float shows;
    if (v_local.y < 0.0) {  // the ring, and a breath of light within
        float r = length(v_local.xz), w = fwidth(r) + 1e-5;
        float band = clamp((0.06 - abs(r - 0.94)) / w + 0.5, 0.0, 1.0) * min(0.12 / w, 1.0);
        shows = max(0.95 * band, r < 0.94 ? 0.22 * r * r : 0.0);
    } else {                // the column is a shell: thicker to look through at its sides
        float facing = abs(dot(normalize(v_local.xz), normalize((eye.xyz - v_at).xz)));
        float fade = 1.0 - v_local.y;
        shows = 0.30 * fade * fade * (1.2 - facing);
    }
    colour = vec4(display(v_tint), shows * (1.0 - fog(v_at)));
}
