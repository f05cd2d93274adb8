"""Any motion file as a clip in metres with Y up: what its units and axes are, judged from the body in it."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from ..body import Clip, Skeleton, between, forward_kinematics
from .acclaim_motion import read_amc
from .bvh import read_bvh
from .parsing import MotionFileError, fail

UNITS = (1.0, 0.1, 0.01, 0.001, 0.3048, 0.0254, 0.0254 / 0.45)
"""Metres in one unit: m, dm, cm, mm, foot, inch, and the 1/0.45 inch of CMU's recordings."""
OTHERS = ".fbx", ".c3d", ".glb", ".gltf", ".vrm", ".trc", ".npz", ".dae", ".usd", ".usda", ".usdz", ".blend"
"""What else motion is kept in."""
LENGTHS = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "ft": 0.3048, "in": 0.0254}
"""Metres in units, by their usual names."""
LEG = 0.856
"""Thigh and shin of an adult [m], `LEG_PART` of the stature: de Leva 1996."""
METRIC = 1.0, 0.01, 0.001
"""The likelier units: where a human is one in them, he is seldom measured in another."""
SHORTEST, SMALL, LONGEST = 0.236, 0.41, 1.53
"""No leg [m] is shorter, as of one 0.48 m tall, or longer, as of one of 3.1 m; and a shorter one than the second is as long as an adult's would be in inches."""
ADULT = 0.6, 1.05
"""An adult's leg [m]."""
LEG_PART = 0.492
LEVEL, GONE = 0.25, 0.75
"""In leg lengths: the lowest joint of who goes over a floor keeps its height to within the first, and a way is longer than the second."""
LIES = 0.25
"""In leg lengths: the lowest joint of who lies on a floor is no higher over it."""
UP = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1), "-x": (-1, 0, 0), "-y": (0, -1, 0), "-z": (0, 0, -1)}


@dataclass(frozen=True)
class Detected:
    """How a raw clip is to be read.

    up: the axis that points up, "x" … "-z". scale: metres in one unit. tpose: how many calibration
    frames lead the motion. root_offset: whether the root's OFFSET adds to its position channels.
    leg: thigh and shin [m], and the stature [m] that goes with them; nan without feet. floor: where
    the lowest joint stands [m]: the 5th percentile over time.
    """

    up: str
    scale: float
    tpose: int
    root_offset: bool
    leg: float
    stature: float
    floor: float


def read(path, *, asf=None) -> Clip:
    """A raw clip from .bvh or .amc, in the file's own units and axes (AMC: metres).

    asf: the skeleton of an AMC file, by default the one beside it. MotionFileError for other endings.
    """
    try:
        ending = Path(path).suffix.lower()
    except TypeError:
        raise MotionFileError(f"a motion file is named by a path, got {path!r}") from None
    if ending == ".bvh":
        return read_bvh(path)
    if ending == ".amc":
        return read_amc(path, asf)
    instead = "; name the .amc file that goes with it" if ending == ".asf" else "; export it as BVH" if ending in OTHERS else ""
    fail(path, None, "is a folder: name a .bvh or .amc file in it" if Path(path).is_dir() else f"'{ending}' is no motion file: .bvh and .amc are read{instead}")


def load(path, *, up: str | None = None, scale: float | None = None, tpose: int | None = None,
         root_offset: bool | None = None, asf=None) -> Clip:
    """A motion file as a clip in metres, Y up, without calibration frames; where it faces is left alone.

    Whatever is not given is judged by `detect`; the arguments are as in `Detected`.
    MotionFileError for a file that can't be read or judged; ValueError for an unknown `up`.
    """
    raw = read(path, asf=asf)
    try:
        found = detect(raw, up=up, scale=scale, tpose=tpose, root_offset=root_offset)
    except MotionFileError as error:
        fail(path, None, str(error))
    return standardise(raw, found)


def detect(clip: Clip, *, up: str | None = None, scale: float | None = None, tpose: int | None = None,
           root_offset: bool | None = None) -> Detected:
    """Judge a raw clip; what is given is taken for granted.

    The scale is the unit that brings thigh and shin nearest to an adult's. Up is Z if the body,
    from feet to head, stands along +Z more than along any other axis, unless it crawls or lies on the floor that way; any other axis if it stands along that, in its zero pose, too; and Y otherwise. Calibration
    frames are cut off from the motion by a jump within the first two steps. The root's OFFSET is
    added only where that brings a body from far off the floor onto it.
    MotionFileError if no scale is given and none fits; ValueError for an unknown `up`, and a scale that is none.
    """
    leg = leg_length(clip.skeleton)
    if scale is None:
        scale = _unit(leg, clip.skeleton)
    elif not (isinstance(scale, float | int | np.floating | np.integer) and 0.0 < scale < np.inf):
        raise ValueError(f"a scale is metres in one unit, above zero, not {scale!r}")
    tpose = _calibration_frames(clip) if tpose is None else int(tpose)
    moving = clip.slice(min(tpose, len(clip) - 1), len(clip))
    positions, _ = moving.kinematics()
    up = _up(clip.skeleton, positions) if up is None else up
    height = scale * (positions @ _direction(up))
    floor = float(np.percentile(height.min(axis=-1), 5))
    raised = floor + scale * float(clip.skeleton.offsets[0] @ _direction(up))
    if root_offset is None:
        root_offset = bool(abs(floor) > 0.5 * leg * scale and abs(raised) < 0.2 * leg * scale)
    return Detected(up, scale, tpose, root_offset, leg * scale, leg * scale / LEG_PART,
                    raised if root_offset else floor)


def standardise(clip: Clip, found: Detected) -> Clip:
    """The clip in metres, Y up, without its calibration frames. A clip keeps one frame at least."""
    clip = clip.slice(min(found.tpose, len(clip) - 1), len(clip))
    skeleton, turn = clip.skeleton, between(_direction(found.up), np.array([0.0, 1.0, 0.0]))
    root = clip.root + skeleton.offsets[0] if found.root_offset else clip.root
    # axes change everywhere, not at the root alone, so that the zero pose stands upright, too
    quaternions = clip.quaternions
    if found.up != "y":
        quaternions = np.concatenate([quaternions[..., :3] @ turn.T, quaternions[..., 3:]], -1)
    skeleton = Skeleton(skeleton.names, skeleton.parents, skeleton.offsets @ turn.T * found.scale,
                        skeleton.end_parents, skeleton.end_offsets @ turn.T * found.scale)
    return replace(clip, skeleton=skeleton, root=root @ turn.T * found.scale, quaternions=quaternions)


def leg_length(skeleton: Skeleton) -> float:
    """Thigh and shin in the skeleton's own unit: the two bones above the ankles; nan without feet."""
    lengths = np.linalg.norm(skeleton.offsets, axis=-1)
    legs = []
    for joint in _joints(skeleton, "foot|ankle"):
        bones = []
        while joint > 0 and len(bones) < 2:
            if lengths[joint] > 1e-6 * lengths.max():  # dummy joints sit where their parents do
                bones.append(lengths[joint])
            joint = skeleton.parents[joint]
        legs.append(sum(bones))
    return float(np.mean(legs)) if legs else np.nan


def unit_of(leg: float) -> float:
    """Metres in the unit in which thigh and shin together are a human's: metres, centimetres or millimetres where that is one of 0.83 to 3.1 m, else the unit in
    which he is most like an adult, else, of 0.48 m on, again one of the three. A leg of 25 to 41 units is an adult's in inches, if nobody says
    that it is a small one's in centimetres. MotionFileError where it is in none."""
    metric = [unit for unit in METRIC if SHORTEST < unit * leg < LONGEST]
    best = min(UNITS, key=lambda unit: abs(np.log(unit * max(leg, 1e-12) / LEG)))
    if metric and (metric[0] * leg > SMALL or not ADULT[0] < best * leg < ADULT[1]):
        return metric[0]
    if not 0.4 < best * leg < 1.4:
        raise MotionFileError(f"a leg of {leg:.4g} units is no human's, in metres, centimetres, millimetres, feet or inches: tell its unit, if it is another")
    return best


def _joints(skeleton: Skeleton, pattern: str) -> list[int]:
    """Joints whose name matches, the first of each branch."""
    fits = [re.search(pattern, name, re.IGNORECASE) is not None for name in skeleton.names]
    return [j for j, fit in enumerate(fits) if fit and (j == 0 or not fits[skeleton.parents[j]])]


def _unit(leg: float, skeleton: Skeleton) -> float:
    if not np.any(skeleton.offsets[1:]):
        raise MotionFileError("all offsets of its joints are zero: its bones have no length")
    if not leg > 0:
        names = ", ".join(skeleton.names[:6]) + ", …" * (len(skeleton) > 6)
        raise MotionFileError(f"no foot or ankle by which to judge the unit among its joints ({names}); wanted are names such as "
                              "LeftFoot, L_Ankle or mixamorig:LeftFoot")
    return unit_of(leg)


def _direction(up: str) -> np.ndarray:
    if up not in UP:
        raise ValueError(f"up is one of {', '.join(UP)}, not '{up}'")
    return np.array(UP[up], float)


def _up(skeleton: Skeleton, positions: np.ndarray) -> str:
    heads, feet = _joints(skeleton, "head|neck"), _joints(skeleton, "foot|ankle|toe")
    if not heads or not feet:
        return "y"
    stand = np.median(positions[:, heads].mean(1) - positions[:, feet].mean(1), axis=0)
    rest, _ = forward_kinematics(skeleton, np.zeros(3), np.tile(np.eye(3), (len(skeleton), 1, 1)))
    stood = _along(rest[heads].mean(0) - rest[feet].mean(0))
    if stand[2] > max(abs(stand[0]), abs(stand[1])):
        leg = leg_length(skeleton)
        return "y" if stood == "y" and (_crawls(positions, leg) or _lies(positions, leg)) else "z"
    way = _along(stand)  # who lies, or stands on his hands, in a file of Y up does not do so in its zero pose
    return way if way == stood else "y"


def _crawls(positions: np.ndarray, leg: float) -> bool:
    """Whether a body (T, J, 3) whose head is farther along Z than its feet goes along Z over a floor across Y: what is lowest of it stays so high along Y, and not along Z."""
    y, z = (np.ptp(np.percentile(positions[..., axis].min(-1), [5, 95])) for axis in (1, 2))
    return bool(y < LEVEL * leg and z > GONE * leg)


def _lies(positions: np.ndarray, leg: float) -> bool:
    """Whether a body (T, J, 3) whose head is farther along Z than its feet lies on the floor at 0 across Y, and does not stand on one at 0 across Z."""
    across, along = (float(np.percentile(positions[..., axis].min(-1), 5)) for axis in (1, 2))
    return 0.0 <= across < LIES * leg and abs(along) > LEVEL * leg


def _along(vector: np.ndarray) -> str:
    """The axis that a vector (3,) is most nearly along."""
    return max(UP, key=lambda name: float(vector @ UP[name]))


def _calibration_frames(clip: Clip) -> int:
    """Frames before the last jump among the first two steps.

    A jump turns the joints by 8° on average, and 8 times as far as the steps of the first second
    do: from a T-pose into motion it is 15° or more, while a recording's own flaws stay below 7°.
    """
    start = clip.quaternions[:1 + max(8, round(1.0 / clip.frame_time))]
    if len(start) < 8:
        return 0
    turn = Rotation.from_quat(start[1:]) * Rotation.from_quat(start[:-1]).inv()
    steps = np.degrees(turn.magnitude()).mean(axis=-1)
    jumps = np.flatnonzero(steps[:2] > max(8.0, 8 * np.median(steps)))
    return int(jumps[-1]) + 1 if len(jumps) else 0
