"""The mannequin's shape: signed distances [m] of limbs and muscles, joined smoothly.

Modelled around the standard human's T-pose (1.741 m), left half only: x is mirrored. Every
function takes points (N, 3) and gives (N,), negative inside.
"""

from __future__ import annotations

import numpy as np


def cone(p, a, b, ra, rb):
    """A limb: a ball of radius ra at a rolled towards one of radius rb at b."""
    a, b = np.asarray(a, p.dtype), np.asarray(b, p.dtype)
    axis = b - a
    l2 = float(axis @ axis)
    rr = ra - rb
    a2 = l2 - rr * rr
    pa = p - a
    y = pa @ axis
    z = y - l2
    across = pa * l2 - axis * y[:, None]
    x2 = np.einsum("ij,ij->i", across, across)
    y2, z2 = y * y * l2, z * z * l2
    k = np.sign(rr) * rr * rr * x2
    body = (np.sqrt(np.maximum(x2 * a2 / l2, 0)) + y * rr) / l2 - ra
    end_b = np.sqrt(x2 + z2) / l2 - rb
    end_a = np.sqrt(x2 + y2) / l2 - ra
    return np.where(np.sign(z) * a2 * z2 > k, end_b, np.where(np.sign(y) * a2 * y2 < k, end_a, body))


def ellipsoid(p, centre, radii, tilt=0.0):
    """An ellipsoid; tilt: turned about x, forwards at the top [rad]. The distance is approximate."""
    q = p - np.asarray(centre, p.dtype)
    if tilt:
        c, s = np.cos(tilt), np.sin(tilt)
        q = np.stack([q[:, 0], c * q[:, 1] + s * q[:, 2], -s * q[:, 1] + c * q[:, 2]], 1).astype(p.dtype)
    r = np.asarray(radii, p.dtype)
    k0 = np.linalg.norm(q / r, axis=1)
    k1 = np.linalg.norm(q / (r * r), axis=1)
    return k0 * (k0 - 1.0) / np.maximum(k1, 1e-6)


def squashed(p, factor, axis, about, shape, *args):
    """A shape whose extent along one axis, about a coordinate, is multiplied by `factor`."""
    q = p.copy()
    q[:, axis] = about + (q[:, axis] - about) / factor
    return shape(q, *args) * min(1.0, factor) ** 0.5


def join(a, b, k):
    """The union, filled over a seam of about k."""
    h = np.maximum(k - np.abs(a - b), 0.0) / k
    return np.minimum(a, b) - h * h * h * k / 6.0


def carve(a, b, k):
    """a without b, softly."""
    return -join(-a, b, k)


def head(p):
    skull = ellipsoid(p, (0, 1.655, -0.004), (0.077, 0.088, 0.098))
    front = ellipsoid(p, (0, 1.632, 0.036), (0.066, 0.080, 0.066))
    jaw = ellipsoid(p, (0, 1.575, 0.040), (0.056, 0.052, 0.058), tilt=-0.25)
    chin = ellipsoid(p, (0, 1.538, 0.074), (0.028, 0.020, 0.024))
    d = join(join(skull, front, 0.05), join(jaw, chin, 0.045), 0.055)
    # a mask rather than a face: one soft ridge tells where it looks
    ridge = cone(p, (0, 1.652, 0.082), (0, 1.588, 0.094), 0.012, 0.014)
    d = join(d, ridge, 0.060)
    ear = ellipsoid(p, (0.073, 1.614, -0.004), (0.012, 0.029, 0.018), tilt=-0.15)
    return join(d, ear, 0.010)


def neck(p):
    throat = cone(p, (0, 1.450, -0.024), (0, 1.585, 0.004), 0.060, 0.054)
    slope = cone(p, (0.015, 1.488, -0.032), (0.150, 1.436, -0.022), 0.040, 0.040)
    return join(throat, slope, 0.07)


def trunk(p):
    ribs = squashed(p, 0.70, 2, -0.004, cone, (0, 1.295, -0.004), (0, 1.180, 0.000), 0.160, 0.132)
    upper = squashed(p, 0.70, 2, -0.010, cone, (0, 1.360, -0.010), (0.105, 1.385, -0.012), 0.130, 0.082)
    chest = ellipsoid(p, (0.075, 1.350, 0.056), (0.086, 0.066, 0.046), tilt=-0.35)
    blades = ellipsoid(p, (0.085, 1.350, -0.080), (0.075, 0.100, 0.034), tilt=0.1)
    wing = cone(p, (0.143, 1.350, -0.030), (0.100, 1.165, -0.012), 0.052, 0.030)
    waist = squashed(p, 0.76, 2, 0.002, cone, (0, 1.180, 0.002), (0, 1.050, 0.0), 0.121, 0.128)
    belly = ellipsoid(p, (0, 1.110, 0.052), (0.085, 0.130, 0.052))
    d = join(join(ribs, upper, 0.06), wing, 0.06)
    d = join(join(d, chest, 0.06), blades, 0.05)
    d = join(join(d, waist, 0.08), belly, 0.06)
    pelvis = squashed(p, 0.72, 2, 0.0, cone, (0.0, 0.985, 0.0), (0.055, 0.960, 0.0), 0.126, 0.110)
    seat = ellipsoid(p, (0.072, 0.930, -0.058), (0.080, 0.090, 0.066), tilt=-0.1)
    crotch = ellipsoid(p, (0, 0.900, 0.024), (0.055, 0.062, 0.055))
    d = join(join(d, pelvis, 0.08), seat, 0.05)
    return join(d, crotch, 0.06)


def leg(p):
    x = 0.0875
    thigh = cone(p, (x + 0.010, 0.900, -0.002), (x, 0.520, 0.004), 0.083, 0.054)
    front = ellipsoid(p, (x + 0.010, 0.740, 0.028), (0.062, 0.175, 0.060))
    inner = ellipsoid(p, (x - 0.025, 0.790, -0.008), (0.048, 0.170, 0.062))
    hams = ellipsoid(p, (x, 0.720, -0.032), (0.056, 0.165, 0.054))
    d = join(join(thigh, front, 0.05), join(inner, hams, 0.05), 0.05)
    knee = ellipsoid(p, (x, 0.508, 0.016), (0.046, 0.056, 0.046))
    shin = cone(p, (x, 0.480, 0.002), (x, 0.095, -0.004), 0.050, 0.036)
    calf = ellipsoid(p, (x + 0.004, 0.380, -0.024), (0.050, 0.120, 0.052), tilt=-0.05)
    calf = join(calf, ellipsoid(p, (x - 0.012, 0.355, -0.022), (0.040, 0.100, 0.046)), 0.03)
    d = join(join(d, knee, 0.05), join(shin, calf, 0.05), 0.045)
    hock = cone(p, (x, 0.160, -0.028), (x, 0.060, -0.044), 0.016, 0.022)
    ankles = cone(p, (x - 0.024, 0.080, -0.002), (x + 0.024, 0.072, -0.006), 0.020, 0.019)
    return join(join(d, hock, 0.05), ankles, 0.03)


def foot(p):
    x = 0.0875
    heel = ellipsoid(p, (x, 0.034, -0.040), (0.037, 0.050, 0.044))
    instep = cone(p, (x - 0.002, 0.070, 0.004), (x - 0.006, 0.022, 0.132), 0.044, 0.028)
    ball = squashed(p, 0.66, 1, 0.010, cone, (x - 0.018, 0.016, 0.120), (x + 0.022, 0.014, 0.096), 0.036, 0.034)
    toes = squashed(p, 0.68, 1, 0.008, cone, (x - 0.014, 0.016, 0.135), (x - 0.008, 0.013, 0.166), 0.037, 0.032)
    outer = squashed(p, 0.66, 1, 0.008, cone, (x + 0.022, 0.013, 0.105), (x + 0.014, 0.012, 0.148), 0.031, 0.028)
    sole = squashed(p, 0.60, 1, 0.016, cone, (x, 0.016, -0.040), (x + 0.004, 0.016, 0.090), 0.036, 0.040)
    d = join(join(heel, join(instep, sole, 0.03), 0.04), join(ball, join(toes, outer, 0.03), 0.03), 0.035)
    # the sole: flat on the floor, its rim a little rounded
    return carve(d, p[:, 1].copy(), 0.012)


def arm(p):
    y, z = 1.425, -0.015
    shoulder = ellipsoid(p, (0.186, y - 0.002, z), (0.078, 0.065, 0.066))
    upper = cone(p, (0.200, y, z), (0.450, y, z), 0.053, 0.041)
    biceps = ellipsoid(p, (0.325, y + 0.002, z + 0.018), (0.100, 0.042, 0.040))
    triceps = ellipsoid(p, (0.310, y - 0.002, z - 0.022), (0.110, 0.042, 0.038))
    elbow = ellipsoid(p, (0.458, y, z - 0.004), (0.046, 0.041, 0.043))
    fore = cone(p, (0.470, y, z), (0.715, y, z), 0.042, 0.028)
    meat = ellipsoid(p, (0.540, y + 0.002, z + 0.005), (0.090, 0.042, 0.047))
    wrist = squashed(p, 0.80, 1, y, cone, (0.660, y, z), (0.735, y, z), 0.032, 0.032)
    d = join(shoulder, join(upper, join(biceps, triceps, 0.04), 0.04), 0.05)
    return join(join(d, elbow, 0.04), join(join(fore, meat, 0.05), wrist, 0.03), 0.04)


def hand(p):
    y, z = 1.425, -0.015
    palm = squashed(p, 0.40, 1, y, cone, (0.758, y, z - 0.001), (0.806, y, z), 0.039, 0.042)
    knuckles = cone(p, (0.818, y + 0.003, z + 0.028), (0.814, y + 0.002, z - 0.029), 0.0110, 0.0098)
    d = join(palm, knuckles, 0.016)
    # four fingers, spread a little and at rest a little bent
    for across, reach, thick in ((0.0310, 0.899, 0.0090), (0.0106, 0.912, 0.0093),
                                 (-0.0098, 0.904, 0.0089), (-0.0290, 0.884, 0.0079)):
        base, tip = (0.816, y + 0.002, z + across), (reach - thick, y - 0.019, z + 1.42 * across)
        middle = (0.45 * base[0] + 0.55 * tip[0], y - 0.001, 0.45 * base[2] + 0.55 * tip[2])
        finger = join(cone(p, base, middle, thick + 0.0012, thick), cone(p, middle, tip, thick, thick * 0.84), 0.004)
        d = join(d, finger, 0.006)
    pad = ellipsoid(p, (0.772, y - 0.009, z + 0.026), (0.034, 0.017, 0.021))
    thumb = join(cone(p, (0.768, y - 0.009, z + 0.032), (0.806, y - 0.015, z + 0.064), 0.0150, 0.0118),
                 cone(p, (0.806, y - 0.015, z + 0.064), (0.837, y - 0.020, z + 0.078), 0.0116, 0.0092), 0.005)
    return join(join(d, pad, 0.025), thumb, 0.016)


def body(points):
    """The whole mannequin."""
    p = np.array(points, np.float64)
    p[:, 0] = np.abs(p[:, 0])
    d = join(trunk(p), neck(p), 0.06)
    d = join(d, head(p), 0.028)
    d = join(d, join(arm(p), hand(p), 0.022), 0.06)
    return join(d, join(leg(p), foot(p), 0.03), 0.045)


def gradient(points, step=5e-4):
    """The outward unit normal (N, 3) by central differences."""
    g = np.stack([body(points + step * e) - body(points - step * e) for e in np.eye(3)], 1)
    return g / np.maximum(np.linalg.norm(g, axis=1, keepdims=True), 1e-9)
