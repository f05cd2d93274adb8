uniform sampler2D atlas;    // r: the glyph; g: the glyph's soft shadow
in vec2 v_uv;
flat in vec4 v_tint;
out vec4 colour;

void main() {
    vec2 ink = texture(atlas, v_uv).rg;
    float alpha = ink.r + (1.0 - ink.r) * ink.g * 0.75;
    colour = vec4(v_tint.rgb * ink.r / max(alpha, 1e-4), alpha * v_tint.a);
}
