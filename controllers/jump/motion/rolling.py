"""The roll: who comes down too hard for legs alone goes on over hands, a shoulder and the back, and up again, as one recorded roll goes.

Feet first, as in any landing; from its lowest point the body tips over its feet, which stand until they are pulled along, onto the hands and the upper back. From there on
it is the recorded roll, laid onto the floor: nothing is below it, and what lies on it stays where it lies.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np

from gambol import assets

from ...body import centre_of_mass, exp, forward_kinematics, yaw
from ...navigation import clearance, floor_at
from ..body import Physique, hermite, monotone
from .lying import FEET, TOUCHES, grounded_poses, places
from .path_estimate import Path
from .plan import Plan
from .tipping import TIPS, tipped

HARD = 6.4
"""Who comes down faster than this [m/s], at standard height, as from 2.1 m, rolls if he can."""
AHEAD, ASIDE = 0.7, 0.35
"""He goes ahead by more than the first [m/s], and by no more than the second of that to a side."""
FLUSH = 0.03
"""Where he rolls the floor is level to this [m]."""
DEFAULT = assets.path("library", "roll.npz")
SPACED = 0.05
"""From one row of coefficients to the next [s]."""
RATE = 120.0
"""Moments a second."""
PACE, PACES = 3.0, (0.75, 1.1)
"""The recorded roll goes so fast [m/s]; it is played at its pace times how much faster this one goes, within these, until it is up."""
WEARS = 0.2, 0.6
"""And at its own from the first to the second of these [s] on."""
SMOOTH = 0.03
"""The body goes up and down over what lies on the floor as smoothly as means of so long are [s]."""
LIFTS = 0.06
"""And where it is lifted off what would be below the floor it is as smoothly as means of so long [s]: sooner, it would be thrown up and pulled down."""
STANDS = 0.025, 0.6
"""Soles that are lower over the floor than the first [m], at standard height, and slower along it than the second [m/s] are held where they stand."""
SLIDES = 0.3
"""A heel or ball that is faster along the floor [m/s] does not stand on it."""


def tumbled(pitch: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Joints' rotations (N, J, 3, 3) of rows (N, J, 3) [rad] of rotation vectors, the pelvis pitched (N,) [rad] after its own."""
    local, forward = exp(rows), np.zeros((len(pitch), 3))
    forward[:, 0] = pitch
    local[:, 0] = exp(forward) @ local[:, 0]
    return local


@lru_cache(maxsize=1)
def _recorded() -> np.ndarray:
    """The recorded roll (R, 3 + 3 J): where its mass centre is, x, z [m], how far its pelvis is pitched [rad], and all joints' rotation vectors, see `tumbled`."""
    with np.load(DEFAULT, allow_pickle=False) as file:
        return np.concatenate([file["path"], file["pitch"][:, None], file["rows"].reshape(len(file["rows"]), -1)], 1).astype(float)


def _over(physique: Physique, pace: float, heading: float) -> tuple[np.ndarray, np.ndarray]:
    """The recorded roll (N, J, 3, 3) towards a heading [rad] at a share of its pace, and its roots (N, 3), the mass centre over the middle of a floor at 0 as it begins."""
    from scipy.ndimage import gaussian_filter1d  # no game waits for it at its start

    rows = _recorded()
    keys = np.arange(len(rows)) * SPACED
    clock = np.arange(0.0, keys[-1] / pace, 1.0 / RATE)
    share = np.clip((clock - WEARS[0]) / (WEARS[1] - WEARS[0]), 0.0, 1.0)
    shown = np.concatenate([[0.0], np.cumsum(pace + (1.0 - pace) * share**2 * (3.0 - 2.0 * share))[:-1] / RATE])
    shown = shown[shown <= keys[-1]]
    told = hermite(keys, rows, monotone(keys, rows), shown)
    local, roots = tumbled(told[:, 2], told[:, 3:].reshape(len(shown), -1, 3)), np.zeros((len(shown), 3))
    local[:, 0] = yaw(heading) @ local[:, 0]
    height = grounded_poses(physique, local, np.zeros(3), 0.0)[0][:, 1]
    roots[:, [0, 2]], roots[:, 1] = physique.size * told[:, :2], _smooth(height, SMOOTH * RATE)
    roots = roots @ yaw(heading).T
    roots[:, [0, 2]] -= centre_of_mass(physique.anatomy, *forward_kinematics(physique.skeleton, np.zeros((len(local), 3)), local))[:, [0, 2]]
    where, over = places(physique, *forward_kinematics(physique.skeleton, roots, local))
    flow = np.asarray(np.gradient(where[:, -FEET:][..., [0, 2]], 1.0 / RATE, axis=0))
    stands = np.exp(-((over[:, -FEET:] / (STANDS[0] * physique.size)) ** 2) - (flow**2).sum(-1) / STANDS[1]**2)
    slips = np.einsum("np,npi->ni", stands, flow) / np.maximum(stands.sum(1), 1.0)[:, None]
    roots[:, [0, 2]] -= gaussian_filter1d(np.cumsum(slips, 0) / RATE, SMOOTH * RATE, axis=0, mode="nearest")
    return local, roots


def _smooth(height: np.ndarray, width: float) -> np.ndarray:
    """Heights (N,) as means of so many moments, which go on at their ends as they went."""
    from scipy.ndimage import gaussian_filter1d  # no game waits for it at its start

    wide = 4 * math.ceil(width)
    return gaussian_filter1d(np.pad(height, wide, "reflect", reflect_type="odd"), width)[wide:-wide]


def rolls(physique: Physique, way: Path) -> bool:
    """Whether who lands so rolls on, if there is room: hard enough, on both feet to stand there, going ahead."""
    heading, (x, y, z) = way.heading + way.turn, way.falling
    ahead, left = math.sin(heading) * x + math.cos(heading) * z, math.cos(heading) * x - math.sin(heading) * z
    return bool(way.lands is None and not way.hops and not way.turn and -y > HARD * math.sqrt(physique.size) and ahead > AHEAD and abs(left) < ASIDE * ahead)


def room(physique: Physique, made: Plan, around: Sequence[Any]) -> bool:
    """Whether a plan rolls over level floor, and nothing stands in the way."""
    if not around:
        return True
    after, floor = made.times > made.lowest, float(made.feet[0, 1] - physique.tables.sole)
    for x, _, z in made.centres[after][::round(0.1 * RATE)]:
        if abs(floor_at(x, z, around, floor + FLUSH) - floor) > FLUSH:
            return False
    positions = forward_kinematics(physique.skeleton, made.roots[after], made.local[after])[0][::4].reshape(-1, 3)
    return bool(clearance(positions, around).min() > 0.0)


def rolled(physique: Physique, made: Plan) -> Plan:
    """A plan that lands on both feet, going ahead, with a roll from the lowest point of its landing on."""
    n, body, skeleton = int(np.searchsorted(made.times, made.lowest)), physique.tables, physique.skeleton
    floor, heading = float(made.feet[0, 1] - body.sole), made.path.heading + made.path.turn
    ahead = np.array([np.sin(heading), 0.0, np.cos(heading)])
    going = made.velocities[n]
    local, roots = _over(physique, float(np.clip(going @ ahead / PACE, *PACES)), heading)
    centres = centre_of_mass(physique.anatomy, *forward_kinematics(skeleton, roots, local)) + [0.0, floor, 0.0]
    meets = (centres[4] - centres[0]) * 0.25 * RATE
    up, count = np.array([0.0, 1.0, 0.0]), round(TIPS * RATE)
    centres += (made.centres[n] + 0.5 * TIPS * (going + meets) - centres[0]) * (1.0 - up)
    rolling = local, centres

    def laid(lift: np.ndarray) -> tuple[np.ndarray, ...]:
        """All of it, lifted by so much (N, 1) [m]: rotations, mass centres, roots, what may touch the floor and how far that is over it; and what is still below it."""
        tipping, tips = tipped(physique, made, n, rolling, meets, heading, lift[:count], 1.0 / RATE)
        local, centres = np.concatenate([tipping, rolling[0]]), np.concatenate([tips, rolling[1] + up * lift[count:]])
        positions, turned = forward_kinematics(skeleton, np.zeros((len(local), 3)), local)
        roots = centres - centre_of_mass(physique.anatomy, positions, turned)
        where, over = places(physique, positions + roots[:, None], turned)
        return local, centres, roots, where, over, _lifts(np.maximum(floor - over.min(1), 0.0))

    local, centres, roots, where, over, more = laid(laid(np.zeros((count + len(local), 1)))[-1])  # hands stay on the floor when what would be below it is lifted
    roots, centres, over = roots + up * more, centres + up * more, over + more
    feet = where[:, -FEET:].reshape(-1, 2, 3, 3)[:, :, :2].reshape(-1, 4, 3)
    flows = np.asarray(np.gradient(feet, 1.0 / RATE, axis=0))
    low = over[:, -FEET:].reshape(-1, 2, 3)[..., :2].reshape(-1, 4) - floor < TOUCHES * physique.size
    velocities = np.asarray(np.gradient(centres, 1.0 / RATE, axis=0))
    gains = np.asarray(np.gradient(velocities, 1.0 / RATE, axis=0))
    after = made.times[n] + np.arange(len(local)) / RATE
    return replace(made, times=np.concatenate([made.times[:n], after]), roots=np.concatenate([made.roots[:n], roots]), local=np.concatenate([made.local[:n], local]),
                   centres=np.concatenate([made.centres[:n], centres]), velocities=np.concatenate([made.velocities[:n], velocities]),
                   forces=np.concatenate([made.forces[:n], physique.mass * (gains - made.path.gravity)]),
                   contacts=np.concatenate([made.contacts[:n], low & (np.hypot(flows[..., 0], flows[..., 2]) < SLIDES)]), through=np.inf, rolls=float(after[-1]))


def _lifts(sunk: np.ndarray) -> np.ndarray:
    """How far a body is lifted (N, 1) [m], smoothly, where something is (N,) below the floor [m]."""
    from scipy.ndimage import gaussian_filter1d, maximum_filter1d  # no game waits for it at its start

    wide = round(LIFTS * RATE)
    lift = gaussian_filter1d(maximum_filter1d(sunk, 2 * wide + 1, mode="nearest"), 0.5 * wide, mode="nearest")
    comes = np.minimum(np.arange(len(lift)) / (2.0 * wide), 1.0)  # whoever still stands is where the landing left him
    lift *= comes**2 * (3.0 - 2.0 * comes)
    return lift[:, None]
