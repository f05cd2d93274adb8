"""A skeleton as a product of exponentials, eq. (10): which joints turn about what, and where that puts them.

A joint turns about one axis, about two, one after the other, or as a ball. A ball's three angles are a rotation vector, one
exponential: no order of axes, nowhere locked. How far a ball turns is a box about its rotation vector.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from ...body import Pose, Skeleton, exp, forward_kinematics, human, joint_limits, log
from . import rigid_motions
from .twist_kernels import chain_kernel

X, Y, Z = np.eye(3)
PAPER: dict[str, tuple[np.ndarray, ...]] = {  # 6 + 20
    "UpLeg": (X, Y, Z), "Leg": (X,), "Foot": (X, Y), "Arm": (X, Y, Z), "ForeArm": (Y,)}
"""What turns about which axes in the paper's 26 degrees of freedom, on both sides: trunk, neck and hands are stiff."""
FULL: dict[str, tuple[np.ndarray, ...]] = PAPER | {  # 6 + 36
    "Spine1": (X, Y, Z), "Neck": (X, Y, Z), "Foot": (X, Y, Z), "ForeArm": (Y, X), "Hand": (Y, Z), "Toe": (X,)}
"""42 degrees: with trunk, neck, wrists and toes."""
WIDE, WIDEST = np.radians(30.0), np.radians(60.0)
"""So much further than the tables say may a joint go [rad], and a ball: recorded squats and cartwheels are far beyond them."""
CARRIES = {"Spine1": "Spine2", "Neck": "Head"}
"""Whose orientation a joint takes over, where those above it are stiff."""
HINGES = {"Leg": (-10.0, 170.0), "ForeArm": (-170.0, 10.0)}
"""How far knees and elbows go [degrees]: heels touch the seat."""


@dataclass(frozen=True, eq=False)
class Configuration:
    """A pose χ = (ξ, Θ) of a chain. root: (..., 4, 4) the hips' motion. angles: (..., D) [rad]."""

    root: np.ndarray
    angles: np.ndarray


@dataclass(frozen=True, eq=False)
class Chain:
    """A skeleton of J joints with D degrees of freedom beside the six of its root.

    joints: (D,) which joint each turns, in the skeleton's order. axes: (D, 3) in the joint's frame. lower, upper: (D,) [rad].
    """

    skeleton: Skeleton
    joints: np.ndarray
    axes: np.ndarray
    lower: np.ndarray
    upper: np.ndarray

    def __post_init__(self):
        for array in (self.joints, self.axes, self.lower, self.upper):
            array.setflags(write=False)
        if np.any(np.diff(self.joints) < 0):
            raise ValueError("degrees of freedom must be in the order of the skeleton's joints")

    def __len__(self) -> int:
        return len(self.joints)

    @cached_property
    def count(self) -> np.ndarray:
        """How many degrees of freedom each joint has (J,)."""
        return np.bincount(self.joints, minlength=len(self.skeleton))

    @cached_property
    def first(self) -> np.ndarray:
        """The number of each joint's first one (J,)."""
        return np.concatenate([[0], np.cumsum(self.count)[:-1]])

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Each degree by its joint and axis, such as LeftLeg.x (D,)."""
        return tuple(f"{self.skeleton.names[j]}.{'xyz'[int(np.abs(axis).argmax())]}" for j, axis in zip(self.joints, self.axes))

    @cached_property
    def moved(self) -> np.ndarray:
        """Whether each degree moves each joint (J, D): the joint itself, or one above it."""
        out = np.zeros((len(self.skeleton), len(self)), bool)
        for j, parent in enumerate(self.skeleton.parents):
            out[j] = self.joints == j
            if parent >= 0:
                out[j] |= out[parent]
        out.setflags(write=False)
        return out

    def rest(self) -> Configuration:
        """T-pose at the world's origin, as high as the skeleton stands."""
        root = np.eye(4)
        root[:3, 3] = self.skeleton.offsets[0]
        return Configuration(root, np.clip(np.zeros(len(self)), self.lower, self.upper))


def chain_of(skeleton: Skeleton | None = None, freedom: Literal["paper", "full"] = "paper") -> Chain:
    """The chain of a skeleton with the standard human's joint names: 26 degrees of freedom with the root's, or 42.

    ValueError for another freedom.
    """
    tables = {"paper": PAPER, "full": FULL}
    if freedom not in tables:
        raise ValueError(f"a chain's freedom is 'paper' or 'full', not {freedom!r}")
    skeleton = skeleton or human()
    limits, joints, axes, lower, upper = joint_limits(skeleton), [], [], [], []
    for j, name in enumerate(skeleton.names):
        part = name.removeprefix("Left").removeprefix("Right")
        turns = tables[freedom].get(part, ())
        mirrored = -1.0 if name.startswith("Right") else 1.0
        for axis in turns:
            k = int(axis.argmax())
            more = WIDEST if len(turns) == 3 else WIDE
            low, high = max(limits.lower[j, k] - more, -np.pi), min(limits.upper[j, k] + more, np.pi)
            if part in HINGES and k == int(turns[0].argmax()):
                ends = np.radians(HINGES[part])
                low, high = sorted(ends * (mirrored if part == "ForeArm" else 1.0))
            joints.append(j)
            axes.append(axis)
            lower.append(low)
            upper.append(high)
    return Chain(skeleton, np.array(joints), np.array(axes), np.array(lower), np.array(upper))


def posed(chain: Chain, where: Configuration) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions (J, 3) [m] and orientations (J, 3, 3) of all joints, and each degree's twist (D, 6) in the world."""
    count = len(chain.skeleton)
    positions, orientations, columns = np.empty((count, 3)), np.empty((count, 3, 3)), np.empty((len(chain), 6))
    chain_kernel(chain.skeleton.parents, chain.skeleton.offsets, chain.first, chain.count, chain.axes,
                 np.ascontiguousarray(where.root, float), np.ascontiguousarray(where.angles, float), positions, orientations, columns)
    return positions, orientations, columns


def product_of_exponentials(chain: Chain, where: Configuration, joint: int, points: np.ndarray) -> np.ndarray:
    """Eq. (10) as it is printed: where points (N, 3) on a joint go, given as they are at T-pose about the hips.

    The slow way, to read and to test the compiled one against.
    """
    skeleton = chain.skeleton
    rest, _ = forward_kinematics(skeleton, np.zeros(3), np.broadcast_to(np.eye(3), (len(skeleton), 3, 3)))
    motion = np.array(where.root, float)
    for j in range(len(skeleton)):
        mine = np.flatnonzero(chain.joints == j)
        if not len(mine) or not chain.moved[joint, mine[0]]:
            continue
        turns = [chain.axes[mine].T @ where.angles[mine]] if len(mine) == 3 else [chain.axes[d] * where.angles[d] for d in mine]
        for turn in turns:
            motion = motion @ rigid_motions.exp(np.concatenate([-np.cross(turn, rest[j]), turn]))
    return points @ motion[:3, :3].T + motion[:3, 3]


def local_turns(chain: Chain, where: Configuration) -> Pose:
    """Configurations (...) as a pose: root (..., 3) [m], local rotations (..., J, 3, 3), the root's in the first."""
    batch = where.angles.shape[:-1]
    out = np.broadcast_to(np.eye(3), (*batch, len(chain.skeleton), 3, 3)).copy()
    for j in np.flatnonzero(chain.count):
        mine = np.flatnonzero(chain.joints == j)
        if len(mine) == 3:
            out[..., j, :, :] = exp(where.angles[..., mine] @ chain.axes[mine])
        else:
            for d in mine:
                out[..., j, :, :] = out[..., j, :, :] @ exp(where.angles[..., d, None] * chain.axes[d])
    out[..., 0, :, :] = where.root[..., :3, :3]
    return Pose(where.root[..., :3, 3], out)


def fitted(chain: Chain, root: np.ndarray, rotations: np.ndarray) -> Configuration:
    """The configurations (...) that are nearest to poses: root (..., 3) [m], local rotations (..., J, 3, 3).

    From the hips outwards, each joint so that it points as in the pose in the world, as far as it can: what a stiff joint
    can't do the next one that turns makes up for.
    """
    skeleton = chain.skeleton
    _, want = forward_kinematics(skeleton, root, np.asarray(rotations, float))
    batch = want.shape[:-3]
    have = np.empty_like(want)
    angles = np.zeros((*batch, len(chain)))
    for j, parent in enumerate(skeleton.parents):
        if parent < 0:
            have[..., j, :, :] = want[..., j, :, :]
            continue
        mine = np.flatnonzero(chain.joints == j)
        before = have[..., parent, :, :]
        target = skeleton.index(CARRIES.get(skeleton.names[j], skeleton.names[j]))
        turn = np.swapaxes(before, -1, -2) @ want[..., target, :, :]
        if len(mine) == 3:
            angles[..., mine] = log(turn) @ chain.axes[mine].T
        elif len(mine) == 2:
            angles[..., mine] = _two(turn, *chain.axes[mine])
        elif len(mine) == 1:
            angles[..., mine[0]] = _about(turn, chain.axes[mine[0]])
        angles[..., mine] = np.clip(angles[..., mine], chain.lower[mine], chain.upper[mine])
        local = np.broadcast_to(np.eye(3), before.shape)
        if len(mine) == 3:
            local = exp(angles[..., mine] @ chain.axes[mine])
        else:
            for d in mine:
                local = local @ exp(angles[..., d, None] * chain.axes[d])
        have[..., j, :, :] = before @ local
    base = np.broadcast_to(np.eye(4), (*batch, 4, 4)).copy()
    base[..., :3, :3], base[..., :3, 3] = want[..., 0, :, :], root
    return Configuration(base, angles)


def _about(turn: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """The angle (...) about an axis whose rotation is nearest to rotations (..., 3, 3)."""
    k = int(axis.argmax())
    a, b = (k + 1) % 3, (k + 2) % 3
    return np.arctan2(turn[..., b, a] - turn[..., a, b], turn[..., a, a] + turn[..., b, b])


def _two(turn: np.ndarray, one: np.ndarray, two: np.ndarray) -> np.ndarray:
    """Angles (..., 2) about two axes, one after the other, whose rotation is near to rotations (..., 3, 3): each in turn, six times."""
    first = second = np.zeros(turn.shape[:-2])
    for _ in range(6):
        first = _about(turn @ exp(-second[..., None] * two), one)
        second = _about(exp(-first[..., None] * one) @ turn, two)
    return np.stack([first, second], -1)
