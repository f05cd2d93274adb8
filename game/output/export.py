"""Motion out: what characters did, as BVH (a file each) or as one animated GLB that wears their bodies.

Both are metres-true, Y up, +Z ahead, at rest in T-pose, with the standard human's joint names; BVH
counts in centimetres, as its readers expect. Contacts go along in the GLB as custom data.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from gambol.controllers.body import Pose, Skeleton, forward_kinematics, local_rotations
from gambol.controllers.mocap import JUDGED, Moved, Reading

from .. import character as glb
from ..files import OutputError, output_file
from ..render import ARMS, Body, mannequin, scale_of, skin, worn
from ..scene import TINT
from ..world import RATE, World, pose_between
from .onto_bvh import READ, MovingRig, moving_rig, write_moved
from .recorder import motion_clip, write_motion

SUFFIXES = (".bvh", ".glb")


@dataclass(frozen=True, eq=False)
class Take:
    """What one character did. poses: one a frame. contacts: (T, 4) bool, left heel, left ball, right
    heel, right ball. tint: linear RGB. body: what it wore, None for the mannequin."""

    name: str
    skeleton: Skeleton
    poses: tuple[Pose, ...]
    contacts: np.ndarray
    tint: Sequence[float] = TINT
    body: Body | None = None


def takes(frames: Iterable[tuple[World, World, float]]) -> list[Take]:
    """What every character did in frames, each `alpha` (0 … 1) of the way between two worlds.

    Who joins later, or leaves, stands still until then, or from then on.
    """
    names: dict[str, Any] = {}
    poses: dict[str, list[Pose]] = {}
    contacts: dict[str, list[np.ndarray]] = {}
    count = 0
    for count, (before, after, alpha) in enumerate(frames, 1):
        earlier = {character.name: character.state for character in before.characters}
        for who in after.characters:
            start = earlier.get(who.name, who.state)
            pose = pose_between(start.pose, who.state.pose, alpha)
            names[who.name] = who
            _fill(poses.setdefault(who.name, []), count, pose)
            _fill(contacts.setdefault(who.name, []), count, (start if alpha < 0.5 else who.state).contacts)
    for name in names:
        _fill(poses[name], count, poses[name][-1])
        _fill(contacts[name], count, contacts[name][-1])
    return [Take(name, who.controller.skeleton, tuple(poses[name]), np.stack(contacts[name]), who.tint,
                 who.controller.body) for name, who in names.items()]


def _fill(kept: list, count: int, value: Any) -> None:
    kept.extend([value] * (count - len(kept)))


def sampled(moments: Iterable[Any], fps: Fraction | int | float) -> Iterable[tuple[World, World, float]]:
    """Frames at `fps` a second of a session's moments (`gambol.game.session.state.SessionState`), which are RATE a second."""
    number = 0
    for tick, moment in enumerate(moments):
        while (due := number * RATE / fps) <= tick + 1e-9:
            yield moment.before, moment.after, moment.fraction(min(max(due - tick + 1.0, 0.0), 1.0))
            number += 1


def checked(path: str | Path, names: Sequence[str] = ()) -> list[Path]:
    """The files that the motion of characters of these names goes into: all in one .glb, a .bvh each.

    OutputError, saying what would be right, where one can't be written.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise OutputError(f"{path}: motion goes into a file that ends in {' or '.join(SUFFIXES)}")
    if suffix == ".glb" or len(names) < 2:
        return [output_file(path, suffix)]
    return [output_file(path.with_name(f"{path.stem}-{name}{path.suffix}"), suffix) for name in names]


def write(path: str | Path, takes: Sequence[Take], fps: float = RATE) -> list[Path]:
    """Write takes at `fps` frames a second; the files that were written.

    .glb: all in one file. .bvh: one file each, NAME-CHARACTER.bvh where there are several.
    OutputError where nothing can be written, or where nothing was played.
    """
    paths = checked(path, [take.name for take in takes])
    if not takes or not len(takes[0].poses):
        raise OutputError(f"{path}: nothing was played yet that could be written")
    if paths[0].suffix.lower() == ".glb":
        return [glb.write(paths[0], [_actor(take) for take in takes], fps)]
    for take, own in zip(takes, paths):
        write_motion(motion_clip(take.name, take.skeleton, take.poses, fps), own)
    return paths


def chosen(takes: Sequence[Take], name: str | None) -> Take:
    """The take of whoever has that name, of the first one by default. OutputError, saying who there is, where nobody has it."""
    if name is None and takes:
        return takes[0]
    found = [take for take in takes if take.name == name]
    if not found:
        raise OutputError(f"nobody is called {name!r} here; there are {', '.join(take.name for take in takes) or 'none'}")
    return found[0]


def suffix_onto(path: str | Path) -> str:
    """What a file with motion on the rig of another one ends in."""
    return ".bvh" if Path(path).suffix.lower() in READ else ".glb"


def rig_in(path: str | Path, reading: Reading = JUDGED) -> glb.Rigged | MovingRig:
    """The human's skeleton in somebody's own file: .glb, .gltf or .vrm with a skin, .bvh or .amc. reading: how the latter are to be read. CharacterError or MotionFileError, naming the file and what would be
    right, where there is none."""
    if Path(path).suffix.lower() not in (*READ, *glb.gltf.SUFFIXES):
        raise OutputError(f"{path}: no rig is read from it; name a {', '.join((*glb.gltf.SUFFIXES, *READ[:-1]))} or {READ[-1]} file")
    return moving_rig(path, reading) if Path(path).suffix.lower() in READ else glb.rigged(path)


def on_rig(onto: glb.Rigged | MovingRig, take: Take) -> Moved:
    """A rig in the poses of a take: ways are as many times as long as the rig is taller, and arms keep out of its own flesh, if it has any."""
    root, at, turned = _kinematics(take)
    if isinstance(onto, glb.Rigged):
        turned[:, ARMS] = worn(glb.load(onto.document.path), at, turned)[1][:, ARMS]
    return onto.rig.pose(take.skeleton, root, local_rotations(take.skeleton, turned))


def write_onto(path: str | Path, onto: glb.Rigged | MovingRig, take: Take, fps: float = RATE) -> Path:
    """Write what somebody did on a rig's own bones: as an animation of its own file, skin, fingers, names and all, into a .glb file, or, where that is a motion file, as
    another one, .bvh.

    OutputError where it can't be written, or where nothing was played.
    """
    if not len(take.poses):
        raise OutputError(f"{path}: nothing was played yet that could be written")
    moved = on_rig(onto, take)
    if isinstance(onto, MovingRig):
        return write_moved(path, onto, moved, fps, take.name)
    return glb.write_onto(path, onto, moved, take.contacts, fps, take.name)


def _kinematics(take: Take) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Roots (T, 3), and all joints' places (T, 22, 3) [m] and orientations (T, 22, 3, 3)."""
    root = np.stack([pose.root for pose in take.poses]).astype(float)
    return root, *forward_kinematics(take.skeleton, root, np.stack([pose.rotations for pose in take.poses]).astype(float))


def _actor(take: Take) -> glb.Actor:
    _, at, turned = _kinematics(take)
    if take.body is None:
        rest, _ = forward_kinematics(take.skeleton, take.skeleton.offsets[0],
                                     np.broadcast_to(np.eye(3), (len(take.skeleton), 3, 3)))
        body, scale, joints = mannequin(), float(scale_of(rest, skin.REST, skin.STANDARD.parents)), rest[skin.AT]
    else:
        body = take.body
        at, turned, sizes = worn(body, at, turned)
        scale = float(sizes[0])
        joints = glb.joints_of(body, scale)
    world = skin.turns(turned)
    local = world.copy()
    local[:, 1:] = skin.multiply(skin.conjugate(world[:, skin.PARENTS[1:]]), world[:, 1:])
    return glb.Actor(take.name, body, joints, scale, take.tint, glb.Motion(at[:, 0], local, take.contacts))
