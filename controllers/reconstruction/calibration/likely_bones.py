"""What bones people are likely to have: recorded performers' own skeletons, by family, and how far performers differ within one.

Wherever somebody's hips, knees and hands are, skeletons place the trunk's joints, necks and collar bones in ways of their own, each motion capture system in
one. So this is a mixture of normal distributions of offsets (not of logarithms of lengths: some place two joints in one), of one covariance, lengths as of a
standard body: sizes are taken off as standing takes them off, by `Stood`, and vary by `_SIZE` beside. Bodies built as Gambol's own are a family, too.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from .... import assets
from ...body import Skeleton, contact_height, forward_kinematics
from ...files import ArraysError, arrays
from ..pose_vector import SKELETON
from .simulated import BONES, SCALES, like_people, numbers
from .stood import JOINTS, WORN, Stood

SHIPPED = assets.path("reconstruction", "bones.npz")
"""Fitted to CMU's, SNU's and NCSOFT's skeletons; see PROVENANCE.md beside it."""
VERSION = 1
_SIZE = 0.04
"""What standing may err of a body's size."""
_APART = 0.3
"""This share of what covaries is taken for chance: there are more bones than performers (a covariance that is shrunk towards its diagonal)."""
_LEAST = 0.004
"""No number of bones is known better than this [m], a standard deviation."""
_FEW = 5
"""Fewer performers tell of themselves, not of others."""
_OURS, _WEIGHT = "Gambol", 5
"""Bodies built as Gambol's own count for so many people."""
_TWIN = [SKELETON.index(name.replace("Left", "*").replace("Right", "Left").replace("*", "Right")) for name in SKELETON.names]


@dataclass(frozen=True, eq=False)
class LikelyBones:
    """names: of F families. means: (F, BONES) of bones as `simulated.numbers` tells them; spread: (BONES, BONES) their covariance in each. people: (F,) how
    many of all people are likely to be of each."""

    names: tuple[str, ...]
    means: np.ndarray
    spread: np.ndarray
    people: np.ndarray

    @staticmethod
    def of(families: Mapping[str, Sequence[Skeleton]]) -> LikelyBones:
        """Fitted to performers' skeletons [m], with our joints, by family; small ones are left out. ValueError where all are."""
        families = {name: those for name, those in families.items() if len(those) >= _FEW}
        found = {name: np.array([_numbers(_sized(one) - SKELETON.offsets) for one in those]) for name, those in families.items()}
        free = sum(len(some) - 1 for some in found.values())
        if not free:
            raise ValueError(f"no family of {_FEW} performers: fewer don't tell how people differ")
        means = np.array([*(some.mean(0) for some in found.values()), _numbers(like_people() - SKELETON.offsets)])
        apart = np.concatenate([some - some.mean(0) for some in found.values()])
        spread = apart.T @ apart / free
        size = _SIZE * _numbers(SKELETON.offsets)
        spread = (1.0 - _APART) * spread + np.diag(_APART * np.diag(spread) + (_LEAST / SCALES[:BONES]) ** 2) + np.outer(size, size)
        return LikelyBones((*found, _OURS), means, spread, np.array([*(len(some) for some in found.values()), _WEIGHT]))


def save(path: str | Path, likely: LikelyBones) -> None:
    """Write them as an .npz file."""
    with Path(path).open("wb") as file:
        np.savez_compressed(file, version=VERSION, joints=np.array(SKELETON.names), names=np.array(likely.names), people=likely.people,
                            means=likely.means.astype(np.float32), spread=likely.spread.astype(np.float32))


@cache
def load(path: str | Path = SHIPPED) -> LikelyBones:
    """Read what `save` wrote. ArraysError, naming the file and what is wrong with it, for anything else."""
    found = arrays(path, "table of bones", {"version": VERSION, "joints": [*SKELETON.names]}, "scripts/build/calibration/bones.py")
    count = np.size(found.get("names", ()))
    for name, shape in {"names": (count,), "people": (count,), "means": (count, BONES), "spread": (BONES, BONES)}.items():
        if name not in found or found[name].shape != shape or not count:
            raise ArraysError(f"{path}: {name} of shape {found[name].shape if name in found else None}, expected {shape}")
    means, spread, people = (found[name].astype(float) for name in ("means", "spread", "people"))
    spread = 0.5 * (spread + spread.T)
    if not (np.isfinite(means).all() and np.isfinite(spread).all() and np.linalg.eigvalsh(spread)[0] > 0.0 and (people > 0).all()):
        raise ArraysError(f"{path}: means and spread are of no normal distributions")
    return LikelyBones(tuple(str(name) for name in found["names"]), means, spread, people)


def _sized(skeleton: Skeleton) -> np.ndarray:
    """Offsets (J, 3) of somebody whose sides are alike, lengths as of a standard body for all that standing in T-pose tells."""
    offsets = 0.5 * (skeleton.offsets + skeleton.offsets[_TWIN] * [-1.0, 1.0, 1.0])
    body = Skeleton(SKELETON.names, SKELETON.parents, offsets, SKELETON.end_parents, SKELETON.end_offsets)
    places, turns = forward_kinematics(body, np.zeros(3), np.tile(np.eye(3), (len(SKELETON), 1, 1)))
    places = places + [0.0, contact_height(SKELETON) - places[:, 1].min(), 0.0]
    return offsets * Stood.of(places[None, JOINTS], turns[None, JOINTS], np.ones((1, len(WORN)), bool)).scale[0]


def _numbers(offsets: np.ndarray) -> np.ndarray:
    none = np.zeros((len(WORN), 3))
    return numbers(offsets, none, none, np.zeros(()))[:BONES]
