"""Lying on uneven ground: a fall that was recorded on a level floor, bent so that what lay on that lies on treads and edges.

Every place of the body is to be as high over the ground as it was over the floor, the more so the nearer it was, and nothing below it. How the pelvis is turned and spine, neck,
hips, knees, ankles, shoulders and elbows are bent for that is found by least squares (`bending`) for all moments at once, with as little as can be and evenly in time. That takes
some rounds, which are spread over the steps of the first moments of a fall; how these are shown themselves is found alone before.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ..body import forward_kinematics
from ..jump.body import Physique, hermite
from ..jump.motion import FEET
from .bending import band_kernel, bends_of, equations_kernel, turned
from .flesh import SPACED, flesh
from .recorded_falls import RATE
from .stepwise_ground import Ground, rest_kernel

EVERY = 5
"""So many moments of the fall are one of these."""
ROUNDS, FIRST, LATE = 12, 0.1, 0.025
"""So many rounds of least squares, spread evenly over the first so many seconds of a fall; a step of a game comes that much later at most."""
SOON = 8
"""The first so many moments are bent by themselves as the fall is planned, in half as many rounds; those of the first seconds stay so."""
SHINS = np.arange(2 * SPACED, 4 * SPACED)
"""Places of the flesh that are near the ground as one stands, too, beside feet."""
NEAR = 0.10
"""What is this near the floor [m], at standard height, is to lie as near the ground."""
LED, LIFTED = np.linspace(-0.3, 0.3, 21), 0.01
"""So far [m] a body may be led aside so that it gets up where its feet stand; a sole stands all over to this [m]."""
STUBS, HANGING, APART, MOVES, EARLY = 1.0, 0.15, 0.5, 0.3, 0.05
"""What it costs there [m] that a heel or tip is in what is higher than its ball, or a foot in the air; hangs over an edge; that feet are not on one level; that they move by 1 m/s; and
to have got up 1 s sooner."""
RESTS = 0.35
"""Nobody has got up whose feet move faster than this [m/s]."""
CARRIES = 0.025
"""Of a foot that is so much over the ground at most [m] with what is nearest to it, that stands and whatever else is no farther by as much."""
LEVEL = 1e-3
"""Ground that is no more uneven under a body [m] is level."""


def uneven(points: np.ndarray, thick: np.ndarray, floor: float, ground: Ground) -> bool:
    """Whether the ground is anywhere else than at `floor` [m] beneath places (N, P, 3) of a body with flesh (P,) [m]."""
    points = points[::EVERY]
    rests = np.empty(points.shape[:2])
    rest_kernel(ground.things, ground.corner, ground.caps, points, thick, False, rests, np.empty((*rests.shape, 2)))
    return bool(np.abs(rests - thick - floor).max() > LEVEL)


def footing(soles: np.ndarray, thick: np.ndarray, floor: float, ground: Ground) -> tuple[int, np.ndarray]:
    """At which of M moments a body has got up, and whither (2,) x, z [m] it is led so that its feet stand on treads then. soles: (M, 6, 3) heel, ball and tip
    of either foot on a level floor [m], 1/RATE apart; thick: (6,) [m]."""
    x, z = (part.ravel() for part in np.meshgrid(LED, LED))
    nearest = np.argsort(np.hypot(x, z), kind="stable")
    x, z = x[nearest], z[nearest]
    far = np.hypot(x, z)
    pace = np.linalg.norm(np.gradient(soles, 1.0 / RATE, axis=0), axis=-1).max(1)
    own = STUBS * ((soles[..., 1] - thick - floor).max(1) > 2.0 * LIFTED) + MOVES * pace + EARLY * np.arange(len(soles))[::-1] / RATE
    best, least = (len(soles) - 1, np.zeros(2)), np.inf
    for n in np.flatnonzero(pace <= max(RESTS, float(pace.min())))[::-3]:
        count = int(np.searchsorted(far, least - own[n]))  # farther ones cost more
        if not count:
            continue
        places = np.repeat(soles[n][None], count, 0)
        places[..., [0, 2]] += np.stack([x, z], -1)[:count, None]
        rests = np.empty(places.shape[:2])
        rest_kernel(ground.things, ground.corner, ground.caps, places, thick, False, rests, np.empty((*rests.shape, 2)))
        heights = (rests - thick).reshape(-1, 2, FEET // 2)
        balls, apart = heights[..., 1], np.ptp(heights.max(2), 1)
        stubs, hangs = (heights > balls[..., None] + LIFTED).sum((1, 2)), (heights < balls[..., None] - LIFTED).sum((1, 2))
        cost = own[n] + far[:count] + STUBS * stubs + HANGING * hangs + APART * (apart > LIFTED)
        if cost.min() < least:
            k = int(cost.argmin())
            best, least = (int(n), np.array([x[k], z[k]])), float(cost[k])
    return best


def stands(soles: np.ndarray, thick: np.ndarray, ground: Ground) -> tuple[float, np.ndarray]:
    """How high [m] the ground lies that carries the lower foot of a body, and which of its heels and balls (4,) stand. soles: (6, 3) heel, ball and tip of either foot; thick: (6,) [m]."""
    rests = np.empty((1, len(soles)))
    rest_kernel(ground.things, ground.corner, ground.caps, soles[None], thick, False, rests, np.empty((*rests.shape, 2)))
    over = (soles[:, 1] - rests[0]).reshape(2, -1)
    lies, near = (rests[0] - thick).reshape(2, -1), over < over.min(1, keepdims=True) + CARRIES
    held = near & (over < 2.0 * CARRIES)
    return float(np.where(near, lies, -np.inf).max(1).min()), np.stack([held[:, 0], held[:, 1:].any(1)], 1).ravel()


@dataclass(frozen=True, eq=False)
class Settling:
    """A fall that is being bent. roots: (N, 3), local: (N, J, 3, 3), facing: (N,) [rad] how it lies on a level floor [m], as high as it begins; toppled: when it strikes that [s].
    keys: (K,) the moments that are bent, of them the first `firm` for good; bent: (K, 3 + B) by how much by now, where the root is [m] and joints [rad]. clear: (K, P) how far over the floor it is [m], near: (K, P) how near to it that is, 0 … 1; lies: (K,)
    how much it lies then, 0 … 1. rounds: so many were done."""

    physique: Physique
    ground: Ground
    roots: np.ndarray
    local: np.ndarray
    facing: np.ndarray
    floor: float
    toppled: float
    keys: np.ndarray
    firm: int
    bent: np.ndarray
    clear: np.ndarray
    near: np.ndarray
    lies: np.ndarray
    rounds: int = 0

    def after(self, seconds: float) -> Settling:
        """The same so long [s] after the fall began: all rounds are done FIRST seconds after it."""
        now = self
        while now.rounds < math.ceil(min(ROUNDS * seconds / FIRST, ROUNDS) - 1e-6):
            now = now._better()
        return now

    @property
    def done(self) -> bool:
        """Whether it is bent as well as can be."""
        return self.rounds == ROUNDS

    def motion(self) -> tuple[np.ndarray, np.ndarray]:
        """Roots (N, 3) and joints' rotations (N, J, 3, 3), bent."""
        rates = np.asarray(np.gradient(self.bent, self.keys, axis=0))
        every = hermite(self.keys, self.bent, rates, np.arange(len(self.roots), dtype=float))
        return self.roots + every[:, :3], turned(bends_of(self.physique), self.local, every[:, 3:])

    def _better(self) -> Settling:
        """A round later: one step of Gauss and Newton over all moments."""
        bends, ground, keys = bends_of(self.physique), self.ground, self.keys.astype(int)
        local = turned(bends, self.local[keys], self.bent[:, 3:])
        positions, world = forward_kinematics(self.physique.skeleton, self.roots[keys] + self.bent[:, :3], local)
        points, thick = flesh(self.physique, positions, world)
        aside = self.rounds > ROUNDS // 2  # what is beside a tread may go out of it that way
        band, right = np.empty((self.bent.size, 2 * self.bent.shape[1] + 1)), np.empty(self.bent.size)
        equations_kernel(bends, ground.things, ground.corner, ground.caps, thick, aside, self.firm, positions, world, points, local, self.clear, self.near, self.lies, self.bent, band, right)
        band_kernel(band, right)
        bent = self.bent.copy()
        bent[self.firm:] += right.reshape(bent.shape)[self.firm:]
        return replace(self, bent=bent, rounds=self.rounds + 1)


def settling(physique: Physique, roots: np.ndarray, local: np.ndarray, facing: np.ndarray, floor: float, toppled: float, begins: float, ground: Ground) -> Settling:
    """A fall that lies on a level floor [m], see `Settling`, to be bent so that it lies on the ground as well. begins: how high its root is at first [m]."""
    keys = np.linspace(0, len(roots) - 1, max(len(roots) // EVERY, 4)).round()
    points, thick = flesh(physique, *forward_kinematics(physique.skeleton, roots[keys.astype(int)], local[keys.astype(int)]))
    clear = points[..., 1] - thick - floor
    lies = np.exp(-((np.delete(clear[:, :-FEET], SHINS, 1).min(1) / (2.5 * NEAR * physique.size)) ** 2))
    near = np.exp(-((clear / (NEAR * physique.size)) ** 2))
    bent = np.zeros((len(keys), 3 + len(bends_of(physique).joints)))
    fall = Settling(physique, ground, roots + [0.0, begins - roots[0, 1], 0.0], local, facing, floor, toppled, keys, 1, bent, clear, near, lies)
    soon = replace(fall, keys=keys[:SOON], bent=bent[:SOON], clear=clear[:SOON], near=near[:SOON], lies=lies[:SOON], rounds=ROUNDS // 2 + 1).after(FIRST)
    firm = int(np.searchsorted(keys, (FIRST + LATE) * RATE)) + 2
    bent[:firm] = soon.bent[:firm]
    return replace(fall, firm=firm, bent=bent)
