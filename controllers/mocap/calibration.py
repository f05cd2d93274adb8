"""How another skeleton's joint frames stand to those of Gambol's human.

For each joint one constant rotation C with  R_ours = R_theirs · C  for world orientations. Where
the source's zero pose looks like a person standing (T-, A- or I-pose), C follows from that pose:
world-aligned twist, limbs turned the shortest way onto the bones. Where it does not (zero pose
along bone axes), C is read off the motion: knees and elbows tell the twist of the limbs, and in
mean upright walking trunk, head and clavicles stand as in the T-pose. Feet are always read off
flat stance, since hardly any skeleton's zero pose has its soles level.
"""

from __future__ import annotations

from dataclasses import dataclass
from collections.abc import Sequence

import numpy as np

from ..body import Clip, Skeleton, forward_kinematics, human
from ..body.rotations import between, heading_of, mean, yaw
from .names import Roles, roles

LIMBS = {"UpLeg": "Leg", "Leg": "Foot", "Arm": "ForeArm", "ForeArm": "Hand"}
"""The bones of the limbs: from a joint to the next, by our names without the side."""
SIDES = ("Left", "Right")
_FLAT_SPEED = 0.2  # m/s, ankle and ball of a foot that stands flat
_FLAT_RISE = 0.02  # m, of the ankle above its 10th percentile among slow frames
_UPRIGHT = np.cos(np.radians(20.0))


@dataclass(frozen=True, eq=False)
class Calibration:
    """What retargeting needs to know of a source skeleton.

    corrections: (J_source, 3, 3) the rotation C of each joint that plays a part, else identity.
    scale: our leg length over theirs. posed: whether the zero pose was a person standing.
    """

    roles: Roles
    corrections: np.ndarray
    scale: float
    posed: bool


def calibrate(clips: Sequence[Clip], skeleton: Skeleton | None = None, *, posed: bool | None = None) -> Calibration:
    """The calibration of one source skeleton from some of its clips; the more walking, the better.

    skeleton: ours, the standard human by default. posed: whether the zero pose is a person
    standing; found out by default. ValueError if there is no clip, or if the skeleton is no human.
    """
    clips = list(clips)
    if not clips:
        raise ValueError("no clips to calibrate from")
    skeleton = skeleton or human()
    source = clips[0].skeleton
    part = roles(source)
    zero = zero_positions(source)
    world = _zero_alignment(part, zero)
    posed = _is_posed(part, zero, world) if posed is None else posed
    motions = [clip.kinematics() for clip in clips]
    corrections = np.broadcast_to(np.eye(3), (len(source), 3, 3)).copy()
    if posed:
        corrections[:] = world
        for side in SIDES:
            for joint, child in LIMBS.items():
                if side + child in part.limbs:
                    ours = skeleton.offsets[skeleton.index(side + child)]
                    theirs = zero[part.limbs[side + child]] - zero[part.limbs[side + joint]]
                    j = part.limbs[side + joint]
                    corrections[j] = between(world @ ours, theirs) @ world
            if side + "Hand" in part.limbs:
                corrections[part.limbs[side + "Hand"]] = corrections[part.limbs[side + "ForeArm"]]
    else:
        _from_motion(skeleton, source, part, zero, motions, corrections)
    for side in SIDES:
        _level_feet(source, part, side, clips, motions, corrections)
    ours = _leg_length(zero_positions(skeleton), {n: i for i, n in enumerate(skeleton.names)})
    return Calibration(part, corrections, ours / _leg_length(zero, part.limbs), posed)


def zero_positions(skeleton: Skeleton) -> np.ndarray:
    """Joint positions (J, 3) [m] of the zero pose, the root at the origin."""
    return forward_kinematics(skeleton, np.zeros(3), np.broadcast_to(np.eye(3), (len(skeleton), 3, 3)))[0]


def flat_frames(ankle: np.ndarray, ball: np.ndarray, frame_time: float) -> np.ndarray:
    """Frames (T,) bool in which a foot stands flat: ankle and ball slow, and the ankle low.

    ankle, ball: (T, 3) [m]. Where hardly any frame is so slow (runs, noisy data) the measure is
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


def _leg_length(zero, limbs):
    """Mean length [m] of thigh and shank together."""
    return np.mean([np.linalg.norm(zero[limbs[side + a]] - zero[limbs[side + b]]) * 2
                    for side in SIDES for a, b in (("UpLeg", "Leg"), ("Leg", "Foot"))])


def _unit(v):
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-12)


def _frame(first, second):
    """Orthonormal frames (..., 3, 3): first column along `first`, second towards `second`."""
    x = _unit(first)
    y = _unit(second - x * np.sum(x * second, -1, keepdims=True))
    return np.stack([x, y, np.cross(x, y)], -1)


def _zero_alignment(part, zero):
    """The rotation that carries our T-pose's axes onto the source's zero pose: left and up."""
    left = zero[part.limbs["LeftUpLeg"]] - zero[part.limbs["RightUpLeg"]]
    chest = zero[part.trunk[-1]] if part.trunk else zero[part.limbs["Head"]]
    middle = (zero[part.limbs["LeftUpLeg"]] + zero[part.limbs["RightUpLeg"]]) / 2
    frame = _frame(left, chest - middle)
    # zero poses that all but agree with the world's axes mean them: a spine may lean, the world does not
    axes = np.round(frame)
    near = np.abs(np.linalg.det(axes) - 1) < 1e-6 and np.trace(axes.T @ frame) > 1 + 2 * np.cos(np.radians(30))
    return axes if near else frame


def _is_posed(part, zero, world):
    """Whether the zero pose is a person standing: legs down, toes ahead, arms not raised or back."""
    def along(joint, child, axis):
        a, b = part.limbs[joint], part.limbs.get(child)
        return np.nan if b is None else _unit(zero[b] - zero[a]) @ (world @ axis)
    up, ahead, left = np.eye(3)[1], np.eye(3)[2], np.eye(3)[0]
    checks = []
    for side, sign in (("Left", 1), ("Right", -1)):
        checks += [along(side + "UpLeg", side + "Leg", -up) > 0.7, along(side + "Leg", side + "Foot", -up) > 0.7,
                   not along(side + "Foot", side + "Toe", ahead) < 0.1,
                   along(side + "Arm", side + "ForeArm", sign * left) > -0.1,
                   along(side + "Arm", side + "ForeArm", up) < 0.5, abs(along(side + "Arm", side + "ForeArm", ahead)) < 0.7]
    return all(checks)


def _from_motion(skeleton, source, part, zero, motions, corrections):
    """Corrections without a standing zero pose; `corrections` is filled in place."""
    limbs = part.limbs
    turns, tops = [], []
    for positions, orientations in motions:
        across = positions[:, limbs["LeftUpLeg"]] - positions[:, limbs["RightUpLeg"]]
        turns.append(yaw(heading_of(np.cross(across, [0.0, 1.0, 0.0]))))
        middle = (positions[:, limbs["LeftUpLeg"]] + positions[:, limbs["RightUpLeg"]]) / 2
        tops.append(_unit(positions[:, limbs["Head"]] - middle)[:, 1])
    upright = np.concatenate(tops) > _UPRIGHT
    upright = upright if upright.sum() >= 5 else np.ones(len(upright), bool)
    turn = np.concatenate(turns)[upright]

    def orient(joint):
        return np.concatenate([orientations[:, joint] for _, orientations in motions])

    clavicles = [limbs[side + "Shoulder"] for side in SIDES if side + "Shoulder" in limbs]
    for joint in {limbs["Hips"], *part.trunk, *part.neck, *clavicles}:
        corrections[joint] = mean(np.swapaxes(turn, -1, -2) @ orient(joint)[upright]).T
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        # flexion carries the shin back and the forearm forward (palms down in the T-pose)
        for upper, lower, last, axis in (("UpLeg", "Leg", "Foot", [1.0, 0.0, 0.0]),
                                         ("Arm", "ForeArm", "Hand", [0.0, -sign, 0.0])):
            a, b = limbs[side + upper], limbs[side + lower]
            c = limbs.get(side + last)
            first = zero[b] - zero[a]
            if c is None:
                ends = np.flatnonzero(source.end_parents == b)
                second = source.end_offsets[ends[0]]
            else:
                second = zero[c] - zero[b]
            above, below = orient(a), orient(b)
            hinge = np.cross(above @ _unit(first), below @ _unit(second))
            for joint, bone, own, child in ((a, first, above, lower), (b, second, below, last)):
                local = np.mean(np.einsum("tji,tj->ti", own, hinge), 0)
                ours = skeleton.offsets[skeleton.index(side + child)]
                corrections[joint] = _frame(bone, local) @ _frame(ours, np.array(axis)).T
        if side + "Hand" in limbs:
            hand, fore = limbs[side + "Hand"], limbs[side + "ForeArm"]
            relative = np.swapaxes(orient(hand), -1, -2) @ orient(fore)
            corrections[hand] = mean(relative) @ corrections[fore]


def _level_feet(source, part, side, clips, motions, corrections):
    """Corrections of a foot and its toes so that flat stance comes out level; filled in place."""
    joints = [part.limbs[side + limb] for limb in ("Foot", "Toe") if side + limb in part.limbs]
    stands = []
    for clip, (positions, orientations) in zip(clips, motions):
        ankle, ball = foot_points(source, part, side, positions, orientations)
        flat = flat_frames(ankle, ball, clip.frame_time)
        turn = yaw(heading_of((ball - ankle)[flat]))
        stands.append(np.swapaxes(turn, -1, -2)[:, None] @ orientations[flat][:, joints])
    stands = np.concatenate(stands)
    for k, joint in enumerate(joints):
        middle = mean(stands[:, k])
        for _ in range(3):  # the nearer half only: a median that heel rise and tiptoe cannot tilt
            nearness = np.einsum("ij,tij->t", middle, stands[:, k])
            middle = mean(stands[nearness >= np.median(nearness), k])
        corrections[joint] = middle.T
