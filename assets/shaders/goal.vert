#include frame.glsl
in vec3 position;   // a square on the floor, then a tube −1 … 1
in vec4 place;      // per goal: its middle on the floor; w: radius
in vec4 tint;       // per goal; w: height of the column
out vec3 v_local;   // in radii; y: up the column, 0 … 1
out vec3 v_at;
flat out vec3 v_tint;

void main() {
    v_local = vec3(position.x, 0.5 + 0.5 * position.y, position.z);
    bool ring = position.y == 0.0;
    v_at = place.xyz + vec3(position.x * place.w, 0.006 + (ring ? 0.0 : v_local.y * tint.w), position.z * place.w);
    if (ring) v_local.y = -1.0;
    v_tint = tint.rgb;
    gl_Position = view_projection * vec4(v_at, 1.0);
}
