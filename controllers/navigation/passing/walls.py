"""Walls: what stands about that holds a body up which walks at it, and how fast somebody may go towards it.

A wall is what is higher over the floor right before it than a step: of stairs, which are walked up, each tread is the floor before the next.
A ramp, which is walked on, is as high as where it is nearest: its tall end and what is high of its sides are walls, to who is not over it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...compiled import kernel
from ..obstacles import is_box, is_pillar, of_the_same, ramp, slope, span
from ..routes import distance

STEP, HEAD = 0.30, 1.7
"""What is no higher over the floor is stepped on, by a child of 1.2 m 20 cm; what hangs higher is walked under [m]."""
NEAR = 0.18
"""How near to its middle a body of usual size lets walls come [m]."""
ASKEW = 0.09
"""… and so much less near who goes askew to one, one leg on its side: his feet pass each other there [m]."""
EDGE = 0.04
"""Right before something is so far from it [m]."""
SAME = 0.01
"""What lies right before something and is higher by no more than this [m] is as high: a landing goes on from the last tread."""
CRACK = 0.1
"""Ramps that make up hills leave cracks of this width between them at most [m]: they are the floor before each other across one."""
PASSES = 3
"""So often all walls are gone through: where two meet, what one takes away another may bring back."""
TRACED, MET = 48, 0.005
"""A straight way is followed in so many stretches at most, until something is nearer than this to where it holds somebody up [m]."""
PACE = 0.1
"""Over a ramp and beside what is low of it a straight way is followed no less than so far at a time [m]."""


@of_the_same
def walls_of(around: Sequence[Any]) -> np.ndarray:
    """What stands about, as kernels here take it, (K, 9): centre x, z [m], half width and half length [m], heading [rad] and radius, as shapes have
    them; how low and how high it reaches [m], a ramp in its middle, and a ramp's slope."""
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
def rise_kernel(walls, k, x, z, far, out):
    """How much higher [m] one of `walls_of` reaches than in its middle where it is nearest to a place, or there, where that is over it: a ramp does.
    far, out: of the place, as `distance` has them."""
    if walls[k, 8] == 0.0:
        return 0.0
    beside = max(far, 0.0)
    return walls[k, 8] * (math.sin(walls[k, 4]) * (x - beside * out[0] - walls[k, 0]) + math.cos(walls[k, 4]) * (z - beside * out[1] - walls[k, 1]))


@kernel
def wall_kernel(walls, k, x, z, floor, bound, out, least=STEP):
    """How far [m] a place on a floor [m] is from one of `walls_of`, endless where that holds nobody up, as what is no higher than `least` [m] over the floor;
    out: (3,) as `distance` has it. Of what is no nearer than a bound [m], whether it holds anybody up is not asked."""
    rises = walls[k, 8] != 0.0
    if not rises and (walls[k, 7] <= floor + least or walls[k, 6] >= floor + HEAD):
        return math.inf
    far = distance(x, z, walls[k, :6], out)
    if far >= bound:
        return far
    rise = rise_kernel(walls, k, x, z, far, out)
    low, high = walls[k, 6] + rise, walls[k, 7] + rise
    if rises and (far <= 0.0 or high <= floor + least or low >= floor + HEAD):
        return math.inf
    before = 0.0
    for part in range(2 if rises else 1):
        px, pz = x - (far - EDGE - part * CRACK) * out[0], z - (far - EDGE - part * CRACK) * out[1]
        for i in range(walls.shape[0]):
            if walls[i, 5] > 0.0 or walls[i, 8] == 0.0 and walls[i, 6] >= floor + HEAD:
                continue
            c, s = math.cos(walls[i, 4]), math.sin(walls[i, 4])
            dx, dz = px - walls[i, 0], pz - walls[i, 1]
            along = s * dx + c * dz
            top = walls[i, 7] + walls[i, 8] * along
            if abs(c * dx - s * dz) <= walls[i, 2] and abs(along) <= walls[i, 3] and before < top <= high + (EDGE if rises or walls[i, 8] != 0.0 else SAME):
                before = top
    return far if high > before + STEP else math.inf


@kernel
def near_kernel(near, heading, out):
    """How near [m] walls come to somebody in a heading [rad] whom they come as near as that when he faces them or has them beside him. out: (3,) as `distance` has it."""
    s, c = math.sin(heading), math.cos(heading)
    return near + ASKEW * (2.0 * (s * out[0] + c * out[1]) * (c * out[0] - s * out[1])) ** 2


@kernel
def slow_kernel(walls, x, z, floor, heading, velocity, near, lag, brake, back, least=STEP):
    """Take from a velocity (2,) along x and z [m/s] what goes towards a wall faster than somebody can brake who begins to after `lag` [s] and brakes with
    `brake` [m/s²], so that his middle comes no nearer than `near` [m], see `near_kernel`; whether anything was. back: so fast is led away [m/s] who is too near already; least: what is no higher over the floor [m] holds nobody up."""
    out, slowed = np.empty(3), False
    for _ in range(PASSES):
        for k in range(walls.shape[0]):
            far = distance(x, z, walls[k, :6], out)
            room = far - near_kernel(near, heading, out)
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
            px, pz = x + gone * ahead[0], z + gone * ahead[1]
            room = wall_kernel(walls, k, px, pz, floor, least + near, here) - near
            if walls[k, 8] != 0.0 and (room == math.inf or here[0] * ahead[0] + here[1] * ahead[1] > 0.0):  # not here, but it may farther on
                far = distance(px, pz, walls[k, :6], here)
                room = max(far - near if far > 0.0 else -far, PACE)
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
def out_kernel(walls, x, z, floor, heading, since, near, shift, least=STEP):
    """Write how far (2,) x, z [m] somebody has to be moved so that no wall is nearer to his middle than `near` [m], see `near_kernel`, or than it was before, at `since` (2,);
    whether he has to be. least: what is no higher over the floor [m] holds nobody up."""
    out, was, moved = np.empty(3), np.empty(3), False
    shift[0] = shift[1] = 0.0
    for _ in range(PASSES):
        for k in range(walls.shape[0]):
            far = wall_kernel(walls, k, x + shift[0], z + shift[1], floor, near + ASKEW, out, least)
            keeps = near_kernel(near, heading, out)
            if far >= keeps:
                continue
            missing = min(keeps, distance(since[0], since[1], walls[k, :6], was)) - far
            if missing > 0.0:
                shift[0] += missing * out[0]
                shift[1] += missing * out[1]
                moved = True
    return moved
