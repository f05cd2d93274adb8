"""Simulated performers: people with limbs as long as those of CMU's subjects, who do what somebody else did."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from gambol.controllers.body import Skeleton, contact_height, contact_points, exp, forward_kinematics, yaw
from gambol.controllers.mocap import MotionFileError, load, roles, zero_positions
from gambol.controllers.reconstruction import SKELETON, parse
from gambol.controllers.reconstruction.database import Database, Take
from gambol.controllers.reconstruction.evaluation import trials
from reconstruction_trackers import MOST, Performance

_LEG = [SKELETON.index("Left" + name) for name in ("Leg", "Foot")]


def people(folder: Path) -> dict[str, Skeleton]:
    """Our skeleton with the lengths of each subject's bones whose ASF file lies in a folder of CMU's, by subject."""
    found = {}
    for own in sorted(path for path in folder.iterdir() if path.is_dir()):
        files = sorted(own.glob("*.amc"))
        try:
            if files:
                found[own.name] = proportions(load(files[0]).skeleton)
        except (MotionFileError, ValueError, KeyError):
            continue
    return found


def proportions(source: Skeleton) -> Skeleton:
    """Our skeleton with the lengths of somebody else's bones: limbs, widths of hips and shoulders, trunk, and neck with head."""
    part, at, zero = roles(source).limbs, zero_positions(source), zero_positions(SKELETON)
    offsets, mine = np.array(SKELETON.offsets), {name: j for j, name in enumerate(SKELETON.names)}

    def times(a: str, b: str) -> float:
        theirs, ours = (np.linalg.norm(points[index[a]] - points[index[b]]) for points, index in ((at, part), (zero, mine)))
        return float(theirs / ours)

    for side in ("Left", "Right"):
        for a, b in (("UpLeg", "Leg"), ("Leg", "Foot"), ("Foot", "Toe"), ("Arm", "ForeArm"), ("ForeArm", "Hand")):
            offsets[mine[side + b]] *= times(side + a, side + b)
        for name, bones in (("UpLeg", ("UpLeg",)), ("Arm", ("Shoulder", "Arm"))):
            offsets[[mine[side + bone] for bone in bones]] *= times("Left" + name, "Right" + name)

    def between(points: np.ndarray, index: dict[str, int]) -> np.ndarray:
        hips, shoulders = ((points[index["Left" + n]] + points[index["Right" + n]]) / 2 for n in ("UpLeg", "Arm"))
        return np.array([np.linalg.norm(shoulders - hips), np.linalg.norm(points[index["Head"]] - shoulders)])
    trunk, neck = between(at, dict(part)) / between(zero, mine)
    offsets[[mine[name] for name in ("Spine", "Spine1", "Spine2")]] *= trunk
    offsets[[mine[name] for name in ("Neck", "Head")]] *= neck
    return Skeleton(SKELETON.names, SKELETON.parents, offsets, SKELETON.end_parents, SKELETON.end_offsets)


def posing(skeleton: Skeleton, asked: np.ndarray, arms: float, unrest: float, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Joints (K, J, 3) [m] and orientations (K, J, 3, 3) of somebody who stands in poses (K, J, 3, 3), soles flat, not quite as asked: arms that are raised
    too low by `arms` [rad], always; joints off by `unrest` [rad] about each axis, trunk and legs by half of it; bent knees by 15° more or less."""
    rotations = np.array(asked)
    half = np.array([0.5 if any(part in name for part in ("Spine", "Leg", "Shoulder", "Hips")) else 1.0 for name in skeleton.names])
    rotations = rotations @ exp(unrest * half[:, None] * rng.normal(size=(*rotations.shape[:2], 3)))
    rotations[:, 0] = yaw(rng.normal(0.0, 0.1, len(rotations)))
    for k, deeper in enumerate(np.radians(rng.normal(0.0, 15.0, len(rotations)))):
        for side, way in (("Left", 1.0), ("Right", -1.0)):
            arm, thigh, shin = (skeleton.index(side + name) for name in ("Arm", "UpLeg", "Leg"))
            down = np.cross(asked[k, arm] @ [way, 0.0, 0.0], [0.0, -1.0, 0.0])
            rotations[k, arm] = exp(arms * down) @ rotations[k, arm]  # not at all where it hangs
            if np.trace(asked[k, shin]) < 2.5:
                rotations[k, thigh], rotations[k, shin] = exp([-0.5 * deeper, 0.0, 0.0]) @ rotations[k, thigh], exp([deeper, 0.0, 0.0]) @ rotations[k, shin]
    _, orientations = forward_kinematics(skeleton, np.zeros((len(asked), 3)), rotations)
    for side in ("Left", "Right"):
        shin, foot, toe = (skeleton.index(side + name) for name in ("Leg", "Foot", "Toe"))
        rotations[:, foot] = np.swapaxes(orientations[:, shin], -1, -2) @ yaw(np.arctan2(orientations[:, foot, 0, 2], orientations[:, foot, 2, 2]))
        rotations[:, toe] = np.eye(3)
    positions, orientations = forward_kinematics(skeleton, np.zeros((len(asked), 3)), rotations)
    up = contact_height(skeleton) - contact_points(skeleton, positions, orientations)[..., 1].min(-1)
    return positions + np.stack([rng.normal(0.0, 0.05, len(up)), up, rng.normal(0.0, 0.05, len(up))], -1)[:, None], orientations


def performing(database: Database, take: Take, body: Skeleton) -> Performance:
    """A take of a database as a body of other lengths does it: joints turn the same, the way goes with the legs, soles come to the floor."""
    trial = trials.trial(database, take, parse("4", SKELETON), MOST)
    legs = [np.linalg.norm(one.offsets[_LEG], axis=-1).sum() for one in (body, SKELETON)]
    root = trial.positions[:, 0] * legs[0] / legs[1]
    soles = contact_points(body, *forward_kinematics(body, root, trial.rotations))[..., 1].min(-1)
    root[:, 1] += contact_height(body) - np.percentile(soles, 20)
    known = np.array([not name.endswith("Toe") for name in SKELETON.names])
    return Performance(body, root, trial.rotations, *forward_kinematics(body, root, trial.rotations), known)
