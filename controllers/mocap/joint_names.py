"""What other people call the joints of a human.

Every tool has its own names: `LeftUpLeg`, `lfemur`, `L_Hip`, `mixamorig:LeftUpLeg`, `thigh.L`, `J_Bip_L_UpperLeg`, `左足`.
Only limbs, hips and head are told by name; which joints make up the trunk and the neck follows
from the tree (from the hips to where the arms part, and on to the head), whatever they are called.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..body import Skeleton

# our name → what it is called elsewhere, the best first. Order matters: a name goes to the first
# joint that asks for it, so that `LeftShoulder` is the upper arm only where nothing better is.
_LIMBS = {
    "UpLeg": ("upleg", "upperleg", "upperleg01", "thigh", "thighbend", "femur", "hip"),
    "Leg": ("leg", "lowerleg", "lowerleg01", "lowleg", "shin", "calf", "knee", "tibia"),
    "Foot": ("ankle", "foot"),
    "Toe": ("toebase", "toes", "toe", "toe0", "ball", "foot"),
    "Arm": ("arm", "uparm", "upperarm", "upperarm01", "humerus", "shldr", "shldrbend", "shoulder"),
    "ForeArm": ("forearm", "forearmbend", "lowerarm", "lowerarm01", "lowarm", "elbow", "radius"),
    "Hand": ("fingerbase", "hand", "wrist"),
    "Shoulder": ("shoulder1", "collar", "clavicle", "shoulder"),
}
_MIDLINE = {"Hips": ("hips", "hip", "pelvis", "root"), "Head": ("head", "head1", "spine006")}
_JAPANESE = {"左": "left", "右": "right", "つま先": "toe", "足首": "ankle", "ひざ": "knee", "足": "upleg", "手首": "wrist", "ひじ": "elbow", "腕": "arm", "肩": "collar", "頭": "head",
             "腰": "hips", "センター": "root"}
_NEEDED = tuple(side + limb for side in ("Left", "Right") for limb in ("UpLeg", "Leg", "Foot", "Arm", "ForeArm"))


@dataclass(frozen=True)
class Roles:
    """Which joint of a skeleton plays which part.

    limbs: joint number by our name (`Hips`, `Head`, `LeftUpLeg`, …); hands, toes and clavicles
    may be missing. trunk: joint numbers above the hips up to the one that carries the arms.
    neck: from there up to the head, the head included.
    """

    limbs: dict[str, int]
    trunk: tuple[int, ...]
    neck: tuple[int, ...]


class NoHuman(ValueError):
    """A skeleton that is no whole human; `missing` are its parts that were not found."""

    def __init__(self, message: str, missing: list[str]):
        super().__init__(message)
        self.missing = missing


def plain(name: str) -> str:
    """A joint's name without namespace, punctuation, case and a tool's prefix; in English, where it is Japanese."""
    for theirs, english in _JAPANESE.items():
        name = name.replace(theirs, english)
    short = re.sub(r"[^a-z0-9]", "", name.split(":")[-1].lower())
    return re.sub(r"^(mixamorig\d*|valvebipedbip0*1|bip0*1|ccbase|jbipc?|def)(?=.)", "", short)


def roles(skeleton: Skeleton) -> Roles:
    """Find the parts of a human in any skeleton.

    NoHuman, naming the missing parts and the names there are, if it has no legs, arms or head.
    """
    names, first = [plain(name) for name in skeleton.names], None
    for spelt in _spelt(names):
        try:
            return _roles(skeleton, spelt)
        except NoHuman as none:
            first = first or none
    assert first is not None
    raise first


def _spelt(names: list[str]) -> Iterator[list[str]]:
    """Joints' names as they are, then without what stands before or after `head` in one of them, as before `Character1_Head` or after `head_jnt`: a figure's own name, say."""
    yield names
    for before, _, after in sorted((name.partition("head") for name in names if "head" in name), key=lambda parts: sum(map(len, parts))):
        if before or after:
            yield [name.removeprefix(before).removesuffix(after) for name in names]


def _roles(skeleton: Skeleton, spelt: list[str]) -> Roles:
    """The same of joints that are called so."""
    known = {}
    for number, name in enumerate(spelt):
        known.setdefault(name, number)
    found: dict[str, int] = {}
    for side, marks in (("Left", ("left", "l")), ("Right", ("right", "r"))):
        for limb, bases in _LIMBS.items():
            names = [n for base in bases for mark in marks for n in (mark + base, base + mark)]
            number = next((known[n] for n in names if n in known and known[n] not in found.values()), None)
            if number is not None:
                found[side + limb] = number
    for part, names in _MIDLINE.items():
        number = next((known[n] for n in names if n in known), None)
        if number is not None:
            found[part] = number
    found.setdefault("Hips", 0)
    missing = [part for part in (*_NEEDED, "Head") if part not in found]
    if missing:
        names = ", ".join(skeleton.names[:60]) + ", …" * (len(skeleton) > 60)
        raise NoHuman(f"not a human we know: no {', '.join(missing)} among {names}", missing)
    above = _path(skeleton, found["LeftArm"])
    others = _path(skeleton, found["RightArm"])
    chest = max(i for i in above if i in others)
    head = _path(skeleton, found["Head"])
    return Roles(found, _chain(skeleton, _path(skeleton, chest), found["Hips"], chest),
                 _chain(skeleton, head, max(i for i in head if i in above), found["Head"]))


def carriers(skeleton: Skeleton) -> tuple[int, ...]:
    """The joints that carry the whole body: from the root to the lowest one above both legs and the head.

    Of what is no human, down to the first that branches; the root alone where none does.
    """
    try:
        limbs = roles(skeleton).limbs
    except ValueError:
        children = np.bincount(skeleton.parents[1:], minlength=len(skeleton))
        last = int(np.argmax(children > 1))
        return tuple(_path(skeleton, last))
    paths = [_path(skeleton, limbs[part]) for part in ("LeftUpLeg", "RightUpLeg", "Head")]
    return tuple(j for j in paths[0] if j in paths[1] and j in paths[2])


def _path(skeleton, joint):
    """Joint numbers from the root to a joint, both included."""
    path = []
    while joint >= 0:
        path.append(int(joint))
        joint = skeleton.parents[joint]
    return path[::-1]


def _chain(skeleton, path, after, last):
    """The joints of a path after one and up to another; dummies, which never move, left out."""
    return tuple(j for j in path if after < j <= last and "dummy" not in plain(skeleton.names[j]))
