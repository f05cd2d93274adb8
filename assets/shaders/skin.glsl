// Dual-quaternion skinning: rigid motions are blended and stay rigid, so that neither a twisted
// forearm nor a folded knee loses its girth. 30 motions for each of up to 16 figures.
layout(std140) uniform Figures {
    vec4 motion[16 * 30 * 2];  // real, dual part of each joint's motion
    vec4 look[16];             // linear tint; w: size of the figure over that of the mesh
};
in vec3 position;
in vec3 normal;
in uvec4 joints;
in vec4 weights;

void skinned(out vec3 at, out vec3 towards) {
    int base = gl_InstanceID * 60;
    ivec4 j = base + 2 * ivec4(joints);
    vec4 r = motion[j.x], r1 = motion[j.y], r2 = motion[j.z], r3 = motion[j.w];
    // q and -q turn alike: take the copies on the first one's side
    vec4 w = weights * vec4(1.0, dot(r, r1) < 0.0 ? -1.0 : 1.0, dot(r, r2) < 0.0 ? -1.0 : 1.0,
                            dot(r, r3) < 0.0 ? -1.0 : 1.0);
    r = r * w.x + r1 * w.y + r2 * w.z + r3 * w.w;
    vec4 d = motion[j.x + 1] * w.x + motion[j.y + 1] * w.y + motion[j.z + 1] * w.z + motion[j.w + 1] * w.w;
    float s = inversesqrt(dot(r, r));
    r *= s;
    d *= s;
    vec3 p = position * look[gl_InstanceID].w;
    at = p + 2.0 * (cross(r.xyz, cross(r.xyz, p) + r.w * p) + r.w * d.xyz - d.w * r.xyz + cross(r.xyz, d.xyz));
    towards = normal + 2.0 * cross(r.xyz, cross(r.xyz, normal) + r.w * normal);
}
