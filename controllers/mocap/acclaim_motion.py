"""Acclaim motion (AMC): frame by frame, a line of channel values for every bone."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from ..body import Clip
from ..compiled import kernel
from .acclaim import AcclaimSkeleton, angle_unit, read_asf
from .parsing import fail, is_space, line_at, parse_number, read_bytes, token_at, turns

_OK, _NO_FRAME, _OTHER_BONE, _BAD_NUMBER, _BAD_COUNT, _CUT = range(6)


def read_amc(path, asf=None, fps: float = 120.0) -> Clip:
    """The motion of an AMC file in metres.

    asf: its skeleton (a path or what `read_asf` returned); by default the .asf in the same folder,
    the one whose name begins the motion's where there are several. fps: frames a second, which
    the format doesn't record. Angles are applied in the order of the channels, about fixed axes.
    Channels that move or stretch bones other than the root are read over: a Clip's bones are rigid.
    MotionFileError, naming file and line, for anything that is not sound or doesn't fit the skeleton.
    """
    data = read_bytes(path)
    asf = skeleton_of(path, asf)
    start, radian = _head(data, asf.radian, path)
    bones = _layout(data, start, asf, path)
    values = _frames(data, start, [(name, len(dofs)) for name, dofs, _ in bones], path)
    skeleton = asf.skeleton
    turning: list[tuple[int, int, np.ndarray]] = []  # column, joint, axis
    root = np.tile(skeleton.offsets[0], (len(values), 1))
    column = 0
    for _, dofs, joint in bones:
        # turns about fixed axes, one after another, are turns about moving axes in reverse
        for c, dof in reversed(list(enumerate(dofs, column))):
            if dof[0] == "r":
                turning.append((c, joint, asf.axes[joint][:, "xyz".index(dof[1])]))
            elif dof[0] == "t" and joint == 0:
                root[:, "xyz".index(dof[1])] += values[:, c] * asf.metre
        column += len(dofs)
    values *= radian
    columns, joints, axes = (np.array(part) for part in zip(*turning))
    quaternions = turns(values, columns, joints, axes, len(skeleton))
    if np.any(asf.axes[0] != np.eye(3)):  # the root's frame is its zero orientation, too
        zero = Rotation.from_matrix(asf.axes[0])
        quaternions[:, 0] = (Rotation.from_quat(quaternions[:, 0]) * zero).as_quat()
    return Clip(Path(path).stem, skeleton, 1.0 / fps, root, quaternions)


def skeleton_of(path, asf=None) -> AcclaimSkeleton:
    """The skeleton of an AMC file, as of `read_amc`."""
    if isinstance(asf, AcclaimSkeleton):
        return asf
    asf = Path(asf or _skeleton_beside(path))
    return _read_once(asf, asf.stat().st_mtime_ns) if asf.is_file() else read_asf(asf)


@lru_cache(maxsize=8)
def _read_once(asf: Path, _modified: int) -> AcclaimSkeleton:
    """One skeleton serves a folder of motions; read again when the file has changed."""
    return read_asf(asf)


def _skeleton_beside(path) -> Path:
    path = Path(path)
    found = sorted(p for p in path.parent.iterdir() if p.suffix.lower() == ".asf")
    mine = [p for p in found if path.stem.lower().startswith(p.stem.lower())]
    if len(found) != 1 and not mine:
        fail(path, None, f"{len(found) or 'no'} .asf files beside it; put its skeleton there, named like it, or name it with asf=")
    return max(mine, key=lambda p: len(p.stem)) if mine else found[0]


def _head(data: bytes, radian: float, path) -> tuple[int, float]:
    """The byte where the first frame begins, and radians in one unit of angle."""
    start = line = 0
    while start < len(data):
        line += 1
        stop = data.find(b"\n", start) + 1 or len(data)
        content = data[start:stop].strip()
        if content.upper() in (b":DEGREES", b":RADIANS"):
            radian = angle_unit(content[1:].decode(), path, line)
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
    if not any(dof[0] == "r" for dofs in acclaim.dofs for dof in dofs):
        fail(path, line, "its skeleton has no bone that turns (dof rx, ry or rz)")
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


@kernel
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
