uniform vec2 size;  // of the picture that places count in [px]
in vec2 place;      // [px] from the top-left corner
in vec2 uv;
in vec4 tint;       // display RGB and opacity
out vec2 v_uv;
out vec4 v_tint;

void main() {
    v_uv = uv;
    v_tint = tint;
    gl_Position = vec4(2.0 * place.x / size.x - 1.0, 1.0 - 2.0 * place.y / size.y, 0.0, 1.0);
}
