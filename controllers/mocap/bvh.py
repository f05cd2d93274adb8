"""Biovision files: a hierarchy of joints, then one line of channel values a frame."""

from __future__ import annotations

import re
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from ..body import Clip, Skeleton
from ..files import whole
from .bvh_header import read_header
from .joint_names import carriers
from .parsing import fail, read_bytes, table, turns


def read_bvh(path) -> Clip:
    """The motion of a BVH file, raw: its own units, axes, dummy joints and end sites.

    Rotation channels may come in any order and number, joint by joint. The root's place is its
    position channels alone, its OFFSET stays in skeleton.offsets[0] (see `load`, which judges
    whether to add it); without position channels it is the OFFSET. Where another joint carries the
    whole body, as the hips do below a reference joint, its position channels, unless all are zero,
    move the root. Any other joint's, unless all are zero, replace its OFFSET by their median over
    time, because the bones of a Clip are rigid; a warning says so where they vary by more than 1 %
    of the longest bone.
    MotionFileError, naming file and line, for anything that is not sound BVH.
    """
    data = read_bytes(path)
    joints, frames, frame_time, body = read_header(data, path)
    channels = [(j, kind, axis) for j, joint in enumerate(joints) for kind, axis in joint.channels]
    if not channels:
        fail(path, joints[0].line, "no joint has any channel")
    values = table(data, body, len(channels), frames, path)
    offsets = np.stack([joint.offset for joint in joints])
    root = np.tile(offsets[0], (frames, 1))
    for c, (j, kind, axis) in enumerate(channels):
        if kind == "position" and j == 0:
            root[:, axis] = values[:, c]
    turning = np.array([(c, j, axis) for c, (j, kind, axis) in enumerate(channels) if kind == "rotation"],
                       np.int64).reshape(-1, 3)
    quaternions = turns(values * (np.pi / 180.0), turning[:, 0], turning[:, 1], np.eye(3)[turning[:, 2]], len(joints))
    ends = [(j, end) for j, joint in enumerate(joints) for end in joint.ends]
    skeleton = Skeleton(tuple(joint.name for joint in joints),
                        np.array([joint.parent for joint in joints]), offsets,
                        np.array([j for j, _ in ends], np.int64), np.array([end for _, end in ends]))
    if places := _places(channels, values, offsets):
        whole = carriers(skeleton)
        root += _travel(skeleton, whole, places, quaternions)
        skeleton = _settled(skeleton, {j: track for j, track in places.items() if j not in whole}, path)
    return Clip(Path(path).stem, skeleton, frame_time, root, quaternions)


def _places(channels, values: np.ndarray, offsets: np.ndarray) -> dict[int, np.ndarray]:
    """Where (T, 3) the position channels of joints below the root put them; none that are all zero."""
    places = {}
    for j in sorted({j for j, kind, _ in channels if kind == "position" and j > 0}):
        mine = [(c, axis) for c, (i, kind, axis) in enumerate(channels) if i == j and kind == "position"]
        track = values[:, [c for c, _ in mine]]
        if track.any():
            places[j] = np.tile(offsets[j], (len(values), 1))
            places[j][:, [axis for _, axis in mine]] = track
    return places


def _travel(skeleton: Skeleton, whole: tuple[int, ...], places: dict[int, np.ndarray], quaternions: np.ndarray) -> np.ndarray:
    """How far (T, 3) the carriers of the whole body move it beside the root: all below them is where the file says."""
    travel, turn = np.zeros((len(quaternions), 3)), Rotation.from_quat(quaternions[:, 0])
    for j in whole[1:]:
        if j in places:
            travel += turn.apply(places[j] - skeleton.offsets[j])
        turn = turn * Rotation.from_quat(quaternions[:, j])
    return travel


def _settled(skeleton: Skeleton, places: dict[int, np.ndarray], path) -> Skeleton:
    """The skeleton with the offsets of some joints replaced by the median of their places."""
    offsets = skeleton.offsets.copy()
    longest = np.linalg.norm(offsets[1:], axis=-1).max()
    stretching = []
    for j, track in places.items():
        offsets[j] = np.median(track, axis=0)
        if np.ptp(track, axis=0).max() > 0.01 * longest:
            stretching.append(skeleton.names[j])
    if stretching:
        warnings.warn(f"{path}: the bones to {', '.join(stretching)} change their length; a clip's "
                      "bones are rigid, so the median over time is taken", stacklevel=3)
    return replace(skeleton, offsets=offsets)


def write_bvh(clip: Clip, path, order: str = "ZXY", unit: float = 0.01) -> None:
    """Write a clip as BVH; the file appears whole or not at all.

    order: in which order the three rotation channels stand, which is the order of the intrinsic
    turns. unit: metres in one unit of the file; 0.01 writes centimetres. White space and braces in
    joint names become underscores. The root's OFFSET is written as zero, so that a reader that adds
    it and one that doesn't agree. ValueError for another order, for what is no clip, or numbers that are not finite.
    """
    if not isinstance(clip, Clip):
        raise ValueError(f"write_bvh(clip, path) takes a Clip first, not {type(clip).__name__}")
    if not isinstance(order, str) or sorted(order.upper()) != ["X", "Y", "Z"]:
        raise ValueError(f"the order of rotations is X, Y and Z in some order, not {order!r}")
    for name, value in (("frame_time", clip.frame_time), ("unit", unit)):
        if not isinstance(value, float | int | np.floating | np.integer) or not 0.0 < value < np.inf:
            raise ValueError(f"{name} is a number above zero, not {value!r}")
    if np.shape(clip.root) != (len(clip), 3) or np.shape(clip.quaternions) != (len(clip), len(clip.skeleton), 4):
        raise ValueError(f"{len(clip)} frames of {len(clip.skeleton)} joints have a root ({len(clip)}, 3) and quaternions ({len(clip)}, {len(clip.skeleton)}, 4); "
                         f"got {np.shape(clip.root)} and {np.shape(clip.quaternions)}")
    order = order.upper()
    lines, sequence = _hierarchy(clip.skeleton, order, unit)
    angles = Rotation.from_quat(clip.quaternions).as_euler(order, degrees=True, suppress_warnings=True)
    angles = np.unwrap(angles, period=360.0, axis=0)  # editors draw curves through the channels
    values = np.concatenate([clip.root / unit, angles[:, sequence].reshape(len(clip), -1)], axis=1)
    if not np.isfinite(values).all():
        raise ValueError(f"the clip '{clip.name}' holds numbers that are not finite")
    row = " ".join(["%.6f"] * values.shape[1])
    lines += ["MOTION", f"Frames: {len(clip)}", f"Frame Time: {clip.frame_time:.9g}"]
    lines += [row % tuple(frame) for frame in values.tolist()]
    with whole(path) as part:
        part.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _hierarchy(skeleton: Skeleton, order: str, unit: float) -> tuple[list[str], list[int]]:
    """The header's lines, and the joints in the order in which they stand there: depth first."""
    children = [np.flatnonzero(skeleton.parents == j).tolist() for j in range(len(skeleton))]
    turning = " ".join(f"{axis}rotation" for axis in order)
    lines, sequence, depth = ["HIERARCHY"], [], 0
    stack = [(0, False)]  # joint, whether it only remains to be closed
    while stack:
        j, done = stack.pop()
        if done:
            depth -= 1
            lines.append("\t" * depth + "}")
            continue
        tab, name = "\t" * depth, re.sub(r"[\s{}]+", "_", skeleton.names[j])
        offset = skeleton.offsets[j] / unit if j else np.zeros(3)
        placing = "3" if j else "6 Xposition Yposition Zposition"
        lines += [f"{tab}{'JOINT' if j else 'ROOT'} {name}", tab + "{",
                  f"{tab}\tOFFSET {_three(offset)}", f"{tab}\tCHANNELS {placing} {turning}"]
        for e in np.flatnonzero(skeleton.end_parents == j):
            lines += [f"{tab}\tEnd Site", f"{tab}\t{{",
                      f"{tab}\t\tOFFSET {_three(skeleton.end_offsets[e] / unit)}", f"{tab}\t}}"]
        sequence.append(j)
        stack.append((j, True))
        stack += [(child, False) for child in reversed(children[j])]
        depth += 1
    return lines, sequence


def _three(vector) -> str:
    return " ".join(f"{value:.8g}" for value in vector)
