uniform sampler2D atlas;    // r: the glyph; g: the glyph's soft shadow
in vec2 v_uv;
in vec2 v_at;
flat in vec2 v_size;
flat in vec4 v_tint;
flat in vec2 v_edge;
out vec4 colour;

void main() {
    if (v_edge.x < 0.0) {
        vec2 ink = texture(atlas, v_uv).rg;
        float alpha = ink.r + (1.0 - ink.r) * ink.g * v_edge.y;
        colour = vec4(v_tint.rgb * ink.r / max(alpha, 1e-4), alpha * v_tint.a);
    } else {
        // the distance to the edge of a rounded rectangle, negative inside
        vec2 q = abs(v_at) - 0.5 * v_size + v_edge.x;
        float d = length(max(q, 0.0)) + min(max(q.x, q.y), 0.0) - v_edge.x;
        float inside = clamp(0.5 - d, 0.0, 1.0);
        float hole = v_edge.y > 0.0 ? clamp(0.5 - d - v_edge.y, 0.0, 1.0) : 0.0;
        colour = vec4(v_tint.rgb, v_tint.a * (inside - hole));
    }
}
