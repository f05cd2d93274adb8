"""Trackers of somebody who stands in set poses as a problem of least squares: what is unknown, what is believed of it, and what is likeliest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...body import carried, contact_height, forward_kinematics, log, yaw
from ..pose_vector import SKELETON
from .pose_slopes import OWN, told_of
from .simulated import BONES, SCALES, numbers
from .stood import JOINTS, Stood

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
_STEPS, _TRIES, _ENOUGH = 8, 6, 1e-3


@dataclass(frozen=True, eq=False)
class PoseFit:
    """What is unknown is shared by all poses (S,): a calibration's numbers, and by what joints are off always (3 (J − 1)) [rad]; or each pose's own (K, O): by
    what they are off beside, how the hips are turned, and moved. mean (S,), precision (S, S): a normal distribution of what is believed of what is shared;
    loose: (K, O) standard deviations of the rest, about nothing. headings (K, 3, 3), roots (K, 3): of the hips, about. beside: [m] how near trackers are
    taken to sit to their joints, along each axis."""

    stood: Stood
    places: np.ndarray
    turns: np.ndarray
    asked: np.ndarray
    worn: np.ndarray
    headings: np.ndarray
    roots: np.ndarray
    mean: np.ndarray
    precision: np.ndarray
    loose: np.ndarray
    beside: float

    @staticmethod
    def of(stood: Stood, places: np.ndarray, turns: np.ndarray, asked: np.ndarray, kneeling: np.ndarray, bones: tuple[np.ndarray, np.ndarray],
           beside: float = BESIDE) -> PoseFit:
        """Of somebody who stood (`stood`, alone) and then in K poses asked (K, J, 3, 3), with knees bent as deep as they like where kneeling (K,), with
        trackers at places (K, S, 3) [m] above the room's floor and turns (K, S, 3, 3); those that are not worn are never read. bones: mean (BONES,) and
        covariance of what they are likely to be."""
        worn, count = stood.there[0], len(asked)
        seen = stood.scale[0] * places[:, worn]
        joints, orientations = forward_kinematics(SKELETON, np.zeros((count, 3)), asked)
        points = (joints[:, JOINTS] + np.einsum("ksij,sj->ksi", orientations[:, JOINTS], stood.offsets[0]))[:, worn]
        a, b = points - points.mean(1, keepdims=True), seen - seen.mean(1, keepdims=True)
        along, across = carried(a, b)
        headings = yaw(np.arctan2(across, along))
        roots = seen.mean(1) - np.einsum("kij,kj->ki", headings, points.mean(1))
        floor, none = np.zeros(()), np.zeros((len(JOINTS), 3))
        each = np.tile(_degrees(_EACH), (count, 1))
        for name in ("UpLeg", "Leg", "Foot"):
            for side in ("Left", "Right"):
                each[kneeling, 3 * (SKELETON.index(side + name) - 1)] = _KNEES
        mean = np.concatenate([bones[0], numbers(SKELETON.offsets * 0.0, -stood.offsets[0], none, floor)[BONES:], np.zeros(OWN)])
        spread = numbers(SKELETON.offsets * 0.0, none + beside, none + _TURNED, floor + 0.015)[BONES:]
        precision = np.diag(np.concatenate([np.ones(BONES), spread, _degrees(_ALWAYS)]) ** -2.0)
        precision[:BONES, :BONES] = np.linalg.inv(bones[1])
        hips = np.tile([*np.radians([5.0, 60.0, 5.0]), 1.0, 1.0, 1.0], (count, 1))
        return PoseFit(stood, seen, turns[:, worn], asked, worn, headings, roots, mean, precision, np.concatenate([each, hips], 1), beside)

    def solved(self, begin: tuple[np.ndarray, np.ndarray] | None = None) -> Solved:
        """The likeliest unknowns from some, shared and own, on, by default from what is believed, by Levenberg's and Marquardt's method.

        Few residuals tell of a pose's many own unknowns. So these are eliminated (Schur's complement), by matrices of the size of its residuals
        (Woodbury's identity): what is solved for is what is shared.
        """
        shared, own = (self.mean, np.zeros_like(self.loose)) if begin is None else begin
        at = self.told(shared, own)
        cost, damping, before = self.cost(shared, own, at.found), 1e-3, np.inf
        for _ in range(_STEPS):
            if before - cost < _ENOUGH * before:
                break
            before = cost
            for _ in range(_TRIES):
                there = self._stepped(shared, own, at, damping)
                found = self.told(*there)
                if (now := self.cost(*there, found.found)) < cost:
                    (shared, own), at, cost, damping = there, found, now, 0.2 * damping
                    break
                damping *= 5.0
        blurred = _blurred(at, self.loose ** -2.0)
        curved = self.precision + _product(at.shared, np.linalg.solve(blurred, at.shared))
        return Solved(shared, own, np.linalg.inv(curved), cost + float(sum(np.linalg.slogdet(some)[1].sum() for some in (curved, blurred))
                                                                      - np.linalg.slogdet(self.precision)[1]))

    def found_beside(self, found: Solved) -> float:
        """How near trackers turn out to sit to their joints [m], along each axis: what `beside` should have been (empirical Bayes, one step of EM)."""
        which = BONES + np.flatnonzero(np.repeat(self.worn, 3))
        squares = np.sum(((found.shared - self.mean)[which] ** 2 + np.diagonal(found.spread)[which]) * SCALES[which] ** 2)
        return float(np.sqrt((squares + _BESIDE_WEIGHT * BESIDE ** 2) / (len(which) + _BESIDE_WEIGHT)))

    def off(self, found: Solved) -> np.ndarray:
        """By how many deviations joints are off what was asked in each pose (K,), the root of their mean square."""
        squares = (found.own / self.loose)[:, :OWN] ** 2
        return np.sqrt(squares.sum(-1) / np.sum(_degrees(_ALWAYS) > 2e-4))

    def told(self, shared: np.ndarray, own: np.ndarray) -> Told:
        """Places, turns and soles, each over how exactly it is met, and their slopes."""
        found = told_of(self.stood, self.worn, self.asked, self.headings, self.roots, shared, own)
        soles = found.points[:, found.worn:, 1] - contact_height(SKELETON)
        off = log(np.swapaxes(self.turns, -1, -2) @ found.held)
        trackers, feet = slice(found.worn), (slice(None), slice(found.worn, None), 1)
        turns, places = found.turned(off), found.points[:, trackers] - self.places

        def met(place: np.ndarray, turn: np.ndarray, sole: np.ndarray, *wide: int) -> np.ndarray:
            return np.concatenate([(part / least).reshape(len(part), -1, *wide) for part, least in ((place, _PLACE), (turn, _TURN), (sole, _SOLE))], 1)
        return Told(met(places, off, soles), met(found.shared[:, trackers], turns[0], found.shared[feet], found.shared.shape[-1]),
                    met(found.own[:, trackers], turns[1], found.own[feet], found.own.shape[-1]))

    def _stepped(self, shared, own, at, damping):
        """What is shared, and own, one step further."""
        held = self.loose ** -2.0
        stiff = (1.0 + damping) * held + damping * np.sum(at.own ** 2, 1)
        back = np.einsum("kmo,km->ko", at.own, at.found) + held * own
        blurred = _blurred(at, stiff)
        met = np.linalg.solve(blurred, np.concatenate([at.shared, np.einsum("kmo,ko->km", at.own, back / stiff)[..., None]], -1))
        curved = self.precision + _product(at.shared, met[..., :-1])
        curved += damping * np.diag(np.diagonal(self.precision) + np.sum(at.shared ** 2, (0, 1)))
        down = np.linalg.solve(curved, np.einsum("kms,km->s", at.shared, at.found - met[..., -1]) + self.precision @ (shared - self.mean))
        back = (back - np.einsum("kmo,km->ko", at.own, at.shared @ down)) / stiff
        met = np.linalg.solve(blurred, np.einsum("kmo,ko->km", at.own, back)[..., None])[..., 0]
        return shared - down, own - (back - np.einsum("kmo,km->ko", at.own, met) / stiff)

    def cost(self, shared: np.ndarray, own: np.ndarray, found: np.ndarray) -> float:
        """Of unknowns that leave residuals found (K, M): those and what is believed, squared, in deviations."""
        away = shared - self.mean
        return float(np.sum(found ** 2) + away @ self.precision @ away + np.sum((own / self.loose) ** 2))


@dataclass(frozen=True, eq=False)
class Told:
    """Residuals found (K, M), and how they change with what is shared (K, M, S), and own (K, M, O)."""

    found: np.ndarray
    shared: np.ndarray
    own: np.ndarray


@dataclass(frozen=True, eq=False)
class Solved:
    """The likeliest unknowns, shared (S,) and own (K, O); the covariance of what is shared (S, S); surprise: minus twice the logarithm of how likely all this is
    (Laplace's approximation), but for a constant."""

    shared: np.ndarray
    own: np.ndarray
    spread: np.ndarray
    surprise: float


def _blurred(at: Told, stiff: np.ndarray) -> np.ndarray:
    """The covariance (K, M, M) of residuals of which own unknowns, so stiff (K, O), are not known."""
    return np.eye(at.found.shape[1]) + (at.own / stiff[:, None]) @ np.swapaxes(at.own, -1, -2)


def _product(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Of (K, M, S) and (K, M, S), (S, S)."""
    return one.reshape(-1, one.shape[-1]).T @ other.reshape(-1, other.shape[-1])


def _degrees(table):
    """Of each joint but the hips, three axes (3 (J − 1),) [rad]; toes don't bend."""
    names = [name.removeprefix("Left").removeprefix("Right").rstrip("12") for name in SKELETON.names[1:]]
    return np.maximum(np.radians(np.repeat([float(table.get(name, 0.0)) for name in names], 3)), 1e-4)
