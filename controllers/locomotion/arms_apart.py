"""Arms that lie in each other are taken apart: whoever folds his arms or rubs his hands was recorded on arms of another thickness and length.

Each arm is bones as capsules, and so is the trunk. Where one comes too near to one of the other arm, both arms turn about their shoulders, by what is missing between them;
how far is smooth in time. While arms cross, the shortest way between them may point either way from moment to moment: which arm lies on which is told by the whole of the crossing.
"""

from __future__ import annotations

import numpy as np

from ..body import Skeleton, end_positions, exp, forward_kinematics, local_rotations

PARTS = ("Arm", "ForeArm", 0.045), ("ForeArm", "Hand", 0.04), ("Hand", "", 0.025)
"""An arm's bones: from which joint to which or to its end, how thick [m]."""
TRUNK = "Hips", "Spine2", 0.10
"""The trunk, likewise."""
ROUNDS, SMOOTH = 12, 0.08
"""So many times arms give way, as smoothly as means of so long [s]."""
GIVES = 0.5
"""So much of what is missing they give way each time, either of two arms."""
CROSSED = -0.3
"""Whose shortest way points this much against that of the whole crossing has the arms through each other."""


def apart(skeleton: Skeleton, root: np.ndarray, local: np.ndarray, rate: float) -> np.ndarray:
    """Poses (T, J, 3, 3) at roots (T, 3) [m], `rate` a second, with arms that do not lie in each other: rotations of upper arms differ."""
    positions, turned = forward_kinematics(skeleton, root, local)
    shoulders, posed = [skeleton.index(side + "Arm") for side in ("Left", "Right")], local
    turns = np.zeros((2, len(local), 3))
    for _ in range(ROUNDS):
        arms, trunk = _bones(skeleton, root, posed)
        wanted = np.zeros_like(turns)
        for a, (one, thick) in enumerate(arms[0]):
            for b, (other, wide) in enumerate(arms[1]):
                if a or b:
                    gap, way, at = between_bones(one, other)
                    signed = _sides(gap, way, thick + wide)[:, None] * way
                    missing = GIVES * np.maximum(thick + wide - gap * (signed * way).sum(-1), 0.0)[:, None] * signed
                    for side, bone, where, sign in ((0, one, at[:, :1], -1.0), (1, other, at[:, 1:], 1.0)):
                        _larger(wanted[side], _turn(positions[:, shoulders[side]], bone[0] + where * (bone[1] - bone[0]), sign * missing))
        for side in range(2):
            for bone, thick in arms[side][1:]:
                gap, way, at = between_bones(bone, trunk)
                missing = np.minimum(gap - thick - TRUNK[2], 0.0)[:, None] * way
                wanted[side] += _turn(positions[:, shoulders[side]], bone[0] + at[:, :1] * (bone[1] - bone[0]), missing)
        if not wanted.any():
            break
        turns += wanted
        world = turned.copy()
        for side, turn in zip(("Left", "Right"), _evenly(turns, SMOOTH * rate)):
            for part, _, _ in PARTS:
                joint = skeleton.index(side + part)
                world[:, joint] = exp(turn) @ turned[:, joint]
        posed = local_rotations(skeleton, world)
    return posed


def _bones(skeleton: Skeleton, root: np.ndarray, local: np.ndarray) -> tuple[list, tuple[np.ndarray, np.ndarray]]:
    """Of both arms their bones' ends (T, 3) [m] and how thick they are [m], and the trunk's ends."""
    positions, orientations = forward_kinematics(skeleton, root, local)
    ends, at = end_positions(skeleton, positions, orientations), skeleton.index
    arms = [[((positions[:, at(side + first)], positions[:, at(side + last)] if last else ends[:, skeleton.end_index[side + first]]), thick) for first, last, thick in PARTS]
            for side in ("Left", "Right")]
    return arms, (positions[:, at(TRUNK[0])], positions[:, at(TRUNK[1])])


def _turn(shoulder: np.ndarray, place: np.ndarray, way: np.ndarray) -> np.ndarray:
    """The rotation vectors (T, 3) [rad] about shoulders that take a place (T, 3) on an arm along a way (T, 3) [m]."""
    lever = place - shoulder
    return np.cross(lever, way) / np.maximum((lever**2).sum(-1, keepdims=True), 0.02)


def _larger(turns: np.ndarray, other: np.ndarray) -> None:
    """Keep, in place, the larger of two rotation vectors (T, 3): bones of one arm are in the way together."""
    more = (other**2).sum(-1) > (turns**2).sum(-1)
    turns[more] = other[more]


def _evenly(turns: np.ndarray, width: float) -> np.ndarray:
    """Rotation vectors (2, T, 3) as means of so many moments."""
    from scipy.ndimage import gaussian_filter1d  # only who builds a library needs it

    return gaussian_filter1d(turns, width, axis=1)


def between_bones(one: tuple[np.ndarray, np.ndarray], other: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """How far bones are from each other (T,) [m], the way (T, 3) of length 1 from the one to the other where they are nearest, and where on them that is (T, 2), 0 … 1."""
    first, second, off = one[1] - one[0], other[1] - other[0], one[0] - other[0]
    a, e, b = ((p * q).sum(-1) for p, q in ((first, first), (second, second), (first, second)))
    c, f = (first * off).sum(-1), (second * off).sum(-1)
    across = a * e - b * b
    s = np.clip(np.where(across > 1e-9, (b * f - c * e) / np.maximum(across, 1e-9), 0.0), 0.0, 1.0)
    t = np.clip((b * s + f) / e, 0.0, 1.0)
    s = np.clip((b * t - c) / a, 0.0, 1.0)
    way = other[0] + t[:, None] * second - one[0] - s[:, None] * first
    gap = np.linalg.norm(way, axis=-1)
    return gap, way / np.maximum(gap, 1e-9)[:, None], np.stack([s, t], -1)


def _sides(gap: np.ndarray, way: np.ndarray, near: float) -> np.ndarray:
    """−1 (T,) where bones that are nearer than so far [m] have gone through each other, else 1."""
    sign, close = np.ones(len(gap)), np.concatenate([[0], (gap < near).astype(int), [0]])
    for begins, ends in np.flatnonzero(np.diff(close)).reshape(-1, 2):
        span = slice(begins, ends)
        whole = (gap[span, None] * way[span]).sum(0)
        sign[span] = np.where(way[span] @ whole < CROSSED * np.linalg.norm(whole), -1.0, 1.0)
    return sign
