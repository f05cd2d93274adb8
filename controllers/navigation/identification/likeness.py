"""How like people's walks to goals are to planned ones."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...body import wrap
from ..planning import Plan, Weights, plans
from .human_paths import HumanPaths

PLACES = 101
"""Walks are compared at so many shares of their way."""
FAR = 3.0
"""Whoever goes farther than this [m] looks where he goes ..."""
MIDDLE = slice(30, 71)
"""... in the middle of his way, at these of the places (as Truong 2009 reports)."""
UNSOLVED = 1.0
"""A walk without a plan counts as so far away [m, rad]."""


class Likeness(NamedTuple):
    """By walk (N,): the mean distance at the same share of the way [m], the mean difference of headings [rad] (NaN where none
    is known), and the fastest planned turning [rad/s]."""

    distance: np.ndarray
    heading: np.ndarray
    turning: np.ndarray

    def means(self) -> tuple[float, float, float]:
        """The means of distance [m] and heading [rad], and the fastest turning of all [rad/s]."""
        known = self.heading[np.isfinite(self.heading)]
        return float(self.distance.mean()), float(known.mean()) if len(known) else np.nan, float(self.turning.max())


def evenly(places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which places, as numbers that need not be whole, lie at even shares (PLACES,) of a way (T, 2), and where those are (PLACES, 2)."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))])
    along += np.linspace(0.0, 1e-9, len(along))  # whoever stands goes on a little
    number = np.interp(np.linspace(0.0, along[-1], PLACES), along, np.arange(len(along)))
    return number, np.stack([np.interp(number, np.arange(len(places)), places[:, i]) for i in range(2)], -1)


def facing(paths: HumanPaths, number: int) -> np.ndarray:
    """Where a walker looks (PLACES,) [rad] at even shares of his way: as recorded, else where he goes in the middle of a far
    way; NaN where nobody knows."""
    at, places = evenly(paths.places[number])
    recorded = paths.headings[number]
    if np.isfinite(recorded).any():
        return np.interp(at, np.arange(len(recorded)), np.unwrap(recorded))
    looks = np.full(PLACES, np.nan)
    if np.linalg.norm(np.diff(places, axis=0), axis=1).sum() > FAR:
        step = np.gradient(places, axis=0)[MIDDLE]
        looks[MIDDLE] = np.arctan2(step[:, 0], step[:, 1])
    return looks


def likeness(paths: HumanPaths, planned: list[Plan]) -> Likeness:
    """How like N plans are to N walks."""
    distance, heading, turning = np.full((3, len(paths)), UNSOLVED)
    for n, plan in enumerate(planned):
        looks = facing(paths, n)
        if plan.reason:
            heading[n] = UNSOLVED if np.isfinite(looks).any() else np.nan
            continue
        _, ground, velocity = plan.sampled(2 * PLACES)
        at, places = evenly(ground[:, :2])
        distance[n] = np.linalg.norm(places - evenly(paths.places[n])[1], axis=1).mean()
        off = np.abs(wrap(np.interp(at, np.arange(len(ground)), ground[:, 2]) - looks))
        heading[n] = off[np.isfinite(off)].mean() if np.isfinite(off).any() else np.nan
        turning[n] = np.abs(velocity[:, 1]).max()
    return Likeness(distance, heading, turning)


def planned_like(paths: HumanPaths, weights: Weights, limits: np.ndarray) -> list[Plan]:
    """Plans for the same starts and goals."""
    return plans(paths.starts, paths.goals, weights=weights, limits=limits)


def straight(paths: HumanPaths) -> np.ndarray:
    """How far straight lines are from the walks (N,) [m], at the same share of the way."""
    return np.array([np.linalg.norm(evenly(path[[0, -1]])[1] - evenly(path)[1], axis=1).mean() for path in paths.places])
