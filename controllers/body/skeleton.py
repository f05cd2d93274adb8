"""Skeletons and forward kinematics over any batch."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..compiled import kernel
from .brief import brief


@dataclass(frozen=True, eq=False)
class Skeleton:
    """A tree of joints in depth-first order, parents before children.

    names: J joint names. parents: (J,) parent of each joint, -1 for the root.
    offsets: (J, 3) [m] each joint in its parent's frame at the zero pose (the root's is ignored).
    end_parents, end_offsets: (E,), (E, 3) [m] the end sites: where the last bones end.
    """

    __repr__ = brief

    names: tuple[str, ...]
    parents: np.ndarray
    offsets: np.ndarray
    end_parents: np.ndarray
    end_offsets: np.ndarray

    def __post_init__(self):
        parents = np.asarray(self.parents, np.int64)
        if parents[0] != -1 or np.any(parents[1:] < 0) or np.any(parents >= np.arange(len(parents))):
            raise ValueError("parents must come before their children, with one root first")
        if len(set(self.names)) != len(self.names):
            twice = sorted({n for n in self.names if self.names.count(n) > 1})
            raise ValueError(f"joint names must differ; twice: {', '.join(twice)}")
        for name, value in (("parents", parents), ("offsets", np.asarray(self.offsets, float)),
                            ("end_parents", np.asarray(self.end_parents, np.int64)),
                            ("end_offsets", np.asarray(self.end_offsets, float).reshape(-1, 3))):
            value.setflags(write=False)
            object.__setattr__(self, name, value)

    def __len__(self) -> int:
        return len(self.names)

    @cached_property
    def _index(self) -> dict[str, int]:
        return {name: i for i, name in enumerate(self.names)}

    def index(self, name: str) -> int:
        """The number of a joint. KeyError, naming the joint, if there is none."""
        return self._index[name]

    def __contains__(self, name: str) -> bool:
        return name in self._index

    def scaled(self, factor: float) -> Skeleton:
        """The same skeleton, every length times `factor`."""
        return Skeleton(self.names, self.parents, self.offsets * factor,
                        self.end_parents, self.end_offsets * factor)

    def offsets_as(self, dtype: np.dtype) -> np.ndarray:
        """The offsets (J, 3) [m] in a float type."""
        if dtype not in self._offsets:
            self._offsets[dtype] = self.offsets.astype(dtype)
        return self._offsets[dtype]

    @cached_property
    def _offsets(self) -> dict[np.dtype, np.ndarray]:
        return {}

    @cached_property
    def end_index(self) -> dict[str, int]:
        """End site by its parent joint's name (the last where a joint has several)."""
        return {self.names[p]: e for e, p in enumerate(self.end_parents)}


def forward_kinematics(skeleton: Skeleton, root: np.ndarray, rotations: np.ndarray
                       ) -> tuple[np.ndarray, np.ndarray]:
    """World positions (..., J, 3) [m] and orientations (..., J, 3, 3) of all joints.

    root: (..., 3) [m] where the root joint is. rotations: (..., J, 3, 3) local rotations.
    The result has the rotations' float type.
    """
    rotations = np.asarray(rotations)
    batch = rotations.shape[:-3]
    count = len(skeleton)
    if rotations.shape[-3:] != (count, 3, 3):
        raise ValueError(f"rotations of shape {rotations.shape} do not fit {count} joints: "
                         f"expected (..., {count}, 3, 3)")
    local = np.ascontiguousarray(rotations.reshape(-1, count, 3, 3))
    start = np.empty(batch + (3,), local.dtype)
    start[...] = root
    positions, orientations = np.empty((len(local), count, 3), local.dtype), np.empty_like(local)
    _kinematics(skeleton.parents, skeleton.offsets_as(local.dtype), start.reshape(-1, 3), local, positions, orientations)
    return positions.reshape(batch + (count, 3)), orientations.reshape(rotations.shape)


def end_positions(skeleton: Skeleton, positions: np.ndarray, orientations: np.ndarray) -> np.ndarray:
    """World positions (..., E, 3) [m] of the end sites, from what forward kinematics returned."""
    at = skeleton.end_parents
    return positions[..., at, :] + np.einsum("...eij,ej->...ei", orientations[..., at, :, :],
                                             skeleton.end_offsets.astype(positions.dtype))


def local_rotations(skeleton: Skeleton, orientations: np.ndarray) -> np.ndarray:
    """Local rotations (..., J, 3, 3) of world orientations: the inverse of forward kinematics."""
    local = orientations.copy()
    parents = skeleton.parents[1:]
    local[..., 1:, :, :] = np.swapaxes(orientations[..., parents, :, :], -1, -2) @ orientations[..., 1:, :, :]
    return local


@kernel(fastmath=True)
def _kinematics(parents, offsets, root, local, positions, orientations):
    for n in range(local.shape[0]):
        for j in range(local.shape[1]):
            p = parents[j]
            if p < 0:
                for i in range(3):
                    positions[n, j, i] = root[n, i]
                    for k in range(3):
                        orientations[n, j, i, k] = local[n, j, i, k]
                continue
            for i in range(3):
                a, b, c = orientations[n, p, i, 0], orientations[n, p, i, 1], orientations[n, p, i, 2]
                positions[n, j, i] = (positions[n, p, i] + a * offsets[j, 0] + b * offsets[j, 1]
                                      + c * offsets[j, 2])
                for k in range(3):
                    orientations[n, j, i, k] = (a * local[n, j, 0, k] + b * local[n, j, 1, k]
                                                + c * local[n, j, 2, k])
