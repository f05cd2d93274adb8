// A checker of metres with lines every metre and every decimetre, as a factor about 1. Each pattern is
// averaged over the pixel's own footprint w (a box filter), so that it fades to its mean towards the
// horizon and does not shimmer.
float checker(vec2 p, vec2 w) {
    vec2 i = 2.0 * (abs(fract((p - 0.5 * w) * 0.5) - 0.5) - abs(fract((p + 0.5 * w) * 0.5) - 0.5)) / w;
    return 0.5 - 0.5 * i.x * i.y;
}

float lines(vec2 p, vec2 w, float width) {
    vec2 a = p + 0.5 * (width + w), b = p + 0.5 * (width - w);
    vec2 i = (floor(a) + min(fract(a) / width, 1.0) - floor(b) - min(fract(b) / width, 1.0)) * width / w;
    return 1.0 - (1.0 - i.x) * (1.0 - i.y);
}

float grid(vec2 p, vec2 w) {
    float fine = lines(p * 10.0, w * 10.0, 0.045), coarse = lines(p, w, 0.018);
    return mix(0.88, 1.12, checker(p, w)) * (1.0 - 0.20 * fine) * (1.0 - 0.42 * coarse);
}
