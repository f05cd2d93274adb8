"""Walls hold up who walks or runs at them, whatever he wishes: the last resort, for who wishes well has braked before.

Before a step, what his command has towards a wall is no faster than he can brake hard, and who gets on no more comes to rest; after it, what still came too near
is led out, feet and all.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import kernel
from ..navigation.passing import HEAD, NEAR, STEP, out_kernel, rise_kernel, slow_kernel
from ..navigation.routes import distance
from .memory import ABOUT, ASKS, put

LAG, BRAKE = 0.1, 6.0
"""Nobody goes faster towards a wall than he could stop who begins to so much later [s], braking so hard [m/s²], half as hard again as legs push."""
SUDDEN = 12.0
"""Who comes there too fast for that, as out of a leap, loses no more [m/s²] than that at once, or as much as just stops him, evenly, before it."""
BACK = 0.3
"""Who is too near to a wall as he walks is led away from it no faster than this [m/s]."""
GIVES = 0.01
"""So much nearer than that [m] a step may end, and the next one makes up for it."""
RESTS, CLOSE = 0.15, 0.1
"""Who would get on more slowly than the first where he wishes to [m/s] stands still in place of treading on the spot; he sets off again only where he could if walls were nearer
by the second [m]."""
LEAPT = 1.3
"""What is no higher over the floor than this [m] may be leapt onto: it does not hold up who is about to leap."""
LATE, HARD = 0.05, 12.0
"""And it holds up who asks for a leap and has not leapt by the last moment: the same of him as LAG and BRAKE."""

ARMS, HANDS = 0.6, 0.5
"""Who stands has no room for his arms where something is so near to his middle [m] that is higher over the floor than the second [m]."""


def held_up(memory: np.ndarray, wish: np.ndarray, floors: np.ndarray, walls: np.ndarray, dt: float) -> None:
    """Slow down, in place, the commands of characters (N,) towards walls (K, 9) as of `walls_of`; of who is about to leap only towards those that nobody leaps onto, and of who
    asks for a leap at the last moment.
    Take away the wishes (N, 3) that lead nowhere. Note whose feet, and of those who stand whose arms, have no room. floors: (N,) [m]."""
    memory["cramped"] = memory["walled"] = 0
    if len(walls):
        hold_kernel(memory, wish, floors, walls, dt)


def led_out(memory: np.ndarray, before: np.ndarray, floors: np.ndarray, walls: np.ndarray, root: np.ndarray) -> None:
    """Move characters (N,) and their roots (N, 3), in place, out of walls (K, 9) that came nearer to them in a step than they may. before: (N, 2) where they
    were; floors: (N,) [m]."""
    shift = np.zeros((len(memory), 2))
    if len(walls) and beyond_kernel(memory, before, floors, walls, shift):
        some = np.flatnonzero(shift.any(-1))
        moved = memory[some]
        put(moved, moved["ground"] + np.pad(shift[some], ((0, 0), (0, 1))))
        memory[some] = moved
        root[:, [0, 2]] += shift


@kernel
def hold_kernel(memory, wish, floors, walls, dt):
    """Slow down the commands of characters (N,) towards walls (K, 9), but for who stands, and let rest whom walls let get on no more."""
    velocity, rate, out = np.empty(2), np.empty(2), np.empty(3)
    for n in range(memory.shape[0]):
        m = memory[n]
        if _nowhere(m, wish[n], floors[n], walls, velocity):
            wish[n, 0] = wish[n, 2] = 0.0
            m.cramped = 1
        if m.settled:
            for k in range(walls.shape[0]):
                far = distance(m.ground[0], m.ground[1], walls[k, :6], out)
                over = floors[n] - rise_kernel(walls, k, m.ground[0], m.ground[1], far, out)
                if far < ARMS and walls[k, 7] > over + HANDS and walls[k, 6] < over + HEAD:
                    m.cramped = 1
            continue
        c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
        velocity[0], velocity[1] = c * m.command[2] + s * m.command[0], c * m.command[0] - s * m.command[2]
        rate[0], rate[1] = velocity[0], velocity[1]
        if _slowed(m, floors[n], walls, velocity, NEAR):
            _evenly(rate, velocity, dt)
            m.walled = 1
            m.command[0], m.command[2] = s * velocity[0] + c * velocity[1], c * velocity[0] - s * velocity[1]
            # nor does what is under way go on towards it
            x, z = velocity[0] - rate[0], velocity[1] - rate[1]
            far = max(math.hypot(x, z), 1e-9)
            x, z = x / far, z / far
            rate[0], rate[1] = c * m.rate[2] + s * m.rate[0], c * m.rate[0] - s * m.rate[2]
            into = min(rate[0] * x + rate[1] * z, 0.0)
            m.rate[0] -= into * (s * x + c * z)
            m.rate[2] -= into * (c * x - s * z)


@kernel
def _slowed(m, floor, walls, velocity, near):
    """Take from a velocity (2,), in place, what goes too fast towards walls, to whose middle none comes nearer than `near` [m]; whether anything was."""
    late = m.alert == ASKS
    return slow_kernel(walls, m.ground[0], m.ground[1], floor, m.ground[2], velocity, near, LATE if late else LAG, HARD if late else BRAKE, BACK,
                       LEAPT if m.alert == ABOUT else STEP)


@kernel
def _evenly(before, velocity, dt):
    """Bring a velocity (2,), in place, no farther from what it was before (2,) [m/s] within dt than evenly braking to where it is to end takes, or as SUDDEN as that is."""
    x, z = velocity[0] - before[0], velocity[1] - before[1]
    less = math.hypot(x, z)
    if less <= SUDDEN * dt:
        return
    into = -(before[0] * x + before[1] * z) / less
    left = max(into - less, 0.0) / BRAKE + LAG
    room = 0.5 * BRAKE * (left * left - LAG * LAG)  # which lets him go so fast
    share = min(max(SUDDEN, 0.5 * into * into / max(room, 1e-6)) * dt / less, 1.0)
    velocity[0], velocity[1] = before[0] + share * x, before[1] + share * z


@kernel
def _nowhere(m, wish, floor, walls, velocity):
    """Whether walls let nobody get on who wishes (3,) to go on from there. velocity: (2,) scratch."""
    speed = math.hypot(wish[0], wish[2])
    if speed <= RESTS:
        return False
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    x, z = c * wish[2] + s * wish[0], c * wish[0] - s * wish[2]
    velocity[0], velocity[1] = x, z
    near = NEAR + CLOSE if m.settled else NEAR
    return _slowed(m, floor, walls, velocity, near) and velocity[0] * x + velocity[1] * z < RESTS * speed


@kernel
def beyond_kernel(memory, before, floors, walls, shifts):
    """Write by how much (N, 2) [m] characters (N,) have to be moved out of walls; whether any has."""
    found = False
    for n in range(memory.shape[0]):
        m = memory[n]
        if out_kernel(walls, m.ground[0], m.ground[1], floors[n], m.ground[2], before[n], NEAR - GIVES, shifts[n], LEAPT if m.alert == ABOUT else STEP):
            found = True
    return found
