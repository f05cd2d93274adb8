uniform sampler2D atlas;    // r: the glyph; g: the glyph's soft shadow
in vec2 v_uv;
in vec2 v_at;
flat in vec4 v_tint;
flat in vec3 v_sheet;
out vec4 colour;

void main() {
    if (v_sheet.z > 0.5) {
        vec2 q = abs(v_at - 0.5 * v_sheet.xy) - 0.5 * v_sheet.xy + 10.0;
        float d = length(max(q, 0.0)) - 10.0;
        colour = vec4(v_tint.rgb, v_tint.a * clamp(0.5 - d, 0.0, 1.0));
    } else {
        vec2 ink = texture(atlas, v_uv).rg;
        float alpha = ink.r + (1.0 - ink.r) * ink.g * 0.75;
        colour = vec4(v_tint.rgb * ink.r / max(alpha, 1e-4), alpha * v_tint.a);
    }
}
