#include frame.glsl
#if SUNLIT == 1
#include shadow.glsl
#endif
in vec3 v_at;
out vec4 colour;

// Each pattern is averaged over the pixel's own footprint (a box filter), so that it fades to its
// mean towards the horizon instead of shimmering.
float checker(vec2 p, vec2 w) {
    vec2 i = 2.0 * (abs(fract((p - 0.5 * w) * 0.5) - 0.5) - abs(fract((p + 0.5 * w) * 0.5) - 0.5)) / w;
    return 0.5 - 0.5 * i.x * i.y;
}

float lines(vec2 p, vec2 w, float width) {
    vec2 a = p + 0.5 * (width + w), b = p + 0.5 * (width - w);
    vec2 i = (floor(a) + min(fract(a) / width, 1.0) - floor(b) - min(fract(b) / width, 1.0)) * width / w;
    return 1.0 - (1.0 - i.x) * (1.0 - i.y);
}

void main() {
    vec2 p = v_at.xz;
    vec2 w = max(abs(dFdx(p)), abs(dFdy(p))) + 1e-4;
    float tone = mix(0.185, 0.235, checker(p, w));
    tone *= 1.0 - 0.22 * lines(p * 5.0, w * 5.0, 0.04);
    tone *= 1.0 - 0.42 * lines(p, w, 0.018);
    vec3 base = tone * vec3(0.96, 1.0, 1.05);
    vec3 light_in = SKY_LIGHT;
#if SUNLIT == 1     // perhaps in somebody's shadow (0: certainly in a box's, 2: in the open)
    light_in += SUN * (sun.y * sunlight(v_at));
#elif SUNLIT == 2
    light_in += SUN * sun.y;
#endif
    colour = vec4(display(mix(base * light_in, HORIZON, fog(v_at))), 1.0);
}
