"""The wind-up by sampling (Ooi 2015, 3.1.4), kept beside the control of `windup` to compare them.

Pelvis positions are drawn from the box over the feet, as high as a standing pelvis; where the legs
can't follow they are dropped. Of the others the tenth whose push would give the momentum nearest
to the wished one is kept, and of these the most balanced is the crouch.

The momentum of a sample is what its muscles give along the wish: as fast as the force allows that
holds |m (v v_y / 2d − g)|, and as their work does (see `windup`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...compiled import kernel
from ..body import GRAVITY, Physique, centre_kernel, frame, pose_kernel, stand_pelvis_kernel, support_kernel
from .spring_muscles import Arm, Reading, force_kernel, muscle
from .strength import between_kernel, held_kernel, squared_kernel, strength, upward
from .windup import planted

KEPT = 0.1
"""The share that counts as having the wished momentum: "ten percent was found empirically"."""


@dataclass(frozen=True, eq=False)
class Sampled:
    """The best of N samples, and all of them.

    pelvis, centre: (3,) [m] of the best. depth: [m] of its centre of mass below standing. momentum:
    (3,) [kg m/s] that its push gives. balance: [m] from the support polygon's middle. tried: (N, 3)
    [m] pelvis positions. possible: (N,) bool. momenta: (N, 3), balances: (N,) of all, NaN where not
    possible.
    """

    pelvis: np.ndarray
    centre: np.ndarray
    depth: float
    momentum: np.ndarray
    balance: float
    tried: np.ndarray
    possible: np.ndarray
    momenta: np.ndarray
    balances: np.ndarray


def sample(physique: Physique, velocity, rise: float, gravity=GRAVITY, *, feet: np.ndarray | None = None,
           count: int = 2000, seed: int = 0, reading: Reading = "wedge", arm: Arm = "constant") -> Sampled:
    """The sampled crouch for a take-off; velocity, rise, gravity, feet, reading, arm as in `windup.crouch`.

    count: how many points of a scrambled Halton sequence are tried; same seed, same points.
    ValueError if the velocity does not rise, and if no sample is a pose of this body.
    """
    velocity, gravity = upward(velocity, 1.0), upward(gravity, -1.0)
    if not velocity[1] > 0.0:
        raise ValueError(f"the velocity must rise, got {velocity}")
    feet, able, spring = planted(physique, feet), strength(physique, reading, arm, -float(gravity[1])), muscle(physique, reading, arm)
    fixed, joints = frame(physique), len(physique.skeleton)
    local, positions, turned = np.tile(np.eye(3), (joints, 1, 1)), np.empty((joints, 3)), np.empty((joints, 3, 3))
    pelvis, turns = np.empty(3), np.zeros((2, 3, 3))
    standing = stand_pelvis_kernel(fixed, feet, pelvis, turns, local, positions, turned)
    body = fixed.body
    back, front = body.heel[2] - body.toe[2], body.tip[2]
    lines = np.array([[f[0] + math.sin(f[3]) * a, f[2] + math.cos(f[3]) * a] for f in feet for a in (back, front)])
    low, high = lines.min(0), lines.max(0)
    ground = feet[:, 1].mean() - body.sole
    box = np.array([[low[0], ground, low[1]], [high[0], pelvis[1], high[1]]])
    from scipy.stats import qmc  # slow to load, and no jump that is played is sampled

    tried = np.ascontiguousarray(qmc.scale(qmc.Halton(3, rng=np.random.default_rng(seed)).random(count), *box))
    found = np.full((count, 6), np.nan)
    samples_kernel(fixed, spring, feet, pelvis[1], standing, velocity / np.linalg.norm(velocity), float(rise), gravity,
                   able.depth, able.spent, tried, turns, local, positions, turned, found)
    momenta = found[:, :1] * physique.mass * velocity / np.linalg.norm(velocity)
    possible, balances = np.isfinite(found[:, 0]), found[:, 1]
    if not possible.any():
        raise ValueError(f"none of {count} pelvis samples is a pose of this body")
    miss = np.linalg.norm(momenta - physique.mass * velocity, axis=-1)
    order = np.argsort(np.where(possible, miss, np.inf))
    near = order[:max(int(KEPT * possible.sum()), 1)]
    best = near[np.argmin(balances[near])]
    return Sampled(tried[best], found[best, 2:5], float(found[best, 5]), momenta[best], float(balances[best]),
                   tried, possible, momenta, balances)


@kernel
def samples_kernel(fixed, spring, feet, top, standing, along, rise, gravity, depths, spent, tried, turns, local, positions,
                   orientations, found):
    """Write speed, balance, centre of mass and depth (N, 6) of pelvis samples (N, 3) that can be.

    along: (3,) the direction of the take-off.
    """
    body = fixed.body
    centre, middle, start = np.empty(3), np.empty(2), turns.copy()
    bends, torques, forces = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    for n in range(len(tried)):
        turns[:] = start
        planted_feet = feet.copy()
        if pose_kernel(fixed, tried[n], top, planted_feet, turns, local, positions, orientations) > 2e-3:
            continue
        centre_kernel(body, positions, orientations, centre)
        support_kernel(body, planted_feet, centre, middle)
        force = force_kernel(body, spring, planted_feet, centre, positions, orientations, bends, torques, forces)
        depth = standing - centre[1]
        push = max(depth + rise, body.sole)
        # |s² u u_y / 2d − g| = F / m for the speed s, a quadratic in s²
        falling, pull = 0.0, 0.0
        for i in range(3):
            falling += along[i] * gravity[i]
            pull += gravity[i] ** 2
        inside = falling**2 - pull + (force / body.total) ** 2
        by_force = 2.0 * push / along[1] * (falling + math.sqrt(inside)) if inside > 0.0 else 0.0
        by_work = 2.0 * (held_kernel(bends, spring) - between_kernel(depths, spent, depth)) / (body.total * squared_kernel(along))
        found[n, 0] = math.sqrt(max(min(by_force, by_work), 0.0))
        found[n, 1] = math.hypot(middle[0] - centre[0], middle[1] - centre[2])
        found[n, 2:5] = centre
        found[n, 5] = depth
