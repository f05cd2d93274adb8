"""The database of those who have no motion capture: Gambol's own motion, made on first use.

A walker walks, turns, side-steps, runs, stops and jumps after a fixed list of wishes, one take a
list. It takes some seconds, once: the file lies with all that is learnt, under a name that changes
with the gait library and with the sources that make the motion, and with no others.
"""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from ...body import Clip, Pose
from ...contract import Intent, Leap
from ...jump import Jump, Physique
from ...locomotion import DEFAULT_LIBRARY, Locomotion
from ...supervisor import Supervisor
from ..pose_vector import encode
from .build_database import sound
from .database import FPS, SUFFIX, Database, Writer
from .store import folder

_CONTROLLERS = Path(__file__).parents[2]
_SOURCES = ("contract/*.py", "supervisor.py", "body/*.py", "locomotion/*.py", "jump/**/*.py", "reconstruction/pose_vector.py",
            "reconstruction/database/*.py")

# seconds, then forward [m/s], yaw [rad/s] and leftward velocity [m/s]
_WALKS = {
    "walk": [(2, 0, 0, 0), (3, 0.7, 0, 0), (3, 1.0, 0, 0), (4, 1.3, 0, 0), (3, 1.6, 0, 0), (2, 0, 0, 0)],
    "walk in bends": [(3, 1.2, 0, 0), (3, 1.2, 0.6, 0), (3, 1.1, -0.8, 0), (2, 0.8, 1.2, 0), (2, 1.3, -0.4, 0)],
    "turn": [(1, 0, 0, 0), (3, 0, 1.5, 0), (1, 0, 0, 0), (3, 0, -1.5, 0), (1, 0, 0, 0), (2, 0.6, 1.5, 0)],
    "side steps": [(1, 0, 0, 0), (3, 0, 0, 0.5), (1, 0, 0, 0), (3, 0.7, 0, 0.4), (3, 0.7, 0, -0.4), (2, 0, 0, -0.5)],
    "backward": [(1, 0, 0, 0), (4, -0.6, 0, 0), (2, -0.5, 0.4, 0), (2, -0.5, 0, 0.3), (1, 0, 0, 0)],
    "run": [(2, 1.5, 0, 0), (4, 2.6, 0, 0), (3, 3.2, 0, 0), (3, 2.8, 0.6, 0), (3, 2.8, -0.5, 0), (2, 1.3, 0, 0),
            (2, 0, 0, 0)],
    "start and stop": [(1.5, 0, 0, 0), (2, 1.3, 0, 0), (1.5, 0, 0, 0), (2, 1.0, 0.5, 0), (1.5, 0, 0, 0), (2, 2.6, 0, 0),
                       (2, 0, 0, 0)],
}
# approach as above, then how far ahead [m] the jump goes and how long it is in the air [s]
_JUMPS = {
    "jump up": [((1, 0, 0, 0), 0.0, 0.40), ((1, 0, 0, 0), 0.0, 0.48), ((1, 0, 0, 0), 0.0, 0.54)],
    "jump forward": [((1, 0, 0, 0), 0.5, None), ((1, 0, 0, 0), 0.9, None), ((1, 0, 0, 0), 1.2, None)],
    "running jump": [((3, 2.6, 0, 0), 1.6, None), ((3, 2.8, 0, 0), 2.0, None)],
}
_LONGEST_WAIT = 3.0  # s, until a jump begins and until it is over


def default_database() -> Database:
    """Gambol's own motion, made on the first call; the same frames on every machine of a kind."""
    told = hashlib.sha1(Path(DEFAULT_LIBRARY).read_bytes())
    for pattern in _SOURCES:
        for source in sorted(_CONTROLLERS.glob(pattern)):
            told.update(source.read_bytes())
    path = folder() / f"own-{told.hexdigest()[:12]}{SUFFIX}"
    if path.exists():
        os.utime(path)  # it is wanted still
    else:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_own(path)
    return Database.open(path)


def write_own(path: Path) -> None:
    """Play all the wishes and write the takes into a new file."""
    someone = Supervisor({"locomotion": Locomotion.load(), "jump": Jump(Physique())})
    with Writer(path) as writer:
        for kind, wishes, player in (("walk", _WALKS, _walked), ("jump", _JUMPS, _jumped)):
            for name, wished in wishes.items():
                _add(writer, f"own/{name}", "run" if name == "run" else kind, someone.skeleton, player(someone, wished))


def _add(writer: Writer, name: str, action: str, skeleton, poses: list[Pose]) -> None:
    root = np.stack([pose.root for pose in poses]).astype(float)
    rotations = np.stack([pose.rotations for pose in poses]).astype(float)
    clip = Clip(name, skeleton, 1 / FPS, root, Rotation.from_matrix(rotations).as_quat())
    frames, _ = encode(root, rotations, 1 / FPS)
    writer.add(name, "Gambol", action, frames, sound(clip, frames))


def _walked(someone: Supervisor, wishes) -> list[Pose]:
    """A walk's poses at FPS."""
    state, poses = someone.start(), []
    for seconds, *velocity in wishes:
        for _ in range(round(seconds * FPS)):
            state, pose = someone.step(state, Intent(np.array(velocity, float)), 1 / FPS)
            poses.append(pose)
    return poses


def _jumped(someone: Supervisor, wishes) -> list[Pose]:
    """The poses at FPS of jumps, one after another; one that turns out impossible is left at its approach."""
    state, poses = someone.start(), []

    def on(leap: Leap | None):
        nonlocal state
        state, pose = someone.step(state, Intent(velocity, leap), 1 / FPS)
        poses.append(pose)
    for (seconds, *wished), ahead, airtime in wishes:
        velocity = np.array(wished, float)
        for _ in range(round(seconds * FPS)):
            on(None)
        for _ in range(round(_LONGEST_WAIT * FPS)):
            x, z, heading = state.ground
            on(Leap(np.array([x + ahead * np.sin(heading), 0.0, z + ahead * np.cos(heading)]), airtime))
            if someone.active(state)[0] == "jump":
                break
        for _ in range(round(_LONGEST_WAIT * FPS)):
            if someone.active(state)[0] != "jump":
                break
            on(None)
    return poses
