uniform sampler2D sheet;
in vec2 v_uv;
in vec4 v_tint;
out vec4 colour;

void main() {
    colour = v_tint * texture(sheet, v_uv);
}
