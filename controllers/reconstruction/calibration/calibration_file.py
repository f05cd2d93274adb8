"""A calibration in a file, for the next day: TOML that people can read.

    [room]
    heading = 12.5                    # how the world is turned to it [degrees]
    shift = [0.1, 0.3]                # … and moved, x and z [m], lengths as of a standard body
    level = 0.0                       # of its floor [m], and how much higher it was found to be
    floor = 0.01
    size = 1.02                       # of the performer, over the standard body's

    [bones]                           # of the performer [m], as of a standard body
    LeftArm = [0.145, 0.0, -0.03]     # … and so on

    [points.lwrist]                   # a tracker's point, by name
    offset = [0.02, 0.05, -0.01]      # where it is from its joint [m], as of a standard body, in the joint's frame
    mount = [0.0, 90.0, 0.0]          # how the joint is turned in the tracker's frame, rotation vectors [degrees]: as told in the end …
    stood = [0.0, 85.0, 0.0]          # … and as standing told
    unsure = 0.03                     # a standard deviation of the offset [m]
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from ...body import exp, log
from ...files import printable, reason, whole
from ..control_points import ControlPoints
from ..live import SIZES, StreamError, read_tables
from ..pose_vector import SKELETON
from .stood import JOINTS, WORN, Stood
from .wearing_trackers import Wearer, slots
from .worn import Calibration

_FAR, _TURN = 100.0, 360.0
"""Nothing in a room is farther away [m], no rotation vector longer [degrees]."""
_ALIKE = 0.2
"""No bone ends farther [m] from where the standard body's does, lengths as of a standard body."""


def save(path: str | Path, wearer: Wearer) -> None:
    """Write how somebody wears trackers. StreamError if that can't be."""
    known, ground = wearer.known, wearer.ground
    lines = ["# How somebody wears trackers; written by Gambol. Without this file it is told anew.", "[room]",
             f"heading = {math.degrees(ground[2]):.4f}", f"shift = {_row(ground[:2])}", f"level = {wearer.level:.5f}", f"floor = {known.floor:.5f}",
             f"size = {1.0 / known.stood.scale[0]:.5f}", "", "[bones]"]
    lines += [f"{name} = {_row(bone)}" for name, bone in zip(SKELETON.names[1:], known.bones[1:], strict=True)]
    for name, s in zip(wearer.controls.names, slots(wearer.controls), strict=True):
        lines += ["", f'[points."{name}"]', f"offset = {_row(known.offsets[s])}", f"mount = {_row(np.degrees(log(known.mounts[s])))}",
                  f"stood = {_row(np.degrees(log(known.stood.mounts[0, s])))}", f"unsure = {known.unsure[1][s]:.4f}"]
    try:
        with whole(Path(path)) as own:
            own.write_text("\n".join(lines) + "\n", encoding="utf-8")
    except OSError as error:
        raise StreamError(f"{path}: can't be written: {reason(error)}") from None


def load(path: str | Path, controls: ControlPoints) -> Wearer:
    """Who wears trackers on these points as a file says. StreamError, naming file and field, for anything else."""
    table = read_tables(path)
    room, bones, points = (_table(path, table.get(name), name) for name in ("room", "bones", "points"))
    heading, level, floor, size = (float(_numbers(path, f"room.{name}", room.get(name), 1, most)[0])
                                   for name, most in (("heading", 3600.0), ("level", _FAR), ("floor", 1.0), ("size", _FAR)))
    if not SIZES[0] <= size <= SIZES[1]:
        raise StreamError(f"{path}: room.size: {size:g} is nobody's; it lies between {SIZES[0]:g} and {SIZES[1]:g}")
    shift = _numbers(path, "room.shift", room.get("shift"), 2, _FAR)
    if set(points) != set(controls.names):
        raise StreamError(f"{path}: points: it is of {printable(', '.join(points))}; trackers are on {', '.join(controls.names)}: "
                          "name another file, and stand anew")
    if not set(controls.joints) <= set(JOINTS):
        raise StreamError(f"{path}: points: trackers are calibrated on {', '.join(WORN)} alone")
    offsets, unsure = np.zeros((len(WORN), 3)), np.zeros(len(WORN))
    mounts, stood = np.tile(np.eye(3), (len(WORN), 1, 1)), np.tile(np.eye(3), (len(WORN), 1, 1))
    for name, s in zip(controls.names, slots(controls), strict=True):
        own = _table(path, points[name], f"points.{name}")
        offsets[s] = _numbers(path, f"points.{name}.offset", own.get("offset"), 3, 1.0)
        mounts[s], stood[s] = (exp(np.radians(_numbers(path, f"points.{name}.{kind}", own.get(kind), 3, _TURN))) for kind in ("mount", "stood"))
        unsure[s] = _numbers(path, f"points.{name}.unsure", own.get("unsure"), 1, 1.0, least=0.0)[0]
    limbs = np.array([SKELETON.offsets[0], *(_numbers(path, f"bones.{name}", bones.get(name), 3, 1.0) for name in SKELETON.names[1:])])
    for name, away in zip(SKELETON.names, np.linalg.norm(limbs - SKELETON.offsets, axis=-1), strict=True):
        if away > _ALIKE:
            raise StreamError(f"{path}: bones.{name}: ends {100 * away:.0f} cm from where a standard body's does, and so does nobody's")
    there = np.isin(JOINTS, controls.joints)
    known = Calibration(Stood(np.zeros(1), np.array([1.0 / size]), np.zeros(1, int), offsets[None], stood[None], there[None]), limbs, offsets, mounts,
                        floor, (0.0, unsure, 0.0), 1)
    return Wearer(controls, known, np.array([*shift, math.radians(heading)]), level, kept=True)


def _row(numbers: np.ndarray) -> str:
    return "[" + ", ".join(f"{number:.5f}" for number in numbers) + "]"


def _table(path: str | Path, found: Any, name: str) -> dict[str, Any]:
    if not isinstance(found, dict):
        raise StreamError(f"{path}: {name}: needs a table [{name}]")
    return found


def _numbers(path: str | Path, name: str, found: Any, count: int, most: float, least: float | None = None) -> np.ndarray:
    """So many numbers, none larger than `most`, nor smaller than `least`, -most by default. StreamError, naming the field, for anything else."""
    least = -most if least is None else least
    rows = [found] if count == 1 else found
    if not (isinstance(rows, list) and len(rows) == count and
            all(isinstance(one, (int, float)) and not isinstance(one, bool) and least <= one <= most for one in rows)):
        wanted = "a number" if count == 1 else f"{count} numbers in brackets"
        raise StreamError(f"{path}: {printable(name)}: needs {wanted}, from {least:g} to {most:g}")
    return np.array(rows, float)
