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
out vec4 colour;

void main() {
    vec3 n = normalize(gl_FrontFacing ? v_normal : -v_normal);  // thin cloth shows its other side
    vec4 base = painted(v_paint, v_tint);
    colour = vec4(display(shaded(v_at, n, base.rgb, v_open, base.a)), 1.0);
}
