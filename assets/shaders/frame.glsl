// What every shader of a frame shares. Positions are in metres, relative to the frame's origin,
// which lies near the camera so that single floats stay fine far from the world's own origin.
layout(std140) uniform Frame {
    mat4 view_projection;
    mat4 figures_light;   // to shadow map coordinates, 0 … 1 in all three
    mat4 solids_light;
    vec4 eye;        // xyz; w: 1 / (fog distance)^4
    vec4 sun;        // xyz towards the sun
    vec4 viewport;   // width, height, 1 / width, 1 / height
    vec4 shade;      // figures' map: xy: 1 / its size [1/m]; z: margin along a normal [m]; w: depth [m], 0 if none
    vec4 stage;      // the same of the solids' map
};

const vec3 SUN = vec3(1.30, 1.18, 1.00);
const vec3 SKY_LIGHT = vec3(0.40, 0.46, 0.54);
const vec3 GROUND_LIGHT = vec3(0.21, 0.20, 0.19);
const vec3 HORIZON = vec3(0.66, 0.72, 0.78);
const vec3 ZENITH = vec3(0.20, 0.33, 0.52);

float fog(vec3 at) {
    vec3 d = at - eye.xyz;
    float d2 = dot(d, d);
    float t = d2 * d2 * eye.w;
    return t / (1.0 + t);
}

// Creases that the sky hardly sees, the sun seldom finds either: what is left of it there.
float through(float open) { return clamp(2.2 * open - 0.35, 0.0, 1.0); }

// Linear light to what the screen shows: a filmic shoulder, then sRGB's curve in three square roots.
vec3 display(vec3 c) {
    c = c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14);
    vec3 a = sqrt(clamp(c, 0.0, 1.0)), b = sqrt(a);
    return 0.585122381 * a + 0.783140355 * b - 0.368262736 * sqrt(b);
}
