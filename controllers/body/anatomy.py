"""Masses, centres of mass, inertias and joint limits of a human.

Body segments: de Leva 1996, "Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters",
J. Biomechanics 29(9), table 4: shares of body mass, centres of mass along the segment, radii of
gyration; for men (mean 73 kg, 1.741 m) and women (61.9 kg, 1.735 m).
Joint limits: 38 CFR § 4.71 (the plates by which the United States rate disability), lumbar spine,
neck and shoulder extension after Kurz, both as collected in our readings; the ankle bends 40°
under the body's weight. Where no table speaks (toes, clavicles, sideways play) we say "ours".
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ..compiled import kernel
from .brief import brief
from .clip import Pose
from .contact import heel_offset
from .skeleton import Skeleton, end_positions, forward_kinematics

# share of mass [%], centre of mass from the first end [%], radii of gyration [% of length] about
# the sagittal (front-back), the transverse (left-right) and the longitudinal axis: men, then women
_DE_LEVA = {
    "head": ((6.94, 50.02, 30.3, 31.5, 26.1), (6.68, 48.41, 27.1, 29.5, 26.1)),
    "upper trunk": ((15.96, 29.99, 71.6, 45.4, 65.9), (15.45, 20.77, 74.6, 50.2, 71.8)),
    "middle trunk": ((16.33, 45.02, 48.2, 38.3, 46.8), (14.65, 45.12, 43.3, 35.4, 41.5)),
    "lower trunk": ((11.17, 61.15, 61.5, 55.1, 58.7), (12.47, 49.20, 43.3, 40.2, 44.4)),
    "upper arm": ((2.71, 57.72, 28.5, 26.9, 15.8), (2.55, 57.54, 27.8, 26.0, 14.8)),
    "forearm": ((1.62, 45.74, 27.6, 26.5, 12.1), (1.38, 45.59, 26.1, 25.7, 9.4)),
    "hand": ((0.61, 79.00, 62.8, 51.3, 40.1), (0.56, 74.74, 53.1, 45.4, 33.5)),
    "thigh": ((14.16, 40.95, 32.9, 32.9, 14.9), (14.78, 36.12, 36.9, 36.4, 16.2)),
    "shank": ((4.33, 44.59, 25.5, 24.9, 10.3), (4.81, 44.16, 27.1, 26.7, 9.3)),
    "foot": ((1.37, 44.15, 25.7, 24.5, 12.4), (1.29, 40.14, 29.9, 27.9, 13.9)),
}
# suprasternale – xiphion – omphalion – mid-hip as shares of that length (de Leva's table 2)
_TRUNK = ((0.0, 0.3209, 0.7261, 1.0), (0.0, 0.2692, 0.6571, 1.0))
_SUPRASTERNALE = 0.94
"""Its height between mid-hip (0) and the neck joint (1): 53.19 of 56.6 cm in the standard human."""
_HAND = 0.0862 / 0.1899  # wrist to third knuckle over wrist to fingertip
# which axis of the joint's frame at T-pose is sagittal, transverse, longitudinal: palms are down,
# so across the palm is Y, while the elbow's own axis (transverse) is Y too
_AXES = {"arm": (2, 1, 0), "hand": (1, 2, 0), "foot": (1, 0, 2), "other": (2, 0, 1)}


@dataclass(frozen=True, eq=False)
class Anatomy:
    """What a body weighs and where. S segments, each moving with one joint.

    mass: of the whole body [kg]. names: S segments. joints: (S,) which joint carries each.
    shares: (S,) of the body's mass, sum 1. centres: (S, 3) [m] centres of mass in the joints'
    frames. inertias: (S, 3, 3) [kg m²] about them, in the joints' frames.
    """

    __repr__ = brief

    mass: float
    names: tuple[str, ...]
    joints: np.ndarray
    shares: np.ndarray
    centres: np.ndarray
    inertias: np.ndarray

    @property
    def masses(self) -> np.ndarray:
        """The segments' masses (S,) [kg]."""
        return self.mass * self.shares


def anatomy(skeleton: Skeleton, mass: float = 73.0, sex: Literal["male", "female"] = "male") -> Anatomy:
    """The anatomy of a skeleton with the standard human's joint names.

    ValueError for a mass that is not above 0 or an unknown sex; KeyError naming a missing joint.
    """
    if not mass > 0:
        raise ValueError(f"a body must weigh something, not {mass} kg")
    if sex not in ("male", "female"):
        raise ValueError(f"de Leva measured 'male' and 'female', not {sex!r}")
    column = ("male", "female").index(sex)
    count = len(skeleton)
    positions, orientations = forward_kinematics(skeleton, np.zeros(3), np.broadcast_to(np.eye(3), (count, 3, 3)))
    names, joints, shares, centres, inertias = [], [], [], [], []
    for name, joint, start, end, axes in _segments(skeleton, positions, orientations, column):
        share, along, *radii = (v / 100 for v in _DE_LEVA[name.removeprefix("left ").removeprefix("right ")][column])
        number = skeleton.index(joint)
        moments = np.zeros(3)
        moments[list(axes)] = mass * share * (np.array(radii) * np.linalg.norm(end - start)) ** 2
        names.append(name)
        joints.append(number)
        shares.append(share)
        centres.append(start + along * (end - start) - positions[number])
        inertias.append(np.diag(moments))
    shares = np.array(shares)
    return Anatomy(float(mass), tuple(names), np.array(joints), shares / shares.sum(),
                   np.stack(centres), np.stack(inertias))


def segment_centres(anatomy: Anatomy, positions: np.ndarray, orientations: np.ndarray) -> np.ndarray:
    """Where the segments' centres of mass are (..., S, 3) [m], from what forward kinematics returned."""
    at = anatomy.joints
    return positions[..., at, :] + np.einsum("...sij,sj->...si", orientations[..., at, :, :],
                                             anatomy.centres.astype(positions.dtype))


def centre_of_mass(anatomy: Anatomy, positions: np.ndarray, orientations: np.ndarray) -> np.ndarray:
    """The body's centre of mass (..., 3) [m], from what forward kinematics returned."""
    return np.einsum("s,...si->...i", anatomy.shares.astype(positions.dtype),
                     segment_centres(anatomy, positions, orientations))


def centre_in_pose(anatomy: Anatomy, skeleton: Skeleton, pose: Pose) -> np.ndarray:
    """The centre of mass (3,) [m] of one body in a pose: what `centre_of_mass` tells, without its joints, in a tenth of the time."""
    out = np.empty(3)
    _centre(skeleton.parents, skeleton.offsets, np.asarray(pose.root, float), np.ascontiguousarray(pose.rotations, float), anatomy.joints, anatomy.shares, anatomy.centres, out)
    return out


@kernel
def _centre(parents, offsets, root, local, joints, shares, centres, out):
    places, turned = np.empty((len(parents), 3)), np.empty((len(parents), 3, 3))
    for j in range(len(parents)):
        p = parents[j]
        if p < 0:
            places[j], turned[j] = root, local[j]
            continue
        for i in range(3):
            places[j, i] = places[p, i]
            for k in range(3):
                places[j, i] += turned[p, i, k] * offsets[j, k]
                turned[j, i, k] = turned[p, i, 0] * local[j, 0, k] + turned[p, i, 1] * local[j, 1, k] + turned[p, i, 2] * local[j, 2, k]
    out[:] = 0.0
    for s in range(len(joints)):
        for i in range(3):
            along = turned[joints[s], i, 0] * centres[s, 0] + turned[joints[s], i, 1] * centres[s, 1] + turned[joints[s], i, 2] * centres[s, 2]
            out[i] += shares[s] * (places[joints[s], i] + along)


def _segments(skeleton, positions, orientations, column):
    """Name, carrying joint, both ends (3,) at T-pose [m] and axes of each segment."""
    at = {name: positions[i] for i, name in enumerate(skeleton.names)}
    tips = {skeleton.names[p]: e for p, e in
            zip(skeleton.end_parents, end_positions(skeleton, positions, orientations))}
    middle = (at["LeftUpLeg"] + at["RightUpLeg"]) / 2
    top = middle + _SUPRASTERNALE * (at["Neck"] - middle)
    yield "head", "Head", tips["Head"], at["Neck"], _AXES["other"]
    # the middle third bends with the lowest spine joint: its centre lies just above that
    for k, (name, joint) in enumerate((("upper", "Spine2"), ("middle", "Spine"), ("lower", "Hips"))):
        a, b = _TRUNK[column][k:k + 2]
        yield f"{name} trunk", joint, top + a * (middle - top), top + b * (middle - top), _AXES["other"]
    for side in ("Left", "Right"):
        low = side.lower()
        yield f"{low} upper arm", side + "Arm", at[side + "Arm"], at[side + "ForeArm"], _AXES["arm"]
        yield f"{low} forearm", side + "ForeArm", at[side + "ForeArm"], at[side + "Hand"], _AXES["hand"]
        wrist = at[side + "Hand"]
        yield f"{low} hand", side + "Hand", wrist, wrist + _HAND * (tips[side + "Hand"] - wrist), _AXES["hand"]
        yield f"{low} thigh", side + "UpLeg", at[side + "UpLeg"], at[side + "Leg"], _AXES["other"]
        yield f"{low} shank", side + "Leg", at[side + "Leg"], at[side + "Foot"], _AXES["other"]
        yield f"{low} foot", side + "Foot", at[side + "Foot"] + heel_offset(skeleton), tips[side + "Toe"], _AXES["foot"]


# degrees about X, Y, Z of the joint's frame at T-pose, midline and left; a trunk bends forward and
# a knee back about +X, a left thigh goes out and a left arm up about +Z, the left elbow bends about -Y
_LIMITS = {
    "Spine": ((-30, 75), (-45, 45), (-35, 35)),  # the whole lumbar spine, shared by three joints
    "Neck": ((-55, 80), (-70, 70), (-35, 35)),  # the whole neck, shared by two
    "Shoulder": ((-30, 30), (-30, 30), (-10, 45)),  # ours
    "Arm": ((-90, 90), (-135, 60), (-110, 90)),  # from the T-pose, which is 90° of abduction
    "ForeArm": ((-85, 80), (-145, 0), (-5, 5)),  # pronation and supination stand here
    "Hand": ((-10, 10), (-20, 45), (-80, 70)),
    "UpLeg": ((-125, 30), (-40, 60), (-25, 45)),
    "Leg": ((0, 140), (-15, 15), (-5, 5)),  # sideways ours
    "Foot": ((-40, 50), (-20, 20), (-35, 20)),  # turning and rolling ours
    "Toe": ((-70, 45), (-10, 10), (-10, 10)),  # ours
}
_SHARED = {"Spine": "Spine", "Spine1": "Spine", "Spine2": "Spine", "Neck": "Neck", "Head": "Neck"}


@dataclass(frozen=True, eq=False)
class JointLimits:
    """How far joints turn: bounds on their rotation vectors. lower, upper: (J, 3) [rad].

    A box about the T-pose: exact for hinges, rough where a joint turns far about several axes.
    """

    lower: np.ndarray
    upper: np.ndarray

    def clip(self, rotvecs: np.ndarray) -> np.ndarray:
        """Rotation vectors (..., J, 3) [rad] brought within the limits."""
        return np.clip(rotvecs, self.lower, self.upper)


def joint_limits(skeleton: Skeleton) -> JointLimits:
    """The limits of a skeleton with the standard human's joint names; others, and the hips, have none."""
    lower, upper = np.full((len(skeleton), 3), -np.inf), np.full((len(skeleton), 3), np.inf)
    for j, name in enumerate(skeleton.names):
        plain = name.removeprefix("Left").removeprefix("Right")
        part = _SHARED.get(plain, plain)
        if part not in _LIMITS:
            continue
        sharing = max(list(_SHARED.values()).count(part), 1)
        low, high = np.radians(np.array(_LIMITS[part], float)).T / sharing
        if name.startswith("Right"):  # in a mirror, turns about Y and Z run the other way
            low, high = np.array([low[0], -high[1], -high[2]]), np.array([high[0], -low[1], -low[2]])
        lower[j], upper[j] = low, high
    return JointLimits(lower, upper)
