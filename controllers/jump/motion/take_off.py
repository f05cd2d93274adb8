"""Where the centre of mass is lowest and where it leaves, so that the ground can give the force that this takes.

The ground pushes from under the soles. Of a mass at height h, where the force leans by l from upright, the centre of
pressure lies l h behind it: the point for which the force has no moment about the centre of mass. A body that wants to go
forward lets itself fall ahead first and pushes when it is ahead of its feet; one that was planned to leave over them would
be pulled by something. Limbs that turn shift that point; how far, `scripts/measure/jump.py` prints.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...compiled import kernel
from ..body import TAKE_OFF_REACH, Physique, Start, carriage, stretched_kernel, uphill
from ..muscles import depth_kernel
from .footing import standing_heels_kernel
from .pendulum import waiting_kernel
from .thrust import MOMENTS, SPRINGY, upward_kernel

TOES = 0.03
"""At take-off the ground pushes so far ahead of the balls of the feet [m], at standard height."""
HURRY, SLOW = 0.8, 0.25
"""Who walks falls ahead already and winds up in so much less time, for each m/s; who is slower than the second [m/s] may take
longer."""
FROM_REST, READY = 0.34, 0.05
"""A wind-up from a stand takes so long [s] beside what it sinks; from the crouch, in which one has waited, the force rises in the second."""
HEELS = 0.9
"""Who waits in the crouch begins to push from behind the middle of the soles by this share of how far they can press, to leap ahead."""
FALLS = 0.3
"""Legs that give to a landing faster than this [m/s] come to their lowest point as they would, and push from there."""
STILL = 0.05
"""A body that rises or sinks slower stands [m/s]."""
DROPS, RISES = 7.2, 18.0
"""A quintic that sinks by d asks for less than gravity if it takes √(DROPS d / g) at least, and does not rise at first if it
takes √(RISES d / a) at most, where it ends with an acceleration a upward."""
MEETS = 2.5
"""With such an acceleration, over gravity, a standing body comes to its lowest point at most, where the push may begin with
more: a quintic that ends with nearly three times it asks the floor to pull before."""
LIFTED = 0.035
"""How much higher the centre of mass of one is who hops on one foot [m], at standard height: the other leg is held up."""
LEAST_CROUCH = 0.07
"""A body crouches at least so deep [m], at standard height."""
LEAST_RISE = 0.05
"""From its lowest point it rises at least so far [m], at standard height."""
MOST = 2.0
"""A wind-up that would need more foot than there is takes longer: at most so many times as long, on Earth."""
EXTENDS, SHORTEST = (0.85, 0.35, 16.0, 0.07), 0.94
"""Whoever leaves faster does so from knees bent more: legs lengthen by the first, as a share of the speed along them, and by the second more aside or
backward, where heels that rise help less; knees turn no faster for that than the third [rad/s] when they are bent by twice the fourth [rad] more than at
last. But legs are no shorter than this share of their length, and as straight as usual where the leap would be too far for the muscles then."""


class TakesOff(NamedTuple):
    """What of a start, and of the floor, tells where a body takes off. size: as in `BodyTables`. gravity: (3,) [m/s²]. floor [m]. stand: [m] how high its mass is as it stands; leads: (L,) as in `Measures`.
    middle, balls: (3,) [m] of the soles and the balls that push, feet: (2, 5) of those, one of them twice; reach: how far from the middle the soles can press [m]; uphill: [rad] how steeply they point up.
    centre, velocity: (3,) [m, m/s]. heading, leaves: [rad]. low: [m] as in `Start`, not a number where it comes down from nothing. The rest: as in `Start`; hops: it pushes off one foot; skipping: see `going_slowly`."""

    size: float
    gravity: np.ndarray
    floor: float
    stand: float
    leads: np.ndarray
    middle: np.ndarray
    balls: np.ndarray
    feet: np.ndarray
    reach: float
    uphill: float
    centre: np.ndarray
    velocity: np.ndarray
    heading: float
    leaves: float
    low: float
    straight: float
    heel_up: float
    haste: int
    ready: bool
    springs: bool
    hops: bool
    along: bool
    bound: bool
    skipping: float


def top(physique: Physique, start: Start, angles: np.ndarray, feet: np.ndarray, heading: float, guess: np.ndarray, velocity: np.ndarray, pushes: float) -> float:
    """How high [m] the centre of mass is over `guess`'s (3,) place as feet (2, 5) leave the floor with a velocity (3,) [m/s] after a push of so long [s], the body
    carried by `angles` (11,)."""
    return top_kernel(physique.tables, carriage.joints_of(physique.skeleton), np.ascontiguousarray(angles), feet, float(uphill(feet, start.slope).mean()), heading, guess, velocity,
                      pushes, start.haste, start.straight, start.heel_up, start.single is not None)


@kernel
def top_kernel(body, joints, angles, feet, uphill, heading, guess, velocity, pushes, haste, straight, heel_up, hops):
    """See `top`. uphill: [rad] how steeply the feet point up as they stand. haste, straight, heel_up: of the start; hops: whether one foot pushes."""
    reach, foot = straight, np.zeros(5)
    for side in range(2):
        for i in range(5):
            foot[i] += 0.5 * feet[side, i]
    if not haste:
        s, c = math.sin(heading), math.cos(heading)
        ahead = max(velocity[0] * s + velocity[2] * c, 0.0)
        speed, fastest = math.sqrt(velocity[0]**2 + velocity[1]**2 + velocity[2]**2), -math.inf
        for side in range(2):
            along, long = 0.0, 0.0
            for i in range(3):
                leg = guess[i] - feet[side, i]
                along, long = along + leg * velocity[i], long + leg * leg
            fastest = max(fastest, along / math.sqrt(long))
        share = math.hypot(velocity[0] - ahead * s, velocity[2] - ahead * c) / max(speed, 1e-9)
        reach = min(reach, straightest_kernel(fastest, 0.5 * (body.thigh + body.shank), share))
    down = standing_heels_kernel(body, foot, guess, pushes, haste, heel_up) - uphill
    return stretched_kernel(body, angles, joints, feet, down, reach, heading, guess) + (LIFTED * body.size if hops else 0.0)


@kernel
def straightest_kernel(speed, bone, astray):
    """How straight a leg is that leaves with a speed [m/s] along it, as a share of its length, see EXTENDS. bone: [m] of each of its two. astray: how much of it is aside or backward."""
    sine = (EXTENDS[0] + EXTENDS[1] * astray) * speed / (EXTENDS[2] * bone)
    bent = math.asin(min(max(sine, 0.0), 1.0)) - EXTENDS[3]  # half of how far its knee is
    return max(min(math.cos(max(bent, 0.0)), TAKE_OFF_REACH), SHORTEST)


@kernel
def standing_kernel(body, joints, able, off, angles, crouch, passing, leave, land, velocity, flight, found):
    """The take-off of a body that pushes off both feet, or hops on one, from about `leave` (3,) [m] with about a velocity (3,) [m/s], to be at `land` (3,) after `flight` [s].

    off: what it takes off from. able: its `Strength`. angles: (11,) as it leaves the floor, see `carriage`. crouch: how deep [m] people go down for it, whatever the muscles need. passing: (3,)
    [m/s] about how fast it falls ahead as the push begins.
    found: (4, 3) written: where it is lowest and where it leaves [m], the velocity with which it is lowest [m/s], and where it begins to press [m]. Returns the time until the lowest point [s], how much
    of that it goes down, and whether the muscles are strong enough.

    Until the lowest point the body falls about a pressed point as an inverted pendulum does; over the push
    the force's lean is linear in time. At the lowest point it comes from the middle of the soles, at take-off from
    the toes. Along the floor that is linear in both places.
    """
    size, g, floor, stand = off.size, -off.gravity[1], off.floor, off.stand
    rise = leave[1] - floor - stand
    deep = depth_kernel(able, velocity, velocity - passing, rise, off.gravity, body.total, 0.02 * size)
    strong = deep == deep  # not a number where the muscles can't
    if off.springs:  # what the landing stored pushes, not muscles that shorten from rest; how hard it may is asked of the finished path
        deep, strong = max(crouch, LEAST_RISE * size - rise), True
    elif strong:
        deep = max(max(deep, min(crouch, able.depth[-1])), max(LEAST_CROUCH * size, LEAST_RISE * size - rise))
    else:
        deep = able.depth[-1]
    duration, level = upward_kernel(max(deep + rise, 0.02 * size), 0.0, velocity[1], g, off.springs)
    low_height = stand - deep
    toes, pressed = off.balls.copy(), off.middle.copy()
    toes[0] += TOES * size * math.sin(off.heading)
    toes[2] += TOES * size * math.cos(off.heading)
    early, late = level * duration / low_height, level * duration / (leave[1] - floor)
    sinks = max(off.centre[1] - floor - low_height, 0.0)
    least = math.sqrt(DROPS * sinks / g)  # nobody is pulled down
    pace = math.hypot(off.velocity[0], off.velocity[2])
    sinking = 0.9 * math.sqrt(sinks / max(g, 3.0))
    usual = max((FROM_REST + sinking) / (1.0 + HURRY * pace), least)
    quick, still = usual, not off.low == off.low
    if off.ready:  # as far down as it is
        quick = max(READY + (FROM_REST - READY) * min(sinks / deep, 1.0) + sinking, least)
    if not still and -off.velocity[1] > FALLS:  # as the legs give already
        quick = max(2.0 * sinks / -off.velocity[1], READY)
    if off.ready and still:  # who waits leaning ahead pushes from the heels at first
        x, z = land[0] - leave[0], land[2] - leave[2]
        back = HEELS * off.reach / max(math.hypot(x, z), 0.3 * size)
        pressed[0] -= back * x
        pressed[2] -= back * z
    fixed = (duration, SPRINGY if off.springs else MOMENTS, early, late, math.sqrt(g / stand), off.centre, off.velocity, pressed, toes, land, flight)
    longest = quick if (pace >= SLOW and not off.ready) or not still else MOST * max(math.sqrt(9.81 / g), 1.0) * usual
    wind_up = waiting_kernel(quick, longest, off.reach, off.middle, fixed, found)
    x, z = found[1, 0] - off.balls[0], found[1, 2] - off.balls[2]
    near = min(1.0, off.leads[-1] / max(math.hypot(x, z), 1e-9))
    found[1, 0], found[1, 1], found[1, 2] = off.balls[0] + near * x, leave[1], off.balls[2] + near * z
    found[1, 1] = top_kernel(body, joints, angles, off.feet, off.uphill, off.leaves, found[1].copy(), velocity, duration, off.haste, off.straight, off.heel_up, off.hops)
    found[0, 1] = floor + low_height
    found[3] = pressed
    dip = math.inf
    # if it took longer it would rise first, and hop where little gravity makes it wait for seconds
    if still and (abs(off.velocity[1]) < STILL or wind_up > MOST * usual):
        dip = max(max(math.sqrt(RISES * sinks / min(max(level - g, 1e-6), MEETS * g)), min(0.5 * wind_up, usual)), least)
    return wind_up, dip, strong
