"""Acclaim skeletons (ASF): bones that stand in any direction, each with the channels it turns by.

A bone turns at its start, where its parent ends; it becomes the joint of that place under the
bone's name. So "lfemur" is the left hip, and the last bones end in end sites.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

from ..body import Skeleton
from .parsing import decode, fail, number, numbers, read_bytes

_DOFS = ("tx", "ty", "tz", "rx", "ry", "rz", "l")


@dataclass(frozen=True, eq=False)
class AcclaimSkeleton:
    """What an ASF file says.

    skeleton: J joints, the root first [m]. dofs: for each joint its channels in the file's order.
    axes: (J, 3, 3) the frame C in which a joint's angles are measured: its rotation is C·M·C⁻¹.
    metre: metres in one unit of length. radian: radians in one unit of angle.
    """

    skeleton: Skeleton
    dofs: tuple[tuple[str, ...], ...]
    axes: np.ndarray
    metre: float
    radian: float


@dataclass
class _Bone:
    """One bone, or the root, in the file's own units."""

    line: int
    name: str | None = None
    direction: np.ndarray | None = None
    length: float | None = None
    dofs: tuple[str, ...] = ()
    order: str = "xyz"
    turn: np.ndarray = field(default_factory=lambda: np.zeros(3))
    position: np.ndarray = field(default_factory=lambda: np.zeros(3))

    @property
    def vector(self) -> np.ndarray:
        """From its joint to the next (3,)."""
        assert self.direction is not None and self.length is not None  # no bone ends without
        return self.direction * self.length


def read_asf(path) -> AcclaimSkeleton:
    """The skeleton of an ASF file in metres: `length` l means that one unit is 1/l inch.

    MotionFileError, naming file and line, for anything that is not a sound skeleton.
    """
    sections = _sections(decode(read_bytes(path), path), path)
    metre, radian = 0.0254, np.pi / 180
    for line, words in sections["units"]:
        if words[0] == "length" and len(words) == 2:
            inverse = number(words[1], path, line)
            if inverse < 1e-9:
                fail(path, line, f"the unit of length must be above zero, not {words[1]}")
            metre = 0.0254 / inverse
        if words[0] == "angle" and len(words) == 2:
            radian = angle_unit(words[1], path, line)
    root = _root(sections["root"], path)
    bones = {"root": root} | _bones(sections["bonedata"], path)
    names, parents = _tree(sections["hierarchy"], bones, path)
    order = [bones[name] for name in names]
    vectors = np.stack([bone.vector for bone in order]) * metre
    offsets = np.where(np.array(parents)[:, None] >= 0, vectors[parents], root.position * metre)
    leaves = np.array([j for j in range(1, len(names)) if j not in parents], np.int64)
    skeleton = Skeleton(names, np.array(parents), offsets, leaves, vectors[leaves])
    return AcclaimSkeleton(skeleton, tuple(bone.dofs for bone in order), _axes(order, radian), metre, radian)


def _sections(text: str, path) -> dict[str, list[tuple[int, list[str]]]]:
    """The words of each :section by line, in lower case but for names of bones."""
    sections: dict[str, list[tuple[int, list[str]]]] = {"units": []}
    current = None
    for line, content in enumerate(text.split("\n"), 1):
        words = content.split("#")[0].split()
        if words and words[0].startswith(":"):
            current = sections.setdefault(words[0][1:].lower(), [])
        elif words and current is not None:
            current.append((line, [words[0].lower(), *words[1:]] if "hierarchy" not in sections else words))
        elif words:
            fail(path, line, f"'{words[0][:40]}' before any section: an ASF file begins with :version")
    last = text.rstrip().count("\n") + 1
    for name in ("root", "bonedata", "hierarchy"):
        if not sections.get(name):
            fail(path, last, f"there is no :{name} section: was the file truncated?")
    return sections


def angle_unit(word: str, path, line: int) -> float:
    """Radians in one unit of the angles."""
    if word.lower()[:3] not in ("deg", "rad"):
        fail(path, line, f"angles are in deg or rad, not '{word[:40]}'")
    return np.pi / 180 if word.lower().startswith("deg") else 1.0


def _root(lines, path) -> _Bone:
    root = _Bone(lines[0][0], "root", np.zeros(3), 0.0)
    for line, words in lines:
        if words[0] == "order":
            root.dofs = _dofs(words[1:], path, line)
        elif words[0] == "axis":
            root.order = _order(words[1] if len(words) == 2 else "", path, line)
        elif words[0] == "position":
            root.position = numbers(words[1:], 3, "the root's position", path, line)
        elif words[0] == "orientation":
            root.turn = numbers(words[1:], 3, "the root's orientation", path, line)
    return root


def _bones(lines, path) -> dict[str, _Bone]:
    """Every bone by its name."""
    bones: dict[str, _Bone] = {"root": _Bone(0, "root")}
    bone = None
    for line, words in lines:
        key = words[0]
        if key == "begin":
            if bone is not None:
                fail(path, line, f"the bone begun in line {bone.line} has no end")
            bone = _Bone(line)
        elif bone is None:
            fail(path, line, f"'{key[:40]}' outside a bone's begin and end")
        elif key == "name" and len(words) == 2:
            bone.name = words[1]
        elif key == "direction":
            bone.direction = numbers(words[1:], 3, "a direction", path, line)
        elif key == "length":
            bone.length = numbers(words[1:], 1, "a length", path, line)[0]
        elif key == "axis":
            bone.turn = numbers(words[1:4], 3, "an axis", path, line)
            bone.order = _order(words[4] if len(words) > 4 else "XYZ", path, line)
        elif key == "dof":
            bone.dofs = _dofs(words[1:], path, line)
        elif key == "end":
            for needed in ("name", "direction", "length"):
                if getattr(bone, needed) is None:
                    fail(path, line, f"the bone begun in line {bone.line} has no {needed}")
            assert bone.name is not None  # see above
            if bone.name in bones:
                fail(path, bone.line, f"a second bone '{bone.name}': names must differ")
            bones[bone.name], bone = bone, None
    if bone is not None:
        fail(path, bone.line, "this bone has no end")
    del bones["root"]
    return bones


def _dofs(words, path, line: int) -> tuple[str, ...]:
    dofs = tuple(word.lower() for word in words)
    for dof in dofs:
        if dof not in _DOFS or dofs.count(dof) > 1:
            fail(path, line, f"channel '{dof[:40]}': each is one of {' '.join(_DOFS)}, and once")
    return dofs


def _order(word: str, path, line: int) -> str:
    if sorted(word.lower()) != ["x", "y", "z"]:
        fail(path, line, f"an axis order is X, Y and Z in some order, not '{word[:40]}'")
    return word.lower()


def _axes(bones: list[_Bone], radian: float) -> np.ndarray:
    """The frames C (J, 3, 3): turns about the fixed axes in the order named, all bones at once."""
    axes = np.empty((len(bones), 3, 3))
    for order in {bone.order for bone in bones}:
        mine = [j for j, bone in enumerate(bones) if bone.order == order]
        turns = np.stack([bones[j].turn for j in mine]) * radian  # about x, y, z, whatever the order
        axes[mine] = Rotation.from_euler(order, turns[:, ["xyz".index(a) for a in order]]).as_matrix()
    return axes


def _tree(lines, bones, path) -> tuple[tuple[str, ...], list[int]]:
    """Names depth first and the parents' numbers, from lines 'parent child child …'."""
    children: dict[str, list[str]] = {}
    placed = {"root": 0}
    for line, words in lines:
        if words[0].lower() in ("begin", "end") and len(words) == 1:
            continue
        for word in words:
            if word not in bones:
                fail(path, line, f"the hierarchy names '{word[:40]}', which :bonedata does not")
        for word in words[1:]:
            if word in placed:
                fail(path, line, f"'{word}' has a place in the hierarchy already")
            placed[word] = line
        children.setdefault(words[0], []).extend(words[1:])
    names, parents, stack = [], [], [("root", -1)]
    while stack:
        name, parent = stack.pop()
        names.append(name)
        parents.append(parent)
        stack += [(child, len(names) - 1) for child in reversed(children.get(name, []))]
    for name, bone in bones.items():
        if name not in names:
            fail(path, bone.line, f"bone '{name}' has no way to the root in the :hierarchy")
    return tuple(names), parents
