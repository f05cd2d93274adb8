"""Trackers of somebody who stands in set poses as a problem of least squares: what is unknown, what is believed of it, and what is left to explain."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...body import carried, contact_height, exp, heel_offset, log, yaw
from ..pose_vector import SKELETON
from .simulated import BONES, SCALES, TARGETS, numbers, told
from .stood import JOINTS, Stood

_N = len(SKELETON)
_OWN = 3 * (_N - 1)
_ALWAYS = {"Arm": 4, "ForeArm": 3, "Hand": 5, "Head": 4, "Neck": 2, "Spine": 2, "Shoulder": 2, "UpLeg": 2, "Leg": 2, "Foot": 3}
_EACH = {"Arm": 5, "ForeArm": 5, "Hand": 7, "Head": 5, "Neck": 3, "Spine": 3, "Shoulder": 4, "UpLeg": 4, "Leg": 3, "Foot": 4}
"""By how much joints are off what was asked [degrees about each axis], standard deviations: in all poses alike, and in each."""
_KNEES = np.radians(20.0)
"""How deep somebody bends his knees is his own business."""
BESIDE = 0.08
"""Trackers are taken to sit on their joints, give or take this [m] along each axis, until something is known of how near they are;"""
_BESIDE_WEIGHT = 2.0
"""and that counts for as much as so many numbers of what is found."""
_TURNED = np.radians(20.0)
"""By how much standing may err of trackers' turns."""
_PLACE, _TURN, _SOLE = 0.004, np.radians(0.7), 0.01
"""How exactly places [m] and turns [rad] are met, and soles on the floor [m]."""
_STEPS, _ENOUGH = 8, 1e-3
_FEET = [SKELETON.index(side + part) for side in ("Left", "Right") for part in ("Foot", "Toe")]
_SOLES = np.array([heel_offset(SKELETON), np.zeros(3)] * 2)


@dataclass(frozen=True, eq=False)
class PoseFit:
    """Unknowns x (D,): a calibration's numbers; by what joints are off always, and in each pose (3 (J − 1) each) [rad]; how the hips are
    turned and moved in each. mean (D,), precision (D, D): a normal distribution of what is believed of them. headings (K, 3, 3), roots (K, 3): of the hips,
    about. beside: [m] how near trackers are taken to sit to their joints, along each axis."""

    stood: Stood
    places: np.ndarray
    turns: np.ndarray
    asked: np.ndarray
    worn: np.ndarray
    headings: np.ndarray
    roots: np.ndarray
    mean: np.ndarray
    precision: np.ndarray
    beside: float

    @property
    def size(self) -> int:
        return len(self.mean)

    @staticmethod
    def of(stood: Stood, places: np.ndarray, turns: np.ndarray, asked: np.ndarray, kneeling: np.ndarray, bones: tuple[np.ndarray, np.ndarray],
           beside: float = BESIDE) -> PoseFit:
        """Of somebody who stood (`stood`, alone) and then in K poses asked (K, J, 3, 3), with knees bent as deep as they like where kneeling (K,), with
        trackers at places (K, S, 3) [m] above the room's floor and turns (K, S, 3, 3); those that are not worn are never read. bones: mean (BONES,) and
        covariance of what they are likely to be."""
        worn, count = stood.there[0], len(asked)
        seen = stood.scale[0] * places[:, worn]
        joints, orientations = _kinematics(SKELETON.offsets[None], asked[None], np.zeros((1, count, 3)))
        points = (joints[:, :, JOINTS] + np.einsum("bksij,sj->bksi", orientations[:, :, JOINTS], stood.offsets[0]))[0][:, worn]
        a, b = points - points.mean(1, keepdims=True), seen - seen.mean(1, keepdims=True)
        along, across = carried(a, b)
        headings = yaw(np.arctan2(across, along))
        roots = seen.mean(1) - np.einsum("kij,kj->ki", headings, points.mean(1))
        floor, none = np.zeros(()), np.zeros((len(JOINTS), 3))
        always, each = _degrees(_ALWAYS), np.tile(_degrees(_EACH), (count, 1))
        for name in ("UpLeg", "Leg", "Foot"):
            for side in ("Left", "Right"):
                each[kneeling, 3 * (SKELETON.index(side + name) - 1)] = _KNEES
        rest = np.concatenate([always, each.ravel(), np.tile(np.radians([5.0, 60.0, 5.0]), count), np.ones(3 * count)])
        mean = np.concatenate([bones[0], numbers(SKELETON.offsets * 0.0, -stood.offsets[0], none, floor)[BONES:], np.zeros(len(rest))])
        spread = numbers(SKELETON.offsets * 0.0, none + beside, none + _TURNED, floor + 0.015)[BONES:]
        precision = np.diag(np.concatenate([np.ones(BONES), spread ** -2.0, rest ** -2.0]))
        precision[:BONES, :BONES] = np.linalg.inv(bones[1])
        return PoseFit(stood, seen, turns[:, worn], asked, worn, headings, roots, mean, precision, beside)

    def solved(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
        """The likeliest unknowns from some (D,) on, how curved the cost is there (D, D), and the cost, by Levenberg's and Marquardt's method."""
        at = self.residuals(x[None])[0]
        cost, damping = self._cost(x, at), 1e-3
        curved, before = self.precision, np.inf
        for _ in range(_STEPS):
            if before - cost < _ENOUGH * before:
                break
            slopes = self._slopes(x, at)
            curved = slopes.T @ slopes + self.precision
            back = slopes.T @ at.ravel() + self.precision @ (x - self.mean)
            before = cost
            for _ in range(6):
                there = x - np.linalg.solve(curved + damping * np.diag(np.diag(curved)), back)
                found = self.residuals(there[None])[0]
                if (now := self._cost(there, found)) < cost:
                    x, at, cost, damping = there, found, now, 0.2 * damping
                    break
                damping *= 5.0
        return x, curved, cost

    def surprise(self, curved: np.ndarray, cost: float) -> float:
        """Minus twice the logarithm of how likely all this is where the likeliest cost so much and is so curved (Laplace's approximation), but for a constant."""
        return cost + float(np.linalg.slogdet(curved)[1] - np.linalg.slogdet(self.precision)[1])

    def found_beside(self, x: np.ndarray, curved: np.ndarray) -> float:
        """How near trackers turn out to sit to their joints [m], along each axis: what `beside` should have been (empirical Bayes, one step of EM)."""
        which = BONES + np.flatnonzero(np.repeat(self.worn, 3))
        unsure = np.linalg.solve(curved, np.eye(self.size)[:, which])[which, np.arange(len(which))]
        squares = np.sum(((x - self.mean)[which] ** 2 + unsure) * SCALES[which] ** 2)
        return float(np.sqrt((squares + _BESIDE_WEIGHT * BESIDE ** 2) / (len(which) + _BESIDE_WEIGHT)))

    def off(self, x: np.ndarray) -> np.ndarray:
        """By how many deviations joints are off what was asked in each pose (K,), the root of their mean square."""
        each = slice(TARGETS + _OWN, TARGETS + _OWN * (1 + len(self.asked)))
        squares = (x[each] ** 2 * np.diagonal(self.precision)[each]).reshape(len(self.asked), _OWN)
        return np.sqrt(squares.sum(-1) / np.sum(_degrees(_ALWAYS) > 2e-4))

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

    def _cost(self, x, found):
        away = x - self.mean
        return float(np.sum(found ** 2) + away @ self.precision @ away)

    def _slopes(self, x, found, step=1e-4):
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
