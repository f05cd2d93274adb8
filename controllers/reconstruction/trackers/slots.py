"""Where trackers are worn, and what a network is told of them: any of eleven places on the body, each maybe with an orientation.

What a tracker gives is that of the joint it was calibrated to. Everything is seen from the ground below the trackers, with the
heading of the hips' tracker, the chest's or the head's, whichever turns and is seen, else with the heading that is given.
"""

from __future__ import annotations

import math

import numpy as np

from ...compiled import kernel
from ..pose_vector import SKELETON
from ..regression import EXACT

LAGS = np.array([0, 2, 4, 8, 16, 30])
"""How many frames before the coming one the trackers are looked at."""
PLACES = ("Hips", "Spine2", "Head", "LeftHand", "RightHand", "LeftFoot", "RightFoot", "LeftForeArm", "RightForeArm",
          "LeftLeg", "RightLeg")
"""The joints that trackers may be calibrated to; the first three tell the heading, in this order."""
SLOTS = np.array([SKELETON.index(name) for name in PLACES])
"""Their numbers."""
_STEPS = len(LAGS) - 1
OWN = 5 + 8 + 4 * _STEPS + 7 * _STEPS
"""How many inputs a slot has: the newest place (3), whether and how long ago; the newest turn (6), the same two; how both
changed from lag to lag, and whether that is known."""
INPUTS = OWN * len(SLOTS) + 3 * len(SKELETON)
"""… and all of them, with the body's offsets."""
LEVEL = 0.9
"""Places are told from so high [m] …"""
PLACE, PACE, SPIN, BONE = 0.4, 1.0, 3.0, 0.05
"""… over this [m]; velocities over this [m/s], turns' columns over this [1/s]; and by how much the body differs from the
standard one over this [m]."""


@kernel(fastmath=EXACT, error_model="numpy")
def view_kernel(places, turns, placed, turned, body, standard, lags, dt, given, inputs, ground):
    """Fills inputs (INPUTS,) float32 and the ground (3,) x, z [m] and heading [rad] that they are seen from.

    places: (L, S, 3) [m] in the world at `lags`, turns: (L, S, 3, 3); placed, turned: (L, S) bool, which are known: what
    is not is never read. body, standard: (J, 3) [m] offsets of this body and of the standard one. dt: [s] between frames.
    given: (3,) the ground to fall back on, where nothing is seen or nothing turns.
    """
    steps, slots = places.shape[0] - 1, places.shape[1]
    inputs[:] = 0.0
    ground[:] = given
    x, z, count = 0.0, 0.0, 0
    for s in range(slots):
        for k in range(steps + 1):
            if placed[k, s]:
                x += places[k, s, 0]
                z += places[k, s, 2]
                count += 1
                break
    if count > 0:
        ground[0], ground[1] = x / count, z / count
    for s in range(3):
        if turned[0, s]:
            across, along = turns[0, s, 0, 2] - turns[0, s, 2, 0], turns[0, s, 0, 0] + turns[0, s, 2, 2]
            if across * across + along * along > 1e-6:  # else it stands on its head, and has none
                ground[2] = math.atan2(across, along)
                break
    c, sine = math.cos(ground[2]), math.sin(ground[2])
    longest = float(lags[steps])
    for s in range(slots):
        at = s * (13 + 11 * steps)
        for k in range(steps + 1):
            if placed[k, s]:
                u, w = places[k, s, 0] - ground[0], places[k, s, 2] - ground[1]
                inputs[at] = (c * u - sine * w) / PLACE
                inputs[at + 1] = (places[k, s, 1] - LEVEL) / PLACE
                inputs[at + 2] = (sine * u + c * w) / PLACE
                inputs[at + 3] = 1.0
                inputs[at + 4] = lags[k] / longest
                break
        for k in range(steps + 1):
            if turned[k, s]:
                for column in range(2):
                    u, w = turns[k, s, 0, 2 * column], turns[k, s, 2, 2 * column]
                    inputs[at + 5 + 3 * column] = c * u - sine * w
                    inputs[at + 6 + 3 * column] = turns[k, s, 1, 2 * column]
                    inputs[at + 7 + 3 * column] = sine * u + c * w
                inputs[at + 11] = 1.0
                inputs[at + 12] = lags[k] / longest
                break
        for k in range(steps):
            seconds = (lags[k + 1] - lags[k]) * dt
            here = at + 13 + 4 * k
            if placed[k, s] and placed[k + 1, s]:
                u, w = places[k, s, 0] - places[k + 1, s, 0], places[k, s, 2] - places[k + 1, s, 2]
                inputs[here] = (c * u - sine * w) / (PACE * seconds)
                inputs[here + 1] = (places[k, s, 1] - places[k + 1, s, 1]) / (PACE * seconds)
                inputs[here + 2] = (sine * u + c * w) / (PACE * seconds)
                inputs[here + 3] = 1.0
            here = at + 13 + 4 * steps + 7 * k
            if turned[k, s] and turned[k + 1, s]:
                for column in range(2):
                    u = turns[k, s, 0, 2 * column] - turns[k + 1, s, 0, 2 * column]
                    v = turns[k, s, 1, 2 * column] - turns[k + 1, s, 1, 2 * column]
                    w = turns[k, s, 2, 2 * column] - turns[k + 1, s, 2, 2 * column]
                    inputs[here + 3 * column] = (c * u - sine * w) / (SPIN * seconds)
                    inputs[here + 1 + 3 * column] = v / (SPIN * seconds)
                    inputs[here + 2 + 3 * column] = (sine * u + c * w) / (SPIN * seconds)
                inputs[here + 6] = 1.0
    at = slots * (13 + 11 * steps)
    for j in range(1, len(body)):
        for i in range(3):
            inputs[at + 3 * j + i] = (body[j, i] - standard[j, i]) / BONE


@kernel(fastmath=EXACT, error_model="numpy")
def views_kernel(places, turns, placed, turned, bodies, standard, lags, dt, given, inputs, grounds):
    """`view_kernel` for each of B samples."""
    for b in range(len(places)):
        view_kernel(places[b], turns[b], placed[b], turned[b], bodies[b], standard, lags, dt, given[b], inputs[b], grounds[b])
