#include frame.glsl
#include solid.glsl
in vec3 tint;       // per solid
out vec3 v_at;
out vec3 v_local;   // along the solid's own axes, from its middle [m]
flat out vec3 v_half;
flat out vec3 v_turn;   // z: 1 if round
flat out vec3 v_tint;
flat out float v_slope;

void main() {
    v_at = placed();
    v_local = position * half_size.xyz;
    v_half = half_size.xyz;
    v_turn = vec3(turn.xy, place.w);
    v_tint = tint;
    v_slope = turn.z;
    gl_Position = view_projection * vec4(v_at, 1.0);
}
