"""What of a body touches the floor that lies, rolls or falls on it, and where that leaves it."""

from __future__ import annotations

import numpy as np

from ...body import contact_height, end_positions, forward_kinematics, heel_offset
from ..body import Physique

BONES = (("UpLeg", "Leg", 0.06), ("Leg", "Foot", 0.045), ("Arm", "ForeArm", 0.04), ("ForeArm", "Hand", 0.035), ("Hand", "", 0.03), ("Hips", "Spine2", 0.10),
         ("Spine2", "Neck", 0.09), ("Head", "", 0.09))
"""Bones as capsules: from which joint to which or to its end, how thick [m] at standard height."""
TOUCHES = 0.012
"""What is no farther over the floor than this [m], at standard height, lies or stands on it, the less the farther."""
FEET = 6
"""So many of the places that may touch the floor are feet, the last ones: heel, ball and tip of either."""


def places(physique: Physique, positions: np.ndarray, turned: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where (N, P, 3) [m] a placed body may touch the floor, the ends of its capsules and its soles, and how far (N, P) these are over y = 0 [m]."""
    skeleton, at, out, over = physique.skeleton, physique.skeleton.index, [], []
    ends = end_positions(skeleton, positions, turned)
    for first, last, radius in BONES:
        for side in ("",) if first in skeleton.names else ("Left", "Right"):
            stop = ends[:, skeleton.end_index[side + first]] if not last else positions[:, at(last if last in skeleton.names else side + last)]
            for place in (positions[:, at(side + first)], stop):
                out.append(place)
                over.append(place[:, 1] - radius * physique.size)
    for place, low in sole_places(physique, positions, turned):
        out.append(place)
        over.append(low)
    return np.stack(out, 1), np.stack(over, 1)


def sole_places(physique: Physique, positions: np.ndarray, turned: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Heel, ball and tip (N, 3) [m] of either foot, and how far (N,) its sole is over y = 0 there [m]."""
    skeleton, at, found = physique.skeleton, physique.skeleton.index, []
    for side in ("Left", "Right"):
        foot, toe = at(side + "Foot"), at(side + "Toe")
        for joint, from_it in ((foot, heel_offset(skeleton)), (toe, np.zeros(3)), (toe, skeleton.end_offsets[skeleton.end_index[side + "Toe"]])):
            place = positions[:, joint] + turned[:, joint] @ from_it
            found.append((place, place[:, 1] - contact_height(skeleton)))
    return found


def grounded_poses(physique: Physique, local: np.ndarray, start: np.ndarray, floor: float) -> tuple[np.ndarray, np.ndarray]:
    """Roots (N, 3) of poses (N, J, 3, 3) that lie or stand on a floor [m]: nothing is below it, what touches it is left where it is as far as that can be. The first has its x and z from
    `start` (3,). And how far (N, P) `places` are over the floor."""
    positions, turned = forward_kinematics(physique.skeleton, np.zeros((len(local), 3)), local)
    where, over = places(physique, positions, turned)
    roots = np.empty((len(local), 3))
    roots[:, 1] = floor - over.min(1)
    over = over - over.min(1)[:, None]
    presses = np.exp(-((over / (TOUCHES * physique.size)) ** 2)) + 1e-9
    presses = presses[1:] * presses[:-1]
    gone = np.einsum("np,npi->ni", presses, np.diff(where[..., [0, 2]], axis=0)) / presses.sum(1)[:, None]
    roots[0, [0, 2]] = start[[0, 2]]
    roots[1:, [0, 2]] = start[[0, 2]] - np.cumsum(gone, 0)
    return roots, over
