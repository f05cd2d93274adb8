"""One frame of both feet: what takes hold and what lets go, where feet come, and legs that bend after them."""

from __future__ import annotations

import math

import numpy as np

from ...body import exp_kernel, log_kernel, product_kernel, spring_kernel
from ...compiled import kernel
from .strained_leg import REACH, SOFT, bend_kernel, carried_kernel, flat_kernel, long_kernel, raise_heel_kernel

TAKES, LEAVES = 0.6, 0.3
"""A point takes hold where it is more probable than this that it stands, and lets go where it is less probable than that."""
GATE, HIGH = 0.05, 0.08
"""… it takes hold no higher than the first above where it stands [m], and lets go beyond the second, whatever was said."""
STOPS, LANDS = 0.008, 0.03
"""Half-lives with which a point that takes hold comes to rest along the floor, and down to it [s]."""
FADES, TURNS = 0.08, 0.05
"""Half-lives with which a foot comes back to where the method has it, and to how it is turned there [s]."""
FOLLOWS = 0.85
"""A foot that a tracker tells of keeps this of its distance from there in a sixtieth of a second, its height above the floor too: it rests more quietly
than told, but where it is told."""
FAR, SLIPPED = 0.35, 0.06
"""A foot whose method has it farther away [m] takes a step; the second for one that a tracker tells of."""
HURRY = 1.6
"""A step waits for the other foot to stand, unless it is farther away by this."""
LANDED = 0.03
"""A step ends so near to where the method has the foot [m]."""
LIFT, HIGHEST = 0.3, 0.06
"""A foot that comes back is lifted by this share of its way in the middle of it, but no higher than the second [m]."""
DRAGGED = 0.02
"""A leg that is too short by more than this [m] lets its foot go."""
LEAPS = 0.5
"""Feet that go farther in a frame [m] are begun anew."""


@kernel
def plant_kernel(positions, orientations, local, standing, told, dt, legs, bones, parents, heel, height, points, speeds, believed, held, offsets, rates,
                 turns, spins, steps, away):
    """Rewrite the local rotations (J, 3, 3) of both legs, and what `Feet` holds, of a body whose joints are at positions (J, 3) and orientations
    (J, 3, 3)."""
    there = np.empty((4, 3))
    for f in range(2):
        foot = legs[f, 2]
        carried_kernel(orientations[foot], heel, there[2 * f])
        carried_kernel(orientations[foot], bones[legs[f, 3]], there[2 * f + 1])
        for i in range(3):
            there[2 * f, i] += positions[foot, i]
            there[2 * f + 1, i] += positions[foot, i]
    anew = False
    for k in range(4):
        way = math.sqrt((there[k, 0] - believed[k, 0]) ** 2 + (there[k, 1] - believed[k, 1]) ** 2 + (there[k, 2] - believed[k, 2]) ** 2)
        anew = anew or not way < LEAPS  # NaN before the first frame
    if anew:
        points[:], believed[:] = there, there
        speeds[:], offsets[:], rates[:], turns[:], spins[:], away[:] = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        held[:], steps[:] = False, False
    stays = np.empty(4, np.bool_)
    for k in range(4):
        if held[k]:
            stays[k] = standing[k] > LEAVES and there[k, 1] < height + HIGH
        else:
            stays[k] = standing[k] > TAKES and there[k, 1] < height + GATE and not steps[k // 2]
    for f in range(2):
        a, b, other = 2 * f, 2 * f + 1, 2 - 2 * f
        if (held[a] and stays[a]) or (held[b] and stays[b]):
            gap, most = flat_kernel(points[b], there[b]), SLIPPED if told[f] else FAR
            if gap > most and (told[f] or gap > HURRY * most or (stays[other] or stays[other + 1]) and not steps[1 - f]):
                steps[f] = True
                stays[a] = stays[b] = False
    for f in range(2):
        _foot(f, positions, orientations, local, told[f], dt, legs, bones, parents, heel, height, there, stays, points, speeds, offsets, rates, turns, spins,
              steps, away)
        if anew:
            rates[f], spins[f], speeds[2 * f], speeds[2 * f + 1] = 0.0, 0.0, 0.0, 0.0
    held[:], believed[:] = stays, there


@kernel
def _foot(f, positions, orientations, local, told, dt, legs, bones, parents, heel, height, there, stays, points, speeds, offsets, rates, turns, spins, steps,
          away):
    """The same for foot f, whose points are `there` as the method has them; `stays`: which stand now."""
    hip, foot, toe = legs[f, 0], legs[f, 2], legs[f, 3]
    a, b = 2 * f, 2 * f + 1
    offset, turn, back = offsets[f].copy(), turns[f].copy(), np.empty((3, 3))
    for i in range(3):
        offsets[f, i], rates[f, i] = spring_kernel(offset[i], rates[f, i], 0.0, FADES, dt)
        turns[f, i], spins[f, i] = spring_kernel(turn[i], spins[f, i], 0.0, TURNS, dt)
    turned, by, sole, ball = np.empty((3, 3)), np.empty((3, 3)), np.empty(3), np.empty(3)
    exp_kernel(turns[f, 0], turns[f, 1], turns[f, 2], by)
    product_kernel(by, orientations[foot], turned)
    carried_kernel(turned, bones[toe] - heel, sole)
    places = _places(a, told, dt, height, there, points, speeds)
    stands = stays[a] or stays[b]
    if stands:
        along = places[1] - places[0]
        if stays[a] != stays[b]:  # the end in the air turns freely, but not into the floor
            rise = sole[1] if stays[a] else -sole[1]
            base, length = (places[0, 1] if stays[a] else places[1, 1]), long_kernel(sole)
            along[:], level = sole, math.hypot(sole[0], sole[2])
            if base + rise < height and level > 1e-6 and abs(height - base) < length:
                along[1] = height - base if stays[a] else base - height
                share = math.sqrt(length * length - along[1] * along[1]) / level
                along[0], along[2] = share * sole[0], share * sole[2]
        _onto(sole, along, by)
        product_kernel(by, turned, back)
        turned[:] = back
        carried_kernel(turned, bones[toe] - heel, sole)
    gap = math.hypot(offsets[f, 0], offsets[f, 2])
    for i in range(3):
        ball[i] = places[1, i] if stays[b] else places[0, i] + sole[i] if stays[a] else there[b, i] + offsets[f, i]
    if stands:
        away[f] = 0.0
    else:
        away[f] = max(away[f], gap)
        steps[f] = steps[f] and gap >= LANDED
        gone = 1.0 - gap / away[f] if away[f] > 1e-6 else 0.0
        lift = min(LIFT * away[f], HIGHEST) * (4.0 * gone * (1.0 - gone)) ** 2
        if not told:
            ball[1] += max(height + lift - min(ball[1], ball[1] - sole[1]), 0.0)
    ankle, arm = np.empty(3), np.empty(3)
    carried_kernel(turned, bones[toe], arm)
    ankle[:] = ball - arm
    length = long_kernel(bones[legs[f, 1]]) + long_kernel(bones[foot])
    own, reached = long_kernel(positions[foot] - positions[hip]), long_kernel(ankle - positions[hip])
    begins, ends = max(SOFT * length, own), max(REACH * length, min(own + 0.02 * length, 0.999 * length))
    if reached > begins:  # the leg straightens ever more slowly, and the heel goes up for the rest
        limit = begins + (ends - begins) * (1.0 - math.exp((begins - reached) / (ends - begins))) if ends > begins + 1e-6 else begins
        if stays[b]:
            raise_heel_kernel(positions[hip], ball, sole, arm, limit, turned, by)
            carried_kernel(turned, bones[toe], arm)
            ankle[:] = ball - arm
        reached = long_kernel(ankle - positions[hip])
        if reached > limit:
            ankle[:] = positions[hip] + (ankle - positions[hip]) * (limit / reached)
    bend_kernel(positions, orientations, local, legs[f], parents, ankle, turned)
    dragged = long_kernel(ankle + arm - ball)
    if stands and dragged > DRAGGED and not steps[1 - f] and (stays[2 - 2 * f] or stays[3 - 2 * f]):
        steps[f] = True
        stays[a] = stays[b] = False
    carried_kernel(turned, heel, ball)
    for i in range(3):
        new = ankle[i] + ball[i], ankle[i] + arm[i]
        speeds[a, i], speeds[b, i] = (new[0] - points[a, i]) / dt, (new[1] - points[b, i]) / dt
        points[a, i], points[b, i] = new
        offsets[f, i] = new[1] - there[b, i]
    for i in range(3):
        for k in range(3):
            by[i, k] = turned[i, 0] * orientations[foot, k, 0] + turned[i, 1] * orientations[foot, k, 1] + turned[i, 2] * orientations[foot, k, 2]
    log_kernel(by, turns[f])
    if stands:
        for i in range(3):
            rates[f, i], spins[f, i] = (offsets[f, i] - offset[i]) / dt, (turns[f, i] - turn[i]) / dt


@kernel
def _places(a, told, dt, height, there, points, speeds):
    """Where heel and ball (2, 3) of the foot whose heel is point a are if they stand."""
    places = np.empty((2, 3))
    for n in range(2):
        k = a + n
        for i in range(3):
            if told:
                places[n, i] = there[k, i] + FOLLOWS ** (60.0 * dt) * (points[k, i] - there[k, i])
            elif i == 1:
                places[n, i] = height + (points[k, i] - height) * 0.5 ** (dt / LANDS)
            else:
                places[n, i] = points[k, i] + speeds[k, i] * dt * 0.5 ** (dt / STOPS)
    return places


@kernel
def _onto(a, b, out):
    """Write the smallest rotation (3, 3) that carries direction a onto b (3,); none where they are opposite."""
    cross, sizes = np.cross(a, b), long_kernel(a) * long_kernel(b)
    sine, cosine = long_kernel(cross), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    scale = math.atan2(sine, cosine) / sine if sine > 1e-9 * sizes and sizes > 0.0 else 0.0
    exp_kernel(scale * cross[0], scale * cross[1], scale * cross[2], out)
