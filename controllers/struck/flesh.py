"""Where a body has flesh: places on its bones and soles, and how thick it is there."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..body import heel_offset
from ..compiled import kernel
from ..jump.body import Physique
from ..jump.motion import BONES

SPACED = 3
"""So many places of a bone are told of."""
SOLE = 0.02
"""A sole is so thick [m], at standard height."""


class Flesh(NamedTuple):
    """P places of a body. joints: (P, 2) between which joints each lies, and shares: (P,) how far on the way to the second. offsets: (P, 2, 3) [m] from either joint, in its frame.
    thick: (P,) [m]."""

    joints: np.ndarray
    shares: np.ndarray
    offsets: np.ndarray
    thick: np.ndarray


@lru_cache(maxsize=16)
def flesh_of(physique: Physique) -> Flesh:
    """The places of a body: SPACED of each bone, then heel, ball and tip of either sole."""
    skeleton, at, rows = physique.skeleton, physique.skeleton.index, []
    none = np.zeros(3)
    for first, last, radius in BONES:
        for side in ("",) if first in skeleton.names else ("Left", "Right"):
            begin = at(side + first)
            stop = at(last if last in skeleton.names else side + last) if last else begin
            end = none if last else skeleton.end_offsets[skeleton.end_index[side + first]]
            rows += [(begin, stop, share, none, end, radius) for share in np.linspace(0.0, 1.0, SPACED)]
    for side in ("Left", "Right"):
        foot, toe = at(side + "Foot"), at(side + "Toe")
        for joint, offset in ((foot, heel_offset(skeleton)), (toe, none), (toe, skeleton.end_offsets[skeleton.end_index[side + "Toe"]])):
            rows.append((joint, joint, 0.0, offset, none, SOLE))
    begins, stops, shares, froms, tos, thick = zip(*rows)
    return Flesh(np.stack([begins, stops], 1), np.array(shares), np.stack([froms, tos], 1), physique.size * np.array(thick))


def flesh(physique: Physique, positions: np.ndarray, turned: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places (N, P, 3) [m] on a placed body's bones and soles, and how thick (P,) it is there [m]."""
    of = flesh_of(physique)
    points = np.empty((len(positions), len(of.thick), 3))
    flesh_kernel(of, np.asarray(positions, float), np.asarray(turned, float), points)
    return points, of.thick


@kernel
def flesh_kernel(of, positions, turned, points):
    """Write where (N, P, 3) [m] places are of a placed body."""
    for n in range(len(points)):
        for p in range(len(of.thick)):
            a, b, share, near, far = of.joints[p, 0], of.joints[p, 1], of.shares[p], of.offsets[p, 0], of.offsets[p, 1]
            for i in range(3):
                begin = positions[n, a, i] + turned[n, a, i, 0] * near[0] + turned[n, a, i, 1] * near[1] + turned[n, a, i, 2] * near[2]
                stop = positions[n, b, i] + turned[n, b, i, 0] * far[0] + turned[n, b, i, 1] * far[1] + turned[n, b, i, 2] * far[2]
                points[n, p, i] = begin + share * (stop - begin)
