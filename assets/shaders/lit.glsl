// One surface under the sun and the sky.
vec3 shaded(vec3 at, vec3 n, vec3 colour, float open, float gloss) {
    float facing = dot(n, sun.xyz);
    float lit = facing > 0.0 ? sunlight(at, n) : 0.0;
    lit *= min(through(open) + 0.4 * max(facing, 0.0), 1.0);
    vec3 view = normalize(eye.xyz - at);
    vec3 middle = normalize(view + sun.xyz);
    float shine = pow(max(dot(n, middle), 0.0), 40.0) * gloss;
    float edge = 1.0 - max(dot(n, view), 0.0);
    edge *= edge;
    vec3 ambient = mix(GROUND_LIGHT, SKY_LIGHT, 0.5 + 0.5 * n.y);
    vec3 light_in = ambient * open + SUN * (max(facing, 0.0) * lit);
    vec3 sheen = ambient * (open * edge * edge * (0.15 + gloss)) + SUN * (shine * lit * max(facing, 0.0));
    return mix(colour * light_in + sheen, HORIZON, fog(at));
}
