"""A pose, and a clip: a skeleton, a frame time and arrays."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation, RotationSpline, Slerp

from .brief import brief
from .skeleton import Skeleton, forward_kinematics


@dataclass(frozen=True, eq=False)
class Pose:
    """Where a body is. root: (..., 3) [m] the root joint. rotations: (..., J, 3, 3) local."""

    __repr__ = brief

    root: np.ndarray
    rotations: np.ndarray


@dataclass(frozen=True, eq=False)
class Clip:
    """A recorded motion.

    name: what to call it. skeleton: J joints. frame_time: seconds between frames.
    root: (T, 3) [m]. quaternions: (T, J, 4) local rotations, scipy's (x, y, z, w).
    """

    __repr__ = brief

    name: str
    skeleton: Skeleton
    frame_time: float
    root: np.ndarray
    quaternions: np.ndarray

    def __len__(self) -> int:
        return len(self.root)

    @property
    def duration(self) -> float:
        """Seconds from the first frame to the last."""
        return (len(self) - 1) * self.frame_time

    @property
    def rotations(self) -> np.ndarray:
        """Local rotation matrices (T, J, 3, 3)."""
        return Rotation.from_quat(self.quaternions).as_matrix()

    def kinematics(self) -> tuple[np.ndarray, np.ndarray]:
        """World positions (T, J, 3) [m] and orientations (T, J, 3, 3)."""
        return forward_kinematics(self.skeleton, self.root, self.rotations)

    def slice(self, start: int, stop: int) -> Clip:
        """Frames start … stop − 1."""
        return replace(self, root=self.root[start:stop], quaternions=self.quaternions[start:stop])

    def resample(self, fps: float, smooth: bool = False) -> Clip:
        """The same motion at another frame rate [Hz]: linear root, spherical-linear joints. ValueError for what is none.

        smooth: cubic splines through the frames instead, of rotations as well (scipy's `RotationSpline`): slow recordings have corners at each frame otherwise.
        """
        if not isinstance(fps, float | int | np.floating | np.integer) or not 0.0 < fps < np.inf:
            raise ValueError(f"fps is a number of frames a second, above zero; got {fps!r}")
        if len(self) < 2:
            return replace(self, frame_time=1.0 / fps)
        old = np.arange(len(self)) * self.frame_time
        new = np.arange(int(np.floor(self.duration * fps + 1e-6)) + 1) / fps
        new = np.minimum(new, old[-1])
        if smooth:
            from scipy.interpolate import CubicSpline  # no game that plays asks for it, and it takes a while to import
        root = CubicSpline(old, self.root)(new) if smooth else np.stack([np.interp(new, old, self.root[:, i]) for i in range(3)], -1)
        between = RotationSpline if smooth else Slerp
        joints = [between(old, Rotation.from_quat(self.quaternions[:, j]))(new).as_quat() for j in range(len(self.skeleton))]
        return replace(self, frame_time=1.0 / fps, root=root, quaternions=np.stack(joints, 1))

    def mirror(self) -> Clip:
        """Left and right exchanged, for a skeleton that is symmetric in x and has Left…/Right… names."""
        swap = mirror_index(self.skeleton)
        quaternions = self.quaternions[:, swap] * np.array([1.0, -1.0, -1.0, 1.0])
        return replace(self, name=f"{self.name} (mirrored)", root=self.root * [-1.0, 1.0, 1.0],
                       quaternions=quaternions)


def mirror_index(skeleton: Skeleton) -> np.ndarray:
    """For each joint the number of its partner on the other side (J,); itself on the midline."""
    def other(name: str) -> str:
        if name.startswith("Left"):
            return "Right" + name[4:]
        return "Left" + name[5:] if name.startswith("Right") else name
    return np.array([skeleton.index(other(n)) if other(n) in skeleton else i
                     for i, n in enumerate(skeleton.names)])
