#include frame.glsl
#include box.glsl
in vec3 tint;       // per box
out vec3 v_at;
out vec3 v_normal;
out vec3 v_local;   // distance along each edge [m], from the middle
flat out vec3 v_half;
flat out vec3 v_tint;

void main() {
    v_at = placed();
    v_normal = turned(normal);
    v_local = position * extent.xyz;
    v_half = 0.5 * extent.xyz;
    v_tint = tint;
    gl_Position = view_projection * vec4(v_at, 1.0);
}
