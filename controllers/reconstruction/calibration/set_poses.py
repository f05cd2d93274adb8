"""Poses that people are asked to stand in, and what those tell together of how trackers are worn, by least squares.

Nobody stands as asked: each joint is off by some degrees, always the same ones and others in each pose. Where all poses, mounts, bones and
the floor are sought at once (`PoseFit`), what joints are off by averages out, and mounts remain. Bones are those of people (`likely_bones`), and
how near trackers sit to their joints is told by how near they turn out to sit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...body import exp, forward_kinematics
from ..pose_vector import SKELETON
from .likely_bones import LikelyBones, load
from .pose_fit import PoseFit
from .simulated import TARGETS, told
from .stood import Stood
from .worn import Calibration

_ROUNDS = 3
"""So often it is told anew how near trackers sit."""
_OTHERWISE = 2.0
"""Who is off a pose by more than this many deviations (root mean square over joints) stood otherwise than asked: it is left out."""


def _asked(spine=(0, 0, 0), nod=0.0, **arms: tuple[float, float, float]) -> np.ndarray:
    """Rotations (J, 3, 3) of a pose: of joints of the left side in rotation vectors [degrees], the right one its mirror image."""
    vectors = np.zeros((len(SKELETON), 3))
    for name, vector in arms.items():
        for side, way in (("Left", 1.0), ("Right", -1.0)):
            vectors[SKELETON.index(side + name)] = np.array(vector) * (1.0, way, way)
    for name in ("Spine", "Spine1", "Spine2"):
        vectors[SKELETON.index(name)] = spine
    vectors[[SKELETON.index("Neck"), SKELETON.index("Head")], 0] = 0.3 * nod, 0.7 * nod
    return exp(np.radians(vectors))


POSES = {
    "arms out to the sides, palms down": _asked(),
    "arms down, palms on your thighs": _asked(Arm=(0, 0, -75)),
    "arms out in front, palms down": _asked(Arm=(0, -88, 0)),
    "arms out to the sides and high": _asked(Arm=(0, 0, 75)),
    "elbows at your sides, forearms in front": _asked(Arm=(0, 0, -75), ForeArm=(0, -90, 0)),
    "arms out to the sides, chest turned to the left": _asked(spine=(0, 12, 0)),
    "arms down, chin on your chest": _asked(Arm=(0, 0, -75), nod=50),
    "arms out in front, knees bent": _asked(Arm=(0, -88, 0), UpLeg=(-60, 0, 0), Leg=(80, 0, 0), Foot=(-20, 0, 0)),
}
"""What people are asked to do, and the rotations (J, 3, 3) of it; the first two are `stood.STANCES`, or nearly so."""
_KNEELING = len(POSES) - 1


def apart(joints: np.ndarray, one: int, other: int) -> float:
    """How far [m] the farthest of some joints (n,) is in one of `POSES` from where it is in another, on a standard body whose feet stay."""
    asked = np.stack([list(POSES.values())[one], list(POSES.values())[other]])
    places = forward_kinematics(SKELETON, np.zeros((2, 3)), asked)[0]
    places = places - places[:, [SKELETON.index(side + part) for side in ("Left", "Right") for part in ("Foot", "Toe")]].mean(1, keepdims=True)
    return float(np.linalg.norm(places[0, joints] - places[1, joints], axis=-1).max())


def fitted(stood: Stood, places: np.ndarray, turns: np.ndarray, poses: Sequence[int], likely: LikelyBones | None = None) -> Calibration:
    """What somebody who stood (`stood`, alone) and then in K set poses tells.

    places: (K, S, 3) [m] above the room's floor, turns: (K, S, 3, 3), of trackers that are worn; others are never read. poses: numbers of `POSES`, of
    each one, the first of which is how they stood. One that is nothing like what was asked is left out. likely: what bones people have, by default as
    shipped; those of a family count as far as they explain what is seen. It takes a seventh of a second. ValueError for no pose.
    """
    if not len(poses):
        raise ValueError("no pose to tell from")
    asked, kneeling = np.array(list(POSES.values()))[list(poses)], np.asarray(poses) == _KNEELING
    known = load() if likely is None else likely
    seen = stood, places, turns, asked, kneeling
    found = [_told(mean, known.spread, *seen) for mean in known.means]
    surprise = np.array([one.surprise for one in found]) - 2.0 * np.log(known.people)
    weights = np.exp(0.5 * (surprise.min() - surprise))
    weights /= weights.sum()
    like = found[int(np.argmin(surprise))].off < _OTHERWISE
    like[0] = True
    if not like.all():
        return fitted(stood, places[like], turns[like], np.asarray(poses)[like].tolist(), likely)
    x = weights @ np.array([one.numbers for one in found])
    spread = weights @ np.array([one.spread + (one.numbers - x) ** 2 for one in found])
    (bones, away, turned, floor), unsure, worn = told(x), told(np.sqrt(spread)), stood.there[0][:, None]
    return Calibration(stood, SKELETON.offsets + bones, stood.offsets[0] + np.where(worn, away, 0.0), stood.mounts[0] @ exp(np.where(worn, turned, 0.0)),
                       float(floor), (float(np.sqrt(np.mean(unsure[0][1:] ** 2))), np.linalg.norm(unsure[1], axis=-1), abs(float(unsure[3]))), len(poses))


@dataclass(frozen=True)
class _Told:
    """What a family of bodies makes of what is seen: how surprising it is; a calibration's numbers (TARGETS,) and their variances; by how many deviations
    joints are off what was asked in each pose (K,)."""

    surprise: float
    numbers: np.ndarray
    spread: np.ndarray
    off: np.ndarray


def _told(mean, spread, stood, places, turns, asked, kneeling):
    """… whose bones are of this mean and covariance."""
    fit = PoseFit.of(stood, places, turns, asked, kneeling, (mean, spread))
    found = fit.solved()
    for _ in range(_ROUNDS - 1):
        fit = PoseFit.of(stood, places, turns, asked, kneeling, (mean, spread), fit.found_beside(found))
        found = fit.solved((found.shared, found.own))
    return _Told(found.surprise, found.shared[:TARGETS], np.diagonal(found.spread)[:TARGETS], fit.off(found))
