#include frame.glsl
#include grid.glsl
#if TOUCHED
#include shadow.glsl
#include occlusion.glsl
#endif
in vec3 v_at;
out vec4 colour;

void main() {
    vec2 w = max(abs(dFdx(v_at.xz)), abs(dFdy(v_at.xz))) + 1e-4;
    vec3 base = 0.21 * vec3(0.96, 1.0, 1.05) * grid(v_at.xz, w);
#if TOUCHED     // perhaps in the shadow of something, or close to it
    const vec3 UP = vec3(0.0, 1.0, 0.0);
    float open = sky_seen(v_at, UP);
    vec3 light_in = SKY_LIGHT * open + SUN * (sun.y * sunlight(v_at, vec3(0.0)) * through(open));
#else
    vec3 light_in = SKY_LIGHT + SUN * sun.y;
#endif
    colour = vec4(display(mix(base * light_in, HORIZON, fog(v_at))), 1.0);
}
