"""Biovision files: a hierarchy of joints, then one line of channel values a frame."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from ..body import Clip, Skeleton
from .text import decode, fail, line_at, number, numbers, read_bytes, table, turns, whole

_CHANNELS = {f"{axis}{kind}".lower(): (kind, i) for kind in ("rotation", "position")
             for i, axis in enumerate("XYZ")}


@dataclass
class _Joint:
    name: str
    parent: int
    line: int
    offset: np.ndarray | None = None
    channels: list[tuple[str, int]] | None = None
    ends: list[np.ndarray] = field(default_factory=list)


def read_bvh(path) -> Clip:
    """The motion of a BVH file, raw: its own units, axes, dummy joints and end sites.

    Rotation channels may come in any order and number, joint by joint. The root's place is its
    position channels alone, its OFFSET stays in skeleton.offsets[0] (see `load`, which judges
    whether to add it); without position channels it is the OFFSET. Another joint's position
    channels, unless all are zero, replace its OFFSET by their median over time, because the bones
    of a Clip are rigid; a warning says so where they vary by more than 1 % of the longest bone.
    MotionFileError, naming file and line, for anything that is not sound BVH.
    """
    data = read_bytes(path)
    lines, body = _header(data, path)
    joints, at = _hierarchy(lines, path)
    frames, frame_time = _motion(lines[at:], path)
    columns = [(j, kind, axis) for j, joint in enumerate(joints) for kind, axis in joint.channels]
    if not columns:
        fail(path, joints[0].line, "no joint has any channel")
    values = table(data, body, len(columns), frames, path)
    turning = [(c, j, axis) for c, (j, kind, axis) in enumerate(columns) if kind == "rotation"]
    offsets = np.stack([joint.offset for joint in joints])
    root = np.tile(offsets[0], (frames, 1))
    for c, (j, kind, axis) in enumerate(columns):
        if kind == "position" and j == 0:
            root[:, axis] = values[:, c]
    _rigid(joints, columns, values, offsets, path)
    index = np.array(turning, np.int64).reshape(-1, 3)
    values *= np.pi / 180.0
    quaternions = turns(values, index[:, 0], index[:, 1], np.eye(3)[index[:, 2]], len(joints))
    ends = [(j, end) for j, joint in enumerate(joints) for end in joint.ends]
    skeleton = Skeleton(tuple(joint.name for joint in joints),
                        np.array([joint.parent for joint in joints]), offsets,
                        np.array([j for j, _ in ends], np.int64), np.array([end for _, end in ends]))
    return Clip(Path(path).stem, skeleton, frame_time, root, quaternions)


def _header(data: bytes, path) -> tuple[list[tuple[int, list[str]]], int]:
    """The header's words by line, [(line, words)], and the byte at which the frames begin."""
    motion = data.upper().find(b"MOTION")
    stop = data.lower().find(b"frame time", motion) if motion >= 0 else -1
    stop = data.find(b"\n", stop) + 1 if stop >= 0 else 0
    text = decode(data[:stop] if stop else data, path)
    spaced = text.replace("{", " { ").replace("}", " } ")
    lines = [(i, words) for i, line in enumerate(spaced.split("\n"), 1) if (words := line.split())]
    return lines, stop if stop else len(data)


def _hierarchy(lines, path) -> tuple[list[_Joint], int]:
    """Joints in file order, and how many of the lines they took (MOTION comes next)."""
    words = [(word, i, k) for k, (i, line) in enumerate(lines) for word in line]
    words.append(("", lines[-1][0], len(lines)))
    if words[0][0].upper() != "HIERARCHY":
        fail(path, words[0][1], f"a BVH file begins with HIERARCHY, not '{words[0][0][:40]}'")
    joints: list[_Joint] = []
    known: dict[str, int] = {}
    open_: list[int] = []  # the joints whose brace is open; -1 for an end site
    n = 1

    def take(count):
        nonlocal n
        taken = [word for word, _, _ in words[n:n + count]]
        n += count
        return taken

    def offset(what):
        return numbers([w for w in take(3) if w not in ("{", "}", "")], 3, f"the OFFSET of {what}", path, line)

    while True:
        word, line, k = words[n]
        n += 1
        kind = word.upper()
        here = joints[open_[-1]] if open_ and open_[-1] >= 0 else None
        if kind in ("ROOT", "JOINT", "END"):
            name = []
            while words[n][0] not in ("{", ""):
                name += take(1)
            if words[n][0] != "{":
                fail(path, line, f"no '{{' after {word} {' '.join(name)[:40]}")
            n += 1
            if kind == "ROOT" and joints:
                fail(path, line, "a second ROOT: a file holds one skeleton")
            if kind != "ROOT" and here is None:
                fail(path, line, f"{word} {' '.join(name)[:40]} stands outside any joint's braces")
            if kind == "END":
                _complete(here, path, line)
                open_.append(-1)
                continue
            name = " ".join(name)
            if not name:
                fail(path, line, f"{word} needs a name")
            if name in known:
                fail(path, line, f"joint '{name}' was already declared in line {known[name]}")
            if here is not None:
                _complete(here, path, line)
            known[name] = line
            joints.append(_Joint(name, open_[-1] if open_ else -1, line))
            open_.append(len(joints) - 1)
        elif kind == "OFFSET" and open_:
            if here is None:
                owner = joints[open_[-2]]
                owner.ends.append(offset(f"the End Site of '{owner.name}'"))
            else:
                here.offset = offset(f"'{here.name}'")
        elif kind == "CHANNELS" and here is not None:
            count = whole(take(1)[0], "the number of CHANNELS", path, line)
            here.channels = [_channel(w, here, count, path, line) for w in take(min(count, 7))]
            if count > 6 or len(set(here.channels) - {("rotation", i) for i in range(3)}) < sum(
                    kind == "position" for kind, _ in here.channels):
                fail(path, line, f"'{here.name}' declares {count} channels; there are at most "
                     "three positions, each once, and three rotations")
        elif word == "}" and open_:
            if here is not None:
                _complete(here, path, line)
            open_.pop()
        elif kind == "MOTION" and joints and not open_:
            return joints, k
        else:
            found = f"'{word[:40]}'" if word else "the end of the header"
            if open_:
                owner = joints[max(open_)]
                fail(path, line, f"{found} where JOINT, End Site, OFFSET, CHANNELS or '}}' should stand: "
                     f"'{owner.name}' of line {owner.line} is still open")
            fail(path, line, f"{found} where {'MOTION' if joints else 'ROOT'} should stand")


def _complete(joint: _Joint, path, line: int) -> None:
    if joint.offset is None:
        fail(path, line, f"joint '{joint.name}' of line {joint.line} has no OFFSET")
    if joint.channels is None:
        joint.channels = []


def _channel(word: str, joint: _Joint, count: int, path, line: int) -> tuple[str, int]:
    if word.lower() not in _CHANNELS:
        if word.upper() in ("JOINT", "END", "{", "}", "OFFSET", ""):
            fail(path, line, f"'{joint.name}' declares {count} CHANNELS but names fewer")
        fail(path, line, f"unknown channel '{word[:40]}': a channel is X, Y or Z with position or rotation")
    return _CHANNELS[word.lower()]


def _motion(lines, path) -> tuple[int, float]:
    """Frames and the frame time [s], from the lines MOTION, Frames: n, Frame Time: s."""
    words = [word for _, line in lines for word in line]
    at = [i for i, line in lines for _ in line]
    low = [word.lower().rstrip(":") for word in words] + [""] * 6
    words += ["nothing"] * 6
    at += [at[-1]] * 6
    if low[1] != "frames":
        fail(path, at[1], f"'Frames: n' should follow MOTION, not '{words[1][:40]}'")
    frames = whole(words[2], "the number of Frames", path, at[2])
    if frames == 0:
        fail(path, at[2], "the file holds zero frames; at least one is needed")
    if low[3:5] != ["frame", "time"]:
        fail(path, at[3], f"'Frame Time: seconds' should follow Frames, not '{words[3][:40]}'")
    frame_time = number(words[5], path, at[5])
    if frame_time <= 0:
        fail(path, at[5], f"the Frame Time must be above zero seconds, not {frame_time}")
    if len(lines) and sum(len(line) for _, line in lines) > 6:
        fail(path, at[6], f"'{words[6][:40]}' after the Frame Time: the frames begin on the next line")
    return frames, frame_time


def _rigid(joints, columns, values, offsets, path) -> None:
    """Let the position channels of other joints than the root replace their offsets, in place."""
    moving: dict[int, list[tuple[int, int]]] = {}
    for c, (j, kind, axis) in enumerate(columns):
        if kind == "position" and j > 0 and values[:, c].any():
            moving.setdefault(j, []).append((c, axis))
    stretching = []
    longest = np.linalg.norm(offsets[1:], axis=-1).max(initial=0.0)
    for j, channels in moving.items():
        for c, axis in channels:
            offsets[j, axis] = np.median(values[:, c])
            if np.ptp(values[:, c]) > 0.01 * longest:
                stretching.append(joints[j].name)
    if stretching:
        warnings.warn(f"{path}: the bones to {', '.join(dict.fromkeys(stretching))} change their "
                      "length; a clip's bones are rigid, the median is taken", stacklevel=3)
