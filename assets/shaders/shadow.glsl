// How much of the sun reaches a point: 1 lit, 0 in shadow. Figures and solids have a map each: the
// figures' is fine and drawn anew every frame, the solids' is wide and kept. TAPS is set by the preset.
uniform sampler2DShadow figures_map, solids_map;

#if TAPS == 16
// The sun is a disc, so a shadow is sharp where it begins and softer the farther it falls (Fernando 2005,
// "Percentage-closer soft shadows"): first how far off the caster is, then a blur as wide as follows.
uniform sampler2D figures_depth, solids_depth;
const float SUN_RADIUS = 0.013;    // half the sun's angle [rad]; a hazy one
const float WIDEST = 0.035;        // of a penumbra, to either side [m]
// in golden-angle order: no two lie in one row, so edges do not show steps
const vec2 DISC[16] = vec2[16](
    vec2(0.177, 0.000), vec2(-0.226, 0.207), vec2(0.035, -0.394), vec2(0.285, 0.371),
    vec2(-0.522, -0.092), vec2(0.495, -0.315), vec2(-0.165, 0.616), vec2(-0.316, -0.608),
    vec2(0.685, 0.250), vec2(-0.712, 0.294), vec2(0.343, -0.734), vec2(0.254, 0.809),
    vec2(-0.765, -0.443), vec2(0.897, -0.197), vec2(-0.548, 0.779), vec2(-0.126, -0.976));
float reach(sampler2D depths, vec4 map, vec3 p) {
    float sum = 0.0, count = 0.0;
    for (int i = 1; i < 16; i += 2) {
        float before = p.z - texture(depths, p.xy + DISC[i] * WIDEST * map.xy).r;
        if (before > 0.004 / map.w) { sum += before; count += 1.0; }
    }
    return min(sum / max(count, 1.0) * map.w * SUN_RADIUS, WIDEST) * step(0.5, count);
}
#define REACH_IN(depths, map, p) reach(depths, map, p)
#else
#define REACH_IN(depths, map, p) 0.009
#endif
#if TAPS == 4
const vec2 DISC[4] = vec2[4](vec2(0.35, 0.62), vec2(-0.62, 0.35), vec2(-0.35, -0.62), vec2(0.62, -0.35));
#endif

// map: 1 / its size [1/m], margin, depth [m].
float past(sampler2DShadow depth, vec4 map, float reach, vec3 p) {
#if TAPS == 1
    return texture(depth, p);
#else
    vec2 size = max(reach * map.xy, 1.2 / vec2(textureSize(depth, 0)));
    float lit = 0.0;
    for (int i = 0; i < TAPS; i++) lit += texture(depth, vec3(p.xy + DISC[i] * size, p.z));
    return lit / float(TAPS);
#endif
}

// Beyond a map nothing casts a shadow, and without one either.
bool within(vec4 map, vec3 p) {
    vec3 off = abs(p - 0.5);
    return map.w > 0.0 && max(off.x, max(off.y, off.z)) < 0.5;
}

// n: the surface's normal; nothing for one that casts no shadow itself and so needs no margin from its own.
float sunlight(vec3 at, vec3 n) {
    vec3 p = (figures_light * vec4(at + n * shade.z, 1.0)).xyz;
    float lit = 1.0;
    if (within(shade, p)) lit = past(figures_map, shade, REACH_IN(figures_depth, shade, p), p);
    p = (solids_light * vec4(at + n * stage.z, 1.0)).xyz;
    if (within(stage, p)) lit *= past(solids_map, stage, REACH_IN(solids_depth, stage, p), p);
    return lit;
}
