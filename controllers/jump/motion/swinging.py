"""The leg that goes on swinging of who lands on the other."""

from __future__ import annotations

import numpy as np

from ...body import sole_corners
from ..body import FLEX, Ledge, Physique, carriage, hermite, monotone, place_kernel, raised, rise, turns
from ..prior import BETWEEN, EACH
from .going_slowly import FOLDS
from .ground_kernels import FREE, ground_kernel
from .ledge import over_lower

CLEARS, LIFT, LIFTS, BENT = 0.015, 0.35, (4, 12), 2.3
"""A leg that swings on as its body lands on the other clears the floor by so much [m], and an edge by twice as much; a knee that is bent by 1 rad more lifts its foot by so much [m], at standard
height; tried so often, the second beside a ledge, and bent no farther than this [rad] for it."""
TOES_UP, FLEXED = 2.5, -0.55
"""What its knee can't, its ankle does, bent by so many times as much, and as far as this [rad]."""


def free_leg(body, lands: int) -> slice:
    """The joints of the leg on which a body, told by its tables, does not land; `lands` is the other, 0 left and 1 right."""
    first = int(body.hip[1 - lands])
    return slice(first, first + 4)


def passing(physique: Physique, landing: np.ndarray, lands: int, times: np.ndarray, rows: np.ndarray, centres: np.ndarray, angles: np.ndarray, upright: np.ndarray,
            slope: np.ndarray, ledge: Ledge | None):
    """How the leg swings of who lands on the other, `lands`: as recorded in rows (K - 1, EACH) [rad] at times (K,) [s] after touch-down, its knee bent by as much more
    as keeps its foot off the floor until the lowest point: recorded bodies sink less over it.

    landing: (2, 5) the feet on the floor. centres: (BETWEEN + 1, 3) [m] the mass centre until the lowest point, angles (BETWEEN + 1, 11) [rad] and upright
    (BETWEEN + 1, 3, 3) how the body is carried and its pelvis turned. slope: (2,) [m/m] how the ground rises; ledge: the edge down which it came. What is given is a function of times, see `keyed_leg`.
    """
    until = times[:BETWEEN + 1]
    feet = np.ones((len(until), 2, 6))
    feet[..., :5], feet[:, 1 - lands, 5] = landing, FREE
    bent = np.zeros((len(until), 4, 3))
    bent[:, :EACH, 0] = rows[:len(until)]
    more = lifted(physique, 1 - lands, landing[lands], slope, bent, (1.0 if ledge is None else 2.0) * CLEARS * physique.size, angles, np.zeros((len(until), len(physique.skeleton), 3)), upright, centres, feet,
                  centres[0] - [0.0, 0.05, 0.0], 0.0 if ledge is None else FOLDS, ledge)
    rows = rows.copy()
    rows[:len(until)] += more
    rows[len(until):] += 0.5 * more[-1]
    return keyed_leg(times, rows)


def lifted(physique: Physique, free: int, stands: np.ndarray, slope: np.ndarray, bent: np.ndarray, clears: np.ndarray | float, angles: np.ndarray, offsets: np.ndarray,
           turned: np.ndarray, centres: np.ndarray, feet: np.ndarray, root: np.ndarray, folds: float = 0.0, ledge: Ledge | None = None) -> np.ndarray:
    """By how much more (M, EACH) [rad] a leg `free`, 0 left or 1 right, is to bend whose joints are turned by bent (M, 4, 3) [rad], so that its foot is so
    high (M,) [m] over the ground, see `lowest`: its knee, and its hip by so much of that as it folds, and what these can't its ankle. The other poses are as in `ground_kernel`."""
    body, count = physique.tables, len(physique.skeleton)
    joints, leg, flex = carriage.joints_of(physique.skeleton), free_leg(body, 1 - free), FLEX * physique.flexibility
    roots, local = np.empty((len(bent), 3)), np.tile(np.eye(3), (len(bent), count, 1, 1))
    more, wanted = np.zeros((len(bent), EACH)), bent[:, 1, 0].copy()
    edge = ledge is not None
    for _ in range(LIFTS[edge]):
        leg_now = bent.copy()
        leg_now[:, :EACH, 0] += more
        local[:, leg] = turns(leg_now)
        ground_kernel(body, flex, angles, joints, offsets, turned, centres, feet, root.copy(), roots, local)
        missing = np.maximum(clears - lowest(physique, free, roots, local, stands, slope, ledge), 0.0) / (LIFT * physique.size)
        if missing.max() < 1e-3:
            break
        wanted += missing
        knee, ankle = bent[:, 1, 0], bent[:, 2, 0]
        more[:, 1] = np.minimum(wanted, np.maximum(knee, BENT)) - knee
        more[:, 0] = -folds * (wanted - knee if edge else more[:, 1])  # a shank that is level swings no foot up
        more[:, 2] = 0.0 if edge else np.maximum(ankle - TOES_UP * (wanted - knee - more[:, 1]), np.minimum(ankle, FLEXED)) - ankle
    return more


def lowest(physique: Physique, side: int, roots: np.ndarray, local: np.ndarray, stands: np.ndarray, slope: np.ndarray, ledge: Ledge | None = None) -> np.ndarray:
    """How high (M,) [m] the lowest of a foot is, 0 left or 1 right, in poses (M, 3), (M, J, 3, 3), over ground that rises by slope (2,) [m/m], and beside a ledge,
    and on which a foot `stands` (5,)."""
    positions, turned = np.empty(local.shape[:-1]), np.empty(local.shape)
    for root, pose, places, facing in zip(roots, local, positions, turned):
        place_kernel(physique.tables, root, pose, places, facing)
    corners = sole_corners(physique.skeleton, positions, turned).reshape(len(roots), 2, -1, 3)[:, side]
    return (corners[..., 1] - rise(corners[..., [0, 2]] - stands[[0, 2]], slope) - over_lower(ledge, corners, physique.size, True)).min(-1) - (stands[1] - raised(physique.tables, slope))


def keyed_leg(times: np.ndarray, rows: np.ndarray):
    """A leg's local rotations (N, 4, 3, 3) at any times (N,) [s], that bends by rows (K, EACH) [rad] at times (K,) [s]; after the last
    row, as in it."""
    bent = np.zeros((len(times), 4, 3))
    bent[:, :EACH, 0] = np.concatenate([rows, rows[-1:]])
    slopes = monotone(times, bent)
    return lambda at: turns(hermite(times, bent, slopes, at))
