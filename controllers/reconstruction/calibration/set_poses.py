"""Poses that people are asked to stand in, and what those tell together of how trackers are worn, by least squares.

Nobody stands as asked: each joint is off by some degrees, always the same ones and others in each pose (`_ALWAYS`, `_EACH`). Where all
poses, mounts, bones and the floor are sought at once (Gauss-Newton, damped), what joints are off by averages out, and mounts remain.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...body import carried, contact_height, exp, heel_offset, log, yaw
from ..pose_vector import SKELETON
from .simulated import TARGETS, likely, numbers, told
from .stood import JOINTS, Stood
from .worn import Calibration

_N = len(SKELETON)
_ALWAYS = {"Arm": 4, "ForeArm": 3, "Hand": 5, "Head": 4, "Neck": 2, "Spine": 2, "Shoulder": 2, "UpLeg": 2, "Leg": 2, "Foot": 3}
_EACH = {"Arm": 5, "ForeArm": 5, "Hand": 7, "Head": 5, "Neck": 3, "Spine": 3, "Shoulder": 4, "UpLeg": 4, "Leg": 3, "Foot": 4}
"""By how much joints are off what was asked [degrees about each axis], standard deviations: in all poses alike, and in each."""
_KNEES = np.radians(20.0)
"""How deep somebody bends his knees is his own business."""
_BESIDE, _TURNED = 0.08, np.radians(20.0)
"""Trackers are taken to sit on their joints, give or take this [m] along each axis; and by how much standing may err of their turns."""
_PLACE, _TURN, _SOLE = 0.004, np.radians(0.7), 0.01
"""How exactly places [m] and turns [rad] are met, and soles on the floor [m]."""
_STEPS, _ENOUGH = 8, 1e-3
_OTHERWISE = 2.0
"""Who is off a pose by more than this many deviations (root mean square over joints) stood otherwise than asked: it is left out."""
_FEET = [SKELETON.index(side + part) for side in ("Left", "Right") for part in ("Foot", "Toe")]
_SOLES = np.array([heel_offset(SKELETON), np.zeros(3)] * 2)


def _asked(spine=(0, 0, 0), nod=0.0, **arms: tuple[float, float, float]) -> np.ndarray:
    """Rotations (J, 3, 3) of a pose: of joints of the left side in rotation vectors [degrees], the right one its mirror image."""
    vectors = np.zeros((_N, 3))
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
    asked = np.stack([list(POSES.values())[one], list(POSES.values())[other]])[None]
    places = _kinematics(SKELETON.offsets[None], asked, np.zeros((1, 2, 3)))[0][0]
    places = places - places[:, _FEET].mean(1, keepdims=True)
    return float(np.linalg.norm(places[0, joints] - places[1, joints], axis=-1).max())


def fitted(stood: Stood, places: np.ndarray, turns: np.ndarray, poses: Sequence[int]) -> Calibration:
    """What somebody who stood (`stood`, alone) and then in K set poses tells.

    places: (K, S, 3) [m] above the room's floor, turns: (K, S, 3, 3), of trackers that are worn; others are never read. poses: numbers of `POSES`, of
    each one, the first of which is how they stood. One that is nothing like what was asked is left out. It takes a fifth of a second.
    ValueError for no pose.
    """
    if not len(poses):
        raise ValueError("no pose to tell from")
    fit = _Fit.of(stood, places, turns, poses)
    x, at = np.zeros(fit.size), fit.residuals(np.zeros((1, fit.size)))[0]
    cost, damping = fit.cost(x, at), 1e-3
    for _ in range(_STEPS):
        slopes = fit.slopes(x, at)
        curved = slopes.T @ slopes + np.diag(fit.spread ** -2.0)
        back = slopes.T @ at.ravel() + (x - fit.mean) / fit.spread ** 2
        before = cost
        for _ in range(6):
            there = x - np.linalg.solve(curved + damping * np.diag(np.diag(curved)), back)
            found = fit.residuals(there[None])[0]
            if (now := fit.cost(there, found)) < cost:
                x, at, cost, damping = there, found, now, 0.2 * damping
                break
            damping *= 5.0
        if before - cost < _ENOUGH * before:
            break
    joints = 3 * (_N - 1)
    off = (x / fit.spread)[TARGETS + joints:TARGETS + joints * (1 + len(poses))].reshape(len(poses), joints)
    like = np.sqrt(np.sum(off ** 2, -1) / np.sum(fit.spread[TARGETS:TARGETS + joints] > 2e-4)) < _OTHERWISE
    like[0] = True
    if not like.all():
        return fitted(stood, places[like], turns[like], np.asarray(poses)[like].tolist())
    bones, away, turned, floor = told(x[:TARGETS])
    unsure = told(np.sqrt(np.diagonal(np.linalg.inv(curved)))[:TARGETS])
    worn = fit.worn[:, None]
    return Calibration(stood, SKELETON.offsets + bones, stood.offsets[0] + np.where(worn, away, 0.0), stood.mounts[0] @ exp(np.where(worn, turned, 0.0)),
                       float(floor), (float(np.sqrt(np.mean(unsure[0][1:] ** 2))), np.linalg.norm(unsure[1], axis=-1), abs(float(unsure[3]))), len(poses))


@dataclass(frozen=True, eq=False)
class _Fit:
    """Unknowns x (D,): a calibration's numbers; by what joints are off always, and in each pose (3 (J − 1) each) [rad]; how the hips are
    turned and moved in each. mean, spread: (D,) what is believed of them. headings (K, 3, 3), roots (K, 3): of the hips, about."""

    stood: Stood
    places: np.ndarray
    turns: np.ndarray
    asked: np.ndarray
    worn: np.ndarray
    headings: np.ndarray
    roots: np.ndarray
    mean: np.ndarray
    spread: np.ndarray

    @property
    def size(self) -> int:
        return len(self.mean)

    @staticmethod
    def of(stood: Stood, places: np.ndarray, turns: np.ndarray, poses: Sequence[int]) -> _Fit:
        worn, count = stood.there[0], len(poses)
        asked = np.stack([list(POSES.values())[pose] for pose in poses])
        seen = stood.scale[0] * places[:, worn]
        joints, orientations = _kinematics(SKELETON.offsets[None], asked[None], np.zeros((1, count, 3)))
        points = (joints[:, :, JOINTS] + np.einsum("bksij,sj->bksi", orientations[:, :, JOINTS], stood.offsets[0]))[0][:, worn]
        a, b = points - points.mean(1, keepdims=True), seen - seen.mean(1, keepdims=True)
        along, across = carried(a, b)
        headings = yaw(np.arctan2(across, along))
        roots = seen.mean(1) - np.einsum("kij,kj->ki", headings, points.mean(1))
        lengths, deviations = likely()
        floor = np.zeros(())
        mean = numbers(lengths - SKELETON.offsets, -stood.offsets[0], np.zeros((len(JOINTS), 3)), floor)
        spread = numbers(deviations, np.full((len(JOINTS), 3), _BESIDE), np.full((len(JOINTS), 3), _TURNED), floor + 0.015)
        always, each = _degrees(_ALWAYS), np.tile(_degrees(_EACH), (count, 1))
        for name in ("UpLeg", "Leg", "Foot"):
            for side in ("Left", "Right"):
                each[np.asarray(poses) == _KNEELING, 3 * (SKELETON.index(side + name) - 1)] = _KNEES
        rest = np.concatenate([always, each.ravel(), np.tile(np.radians([5.0, 60.0, 5.0]), count), np.ones(3 * count)])
        return _Fit(stood, seen, turns[:, worn], asked, worn, headings, roots, np.concatenate([mean, np.zeros(len(rest))]),
                    np.concatenate([np.maximum(np.abs(spread), 1e-3), rest]))

    def residuals(self, x: np.ndarray) -> np.ndarray:
        """(B, K, M) of unknowns (B, D): places, turns and soles, each over how exactly it is met."""
        batch, count, own = len(x), len(self.places), 3 * (_N - 1)
        parts = np.split(x, np.cumsum([TARGETS, own, count * own, 3 * count]), -1)
        bones, away, turned, floor = told(parts[0])
        rotations = np.broadcast_to(self.asked, (batch, *self.asked.shape)).copy()
        off = parts[1][:, None] + parts[2].reshape(batch, count, own)
        rotations[:, :, 1:] = rotations[:, :, 1:] @ exp(off.reshape(batch, count, -1, 3))
        rotations[:, :, 0] = self.headings @ exp(parts[3].reshape(batch, count, 3))
        joints, orientations = _kinematics(SKELETON.offsets + bones, rotations, self.roots + parts[4].reshape(batch, count, 3))
        soles = joints[:, :, _FEET, 1] + np.einsum("bkfj,fj->bkf", orientations[:, :, _FEET, 1], _SOLES) - contact_height(SKELETON)
        held = orientations[:, :, JOINTS[self.worn]] @ np.swapaxes(self.stood.mounts[0] @ exp(turned), -1, -2)[:, None, self.worn]
        beside = (self.stood.offsets[0] + away)[:, None, self.worn]
        places = joints[:, :, JOINTS[self.worn]] + np.einsum("bksij,bksj->bksi", held @ self.stood.mounts[0, self.worn], np.broadcast_to(beside, held.shape[:-1]))
        places[..., 1] += floor[:, None, None]
        met = (places - self.places) / _PLACE, log(np.swapaxes(self.turns, -1, -2) @ held) / _TURN, soles / _SOLE
        return np.concatenate([part.reshape(batch, count, -1) for part in met], -1)

    def cost(self, x: np.ndarray, found: np.ndarray) -> float:
        return float(np.sum(found ** 2) + np.sum(((x - self.mean) / self.spread) ** 2))

    def slopes(self, x: np.ndarray, found: np.ndarray, step: float = 1e-4) -> np.ndarray:
        """How residuals change with the unknowns (K M, D); one pose's own unknowns leave the others alone, so all poses' are tried at once."""
        count, wide = found.shape
        shared = TARGETS + 3 * (_N - 1)
        out = np.zeros((count, wide, self.size))
        out[:, :, :shared] = np.moveaxis((self.residuals(x + step * np.eye(shared, self.size)) - found) / step, 0, -1)
        begin = shared
        for width in (3 * (_N - 1), 3, 3):
            tried = np.tile(x, (width, 1))
            numbers_of = begin + np.arange(width)[:, None] + width * np.arange(count)
            tried[np.arange(width)[:, None], numbers_of] += step
            change = (self.residuals(tried) - found) / step
            for k in range(count):
                out[k][:, numbers_of[:, k]] = change[:, k].T
            begin += width * count
        return out.reshape(count * wide, self.size)


def _kinematics(offsets, rotations, roots):
    """Joints (B, K, J, 3) and orientations of bodies (B, J, 3) in poses (B, K, J, 3, 3)."""
    joints, orientations = np.empty(rotations.shape[:-1]), np.array(rotations)
    joints[:, :, 0] = roots
    for j in range(1, _N):
        p = SKELETON.parents[j]
        joints[:, :, j] = joints[:, :, p] + np.einsum("bkij,bj->bki", orientations[:, :, p], offsets[:, j])
        orientations[:, :, j] = orientations[:, :, p] @ orientations[:, :, j]
    return joints, orientations


def _degrees(table):
    """Of each joint but the hips, three axes (3 (J − 1),) [rad]; toes don't bend."""
    names = [name.removeprefix("Left").removeprefix("Right").rstrip("12") for name in SKELETON.names[1:]]
    return np.maximum(np.radians(np.repeat([float(table.get(name, 0.0)) for name in names], 3)), 1e-4)
