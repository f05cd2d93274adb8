"""Control points: the few places on the body that are seen, by name.

The sets of two to six points are those of Mousas 2014, section 5.2, where "root" is the hips. Liu 2011, whose
six points the paper also compares with, has the middle of the torso in its place.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..body import Clip, Skeleton

NAMES = {
    "root": "Hips", "torso": "Spine1", "chest": "Spine2", "neck": "Neck", "head": "Head",
    "lshoulder": "LeftArm", "rshoulder": "RightArm", "lelbow": "LeftForeArm", "relbow": "RightForeArm",
    "lwrist": "LeftHand", "rwrist": "RightHand", "lhip": "LeftUpLeg", "rhip": "RightUpLeg",
    "lknee": "LeftLeg", "rknee": "RightLeg", "lankle": "LeftFoot", "rankle": "RightFoot",
    "ltoe": "LeftToe", "rtoe": "RightToe",
}
"""Joint by the name of the point in it. Joints' own names serve as well."""
SETS = {
    "2": ("lwrist", "rankle"),
    "3": ("lwrist", "lankle", "rankle"),
    "4": ("lwrist", "rwrist", "lankle", "rankle"),
    "5": ("root", "lwrist", "rwrist", "lankle", "rankle"),
    "6": ("head", "root", "lwrist", "rwrist", "lankle", "rankle"),
    "liu": ("head", "torso", "lwrist", "rwrist", "lankle", "rankle"),
}
"""The paper's sets by how many points they have, and Liu's six."""


@dataclass(frozen=True, eq=False)
class ControlPoints:
    """n points fixed to joints. names: n. joints: (n,) joint numbers. offsets: (n, 3) [m] in the joints' frames."""

    names: tuple[str, ...]
    joints: np.ndarray
    offsets: np.ndarray

    def __post_init__(self):
        for name, value in (("joints", np.array(self.joints, np.int64)),
                            ("offsets", np.array(self.offsets, float).reshape(-1, 3))):
            value.setflags(write=False)
            object.__setattr__(self, name, value)

    def __len__(self) -> int:
        return len(self.joints)

    def on(self, positions: np.ndarray, orientations: np.ndarray) -> np.ndarray:
        """Where the points are, (..., n, 3) [m], from what forward kinematics returned."""
        points = positions[..., self.joints, :]
        return points if not self._beside else points + np.einsum("...nij,nj->...ni", orientations[..., self.joints, :, :], self.offsets.astype(positions.dtype))

    @cached_property
    def _beside(self) -> bool:
        """Whether any point stands beside its joint."""
        return bool(self.offsets.any())

    def extract(self, clip: Clip) -> np.ndarray:
        """Where a recorded body has the points, (T, n, 3) [m]; it must have the skeleton that they were parsed for."""
        return self.on(*clip.kinematics())


def parse(text: str | Sequence[str], skeleton: Skeleton) -> ControlPoints:
    """The points that a text, or some, name: "4" for the paper's set of four, or "lwrist,rankle,Head+0/0.12/0.05".

    Points are divided by commas. A point is a name in `NAMES` or a joint's own, small and capital letters alike,
    and may stand beside the joint by metres right after a plus: x/y/z in the joint's frame.
    ValueError, naming the point and what there is, for anything else.
    """
    if isinstance(text, list | tuple) and all(isinstance(word, str) for word in text):
        text = ",".join(text)
    if not isinstance(text, str):
        raise ValueError(f"points are named, as in 'lwrist,rwrist', or a set of the paper, '4'; got {text!r}")
    if not text.strip():
        raise ValueError(f"no control points: name some of {_known(skeleton)}, or a set of the paper: {', '.join(SETS)}")
    words = [word.strip() for word in text.split(",")]
    points = [_point(word, skeleton) for word in (SETS[words[0]] if len(words) == 1 and words[0] in SETS else words)]
    for i, (name, joint, offset) in enumerate(points):
        for other, at, beside in points[:i]:
            if joint == at and np.array_equal(offset, beside):
                raise ValueError(f"control point '{name}' is given twice" if name == other else
                                 f"control points '{other}' and '{name}' are one place")
    names, joints, offsets = zip(*points, strict=True)
    return ControlPoints(names, np.array(joints), np.array(offsets))


def _point(word: str, skeleton: Skeleton) -> tuple[str, int, np.ndarray]:
    """A point's name, joint number and offset [m]."""
    name, plus, beside = word.partition("+")
    name = name.strip()
    joint = NAMES.get(name.lower(), name)
    own = {known.lower(): j for j, known in enumerate(skeleton.names)}
    if joint.lower() not in own:
        raise ValueError(f"no control point '{name}': there are {_known(skeleton)}, or a set of the paper: {', '.join(SETS)}")
    if not plus:
        return word, own[joint.lower()], np.zeros(3)
    try:
        offset = np.array([float(number) for number in beside.split("/")])
    except ValueError:
        offset = np.empty(0)
    if offset.shape != (3,) or not np.all(np.isfinite(offset)):
        raise ValueError(f"control point '{word}': after the plus stand three numbers in metres, as in {name}+0/0.1/0")
    return word, own[joint.lower()], offset


def _known(skeleton: Skeleton) -> str:
    short = [name for name, joint in NAMES.items() if joint in skeleton]
    return ", ".join([*short, *(name for name in skeleton.names if name not in NAMES.values())])
