#include frame.glsl
#include shadow.glsl
#include lit.glsl
#if PICTURES
#include picture.glsl
#else
#include paint.glsl
#endif
in vec3 v_at;
in vec3 v_normal;
in vec3 v_paint;     // where its colour is looked up
in float v_open;     // how open it is to the sky, 0 … 1
flat in vec3 v_tint;
uniform float opacity;  // 1, or less of a ghost
uniform float cover;    // 1, or less of who stands in the camera's way
out vec4 colour;

void main() {
    vec3 n = normalize(gl_FrontFacing ? v_normal : -v_normal);  // thin cloth shows its other side
    vec4 base = painted(v_paint, v_tint);
    float seen = 1.0;
    if (opacity < 1.0) {  // one colour all over, and firmer towards its rim, so that it is read by its outline
        float facing = max(dot(n, normalize(eye.xyz - v_at)), 0.0);
        base = vec4(v_tint, 0.05);
        seen = mix(opacity, 1.0, 0.75 * (1.0 - facing) * (1.0 - facing));
    }
    colour = vec4(display(shaded(v_at, n, base.rgb, v_open, base.a)), seen * cover);
}
