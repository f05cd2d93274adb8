"""Acclaim files: a skeleton of bones (ASF), and motion for it (AMC).

A bone turns at its start, where its parent ends; it becomes the joint of that place under the
bone's name. So "lfemur" is the left hip, and the last bones end in end sites.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numba import njit
from scipy.spatial.transform import Rotation

from ..body import Clip, Skeleton
from .text import (decode, fail, is_space, line_at, number, numbers, parse_number, read_bytes,
                   token_at, turns)

_OK, _NO_FRAME, _OTHER_BONE, _BAD_NUMBER, _BAD_COUNT, _CUT = range(6)
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


def read_asf(path) -> AcclaimSkeleton:
    """The skeleton of an ASF file in metres: `length` l means that one unit is 1/l inch.

    MotionFileError, naming file and line, for anything that is not a sound skeleton.
    """
    sections = _sections(decode(read_bytes(path), path), path)
    metre, radian = 0.0254, np.pi / 180
    for line, words in sections["units"]:
        if words[0] == "length" and len(words) == 2:
            metre = 0.0254 / (number(words[1], path, line) or np.nan)
            if not 0 < metre < np.inf:
                fail(path, line, f"the unit of length must be above zero, not {words[1]}")
        if words[0] == "angle" and len(words) == 2:
            radian = _angle(words[1], path, line)
    bones = _bones(sections, radian, path)
    names, parents = _tree(sections["hierarchy"], bones, path)
    order = [bones[name] for name in names]
    vectors = np.stack([bone["vector"] for bone in order]) * metre
    offsets = np.where(np.array(parents)[:, None] >= 0, vectors[parents], order[0]["position"] * metre)
    leaves = np.array([j for j in range(1, len(names)) if j not in parents], np.int64)
    skeleton = Skeleton(names, np.array(parents), offsets, leaves, vectors[leaves])
    return AcclaimSkeleton(skeleton, tuple(bone["dofs"] for bone in order),
                           np.stack([bone["axes"] for bone in order]), metre, radian)


def read_amc(path, asf=None, fps: float = 120.0) -> Clip:
    """The motion of an AMC file in metres.

    asf: its skeleton (a path or what `read_asf` returned); by default the .asf in the same folder,
    the one whose name begins the motion's where there are several. fps: frames a second, which
    the format doesn't record. Angles are applied in the order of the channels, about fixed axes.
    Channels that move or stretch bones other than the root are read over: a Clip's bones are rigid.
    MotionFileError, naming file and line, for anything that is not sound or doesn't fit the skeleton.
    """
    data = read_bytes(path)
    acclaim = asf if isinstance(asf, AcclaimSkeleton) else read_asf(asf or _skeleton_beside(path))
    start, radian = _head(data, acclaim.radian, path)
    bones = _layout(data, start, acclaim, path)
    values = _frames(data, start, [(name, len(dofs)) for name, dofs, _ in bones], path)
    skeleton, radian_axes = acclaim.skeleton, []
    root = np.tile(skeleton.offsets[0], (len(values), 1))
    column = 0
    for _, dofs, joint in bones:
        turning = []
        for c, dof in enumerate(dofs, column):
            if dof[0] == "r":
                turning.append((c, joint, acclaim.axes[joint][:, "xyz".index(dof[1])]))
            elif dof[0] == "t" and joint == 0:
                root[:, "xyz".index(dof[1])] += values[:, c] * acclaim.metre
        # turns about fixed axes, one after another, are turns about moving axes in reverse
        radian_axes += reversed(turning)
        column += len(dofs)
    values *= radian
    quaternions = turns(values, np.array([c for c, _, _ in radian_axes], np.int64),
                        np.array([j for _, j, _ in radian_axes], np.int64),
                        np.array([axis for _, _, axis in radian_axes]).reshape(-1, 3), len(skeleton))
    if np.any(acclaim.axes[0] != np.eye(3)):  # the root's frame is its zero orientation, too
        zero = Rotation.from_matrix(acclaim.axes[0])
        quaternions[:, 0] = (Rotation.from_quat(quaternions[:, 0]) * zero).as_quat()
    return Clip(Path(path).stem, skeleton, 1.0 / fps, root, quaternions)


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


def _angle(word: str, path, line: int) -> float:
    if word.lower()[:3] not in ("deg", "rad"):
        fail(path, line, f"angles are in deg or rad, not '{word[:40]}'")
    return np.pi / 180 if word.lower().startswith("deg") else 1.0


def _bones(sections, radian: float, path) -> dict[str, dict]:
    """Every bone, and the root, by name: vector, dofs, axes, line (and the root's position)."""
    root: dict = {"line": sections["root"][0][0], "dofs": (), "vector": np.zeros(3), "position": np.zeros(3)}
    axis, turn = "XYZ", np.zeros(3)
    for line, words in sections["root"]:
        if words[0] == "order":
            root["dofs"] = _dofs(words[1:], path, line)
        elif words[0] == "axis":
            axis = words[1] if len(words) == 2 else ""
        elif words[0] == "position":
            root["position"] = numbers(words[1:], 3, "the root's position", path, line)
        elif words[0] == "orientation":
            turn = numbers(words[1:], 3, "the root's orientation", path, line)
        root["axes"] = _frame(axis, turn * radian, path, line)
    bones, bone = {"root": root}, None
    for line, words in sections["bonedata"]:
        key = words[0]
        if key == "begin":
            if bone is not None:
                fail(path, line, f"the bone begun in line {bone['line']} has no end")
            bone = {"line": line, "dofs": (), "axes": np.eye(3)}
        elif bone is None:
            fail(path, line, f"'{key[:40]}' outside a bone's begin and end")
        elif key == "name" and len(words) == 2:
            bone["name"] = words[1]
        elif key == "direction":
            bone["direction"] = numbers(words[1:], 3, "a direction", path, line)
        elif key == "length":
            bone["length"] = numbers(words[1:], 1, "a length", path, line)[0]
        elif key == "axis":
            turn = numbers(words[1:4], 3, "an axis", path, line)
            bone["axes"] = _frame(words[4] if len(words) > 4 else "XYZ", turn * radian, path, line)
        elif key == "dof":
            bone["dofs"] = _dofs(words[1:], path, line)
        elif key == "end":
            for needed in ("name", "direction", "length"):
                if needed not in bone:
                    fail(path, line, f"the bone begun in line {bone['line']} has no {needed}")
            if bone["name"] in bones:
                fail(path, bone["line"], f"bone '{bone['name']}' was already declared in line "
                     f"{bones[bone['name']]['line']}")
            bone["vector"] = bone["direction"] * bone["length"]
            bones[bone["name"]], bone = bone, None
    if bone is not None:
        fail(path, bone["line"], "this bone has no end")
    return bones


def _dofs(words, path, line: int) -> tuple[str, ...]:
    dofs = tuple(word.lower() for word in words)
    for dof in dofs:
        if dof not in _DOFS or dofs.count(dof) > 1:
            fail(path, line, f"channel '{dof[:40]}': each is one of {' '.join(_DOFS)}, and once")
    return dofs


def _frame(order: str, angles: np.ndarray, path, line: int) -> np.ndarray:
    if sorted(order.lower()) != ["x", "y", "z"]:
        fail(path, line, f"an axis order is X, Y and Z in some order, not '{order[:40]}'")
    named = [angles["xyz".index(axis)] for axis in order.lower()]
    return Rotation.from_euler(order.lower(), named).as_matrix()


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
            fail(path, bone["line"], f"bone '{name}' has no way to the root in the :hierarchy")
    return tuple(names), parents


def _skeleton_beside(path) -> Path:
    path = Path(path)
    found = sorted(p for p in path.parent.iterdir() if p.suffix.lower() == ".asf")
    mine = [p for p in found if path.stem.lower().startswith(p.stem.lower())]
    if len(found) != 1 and not mine:
        fail(path, None, f"{len(found) or 'no'} .asf files beside it; name its skeleton with asf=")
    return max(mine, key=lambda p: len(p.stem)) if mine else found[0]


def _head(data: bytes, radian: float, path) -> tuple[int, float]:
    """The byte where the first frame begins, and radians in one unit of angle."""
    start = line = 0
    while start < len(data):
        line += 1
        stop = data.find(b"\n", start) + 1 or len(data)
        content = data[start:stop].strip()
        if content.upper() in (b":DEGREES", b":RADIANS"):
            radian = _angle(content[1:].decode(), path, line)
        elif content and not content.startswith((b"#", b":")):
            if not content.isdigit():
                fail(path, line, f"'{token_at(data, start)}' where the number of the first frame should stand")
            return start, radian
        start = stop
    fail(path, line, "the file holds zero frames; at least one is needed")


def _layout(data: bytes, start: int, acclaim: AcclaimSkeleton, path
            ) -> list[tuple[str, tuple[str, ...], int]]:
    """The bones of the first frame in the file's order: name, channels, joint."""
    line = line_at(data, start)
    bones: list[tuple[str, tuple[str, ...], int]] = []
    skeleton = acclaim.skeleton
    first = True
    while start < len(data):
        stop = data.find(b"\n", start) + 1 or len(data)
        words = data[start:min(stop, start + 1000)].split()
        if words and not first:
            if words[0].isdigit():
                break
            name = words[0].decode("utf-8", "replace")
            if name not in skeleton:
                fail(path, line, f"bone '{name[:40]}' is not in the skeleton: does the .asf belong to it?")
            dofs = acclaim.dofs[skeleton.index(name)]
            if name in (bone for bone, _, _ in bones):
                fail(path, line, f"bone '{name}' comes twice in one frame")
            if len(words) - 1 != len(dofs):
                fail(path, line, f"bone '{name}' has {len(words) - 1} values, but {len(dofs)} channels "
                     f"({' '.join(dofs) or 'none'}) in its skeleton")
            bones.append((name, dofs, skeleton.index(name)))
        first = first and not words
        start, line = stop, line + 1
    for joint, dofs in enumerate(acclaim.dofs):
        if dofs and joint not in (j for _, _, j in bones):
            fail(path, line - 1, f"the first frame lacks bone '{skeleton.names[joint]}' of the skeleton")
    return bones


def _frames(data: bytes, start: int, bones: list[tuple[str, int]], path) -> np.ndarray:
    """The values of all frames (T, channels); every frame must be laid out like the first."""
    names = [name.encode() for name, _ in bones]
    bounds = np.concatenate([[0], np.cumsum([len(name) for name in names])])
    counts = np.array([count for _, count in bones])
    columns = int(counts.sum())
    room = min((len(data) - start) // (2 * columns), data.count(b"\n", start) // (1 + len(bones))) + 1
    out = np.empty((room, columns))
    rows, code, position, bone = _fill(np.frombuffer(data, np.uint8), start,
                                       np.frombuffer(b"".join(names), np.uint8), bounds, counts, out)
    if code == _OK:
        return out[:rows]
    line, word = line_at(data, position), token_at(data, position)
    what = f"bone '{bones[bone][0]}'"
    if code == _CUT:
        fail(path, line, f"the file ends within frame {rows + 1}, before {what}: was it truncated?")
    if code == _NO_FRAME:
        fail(path, line, f"'{word}' where the number of frame {rows + 1} should stand")
    if code == _OTHER_BONE:
        fail(path, line, f"'{word}' where {what} should stand, as in the first frame")
    if code == _BAD_NUMBER:
        fail(path, line, f"'{word}' among the values of {what} is not a finite number")
    fail(path, line, f"{what} needs {counts[bone]} values in its line")


@njit(cache=True)
def _fill(buffer, i, names, bounds, counts, out):
    """Fill `out`; return (frames, code, the byte that the code speaks of, which bone)."""
    n, frame = len(buffer), 0
    while True:
        while i < n and (is_space(buffer[i]) or buffer[i] == 10):
            i += 1
        if i == n:
            return frame, _OK, i, 0
        first = i
        while i < n and 48 <= buffer[i] <= 57:
            i += 1
        digits = i - first
        while i < n and is_space(buffer[i]):
            i += 1
        if digits == 0 or frame == len(out) or (i < n and buffer[i] != 10):
            return frame, _NO_FRAME, first, 0
        column = 0
        for bone in range(len(counts)):
            while i < n and (is_space(buffer[i]) or buffer[i] == 10):
                i += 1
            if i == n:
                return frame, _CUT, i, bone
            first = i
            for k in range(bounds[bone], bounds[bone + 1]):
                if i == n or buffer[i] != names[k]:
                    return frame, _OTHER_BONE, first, bone
                i += 1
            if i < n and not (is_space(buffer[i]) or buffer[i] == 10):
                return frame, _OTHER_BONE, first, bone
            for _ in range(counts[bone]):
                while i < n and is_space(buffer[i]):
                    i += 1
                if i == n or buffer[i] == 10:
                    return frame, _BAD_COUNT, first, bone
                value, behind, good = parse_number(buffer, i)
                if not good:
                    return frame, _BAD_NUMBER, i, bone
                out[frame, column] = value
                column += 1
                i = behind
            while i < n and is_space(buffer[i]):
                i += 1
            if i < n and buffer[i] != 10:
                return frame, _BAD_COUNT, first, bone
        frame += 1
