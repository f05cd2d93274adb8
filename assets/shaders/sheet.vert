uniform vec2 size;  // of the picture [px]
in vec4 place;      // per piece: left, top, width, height [px] from the top-left corner
in vec4 cell;       // per glyph: the same in the atlas, 0 … 1
in vec4 tint;       // display RGB and opacity
in vec2 edge;       // per shape: radius of its corners, width of its rim or 0 if it is filled [px];
                    // per glyph: −1, strength of its shadow
out vec2 v_uv;
out vec2 v_at;
flat out vec2 v_size;
flat out vec4 v_tint;
flat out vec2 v_edge;

void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    vec2 at = place.xy + corner * place.zw;
    v_uv = cell.xy + corner * cell.zw;
    v_at = (corner - 0.5) * place.zw;
    v_size = place.zw;
    v_tint = tint;
    v_edge = edge;
    gl_Position = vec4(2.0 * at.x / size.x - 1.0, 1.0 - 2.0 * at.y / size.y, 0.0, 1.0);
}
