// How much of the sky a surface point sees past limbs, solids and the floor: 1 all, 0 nothing.
// All from shapes, without samples: it is smooth, and the same from frame to frame.
const int LIMBS = 15;
// 16, 48 and LIMBS are FIGURES, SOLIDS and COUNT of render/occlusion.py.
layout(std140) uniform Occluders {
    vec4 count;               // x: figures; y: solids
    vec4 ball[16];            // a figure's middle; w: (how far it darkens anything)^2
    vec4 limb[16 * LIMBS * 2];   // capsules, the lowest first: two ends; w: radius, height of the lower end
    vec4 solid[48 * 3];       // centre, w: 1 if round; half its size; cosine and sine of its heading
};
const float REACH = 0.5;      // where a limb's darkening ends [m]
const float CREASE = 0.35;    // how far from a solid its darkening ends [m]

// A capsule hides about what a ball at its nearest point would, and more, as it is long
// (after Quilez, "Capsule occlusion"). A limb never hides its own surface: its axis lies behind.
float beside(vec3 at, vec3 n, vec4 a, vec3 b) {
    vec3 along = b - a.xyz, from = at - a.xyz;
    vec3 d = along * clamp(dot(from, along) / max(dot(along, along), 1e-8), 0.0, 1.0) - from;
    float l2 = dot(d, d) + 1e-6;
    float near = max(1.0 - l2 / (REACH * REACH), 0.0);
    float hidden = max(dot(n, d), 0.0) * inversesqrt(l2) * min(a.w * a.w / l2, 1.0) * near;
    return (1.0 - hidden) * (1.0 - 0.5 * hidden);
}

float past_limbs(vec3 at, vec3 n) {
    float sees = 1.0;
    for (int f = 0; f < int(count.x); f++) {
        vec3 d = at - ball[f].xyz;
        if (dot(d, d) < ball[f].w)
            for (int k = 2 * LIMBS * f; k < 2 * LIMBS * (f + 1) && limb[k + 1].w < at.y + REACH; k += 2)
                sees *= beside(at, n, limb[k], limb[k + 1].xyz);
    }
    return sees;
}

// What stands within CREASE along the normal darkens: half the sky where a wall meets a floor.
float creased(float distance) { return 1.0 - 0.5 * (1.0 - smoothstep(0.0, CREASE, distance)); }

float past_solids(vec3 at, vec3 n) {
    vec3 p = at + CREASE * n;
    float past = 1.0;  // the nearest alone: a flight's steps lie in each other
    for (int k = 0; k < 3 * int(count.y); k += 3) {
        vec3 q = p - solid[k].xyz, half_size = solid[k + 1].xyz;
        vec3 turn = solid[k + 2].xyz;
        q = vec3(turn.x * q.x - turn.y * q.z, q.y, turn.y * q.x + turn.x * q.z);
        q.y -= turn.z * q.z;
        if (solid[k].w > 0.5) q = vec3(length(q.xz), q.y, 0.0);
        vec3 d = max(abs(q) - half_size, 0.0);
        past = min(past, creased(length(d)));
    }
    return creased(p.y) * past;
}

float sky_seen(vec3 at, vec3 n) { return past_limbs(at, n) * past_solids(at, n); }
