#include frame.glsl
in vec3 position;   // of a unit octahedron along +Y
in vec3 normal;
in vec3 start;      // per bone
in vec3 along;      // per bone: from its start to its end [m]
in vec3 aside;      // per bone: half its width, across it [m]
in vec3 tint;       // per bone
out vec3 v_normal;
flat out vec3 v_tint;

void main() {
    float l2 = max(dot(along, along), 1e-12);
    float r2 = max(dot(aside, aside), 1e-12);
    vec3 across = cross(aside, along) * inversesqrt(l2);
    vec3 at = start + aside * position.x + along * position.y + across * position.z;
    v_normal = aside * (normal.x / r2) + along * (normal.y / l2) + across * (normal.z / r2);
    v_tint = tint;
    gl_Position = view_projection * vec4(at, 1.0);
    // the nearest fiftieth of the depth range: in front of every body, yet ordered among themselves
    gl_Position.z = (gl_Position.z + gl_Position.w) * 0.02 - gl_Position.w;
}
