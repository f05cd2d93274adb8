#include frame.glsl
in vec3 position;
in vec4 tint;       // linear RGB and opacity
in vec3 shape;      // x, y: place within the mark; z: what it is
out vec4 v_tint;
out vec3 v_shape;

void main() {
    v_tint = tint;
    v_shape = shape;
    gl_Position = view_projection * vec4(position, 1.0);
#ifdef THROUGH
    // the very nearest of the depth range: in front of every body and bone
    gl_Position.z = (gl_Position.z + gl_Position.w) * 0.001 - gl_Position.w;
#endif
}
