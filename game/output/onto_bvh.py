"""Motion onto the skeleton of somebody's own motion file, BVH or AMC: his joints' names, bones, axes and unit, in a BVH file.

How his joints stand to ours is told by his zero pose where that is a person standing, else by how he moves (`mocap.calibrate`), just as when his motion is read: so what is
written comes back as it was.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from gambol.controllers.body import Clip, Skeleton, between, forward_kinematics, local_rotations
from gambol.controllers.mocap import JUDGED, MotionFileError, Moved, Reading, Rig, calibrate, standardise, write_bvh

from ..files import named, output_file

READ = (".bvh", ".amc")
"""What files end in whose skeleton is found here."""
SHORTEST = 1.0
"""Who stands nowhere as a person does, tells how his joints stand by moving for so long at least [s]."""


@dataclass(frozen=True, eq=False)
class MovingRig:
    """The skeleton in a motion file, in its own axes and unit; its rig, in metres and Y up; what brings its axes there (3, 3); metres in its unit."""

    path: Path
    skeleton: Skeleton
    rig: Rig
    axes: np.ndarray
    scale: float


def moving_rig(path: str | Path, reading: Reading = JUDGED) -> MovingRig:
    """The human's skeleton in a .bvh or .amc file. MotionFileError, naming the file and what would be right, where there is none."""
    raw, found = reading.read(path)
    try:
        clip = standardise(raw, found)
        known = calibrate([clip])
        seconds = len(clip) * clip.frame_time
        if not known.posed and seconds < SHORTEST:
            raise ValueError(f"how its joints stand can't be told: its zero pose is no person standing, and it moves for {seconds:.2g} s only; "
                             f"wanted is a file with {SHORTEST:g} s of walking or more")
        plays = {*known.roles.limbs.values(), *known.roles.trunk, *known.roles.neck}
        turned = np.tile(np.eye(3), (len(clip.skeleton), 1, 1))  # as it stands in T-pose
        for joint, parent in enumerate(clip.skeleton.parents):
            turned[joint] = known.corrections[joint].T if joint in plays else turned[max(parent, 0)]
        places, _ = forward_kinematics(clip.skeleton, np.zeros(3), local_rotations(clip.skeleton, turned))
        rig = Rig.of(clip.skeleton.names, clip.skeleton.parents, places, turned, metres=1.0)
    except ValueError as error:
        raise MotionFileError(f"{path}: {error}") from None
    up = np.eye(3)["xyz".index(found.up[-1])] * (-1.0 if found.up.startswith("-") else 1.0)
    return MovingRig(Path(path), raw.skeleton, rig, between(up, np.array([0.0, 1.0, 0.0])), found.scale)


def write_moved(path: str | Path, onto: MovingRig, moved: Moved, fps: float = 60.0, name: str = "Motion") -> Path:
    """Write a rig's poses (T, ...) at `fps` frames a second as a .bvh file of its own skeleton. What lies above its hips carries all of it, wherever they go.

    OutputError where it can't be written, ValueError for numbers that are not finite.
    """
    hips = onto.rig.roles.limbs["Hips"]
    below, _ = forward_kinematics(onto.rig.skeleton, np.zeros(3), moved.local)
    root = (moved.places[:, hips] - below[:, hips]) @ onto.axes / onto.scale
    local = Rotation.from_matrix((onto.axes.T @ moved.local @ onto.axes).reshape(-1, 3, 3)).as_quat().reshape(*moved.local.shape[:2], 4)
    with named(path := output_file(path, ".bvh")):
        write_bvh(Clip(name, onto.skeleton, 1.0 / fps, root, local), path, unit=1.0)
    return path
