"""Feet that would go through the floor in the air: ankles bend that point down too far, and knees where heels are too low."""

from __future__ import annotations

import numpy as np

from ...body import forward_kinematics, sole_corners
from ..body import Ledge, Physique, hermite, monotone, raised, rise
from ..prior import EACH
from .ledge import over_lower
from .swinging import FLEXED, LIFT

ROWS = 13
"""Of so many moments from take-off to touch-down it is told by how much more legs bend."""
GRAZES = 0.002
"""What is no deeper in the floor than this [m], at standard height, is left."""
TOE = 0.16
"""An ankle that is bent by 1 rad more lifts the toes by so much [m], at standard height."""
FROM = 0.2
"""The floor that was left counts in the first half of a flight, until the body is as low as it left, where a foot is no farther from where it stood than this [m], at
standard height; else the lower of both: who leaps down comes down beside it."""


def depths(physique: Physique, roots: np.ndarray, local: np.ndarray, arc: np.ndarray, left: np.ndarray, landing: np.ndarray, slope: np.ndarray,
           lands_on: np.ndarray, ledge: Ledge | None) -> tuple[np.ndarray, np.ndarray]:
    """How deep (N, 2) [m] each foot of flying poses (N, 3), (N, J, 3, 3) is in the floor that it left or on which it lands, 0 where in neither, and whether
    its toes point down (N, 2). arc: (N, 3) [m] the centre of mass. left, landing: (2, 5) the feet as they stood and will stand, on floors that rise by slope and
    lands_on (2,) [m/m]. ledge: the edge between."""
    body = physique.tables
    positions, turned = forward_kinematics(physique.skeleton, roots, local)
    corners = sole_corners(physique.skeleton, positions, turned).reshape(len(roots), 2, -1, 3)
    floors = [feet[:, None, 1] - raised(body, way) + rise(corners[..., [0, 2]] - feet[:, None, [0, 2]], way) for feet, way in ((left, slope), (landing, lands_on))]
    away = np.linalg.norm(corners[..., [0, 2]] - left[:, None, [0, 2]], axis=-1)
    early = ((np.arange(len(roots)) < 0.5 * len(roots)) & (arc[:, 1] >= arc[0, 1]))[:, None, None]
    floor = np.where((away < FROM * body.size) & early, floors[0], np.minimum(*floors))
    if ledge is not None:
        floor = np.minimum(*floors) + over_lower(ledge, corners, body.size)
    deep = np.maximum((floor - corners[..., 1]).max(-1), 0.0)
    return np.where(deep > GRAZES * body.size, deep, 0.0), turned[:, body.hip + 2, 1, 2] < 0.0


def lifts(times: np.ndarray, deep: np.ndarray, down: np.ndarray, bent: np.ndarray, more: np.ndarray, size: float) -> np.ndarray:
    """By how much more (ROWS, 2, EACH) [rad] legs bend from take-off to touch-down, at its ends not at all, where feet were so deep (N, 2) [m] in the floor at times
    (N,) [s] although they bent by `more` (ROWS, 2, EACH) already. down: (N, 2) whether toes point down; bent: (N, 2, EACH) [rad] legs' joints."""
    rows, found = np.linspace(0.0, times[-1], ROWS), more.copy()
    near = np.abs(times[:, None] - rows) <= rows[1]
    for n in range(1, ROWS - 1):
        for side in range(2):
            here = np.flatnonzero(near[:, n])
            worst = here[int(deep[here, side].argmax())]
            if not deep[worst, side]:
                continue
            room = bent[worst, side, 2] - FLEXED if down[worst, side] else 0.0
            ankle = min(deep[worst, side] / (TOE * size), max(room, 0.0))
            found[n, side, 2] -= ankle
            found[n, side, 1] += max(deep[worst, side] - ankle * TOE * size, 0.0) / (LIFT * size)
    return found


def spread(times: np.ndarray, lasts: float, more: np.ndarray) -> np.ndarray:
    """By how much more legs bend (N, 2, EACH) [rad] at times (N,) [s], as told of `ROWS` moments of a flight that lasts so long [s]."""
    rows = np.linspace(0.0, lasts, ROWS)
    flat = more.reshape(ROWS, -1)
    return hermite(rows, flat, monotone(rows, flat), times).reshape(len(times), 2, EACH)
