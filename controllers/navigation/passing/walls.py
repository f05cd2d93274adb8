"""Walls: what stands about that holds a body up which walks at it, and how fast somebody may go towards it.

A wall is what is higher over the floor right before it than a step: of stairs, which are walked up, each tread is the floor before the next.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...compiled import kernel
from ..obstacles import is_box, is_pillar, ramp, slope, span
from ..routes import distance

STEP, HEAD = 0.30, 1.7
"""What is no higher over the floor is stepped on, by a child of 1.2 m 20 cm; what hangs higher is walked under [m]."""
NEAR = 0.18
"""How near to its middle a body of usual size lets walls come [m]."""
EDGE = 0.04
"""Right before something is so far from it [m]."""
PASSES = 3
"""So often all walls are gone through: where two meet, what one takes away another may bring back."""
TRACED, MET = 48, 0.005
"""A straight way is followed in so many stretches at most, until something is nearer than this to where it holds somebody up [m]."""


def walls_of(around: Sequence[Any]) -> np.ndarray:
    """What stands about, as kernels here take it, (K, 9): centre x, z [m], half width and half length [m], heading [rad] and radius, as shapes have
    them; how low and how high it reaches [m], and the slope of a ramp, which is walked on."""
    found = []
    for thing in around:
        if is_box(thing):
            centre, size = thing.centre, thing.size
            found.append((centre[0], centre[2], 0.5 * size[0], 0.5 * size[2], thing.heading, 0.0, *span(thing), slope(thing) if ramp(thing) else 0.0))
        elif is_pillar(thing):
            foot = thing.foot
            found.append((foot[0], foot[2], 0.0, 0.0, 0.0, thing.radius, foot[1], foot[1] + thing.height, 0.0))
    return np.array(found, float).reshape(-1, 9)


@kernel
def wall_kernel(walls, k, x, z, floor, bound, out, least=STEP):
    """How far [m] a place on a floor [m] is from one of `walls_of`, endless where that holds nobody up, as what is no higher than `least` [m] over the floor;
    out: (3,) as `distance` has it. Of what is no nearer than a bound [m], whether it holds anybody up is not asked."""
    low, high = walls[k, 6], walls[k, 7]
    if walls[k, 8] != 0.0 or high <= floor + least or low >= floor + HEAD:
        return math.inf
    far = distance(x, z, walls[k, :6], out)
    if far >= bound:
        return far
    before = 0.0
    px, pz = x - (far - EDGE) * out[0], z - (far - EDGE) * out[1]
    for i in range(walls.shape[0]):
        if walls[i, 5] > 0.0:
            continue
        c, s = math.cos(walls[i, 4]), math.sin(walls[i, 4])
        dx, dz = px - walls[i, 0], pz - walls[i, 1]
        along = s * dx + c * dz
        top = walls[i, 7] + walls[i, 8] * along
        if abs(c * dx - s * dz) <= walls[i, 2] and abs(along) <= walls[i, 3] and before < top <= high - EDGE:
            before = top
    return far if high > before + STEP else math.inf


@kernel
def slow_kernel(walls, x, z, floor, velocity, near, lag, brake, back, least=STEP):
    """Take from a velocity (2,) along x and z [m/s] what goes towards a wall faster than somebody can brake who begins to after `lag` [s] and brakes with
    `brake` [m/s²], so that his middle comes no nearer than `near` [m]; whether anything was. back: so fast is led away [m/s] who is too near already; least: what is no higher over the floor [m] holds nobody up."""
    out, slowed = np.empty(3), False
    for _ in range(PASSES):
        for k in range(walls.shape[0]):
            far = distance(x, z, walls[k, :6], out)
            room = far - near
            allowed = brake * (math.sqrt(lag * lag + 2.0 * room / brake) - lag) if room > 0.0 else max(room / lag, -back)
            over = -velocity[0] * out[0] - velocity[1] * out[1] - allowed
            if over > 1e-9 and wall_kernel(walls, k, x, z, floor, math.inf, out, least) < math.inf:
                velocity[0] += over * out[0]
                velocity[1] += over * out[1]
                slowed = True
    return slowed


@kernel
def way_kernel(walls, x, z, floor, ahead, near, most, out):
    """How far [m] somebody gets along a direction (2,) until a wall is as near as `near` [m], `most` [m] at most; out: (3,) the way out of that wall, as
    `distance` has it."""
    gone, here = 0.0, np.empty(3)
    for _ in range(TRACED):
        least = math.inf
        for k in range(walls.shape[0]):
            room = wall_kernel(walls, k, x + gone * ahead[0], z + gone * ahead[1], floor, least + near, here) - near
            if room < least:
                least = room
                for i in range(3):
                    out[i] = here[i]
        if least < MET:
            return gone
        gone += least
        if gone >= most:
            return most
    return gone


@kernel
def out_kernel(walls, x, z, floor, since, near, shift, least=STEP):
    """Write how far (2,) x, z [m] somebody has to be moved so that no wall is nearer to his middle than `near` [m], or than it was before, at `since` (2,);
    whether he has to be. least: what is no higher over the floor [m] holds nobody up."""
    out, was, moved = np.empty(3), np.empty(3), False
    shift[0] = shift[1] = 0.0
    for _ in range(PASSES):
        for k in range(walls.shape[0]):
            far = wall_kernel(walls, k, x + shift[0], z + shift[1], floor, near, out, least)
            if far >= near:
                continue
            missing = min(near, distance(since[0], since[1], walls[k, :6], was)) - far
            if missing > 0.0:
                shift[0] += missing * out[0]
                shift[1] += missing * out[1]
                moved = True
    return moved
