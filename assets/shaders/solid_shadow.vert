#include frame.glsl
#include solid.glsl

void main() {
    gl_Position = vec4((solids_light * vec4(placed(), 1.0)).xyz * 2.0 - 1.0, 1.0);
}
