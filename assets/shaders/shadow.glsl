// How much of the sun reaches a point: 1 lit, 0 in shadow. TAPS is set by the preset.
uniform sampler2DShadow shadow_map;

float sunlight(vec3 at) {
    vec3 p = (light * vec4(at, 1.0)).xyz;
#if TAPS == 1
    float lit = texture(shadow_map, p);
#else
    // a disc of taps in golden-angle order: no two lie in one row, so edges do not show steps
    float lit = 0.0;
#if TAPS == 4
    const vec2 DISC[4] = vec2[4](vec2(0.35, 0.62), vec2(-0.62, 0.35), vec2(-0.35, -0.62), vec2(0.62, -0.35));
#else
    const vec2 DISC[9] = vec2[9](vec2(0.0, 0.0), vec2(0.47, 0.10), vec2(-0.36, 0.38), vec2(0.04, -0.58),
        vec2(0.55, 0.62), vec2(-0.86, 0.0), vec2(0.68, -0.62), vec2(-0.26, 0.93), vec2(-0.50, -0.80));
#endif
    for (int i = 0; i < TAPS; i++) lit += texture(shadow_map, vec3(p.xy + DISC[i] * shade.xy, p.z));
    lit *= 1.0 / float(TAPS);
#endif
    // beyond the map nobody casts a shadow
    vec3 off = abs(p - 0.5);
    return max(off.x, max(off.y, off.z)) < 0.5 ? lit : 1.0;
}
