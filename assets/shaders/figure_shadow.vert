#include frame.glsl
#include skin.glsl

void main() {
    vec3 at, towards;
    skinned(at, towards);
    gl_Position = vec4((figures_light * vec4(at, 1.0)).xyz * 2.0 - 1.0, 1.0);
}
