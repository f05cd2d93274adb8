// Skinning alone, for the test that compares it with numpy.
#include skin.glsl
out vec3 at;
out vec3 towards;

void main() { skinned(at, towards); }
