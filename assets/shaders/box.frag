#include frame.glsl
#include shadow.glsl
#include lit.glsl
in vec3 v_at;
in vec3 v_normal;
in vec3 v_local;
flat in vec3 v_half;
flat in vec3 v_tint;
out vec4 colour;

void main() {
    // a fine lighter line along the edges, so that boxes of one colour read against each other
    vec3 inside = v_half - abs(v_local);
    vec3 side = step(vec3(0.5), abs(v_normal.xyz));
    vec3 sorted = vec3(min(inside.x, min(inside.y, inside.z)), 0.0, max(inside.x, max(inside.y, inside.z)));
    sorted.y = inside.x + inside.y + inside.z - sorted.x - sorted.z;
    float width = fwidth(sorted.y) + 1e-5;
    float edge = clamp((0.012 - sorted.y) / width + 0.5, 0.0, 1.0) * min(0.024 / width, 1.0);
    float open = 0.75 + 0.25 * clamp(v_at.y * 1.5, 0.0, 1.0);
    vec3 base = v_tint * (1.0 + 0.35 * edge);
    colour = vec4(display(shaded(v_at, normalize(v_normal), base, open, 0.03)), 1.0);
}
