#include frame.glsl
#include shadow.glsl
#include occlusion.glsl
#include lit.glsl
#include grid.glsl
in vec3 v_at;
in vec3 v_local;
flat in vec3 v_half;
flat in vec3 v_turn;
flat in vec3 v_tint;
flat in float v_slope;
out vec4 colour;
const float BEVEL = 0.018;

// The normal of the solid with its upper edges rounded: away from the nearest point of its core.
vec3 bevelled() {
    vec3 local = clamp(v_local, -v_half, v_half), core = max(v_half - BEVEL, 0.0);
    vec3 low = vec3(-core.x, -v_half.y, -core.z);
    if (v_turn.z > 0.5) {
        float r = max(length(v_local.xz), 1e-6);
        vec2 n = vec2(r, local.y) - clamp(vec2(r, local.y), low.xy, core.xy);
        local = vec3(local.x / r * n.x, n.y, local.z / r * n.x);
    } else {
        local -= clamp(local, low, core);
        local.z -= v_slope * local.y;
    }
    return vec3(v_turn.x * local.x + v_turn.y * local.z, local.y, v_turn.x * local.z - v_turn.y * local.x);
}

void main() {
    vec3 right = dFdx(v_at), up = dFdy(v_at);
    float pixel = length(abs(right) + abs(up));
    // where a pixel is wider than the bevel, it fades instead of flickering
    vec3 n = normalize(mix(normalize(cross(right, up)), bevelled() / BEVEL, clamp(BEVEL / pixel, 0.0, 1.0)));
    vec3 base = v_tint;
    if (n.y > 0.5) base *= grid(v_local.xz, max(abs(dFdx(v_local.xz)), abs(dFdy(v_local.xz))) + 1e-4);
    colour = vec4(display(shaded(v_at, n, base, sky_seen(v_at, n), 0.03)), 1.0);
}
