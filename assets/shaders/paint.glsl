// The mannequin's two materials, told from where a point lies on the standard one in T-pose. Worked out for each pixel,
// so that the borders are as sharp on the coarse mesh as on the fine one.
float strip(float t, float low, float high) { return min(t - low, high - t); }

// x: distance into the dark material [m]: gloves, shoes, elbows, knees, waist, neck, face plane.
// y: signed distance to the seams where arms and legs are set in.
vec2 paint(vec3 p) {
    p.x = abs(p.x);
    float dark = -0.03, seam;
    if (p.x > 0.24) {
        dark = max(dark, p.x - 0.722 - 0.10 * abs(p.z + 0.015));
        dark = max(dark, strip(p.x + 0.30 * clamp(p.z + 0.015, -0.05, 0.05), 0.436, 0.490));
        seam = 0.03;
    } else if (p.y < 0.80) {
        dark = max(dark, 0.098 - 0.22 * clamp(p.z, -0.08, 0.06) - p.y);
        dark = max(dark, strip(p.y - 0.25 * clamp(p.z, -0.05, 0.05), 0.470, 0.540));
        seam = 0.8 * (0.868 + 0.70 * p.x - 0.35 * clamp(-p.z, 0.0, 0.06) - p.y);
    } else {
        float collar = p.x < 0.10 ? strip(p.y + 0.35 * clamp(p.z, -0.05, 0.10) - 2.6 * p.x * p.x, 1.492, 1.522) : -0.03;
        vec3 q = (p - vec3(0.0, 1.605, 0.120)) / vec3(0.063, 0.074, 0.085);
        float k0 = length(q), k1 = length(q / vec3(0.063, 0.074, 0.085));
        dark = max(max(dark, strip(p.y - 1.9 * p.x * p.x + 0.12 * p.z, 1.030, 1.088)), max(collar, k0 * (1.0 - k0) / k1));
        seam = p.y > 1.15 ? p.x + 0.25 * (p.y - 1.425) - 0.150
                          : 0.8 * (0.868 + 0.70 * p.x - 0.35 * clamp(-p.z, 0.0, 0.06) - p.y);
    }
    return vec2(dark, clamp(seam, -0.03, 0.03));
}

// The colour at a point [m], and how it shines.
vec4 painted(vec3 at, vec3 tint) {
    vec2 field = paint(at), blur = fwidth(field) + 1e-5;
    float dark = clamp(0.5 + field.x / blur.x, 0.0, 1.0);
    // grooves between the parts, too fine to model: 3 mm wide, fainter where a pixel is wider
    vec2 groove = clamp((0.0015 - abs(field)) / blur + 0.5, 0.0, 1.0) * min(0.003 / blur, 1.0);
    float seam = max(groove.x, groove.y * (1.0 - dark));
    vec3 base = mix(tint, vec3(0.045, 0.049, 0.058) + 0.05 * tint, dark) * (1.0 - 0.75 * seam);
    return vec4(base, mix(0.10, 0.35, dark));
}
