#include frame.glsl
in vec3 position;
out vec3 v_at;

void main() {
    v_at = position;
    gl_Position = view_projection * vec4(position, 1.0);
}
