// Somebody else's character: colours from its own pictures, sRGB and opacity, one layer a material.
uniform sampler2DArray pictures;

// The colour at u, v and layer, and how it shines; below layer 0 it is the figure's tint.
vec4 painted(vec3 at, vec3 tint) {
    vec4 texel = texture(pictures, at);
    if (at.z < -0.5) return vec4(tint, 0.10);
    if (texel.a < 0.5) discard;
    return vec4(texel.rgb * (texel.rgb * (texel.rgb * 0.305306011 + 0.682171111) + 0.012522878), 0.12);
}
