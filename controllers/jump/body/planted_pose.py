"""Postures: a whole body over planted feet, its centre of mass exactly where the plan wants it.

The trunk, the arms and the head are posed by joint rotations, the legs by where the feet stand;
the pelvis is then moved until the centre of mass is in place.
"""

from __future__ import annotations

import math

import numpy as np

from ...body import distance_kernel, product_kernel, relative_kernel, two_bone_kernel
from ...compiled import kernel
from .dynamics import centre_kernel, place_kernel

STRAIGHT = 0.992
"""A leg is straight at this share of its length: beyond, the heel rises, and then the jump is over."""
SOFT = 0.012
"""A leg that pushes straightens ever slower from so much of its length before that on, and its heel rises instead: near the end a knee would have to
turn infinitely fast."""
HINGE = 0.02
"""Where a knee points that is off the line from hip to ankle by less than this share of its leg is told by its hinge rather than by its place."""
GAIN = 1.0 / 0.82
"""How far the pelvis moves for what the centre of mass lacks: part of the legs stays behind."""


@kernel
def bend_kernel(parent, child):
    """How far [rad] a joint is turned about its parent's x axis, from the orientations (3, 3) of both."""
    sine, cosine = 0.0, 0.0
    for i in range(3):
        sine += child[i, 1] * parent[i, 2]
        cosine += child[i, 1] * parent[i, 1]
    return math.atan2(sine, cosine)


@kernel
def foot_kernel(yaw, pitch, out):
    """Write the orientation (3, 3) of a foot that points along `yaw`, its toes `pitch` down [rad]."""
    cy, sy, cp, sp = math.cos(yaw), math.sin(yaw), math.cos(pitch), math.sin(pitch)
    out[0, 0], out[0, 1], out[0, 2] = cy, sy * sp, sy * cp
    out[1, 0], out[1, 1], out[1, 2] = 0.0, cp, -sp
    out[2, 0], out[2, 1], out[2, 2] = -sy, cy * sp, cy * cp


@kernel
def lying_kernel(foot, pitch, out):
    """Write the orientation (3, 3) of a foot (6,) or (8,) that points `pitch` [rad] down from the ground under it: the last two are how that rises along x and z [m/m]."""
    foot_kernel(foot[3], pitch, out)
    if foot.shape[0] < 8 or (foot[6] == 0.0 and foot[7] == 0.0):
        return
    size = math.sqrt(1.0 + foot[6] * foot[6] + foot[7] * foot[7])
    x, z, c = -foot[7] / size, foot[6] / size, 1.0 / size  # by the smallest turn from upright to the ground's normal: about its cross product with that
    k = 1.0 / (1.0 + c)
    tilt, flat = np.empty((3, 3)), out.copy()
    tilt[0, 0], tilt[0, 1], tilt[0, 2] = c + k * x * x, -z, k * x * z
    tilt[1, 0], tilt[1, 1], tilt[1, 2] = z, c, -x
    tilt[2, 0], tilt[2, 1], tilt[2, 2] = k * x * z, x, c + k * z * z
    product_kernel(tilt, flat, out)


@kernel
def ankle_kernel(body, foot, turned, out):
    """Write where the ankle (3,) is. foot: (6,) ball x, y, z [m], yaw, pitch [rad], heel's freedom."""
    for i in range(3):
        out[i] = foot[i]
        for k in range(3):
            out[i] -= turned[i, k] * body.toe[k]


@kernel
def nearest_kernel(body, hip, foot):
    """With which pitch [rad] of a foot (6,) its ankle is nearest to a hip (3,): above the ball, seen from there. Beyond it a heel that rises is of no use."""
    ahead = (hip[0] - foot[0]) * math.sin(foot[3]) + (hip[2] - foot[2]) * math.cos(foot[3])
    return math.atan2(hip[1] - foot[1], -ahead) - math.atan2(-body.toe[1], body.toe[2])


@kernel
def heel_kernel(body, hip, foot, reach, high):
    """With which pitch [rad], no less than a foot's (6,) or (8,) own and no more than `high`, its ankle comes as near as `reach` [m] to a hip (3,); `high` where with none.
    The square of how far they are apart goes with the cosine of the pitch."""
    flat, apart = np.empty((3, 3)), 0.0
    lying_kernel(foot, 0.0, flat)
    y, z = 0.0, 0.0
    for i in range(3):
        way = hip[i] - foot[i]
        apart += way * way + body.toe[i] * body.toe[i] + 2.0 * way * flat[i, 0] * body.toe[0]
        y += way * flat[i, 1]
        z += way * flat[i, 2]
    even, odd = y * body.toe[1] + z * body.toe[2], z * body.toe[1] - y * body.toe[2]
    share = (apart - reach * reach) / (2.0 * math.hypot(even, odd))
    if share > 1.0:
        return high
    return min(max(math.atan2(-odd, -even) - math.acos(max(share, -1.0)), foot[4]), high)


@kernel
def pole_kernel(body, side, yaw, positions, orientations, out):
    """Write whither (3,) a knee points of itself: between pelvis and a foot that points along `yaw` [rad]."""
    hip = body.hip[side]
    for i in range(3):
        out[i] = orientations[0, i, 2] + 0.5 * (positions[hip, i] - positions[0, i])
    out[0] += 1.5 * math.sin(yaw)
    out[2] += 1.5 * math.cos(yaw)


@kernel
def across_kernel(axis, vector):
    """Take out of a vector (3,) what of it is along an axis (3,) of length 1."""
    along = axis[0] * vector[0] + axis[1] * vector[1] + axis[2] * vector[2]
    for i in range(3):
        vector[i] -= along * axis[i]


@kernel
def swivel_kernel(hip, ankle, angle, pole):
    """Turn a pole (3,) about the line from hip to ankle (3,) by an angle [rad]; what of it is along that is left out."""
    far = distance_kernel(hip, ankle)
    x, y, z = (ankle[0] - hip[0]) / far, (ankle[1] - hip[1]) / far, (ankle[2] - hip[2]) / far
    along, c, s = x * pole[0] + y * pole[1] + z * pole[2], math.cos(angle), math.sin(angle)
    px, py, pz = pole[0] - along * x, pole[1] - along * y, pole[2] - along * z
    pole[0], pole[1], pole[2] = c * px + s * (y * pz - z * py), c * py + s * (z * px - x * pz), c * pz + s * (x * py - y * px)


@kernel
def swivelled_kernel(body, side, yaw, positions, orientations):
    """How far [rad] the knee of a placed body is turned about the line from hip to ankle from where it points of itself over a foot that points along `yaw` [rad]."""
    hip, pole = body.hip[side], np.empty(3)
    axis = (positions[hip + 2] - positions[hip]) / distance_kernel(positions[hip + 2], positions[hip])
    pole_kernel(body, side, yaw, positions, orientations, pole)
    knee = positions[hip + 1] - positions[hip] + HINGE * (body.thigh + body.shank) * np.cross(axis, orientations[hip, :, 0])
    across_kernel(axis, pole)
    across_kernel(axis, knee)
    return math.atan2((axis * np.cross(pole, knee)).sum(), (pole * knee).sum())


@kernel
def leg_kernel(body, side, foot, flex, local, positions, orientations):
    """Pose one leg so that its foot is where `foot` (6,) or, on a slope, (8,) says, see `lying_kernel`; the hip's placement is known.

    A planted heel (foot[5] > 0) rises where the leg is too short or the ankle would bend beyond
    `flex` [rad]; foot[4] then becomes the pitch that this needs. A leg whose foot[5] is 2 straightens softly, see SOFT; one whose is 1
    does not. foot[8], where there is one: how far the knee is turned about the line from hip to ankle from where it points of itself [rad].
    Returns how far the ankle is from where it should be [m].
    """
    hip = body.hip[side]
    knee, ankle, ball = hip + 1, hip + 2, hip + 3
    turned, at, pole = np.empty((3, 3)), np.empty(3), np.empty(3)
    soft = SOFT * max(foot[5] - 1.0, 0.0) * (body.thigh + body.shank)
    root = positions[hip]
    pelvis = orientations[0]
    uphill = math.atan(foot[6] * math.sin(foot[3]) + foot[7] * math.cos(foot[3])) if foot.shape[0] > 6 else 0.0
    for _ in range(4):
        lying_kernel(foot, foot[4], turned)
        ankle_kernel(body, foot, turned, at)
        reach = STRAIGHT * (body.thigh + body.shank)
        beyond = distance_kernel(root, at) - reach + soft
        if soft > 0.0 and beyond > 0.0:
            reach -= soft * math.exp(-beyond / soft)
        if foot[5] > 0.0 and distance_kernel(root, at) > reach:
            foot[4] = heel_kernel(body, root, foot, reach, max(foot[4], min(nearest_kernel(body, root, foot) + uphill, 1.25)))
            lying_kernel(foot, foot[4], turned)
            ankle_kernel(body, foot, turned, at)
        pole_kernel(body, side, foot[3], positions, orientations, pole)
        if foot.shape[0] > 8 and foot[8] != 0.0:
            swivel_kernel(root, at, foot[8], pole)
        two_bone_kernel(root, body.thigh, body.shank, at, pole, (1.0 - STRAIGHT) * (body.thigh + body.shank),
                        positions[knee], positions[ankle])
        _frames(positions[hip], positions[knee], positions[ankle], pole, orientations[hip], orientations[knee])
        # the ankle's bend about its own x axis: negative with the toes up
        sine, cosine = 0.0, 0.0
        for k in range(3):
            sine += orientations[knee][k, 2] * turned[k, 1]
            cosine += orientations[knee][k, 1] * turned[k, 1]
        excess = -flex - math.atan2(sine, cosine)
        if foot[5] <= 0.0 or excess < 1e-4:
            break
        foot[4] = max(foot[4], min(foot[4] + 1.05 * excess, 1.25))
    orientations[ankle] = turned
    gap = distance_kernel(positions[ankle], at)
    for i in range(3):
        positions[ball, i] = positions[ankle, i]
        for k in range(3):
            positions[ball, i] += turned[i, k] * body.toe[k]
    # the toes stay on the floor while the heel is up
    lying_kernel(foot, min(foot[4], 0.0) if foot[5] > 0.0 else foot[4] - min(max(foot[4], 0.0), 0.5), orientations[ball])
    relative_kernel(pelvis, orientations[hip], local[hip])
    relative_kernel(orientations[hip], orientations[knee], local[knee])
    relative_kernel(orientations[knee], turned, local[ankle])
    relative_kernel(turned, orientations[ball], local[ball])
    return gap


@kernel
def _frames(hip, knee, ankle, pole, thigh, shank):
    """The world orientations of thigh and shank: y up the bone, x the knee's hinge."""
    dx, dy, dz = ankle[0] - hip[0], ankle[1] - hip[1], ankle[2] - hip[2]
    hx, hy, hz = pole[1] * dz - pole[2] * dy, pole[2] * dx - pole[0] * dz, pole[0] * dy - pole[1] * dx
    size = math.sqrt(hx * hx + hy * hy + hz * hz)
    hx, hy, hz = hx / size, hy / size, hz / size
    for a, b, out in ((hip, knee, thigh), (knee, ankle, shank)):
        ux, uy, uz = a[0] - b[0], a[1] - b[1], a[2] - b[2]
        size = math.sqrt(ux * ux + uy * uy + uz * uz)
        ux, uy, uz = ux / size, uy / size, uz / size
        out[0, 0], out[1, 0], out[2, 0] = hx, hy, hz
        out[0, 1], out[1, 1], out[2, 1] = ux, uy, uz
        out[0, 2], out[1, 2], out[2, 2] = hy * uz - hz * uy, hz * ux - hx * uz, hx * uy - hy * ux


@kernel
def stand_kernel(body, centre, feet, flex, root, local, positions, orientations):
    """Move the pelvis `root` (3,) until the body over its feet (2, 6), or (2, 8) on a slope, has its centre of mass at `centre`.

    local: (J, 3, 3) all but the legs given; also those whose foot is free (feet[side, 5] < 0). Returns the worst of the two ankles' gaps and of what
    the centre of mass still lacks [m].
    """
    found, lacks, before, step, gap = np.empty(3), np.empty(3), np.empty(3), np.zeros(3), 0.0
    started = feet[:, 4].copy()
    gain = GAIN * np.eye(3)
    missing = 1.0
    place_kernel(body, root, local, positions, orientations)
    for attempt in range(60):
        feet[:, 4] = started
        gap = 0.0
        for side in range(2):
            if feet[side, 5] >= 0.0:
                gap = max(gap, leg_kernel(body, side, feet[side], flex, local, positions, orientations))
        centre_kernel(body, positions, orientations, found)
        missing = distance_kernel(centre, found)
        if missing < 1e-9:
            break
        for i in range(3):
            before[i], lacks[i] = lacks[i], centre[i] - found[i]
        if attempt > 0:
            _learn(gain, step, before, lacks)
        for i in range(3):
            step[i] = gain[i, 0] * lacks[0] + gain[i, 1] * lacks[1] + gain[i, 2] * lacks[2]
            root[i] += step[i]
        for j in range(len(positions)):  # all but the legs moves along
            for i in range(3):
                positions[j, i] += step[i]
    else:
        place_kernel(body, root, local, positions, orientations)
    return max(gap, missing)


@kernel
def _learn(gain, step, before, lacks):
    """Broyden's method: mend `gain` (3, 3), by which a `step` (3,) was taken, by what was lacking before and after it (3,)."""
    row, moved = np.zeros(3), np.zeros(3)  # stepᵀ gain, gain (before − lacks)
    for i in range(3):
        for k in range(3):
            row[k] += step[i] * gain[i, k]
            moved[i] += gain[i, k] * (before[k] - lacks[k])
    whole = step[0] * moved[0] + step[1] * moved[1] + step[2] * moved[2]
    if abs(whole) < 0.1 * (step[0] ** 2 + step[1] ** 2 + step[2] ** 2):
        return  # a kink, where a heel begins to rise: nothing to learn from
    for i in range(3):
        for k in range(3):
            gain[i, k] += (step[i] - moved[i]) * row[k] / whole
