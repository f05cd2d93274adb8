"""How another skeleton's joint frames stand to those of Gambol's human.

For each joint one constant rotation C with  R_ours = R_theirs · C  for world orientations. Where
the source's zero pose looks like a person standing (T-, A- or I-pose), C follows from that pose:
world-aligned twist, limbs turned the shortest way onto the bones. Where it does not (zero pose
along bone axes), C is read off the motion: knees and elbows tell the twist of the limbs, and in
mean upright walking trunk, head and clavicles stand as in the T-pose. Feet are always read off
flat stance, since hardly any skeleton's zero pose has its soles level.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from collections.abc import Sequence

import numpy as np

from ..body import Clip, Skeleton, between, exp, forward_kinematics, heading_of, human, mean, yaw
from .flat_stance import flat_stance
from .joint_names import Roles, roles

LIMBS = {"UpLeg": "Leg", "Leg": "Foot", "Arm": "ForeArm", "ForeArm": "Hand"}
"""The bones of the limbs: from a joint to the next, by our names without the side."""
SIDES = ("Left", "Right")
SHORTEST = 0.01
"""A bone of a limb that is no longer than this share of thigh and shank together is none."""
_UPRIGHT = np.cos(np.radians(20.0))
_STRAIGHT = 0.04  # m: a leg that comes within this of straight is taken to straighten in its stride
_MOST_ROLL = np.radians(3.0)
_MOST_SINK = 0.01  # m
_STRAIGHTENS, _SHORTEST_REACH = 99.5, 0.99
"""A leg that comes within the second of its length is straight in the last frames of the first percent: people's legs
straighten as they walk, fitted skeletons' often do not."""


@dataclass(frozen=True, eq=False)
class Calibration:
    """What retargeting needs to know of a source skeleton.

    corrections: (J_source, 3, 3) the rotation C of each joint that plays a part, else identity.
    scale: our leg length over theirs. posed: whether the zero pose was a person standing.
    ankles: (2, 3) [m] where our left and right ankle are in our foot's frame, seen from theirs
    (scaled): some skeletons have their ankles 8 cm higher than people do, or one higher than the other.
    clavicles: the share of the clavicles' rotation we take, so that longer ones do not shrug.
    sink: how much lower than theirs our hips are [m], where our legs are uneven otherwise.
    reach: (2,) the share of its length at which their left and right leg is straight.
    """

    roles: Roles
    corrections: np.ndarray
    scale: float
    posed: bool
    ankles: np.ndarray
    clavicles: float
    sink: float
    reach: tuple[float, float]


def calibrate(clips: Sequence[Clip], skeleton: Skeleton | None = None, *, posed: bool | None = None) -> Calibration:
    """The calibration of one source skeleton from some of its clips; the more walking, the better.

    skeleton: ours, the standard human by default. posed: whether the zero pose is a person
    standing; found out by default. ValueError if there is no clip, if the skeleton is no human or a
    bone of its limbs has no length, or if the clips' skeletons differ.
    """
    clips = [clips] if isinstance(clips, Clip) else list(clips)
    if not clips:
        raise ValueError("no clips to calibrate from")
    if not all(isinstance(clip, Clip) for clip in clips):
        raise ValueError(f"clips are Clips, as load gives them; got {', '.join(type(clip).__name__ for clip in clips[:3])}")
    skeleton = skeleton or human()
    source = clips[0].skeleton
    part = roles(source)
    zero = zero_positions(source)
    has_limbs(part, zero, source.names)
    for clip in clips[1:]:
        length = _leg_length(zero_positions(clip.skeleton), part.limbs) if clip.skeleton.names == source.names else 0.0
        if abs(length / _leg_length(zero, part.limbs) - 1) > 0.02:
            raise ValueError(f"{clip.name} has another skeleton than {clips[0].name}: calibrate them apart")
    world = _zero_alignment(part, zero)
    posed = _is_posed(part, zero, world) if posed is None else posed
    motions = [clip.kinematics() for clip in clips]
    corrections = np.broadcast_to(np.eye(3), (len(source), 3, 3)).copy()
    if posed:
        _from_zero_pose(skeleton, part, zero, world, corrections)
    else:
        _from_motion(skeleton, source, part, zero, motions, corrections)
    ours = {name: i for i, name in enumerate(skeleton.names)}
    rest = zero_positions(skeleton)
    scale = float(_leg_length(rest, ours) / _leg_length(zero, part.limbs))
    feet = [flat_stance(part, side, clips, motions, scale) for side in SIDES]
    for foot in feet:
        for joint, turn in foot.turns.items():
            corrections[joint] = turn
    drop = rest[ours["LeftFoot"], 1] - rest[ours["LeftToe"], 1] - np.mean([foot.drop for foot in feet])
    uneven = np.median(feet[0].heights - feet[1].heights) / 2
    ankles = np.array([[0.0, drop - uneven, 0.0], [0.0, drop + uneven, 0.0]])
    clavicles = 1.0
    if "LeftShoulder" in part.limbs:
        bone = "LeftShoulder", "LeftArm"
        clavicles = float(min(scale * _distance(zero, part.limbs, *bone) / _distance(rest, ours, *bone), 1.0))
    straight = [float(np.percentile(np.concatenate([leg_stretch(positions, part, side) for positions, _ in motions]), _STRAIGHTENS))
                for side in SIDES]
    left, right = (reach if reach > _SHORTEST_REACH else 1.0 for reach in straight)
    draft = Calibration(part, corrections, scale, posed, ankles, clavicles, 0.0, (left, right))
    roll, sink = _even_legs(skeleton, draft, motions)
    corrections = corrections.copy()
    corrections[part.limbs["Hips"]] @= exp([0.0, 0.0, roll])
    return replace(draft, corrections=corrections, sink=sink)


def has_limbs(part: Roles, places: np.ndarray, names: Sequence[str]) -> None:
    """Nothing, if the bones of the limbs have lengths in a skeleton at rest, its joints at places (J, 3). ValueError, naming one that has none: it points nowhere."""
    legs = _leg_length(places, part.limbs)
    for side in SIDES:
        for a, b in LIMBS.items():
            if side + b in part.limbs and not _distance(places, part.limbs, side + a, side + b) > SHORTEST * legs:
                raise ValueError(f"{names[part.limbs[side + a]]} has no length: {names[part.limbs[side + b]]} is where it is")


def place_feet(skeleton: Skeleton, known: Calibration, positions: np.ndarray, orientations: np.ndarray
               ) -> tuple[np.ndarray, np.ndarray]:
    """Where our hip joints' midpoint (T, 3) and ankles (T, 2, 3) go [m], up to a constant height.

    positions, orientations: (T, J, 3) [m], (T, J, 3, 3) of the source.
    """
    limbs = known.roles.limbs
    middle = known.scale * (positions[:, limbs["LeftUpLeg"]] + positions[:, limbs["RightUpLeg"]]) / 2
    middle[:, 1] -= known.sink
    feet = [limbs["LeftFoot"], limbs["RightFoot"]]
    turned = np.einsum("tsij,sj->tsi", orientations[:, feet] @ known.corrections[feet], known.ankles)
    # the whole body sinks with the soles, so the legs keep their stretch
    turned[..., 1] -= known.ankles[:, 1].mean()
    return middle, known.scale * positions[:, feet] + turned


def leg_stretch(positions: np.ndarray, part: Roles, side: str) -> np.ndarray:
    """How far apart (T,) hip and ankle of the "Left" or "Right" leg are, as a share of its length. positions: (T, J, 3)."""
    hip, knee, foot = (positions[:, part.limbs[side + n]] for n in ("UpLeg", "Leg", "Foot"))
    length = np.linalg.norm(knee - hip, axis=-1) + np.linalg.norm(foot - knee, axis=-1)
    return np.linalg.norm(foot - hip, axis=-1) / np.maximum(length, 1e-9)


def _even_legs(skeleton, known, motions):
    """The pelvis' roll [rad] and how far it sinks [m] so that no foot hangs out of reach.

    Fitted skeletons have one leg longer or one ankle higher than the other by up to 2 cm. On our
    even legs a little roll evens out most of it, for the longer one's last reach the hips sink.
    """
    hips = known.roles.limbs["Hips"]
    legs = [skeleton.offsets[skeleton.index(side + "UpLeg")] for side in SIDES]
    length = _leg_length(zero_positions(skeleton), {name: i for i, name in enumerate(skeleton.names)})
    stretch = []
    for positions, orientations in motions:
        middle, ankles = place_feet(skeleton, known, positions, orientations)
        across = (orientations[:, hips] @ known.corrections[hips]) @ ((legs[0] - legs[1]) / 2)
        stretch.append([np.linalg.norm(ankles[:, 0] - middle - across, axis=-1),
                        np.linalg.norm(ankles[:, 1] - middle + across, axis=-1)])
    left, right = np.percentile(np.concatenate(stretch, 1), 98, axis=1) - length
    if min(left, right) < -_STRAIGHT:
        return 0.0, 0.0
    width = np.linalg.norm(legs[0] - legs[1])
    roll = float(np.clip((right - left) / width, -_MOST_ROLL, _MOST_ROLL))
    worst = max(left + roll * width / 2, right - roll * width / 2)
    return roll, float(np.clip(worst + 0.002, 0.0, _MOST_SINK))


def zero_positions(skeleton: Skeleton) -> np.ndarray:
    """Joint positions (J, 3) [m] of the zero pose, the root at the origin."""
    return forward_kinematics(skeleton, np.zeros(3), np.broadcast_to(np.eye(3), (len(skeleton), 3, 3)))[0]


def _leg_length(zero, limbs):
    """Mean length [m] of thigh and shank together."""
    return np.mean([_distance(zero, limbs, side + a, side + b) * 2
                    for side in SIDES for a, b in (("UpLeg", "Leg"), ("Leg", "Foot"))])


def _distance(zero, limbs, a, b):
    return np.linalg.norm(zero[limbs[a]] - zero[limbs[b]])


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


def _from_zero_pose(skeleton, part, zero, world, corrections):
    """Corrections from a person standing in the zero pose; `corrections` is filled in place."""
    corrections[:] = world
    for side in SIDES:
        for joint, child in LIMBS.items():
            if side + child in part.limbs:
                j = part.limbs[side + joint]
                ours = skeleton.offsets[skeleton.index(side + child)]
                corrections[j] = between(world @ ours, zero[part.limbs[side + child]] - zero[j]) @ world
        if side + "Hand" in part.limbs:
            corrections[part.limbs[side + "Hand"]] = corrections[part.limbs[side + "ForeArm"]]


def _from_motion(skeleton, source, part, zero, motions, corrections):
    """Corrections without a standing zero pose; `corrections` is filled in place."""
    limbs = part.limbs
    turns, tops = [], []
    for positions, _ in motions:
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
