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
    skull = ellipsoid(p, (0, 1.652, -0.006), (0.076, 0.092, 0.097))
    brow = ellipsoid(p, (0, 1.640, 0.045), (0.062, 0.070, 0.057))
    jaw = ellipsoid(p, (0, 1.566, 0.042), (0.050, 0.050, 0.056), tilt=-0.25)
    cheek = ellipsoid(p, (0.020, 1.598, 0.052), (0.043, 0.055, 0.045))
    chin = ellipsoid(p, (0, 1.533, 0.075), (0.026, 0.020, 0.022))
    d = join(join(skull, brow, 0.05), join(join(jaw, cheek, 0.04), chin, 0.035), 0.05)
    nose = cone(p, (0, 1.620, 0.098), (0, 1.588, 0.108), 0.007, 0.011)
    d = join(d, nose, 0.025)
    ear = squashed(p, 0.45, 0, 0.076, ellipsoid, (0.076, 1.612, 0.000), (0.022, 0.030, 0.020))
    d = join(d, ear, 0.015)
    socket = ellipsoid(p, (0.033, 1.620, 0.104), (0.022, 0.014, 0.018))
    return carve(d, socket, 0.025)


def neck(p):
    throat = cone(p, (0, 1.470, -0.018), (0, 1.570, 0.006), 0.058, 0.053)
    slope = cone(p, (0.020, 1.520, -0.030), (0.150, 1.438, -0.024), 0.036, 0.036)
    return join(throat, slope, 0.06)


def trunk(p):
    ribs = ellipsoid(p, (0, 1.270, -0.004), (0.148, 0.190, 0.108), tilt=0.05)
    upper = squashed(p, 0.68, 2, -0.012, cone, (0, 1.365, -0.012), (0.092, 1.372, -0.012), 0.125, 0.090)
    chest = ellipsoid(p, (0.070, 1.325, 0.062), (0.082, 0.062, 0.044), tilt=-0.25)
    blades = ellipsoid(p, (0.085, 1.345, -0.082), (0.070, 0.095, 0.032), tilt=0.1)
    wing = cone(p, (0.128, 1.340, -0.035), (0.098, 1.170, -0.020), 0.048, 0.040)
    waist = squashed(p, 0.74, 2, 0.0, cone, (0, 1.190, 0.0), (0, 1.060, 0.0), 0.132, 0.140)
    belly = ellipsoid(p, (0, 1.100, 0.050), (0.095, 0.120, 0.058))
    d = join(join(ribs, upper, 0.06), wing, 0.05)
    d = join(join(d, chest, 0.035), blades, 0.04)
    d = join(join(d, waist, 0.07), belly, 0.06)
    pelvis = squashed(p, 0.70, 2, 0.0, cone, (0.0, 0.985, 0.0), (0.058, 0.965, 0.0), 0.128, 0.112)
    seat = ellipsoid(p, (0.074, 0.925, -0.062), (0.078, 0.088, 0.066), tilt=-0.1)
    crotch = ellipsoid(p, (0, 0.905, 0.030), (0.050, 0.060, 0.052))
    d = join(join(d, pelvis, 0.06), seat, 0.045)
    return join(d, crotch, 0.04)


def leg(p):
    x = 0.0875
    thigh = cone(p, (x + 0.004, 0.890, -0.002), (x, 0.520, 0.004), 0.087, 0.053)
    front = ellipsoid(p, (x + 0.008, 0.735, 0.028), (0.062, 0.165, 0.058))
    inner = ellipsoid(p, (x - 0.028, 0.840, -0.012), (0.050, 0.120, 0.060))
    hams = ellipsoid(p, (x, 0.715, -0.030), (0.056, 0.160, 0.052))
    d = join(join(thigh, front, 0.03), join(inner, hams, 0.03), 0.03)
    knee = ellipsoid(p, (x, 0.505, 0.014), (0.048, 0.058, 0.048))
    shin = cone(p, (x, 0.480, 0.002), (x, 0.095, -0.004), 0.050, 0.034)
    calf = ellipsoid(p, (x + 0.003, 0.375, -0.024), (0.052, 0.115, 0.050), tilt=-0.05)
    calf = join(calf, ellipsoid(p, (x - 0.014, 0.350, -0.022), (0.036, 0.090, 0.042)), 0.03)
    d = join(join(d, knee, 0.04), join(shin, calf, 0.04), 0.035)
    hock = cone(p, (x, 0.150, -0.030), (x, 0.060, -0.045), 0.016, 0.022)
    ankles = cone(p, (x - 0.026, 0.078, -0.004), (x + 0.026, 0.070, -0.008), 0.018, 0.017)
    return join(join(d, hock, 0.05), ankles, 0.02)


def foot(p):
    x = 0.0875
    heel = ellipsoid(p, (x, 0.034, -0.042), (0.035, 0.046, 0.042))
    arch = squashed(p, 0.85, 1, 0.0, cone, (x, 0.060, 0.000), (x + 0.002, 0.026, 0.120), 0.042, 0.036)
    ball = squashed(p, 0.62, 1, 0.010, cone, (x - 0.016, 0.020, 0.122), (x + 0.022, 0.018, 0.100), 0.036, 0.034)
    toes = squashed(p, 0.58, 1, 0.008, cone, (x - 0.016, 0.018, 0.135), (x - 0.014, 0.016, 0.172), 0.034, 0.031)
    outer = squashed(p, 0.62, 1, 0.008, cone, (x + 0.022, 0.014, 0.105), (x + 0.014, 0.014, 0.158), 0.030, 0.027)
    d = join(join(heel, arch, 0.04), join(ball, join(toes, outer, 0.02), 0.025), 0.03)
    # the sole: flat on the floor, its rim a little rounded
    return carve(d, p[:, 1].copy(), 0.012)


def arm(p):
    y, z = 1.425, -0.015
    shoulder = ellipsoid(p, (0.196, y + 0.002, z), (0.068, 0.059, 0.061))
    upper = cone(p, (0.200, y, z), (0.450, y, z), 0.049, 0.038)
    biceps = ellipsoid(p, (0.325, y + 0.004, z + 0.018), (0.092, 0.038, 0.036))
    triceps = ellipsoid(p, (0.310, y - 0.002, z - 0.020), (0.100, 0.038, 0.034))
    elbow = ellipsoid(p, (0.458, y, z - 0.004), (0.045, 0.038, 0.040))
    fore = cone(p, (0.470, y, z), (0.715, y, z), 0.039, 0.025)
    meat = ellipsoid(p, (0.535, y + 0.002, z + 0.006), (0.082, 0.038, 0.043))
    wrist = squashed(p, 0.78, 1, y, cone, (0.660, y, z), (0.735, y, z), 0.029, 0.029)
    d = join(shoulder, join(upper, join(biceps, triceps, 0.03), 0.025), 0.035)
    return join(join(d, elbow, 0.03), join(join(fore, meat, 0.04), wrist, 0.025), 0.03)


def hand(p):
    y, z = 1.425, -0.015
    palm = squashed(p, 0.42, 1, y, cone, (0.752, y, z - 0.004), (0.812, y, z), 0.038, 0.041)
    d = palm
    # four fingers side by side, a little bent, parted only by grooves
    for k, (reach, thick) in enumerate(((0.906, 0.0102), (0.922, 0.0106), (0.914, 0.0102), (0.893, 0.0090))):
        at = z + 0.0300 - 0.0196 * k
        base, tip = (0.822, y + 0.001, at), (reach - thick, y - 0.015, at * 0.9 + z * 0.1)
        middle = (0.5 * (base[0] + tip[0]) + 0.004, y - 0.002, 0.5 * (base[2] + tip[2]))
        finger = join(cone(p, base, middle, thick + 0.001, thick), cone(p, middle, tip, thick, thick * 0.85), 0.004)
        d = join(d, finger, 0.010)
    pad = ellipsoid(p, (0.770, y - 0.008, z + 0.028), (0.032, 0.015, 0.018))
    thumb = join(cone(p, (0.768, y - 0.008, z + 0.034), (0.806, y - 0.014, z + 0.062), 0.0145, 0.0120),
                 cone(p, (0.806, y - 0.014, z + 0.062), (0.838, y - 0.019, z + 0.070), 0.0118, 0.0092), 0.005)
    return join(join(d, pad, 0.02), thumb, 0.016)


def body(points):
    """The whole mannequin."""
    p = np.array(points, np.float64)
    p[:, 0] = np.abs(p[:, 0])
    d = join(trunk(p), neck(p), 0.045)
    d = join(d, head(p), 0.022)
    d = join(d, join(arm(p), hand(p), 0.018), 0.045)
    return join(d, join(leg(p), foot(p), 0.022), 0.030)


def gradient(points, step=5e-4):
    """The outward unit normal (N, 3) by central differences."""
    g = np.stack([body(points + step * e) - body(points - step * e) for e in np.eye(3)], 1)
    return g / np.maximum(np.linalg.norm(g, axis=1, keepdims=True), 1e-9)


def dark(points):
    """Distance [m] into the dark material: gloves, shoes, joints, waist, neck and the face plane."""
    p = np.array(points, np.float64)
    p[:, 0] = np.abs(p[:, 0])
    x, y, z = p.T

    def band(t, low, high):
        return np.minimum(t - low, high - t)
    limb = x > 0.2
    parts = [
        np.where(limb, x - 0.722, -1.0),                                    # gloves
        np.where(limb, band(x, 0.432, 0.492), -1.0),                        # elbows
        np.where(x < 0.2, 0.092 + 0.25 * np.clip(z, -0.03, 0.05) - y, -1.0),  # shoes
        np.where(x < 0.2, band(y - 0.10 * z, 0.468, 0.540), -1.0),          # knees
        np.where(x < 0.17, band(y + 0.20 * np.abs(x), 1.485, 1.540) + 0.0, -1.0),
        np.where(x < 0.2, band(y + 0.35 * x * np.sign(z + 1.0) * 0.4, 1.045, 1.115), -1.0),
        -ellipsoid(p, (0, 1.612, 0.125), (0.062, 0.070, 0.080)),            # face plane
    ]
    return np.max(parts, 0)
