"""How a source's feet stand on the floor: the frames of flat stance and what they tell."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..body import Clip, Skeleton, heading_of, mean, yaw
from .joint_names import Roles

_FLAT_SPEED = 0.2  # m/s, ankle and ball of a foot that stands flat
_FLAT_RISE = 0.02  # m, of the ankle above its 10th percentile among slow frames


@dataclass(frozen=True, eq=False)
class FlatStance:
    """One foot of a source, standing flat.

    turns: corrections that level the foot and its toes, joint number → (3, 3).
    drop: the ankle's height above the ball [m]. heights: (C,) the ankle's height in each clip [m].
    """

    turns: dict[int, np.ndarray]
    drop: float
    heights: np.ndarray


def flat_frames(ankle: np.ndarray, ball: np.ndarray, frame_time: float) -> np.ndarray:
    """Frames (T,) bool in which a foot stands flat: ankle and ball slow, and the ankle low.

    ankle, ball: (T, 3) [m], scaled to our size, so that a child's or a giant's will do as well. Where hardly any frame is so slow (runs, noisy data) the measure is
    loosened until half a percent, at least five frames, qualify.
    """
    if len(ankle) < 3:
        return np.ones(len(ankle), bool)
    speed = np.maximum(*(np.linalg.norm(np.gradient(p, frame_time, axis=0), axis=-1) for p in (ankle, ball)))
    rise = ankle[:, 1] - np.percentile(ankle[:, 1], 2)
    for factor in (1, 1.5, 2, 3, 5, 8, 15, 30):
        slow = (speed < _FLAT_SPEED * factor) & (rise < 0.06 * factor)
        if slow.sum() >= max(5, 0.005 * len(ankle)):
            height = np.percentile(ankle[slow, 1], 10)
            return slow & (ankle[:, 1] < height + _FLAT_RISE * factor)
    return np.ones(len(ankle), bool)


def foot_points(source: Skeleton, part: Roles, side: str, positions: np.ndarray, orientations: np.ndarray
                ) -> tuple[np.ndarray, np.ndarray]:
    """A source foot's ankle and ball (T, 3) [m]; without toes, the end of the foot serves as ball."""
    foot = part.limbs[side + "Foot"]
    if side + "Toe" in part.limbs:
        return positions[:, foot], positions[:, part.limbs[side + "Toe"]]
    ends = np.flatnonzero(source.end_parents == foot)
    if not len(ends):
        raise ValueError(f"{source.names[foot]} has neither a toe nor an end site: where does the foot point?")
    return positions[:, foot], positions[:, foot] + orientations[:, foot] @ source.end_offsets[ends[0]]


def flat_stance(part: Roles, side: str, clips: Sequence[Clip], motions: Sequence[tuple], scale: float
                ) -> FlatStance:
    """What the flat stance of one foot ("Left" or "Right") tells.

    motions: each clip's kinematics. scale: our size over theirs; the result is in our metres.
    """
    source = clips[0].skeleton
    joints = [part.limbs[side + limb] for limb in ("Foot", "Toe") if side + limb in part.limbs]
    stands, drops, heights = [], [], []
    for clip, (positions, orientations) in zip(clips, motions):
        ankle, ball = (scale * p for p in foot_points(source, part, side, positions, orientations))
        flat = flat_frames(ankle, ball, clip.frame_time)
        turn = yaw(heading_of((ball - ankle)[flat]))
        stands.append(np.swapaxes(turn, -1, -2)[:, None] @ orientations[flat][:, joints])
        drops.append((ankle - ball)[flat, 1])
        heights.append(np.median(ankle[flat, 1]))
    stands = np.concatenate(stands)
    turns = {}
    for k, joint in enumerate(joints):
        middle = mean(stands[:, k])
        for _ in range(3):  # the nearer half only: a median that heel rise and tiptoe cannot tilt
            nearness = np.einsum("ij,tij->t", middle, stands[:, k])
            middle = mean(stands[nearness >= np.median(nearness), k])
        turns[joint] = middle.T
    return FlatStance(turns, float(np.median(np.concatenate(drops))), np.array(heights))
