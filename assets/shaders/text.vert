#include frame.glsl
in vec4 place;      // per glyph: left, top, width, height [px] from the top-left corner
in vec4 cell;       // per glyph: the same in the atlas, 0 … 1
in vec4 tint;       // per glyph: display RGB and opacity
out vec2 v_uv;
flat out vec4 v_tint;

void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    vec2 at = place.xy + corner * place.zw;
    v_uv = cell.xy + corner * cell.zw;
    v_tint = tint;
    gl_Position = vec4(at.x * viewport.z * 2.0 - 1.0, 1.0 - at.y * viewport.w * 2.0, 0.0, 1.0);
}
