#include frame.glsl
#include skin.glsl
#include occlusion.glsl
in float open;
in vec3 paint;
uniform float behind;  // how far it is pushed along the line of sight, where it is seen alike [m]
out vec3 v_at;
out vec3 v_normal;
out vec3 v_paint;
out float v_open;
flat out vec3 v_tint;

void main() {
    skinned(v_at, v_normal);
    v_paint = paint;
    v_open = open * sky_seen(v_at, v_normal);
    v_tint = look[gl_InstanceID].rgb;
    gl_Position = view_projection * vec4(v_at + behind * normalize(v_at - eye.xyz), 1.0);
}
