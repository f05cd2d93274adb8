"""The landing: legs push back nearly as hard all the way down, from nothing at touch-down, then bring the body up to stand.

Feet first (Ha 2012 without the roll): toes, then heels, knees absorbing. A fall of speed v that is stopped over s takes a force of
1 + v²/(2 g s) body weights at least, if it is level; a spring's peak is a third more. Along the floor the body
comes to rest over its feet if it can; the margin says whether it could.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

TIME = 1.35
"""From touch-down until the body stands [s]."""
HOLD, PASS = 4.2, 1.0
"""Rate of the spring that brings the body to rest over its feet, and of one that lets it pass over them [1/s]."""
STRIDE, STIFF = 0.25, 0.5
"""Rate of that spring where one runs on on one foot [1/s], whose leg sinks by this share of how far two sink: knees bend by 78° of who walks
and by 87° of who runs, recorded ones of runners by 83 to 85."""
GRIP = 0.8
"""The friction of soles that a body which passes over its feet counts on."""
SINKS = 0.04, 0.085, 0.42
"""How deep [m] legs give to a body that hardly falls, how much deeper for each m/s that it falls, and at most: a tenth deeper than recorded
for fast falls, at standard height."""
FOLDED = 0.08, 0.3
"""Who touches down lower below where it stands than the first, as a share of that, sinks by so much of the rest less: legs that are folded
already would raise the heels."""
SOONEST = 10
"""The force over the way down (s = t / T) is A (1 − (1 − s)^SOONEST − c s²): it begins at nothing and is nearly level after a tenth of T."""
EASES, HARD = 0.3, 0.7
"""c at most; it is as much where a level force would be heavier than the body by the second, times its weight, and less in softer landings."""
RISES, EASIEST = 5.6, 0.85
"""But c is so much that at the lowest point no more than some seven times its weight is left, lest the body be thrown up; and at most."""
SLOWEST, LIGHT = 8.0, 6.5
"""Rate of the spring with which a body stands up at least [1/s], so that it is up when its trunk and arms are; the square of that rate at most,
times how deep it is over gravity: the floor can't pull."""
ADULT = 0.975
"""How high the centre of mass of a standard body stands [m]."""
LOWER = 1.25
"""Who rolls on from there sinks deeper by this: hands take the rest."""
DEEPEST = 0.45
"""How far a body sinks at most, as a share of its standing height."""
LEAST = 0.02
"""And at least, likewise."""
CATCH = 0.6
"""How much of the capture point's lead counts: arms, trunk and a heel's edge brake, too."""
QUARTER = 0.13
"""So long [s] a springy landing gives whatever the fall: a mass on a spring comes to its lowest point after a quarter of its time. By the measure of
`scripts/measure/hops.py`, which takes 0.03 s longer, as recorded (0.12 … 0.19 s). At standard height."""
HARDEST = 3.3, 5.0
"""But longer where one leg, or two, would have to give more than so many of an adult's weights on Earth."""
OVER = 0.04
"""A body that passes over its feet walks on once it is so far beyond their middle [m]."""


@dataclass(frozen=True, eq=False)
class Landing:
    """The centre of mass after touch-down: rate [1/s] of the springs along the floor, `offset` (3,) [m] from where it
    comes to rest, `velocity` (3,) [m/s] with which it landed, `gravity` [m/s²], `goal` (3,) [m]. deep: how far [m] it sinks. passes: it
    can't stop here."""

    rate: float
    offset: np.ndarray
    velocity: np.ndarray
    gravity: float
    goal: np.ndarray
    deep: float
    passes: bool = False

    def until(self, times: np.ndarray) -> float:
        """When [s] a body that passes over its feet walks on: infinite for one that stops."""
        return self.over(times) if self.passes else np.inf

    def over(self, times: np.ndarray) -> float:
        """When [s] a body has come over its feet: infinite where it does not."""
        place, velocity, _ = self.motion(times)
        ahead = self.velocity * [1.0, 0.0, 1.0] / np.linalg.norm(self.velocity[[0, 2]])
        beyond = (place - self.goal) @ ahead > OVER
        return float(times[int(np.argmax(beyond))]) if beyond.any() else np.inf

    @cached_property
    def down(self) -> tuple[float, float, float]:
        """How long [s] the body sinks, the force over mass [m/s²] that the way down is scaled by, A, and how it eases, c."""
        fall, g, n = max(-float(self.velocity[1]), 0.0), self.gravity, SOONEST + 1.0
        hard = fall**2 / (2.0 * g * self.deep)
        eases = max(EASES * min(hard / HARD, 1.0), min(1.0 - RISES / (1.0 + hard), EASIEST))
        # with A from the velocity, w + g T = A T m0, the way d = w T + ½ g T² − A T² n0 is quadratic in T; n0 < ½ m0
        whole, way = 1.0 - 1.0 / n - eases / 3.0, 0.5 - 1.0 / n + 1.0 / (n * (n + 1.0)) - eases / 12.0
        share = way / whole
        half = 0.5 * fall * (1.0 - share)
        lasts = self.deep / (half + np.sqrt(half**2 + g * (0.5 - share) * self.deep))
        return float(lasts), float((fall / lasts + g) / whole), float(eases)

    def gives(self, share: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The force over its level after a share (N,) of the way down, and its first and second integral."""
        s, n, eases = share, SOONEST + 1.0, self.down[2]
        left = 1.0 - s
        return (1.0 - left**SOONEST - eases * s**2, s - (1.0 - left**n) / n - eases * s**3 / 3.0,
                0.5 * s**2 - s / n + (1.0 - left ** (n + 1.0)) / (n * (n + 1.0)) - eases * s**4 / 12.0)

    def motion(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Place, velocity, acceleration (N, 3) at times (N,) [s] after touch-down."""
        t = np.asarray(time, float)
        found = sprung(t[:, None], self.rate, self.offset, self.velocity, np.array([0.0, -self.gravity, 0.0]))
        lasts, level, eases = self.down
        force, rate, way = self.gives(np.minimum(t / lasts, 1.0))
        force, rate, way = level * force, level * lasts * rate, level * lasts**2 * way
        fall, under = min(float(self.velocity[1]), 0.0), float(self.offset[1]) - self.deep
        ends = level * (1.0 - eases) - self.gravity
        stands = max(np.sqrt(max(ends, 0.0) / -under), min(SLOWEST, np.sqrt(LIGHT * self.gravity / -under)))
        up = sprung(np.maximum(t - lasts, 0.0), stands, under, 0.0, ends)
        sinking = (self.offset[1] + fall * t - 0.5 * self.gravity * t**2 + way, fall - self.gravity * t + rate, force - self.gravity)
        for part, before, after in zip(found, sinking, up):
            part[:, 1] = np.where(t < lasts, before, after)
        return self.goal + found[0], found[1], found[2]


class Springy(Landing):
    """A landing from which one hops on: the force is a quarter of a sine until the lowest point, as of a mass on a spring."""

    @staticmethod
    def depth(fall: float, gravity: float, size: float, legs: int) -> float:
        """How deep [m] legs give to a fall [m/s] under gravity [m/s²]. size: over standard height."""
        most = 0.5 * np.pi
        lasts = max(QUARTER * np.sqrt(size), most * fall / max(HARDEST[legs - 1] * 9.81 - most * gravity, 1e-6))
        return float(lasts * (fall / most + (2.0 / np.pi - 0.5) * gravity * lasts))

    @cached_property
    def down(self) -> tuple[float, float, float]:
        """How long [s] the body sinks, the force over mass [m/s²] at the lowest point, and 0: nothing eases."""
        fall, g, most = max(-float(self.velocity[1]), 0.0), self.gravity, 0.5 * np.pi
        half, bend = 0.5 * fall / most, (2.0 / np.pi - 0.5) * g
        lasts = self.deep / (half + np.sqrt(half**2 + bend * self.deep))
        return float(lasts), float((fall / lasts + g) * most), 0.0

    def gives(self, share: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The force over its level after a share (N,) of the way down, and its integrals."""
        turn = 0.5 * np.pi * share
        return np.sin(turn), (1.0 - np.cos(turn)) * 2.0 / np.pi, (share - np.sin(turn) * 2.0 / np.pi) * 2.0 / np.pi


def sprung(t, r, offset, velocity, gains):
    """Place, velocity and acceleration at times t [s] of what a spring of three equal rates r [1/s] brings to 0, from an offset, a velocity and an
    acceleration `gains`."""
    a, b = velocity + r * offset, 0.5 * (gains + 2.0 * r * velocity + r**2 * offset)
    fade, way = np.exp(-r * t), offset + a * t + b * t**2
    rate, bend = a + 2.0 * b * t, 2.0 * b
    return fade * way, fade * (rate - r * way), fade * (bend - 2.0 * r * rate + r**2 * way)


def absorb(land: np.ndarray, velocity: np.ndarray, goal: np.ndarray, support: np.ndarray, gravity: float, striding: bool = False,
           hops: bool = False, rolls: bool = False, gives: float = 1.0) -> Landing:
    """The landing of a body at `land` (3,) with `velocity` (3,) over feet whose middle is under `goal` (3,).

    support: (C, 3) corners of the soles. It comes to rest if its capture point, x + v √(h/g), lies over
    them; else it passes over them and must step on (Ha 2012 rolls on; feet do it here). It sinks the
    deeper the faster it fell; the springs have three equal rates, so that the ground's force begins with none. striding: on one foot, to run on. hops: on one foot
    or both, to hop on: as deep as a spring gives. rolls: on both, to roll on. gives: it
    sinks by this share of the usual.
    """
    fall = max(-velocity[1], 0.0)
    flat = velocity * [1.0, 0.0, 1.0]
    pace = float(np.linalg.norm(flat))
    passes = False
    if pace > 1e-6:
        ahead = flat / pace
        capture = (land - goal) @ ahead + pace * np.sqrt((goal[1] - support[0, 1]) / gravity) * CATCH
        passes = bool(capture > ((support - goal) @ ahead).max())
    # soles don't slip: a spring of rate r brakes with 2 r v at first
    rate = STRIDE if striding or hops and passes else min(PASS, 0.5 * GRIP * gravity / max(pace, 1e-6)) if passes else HOLD
    size, start = goal[1] - support[0, 1], float(land[1] - goal[1])
    if hops:
        deep = Springy.depth(fall, gravity, size / ADULT, len(support) // 4)
    else:
        deep = min(SINKS[0] + SINKS[1] * fall, SINKS[2]) * (STIFF if striding else LOWER if rolls else 1.0) * size / ADULT
        deep = gives * deep - FOLDED[1] * max(-start - FOLDED[0] * size, 0.0)
    deep = max(min(deep, start + DEEPEST * (LOWER if rolls else 1.0) * size), max(start, 0.0) + LEAST * size)
    return (Springy if hops else Landing)(rate, land - goal, velocity, gravity, goal, deep, passes)
