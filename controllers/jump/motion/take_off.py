"""Where the centre of mass is lowest and where it leaves, so that the ground can give the force that this takes.

The ground pushes from under the soles. Of a mass at height h, where the force leans by l from upright, the centre of
pressure lies l h behind it: the point for which the force has no moment about the centre of mass. A body that wants to go
forward lets itself fall ahead first and pushes when it is ahead of its feet; one that was planned to leave over them would
be pulled by something. Limbs that turn shift that point; how far, `scripts/measure/jump.py` prints.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ...body import yaw
from ..body import FLAT, TAKE_OFF_REACH, BodyTables, Measures, Physique, Start, over, stretched, uphill
from ..muscles import crouch_depth, strength
from .bound import longer
from .footing import heels_up
from .going_slowly import LOW, PUSHES, skipping
from .pendulum import waiting_kernel
from .thrust import MOMENTS, moments, risen, upward

TOES = 0.03
"""At take-off the ground pushes so far ahead of the balls of the feet [m], at standard height."""
YIELDS = 0.04
"""How long a runner's foot gives before it pushes, at least [s]."""
SHORTEST_PUSH = 0.08
"""No foot pushes a runner off in less [s]."""
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
STRIDE = 1.022
"""How much higher a body leaves off one foot, whose heel is higher, than off two."""
SLACK = 0.03
"""So much higher a runner may leave, on a straighter leg [m], at standard height."""
STRIKE = -0.5
"""How a runner's centre of mass is accelerated as the foot has struck, over gravity: half its weight is carried."""
LIFTED = 0.035
"""How much higher the centre of mass of one is who hops on one foot [m], at standard height: the other leg is held up."""
LEAST_CROUCH = 0.07
"""A body crouches at least so deep [m], at standard height."""
LEAST_RISE = 0.05
"""From its lowest point it rises at least so far [m], at standard height."""
MOST = 2.0
"""A wind-up that would need more foot than there is takes longer: at most so many times as long, on Earth."""
SOONER, TIMES = 0.85, 5
"""How much sooner a runner leaves that could not come up so far ahead of the foot, at most so often."""


EXTENDS, SHORTEST = (0.85, 0.35, 16.0, 0.07), 0.94
"""Whoever leaves faster does so from knees bent more: legs lengthen by the first, as a share of the speed along them, and by the second more aside or
backward, where heels that rise help less; knees turn no faster for that than the third [rad/s] when they are bent by twice the fourth [rad] more than at
last. But legs are no shorter than this share of their length, and as straight as usual where the leap would be too far for the muscles then."""


class TakeOff(NamedTuple):
    """Lowest point and take-off of the centre of mass (3,) [m], its velocity (3,) [m/s] at the lowest point, the time until
    there [s] and how much of that it goes down, whether the muscles are strong enough, and where (3,) the push begins to press."""

    low: np.ndarray
    leave: np.ndarray
    passing: np.ndarray
    wind_up: float
    dip: float
    strong: bool
    pressed: np.ndarray


def top(physique: Physique, start: Start, angles: np.ndarray, feet: np.ndarray, heading: float, guess: np.ndarray, velocity: np.ndarray, pushes: float) -> float:
    """How high [m] the centre of mass is over `guess`'s (3,) place as feet (2, 5) leave the floor with a velocity (3,) [m/s] after a push of so long [s], the body
    carried by `angles` (11,)."""
    lifted, body, reach = 0.0 if start.single is None else LIFTED * physique.size, physique.tables, start.straight
    if not start.haste:
        legs, facing = guess - feet[:, :3], yaw(heading)[:, 2]
        astray = velocity * FLAT - max(float(velocity @ facing), 0.0) * facing
        share = float(np.linalg.norm(astray)) / max(float(np.linalg.norm(velocity)), 1e-9)
        reach = min(reach, straightest(float((legs @ velocity / np.linalg.norm(legs, axis=1)).max()), body, share))
    down = heels_up(start, feet, guess, pushes, body) - float(uphill(feet, start.slope).mean())
    return stretched(physique, angles, feet, down, reach, heading, guess) + lifted


def straightest(speed: float, body: BodyTables, astray: float) -> float:
    """How straight a leg is that leaves with a speed [m/s] along it, as a share of its length, see EXTENDS. astray: how much of it is aside or backward."""
    sine = (EXTENDS[0] + EXTENDS[1] * astray) * speed / (EXTENDS[2] * 0.5 * (body.thigh + body.shank))
    bent = math.asin(min(max(sine, 0.0), 1.0)) - EXTENDS[3]  # half of how far its knee is
    return max(min(math.cos(max(bent, 0.0)), TAKE_OFF_REACH), SHORTEST)


@dataclass(frozen=True, eq=False)
class Standing:
    """A body that pushes off both feet, or hops on one: `middle` (3,) [m] of the soles, `balls` (3,) of the feet; reach: how far from that middle
    the soles can press [m]. floor [m], gravity (3,) [m/s²]. crouch: how deep [m] people go down for it, whatever the muscles
    need. feet: (2, 5) that push, one of them twice. angles: (11,) as they leave the floor, see `carriage`. passing: (3,) [m/s] about how fast it falls ahead
    as the push begins.
    """

    physique: Physique
    start: Start
    heights: Measures
    middle: np.ndarray
    balls: np.ndarray
    reach: float
    floor: float
    gravity: np.ndarray
    feet: np.ndarray
    angles: np.ndarray
    crouch: float = 0.0
    passing: np.ndarray = field(default_factory=lambda: np.zeros(3))

    @cached_property
    def facing(self) -> np.ndarray:
        """Where (3,) it faces."""
        return yaw(self.start.heading)[:, 2]

    def take_off(self, leave: np.ndarray, land: np.ndarray, velocity: np.ndarray, flight: float) -> TakeOff:
        """The take-off from about `leave` (3,) [m] with about a velocity (3,) [m/s], to be at `land` (3,) after `flight` [s].

        Until the lowest point the body falls about a pressed point as an inverted pendulum does; over the push
        the force's lean is linear in time. At the lowest point it comes from the middle of the soles, at take-off from
        the toes. Along the floor that is linear in both places.
        """
        size, g = self.physique.size, -float(self.gravity[1])
        rise = leave[1] - self.floor - self.heights.stand
        deep = crouch_depth(self.physique, velocity, rise, self.gravity, passing=self.passing)
        strong = deep == deep  # not a number where the muscles can't
        able = float(strength(self.physique).depth[-1])
        if self.start.springs:  # what the landing stored pushes, not muscles that shorten from rest; how hard it may is asked of the finished path
            deep, strong = max(self.crouch, LEAST_RISE * size - rise), True
        else:
            deep = max(deep, min(self.crouch, able), LEAST_CROUCH * size, LEAST_RISE * size - rise) if strong else able
        duration, level = upward(max(deep + rise, 0.02 * size), 0.0, float(velocity[1]), g, self.start.springs)
        low_height, start = self.heights.stand - deep, self.start
        facing = self.facing
        toes = self.balls + TOES * size * facing
        early, late = level * duration / low_height, level * duration / (leave[1] - self.floor)
        sinks = max(float(start.centre[1]) - self.floor - low_height, 0.0)
        least = math.sqrt(DROPS * sinks / g)  # nobody is pulled down
        pace = float(np.linalg.norm(start.velocity * FLAT))
        sinking = 0.9 * math.sqrt(sinks / max(g, 3.0))
        usual = quick = max((FROM_REST + sinking) / (1.0 + HURRY * pace), least)
        if start.ready:  # as far down as it is
            quick = max(READY + (FROM_REST - READY) * min(sinks / deep, 1.0) + sinking, least)
        if start.low is not None and -start.velocity[1] > FALLS:  # as the legs give already
            quick = max(2.0 * sinks / -float(start.velocity[1]), READY)

        rate = math.sqrt(g / self.heights.stand)
        pressed = self.middle
        if start.ready and start.low is None:  # who waits leaning ahead pushes from the heels at first
            flat = (land - leave) * FLAT
            pressed = pressed - HEELS * self.reach * flat / max(float(np.linalg.norm(flat)), 0.3 * size)
        fixed = (duration, moments(self.start.springs), early, late, rate, start.centre, start.velocity, pressed, toes, land, flight)
        found = np.empty((4, 3))
        longest = quick if pace >= SLOW and not start.ready or start.low is not None else MOST * max(math.sqrt(9.81 / g), 1.0) * usual
        wind_up = waiting_kernel(quick, longest, self.reach, self.middle, fixed, found)
        low, ahead, passing, _ = found
        lead = (ahead - self.balls) * FLAT
        lead *= min(1.0, self.heights.leads[-1] / max(float(np.linalg.norm(lead)), 1e-9))
        ahead = self.balls * FLAT + lead + [0.0, leave[1], 0.0]
        ahead[1] = top(self.physique, start, self.angles, self.feet, start.leaves, ahead, velocity, duration)
        leave = ahead
        low = low * FLAT + [0.0, self.floor + low_height, 0.0]
        dip = math.inf
        # if it took longer it would rise first, and hop where little gravity makes it wait for seconds
        if start.low is None and (abs(start.velocity[1]) < STILL or wind_up > MOST * usual):
            dip = max(math.sqrt(RISES * sinks / min(max(level - g, 1e-6), MEETS * g)), min(0.5 * wind_up, usual), least)
        return TakeOff(low, leave, passing, wind_up, dip, strong, pressed)


@dataclass(frozen=True, eq=False)
class Running:
    """A runner who pushes off one foot that has just struck: `ball` (3,) [m] of it. floor [m], gravity (3,) [m/s²]."""

    physique: Physique
    start: Start
    heights: Measures
    ball: np.ndarray
    floor: float
    gravity: np.ndarray

    def take_off(self, leave: np.ndarray, land: np.ndarray, velocity: np.ndarray, flight: float) -> TakeOff:
        """The take-off from about `leave` (3,) [m] with about a velocity (3,) [m/s], to be at `land` (3,) after `flight` [s].

        The foot gives while the body passes, then pushes; it pushes as long as the body is about as far behind it
        at first as ahead of it at last, or farther ahead if it is to become faster.
        """
        start, g, most = self.start, -float(self.gravity[1]), float(self.heights.leads[-1])
        passing = start.velocity * FLAT
        mean = 0.5 * (passing + velocity * FLAT)
        along = mean / max(float(np.linalg.norm(mean)), 1e-6)
        behind = float((start.centre - self.ball) @ along)
        speed = max(float(np.linalg.norm(mean)), 0.3)
        # the force's mean lean brings the velocity about
        lean = float((velocity - passing) @ along) / max(float(velocity[1]) - float(start.velocity[1]) + g * 0.2, 1.0)
        lead = min(2.0 * lean * self.heights.stand - behind, most)
        if start.along:
            lead = behind + (float(longer(float(velocity[1]), self.physique.size, g)) if start.bound else 1.0) * PUSHES * math.sqrt(9.81 * self.physique.size / g) * speed

        def above(yielding: float, contact: float) -> float:
            """How much too high [m] the body leaves if the foot gives so long [s]."""
            pushed = contact - yielding
            level = (float(velocity[1]) / pushed + g) / MOMENTS[0]
            sinks = -0.5 * start.velocity[1] * yielding + (level - g - STRIKE * g) * yielding**2 / 12.0
            return float(start.centre[1]) - sinks + risen(pushed, float(velocity[1]), g) - self._top(contact * speed + behind)

        for _ in range(TIMES):  # who leaves sooner leaves higher
            contact = max((lead - behind) / speed, YIELDS + SHORTEST_PUSH)
            least, longest = YIELDS, contact - SHORTEST_PUSH
            if above(longest, contact) <= SLACK * self.physique.size or longest <= least:
                break
            lead = behind + SOONER * (lead - behind)
        if above(least, contact) <= 0.0:
            yielding = least
        elif above(longest, contact) >= 0.0:
            yielding = longest
        else:
            from scipy.optimize import brentq  # slow to load, and a game starts without

            # scipy's hints forget that only full_output makes it a pair
            yielding: float = brentq(above, least, longest, args=(contact,), xtol=1e-4)  # pyright: ignore[reportAssignmentType]
        rise = risen(contact - yielding, float(velocity[1]), g)
        low = (start.centre + start.velocity * yielding) * FLAT
        leave = low + mean * (contact - yielding)
        leave[1] = self._top(contact * speed + behind) + min(above(yielding, contact), SLACK * self.physique.size)
        low[1] = leave[1] - rise
        return TakeOff(low, leave, passing, yielding, math.inf, True, self.ball)

    def _top(self, lead: float) -> float:
        """How high it leaves so far ahead of its foot [m]."""
        return self.floor + over(STRIDE * self.heights.leave(0.0), max(lead, 0.0)) - LOW * self.physique.size * skipping(self.start, self.physique.size)
