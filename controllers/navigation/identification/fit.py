"""Inverse optimal control: the weights with which plans are most like people's walks (Mombaur 2010).

A search without derivatives over the logarithms of α₂, α₃ and α₄, whose every trial solves the control problem for every
walk. α₀ is the unit. Walks are recorded over shares of their time, not over seconds, and a walk that takes longer by a factor k costs
the same with α₁, α₂ and α₃ larger by k⁴: so that α₁ sets the pace, and is given.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import minimize

from ..planning import Weights
from .human_paths import HumanPaths
from .likeness import Likeness, likeness, planned_like

FIRST = Weights(1.0, 0.35, 0.03, 1.0, 2.2)
"""Where the search begins: weights at which people's speeds come out."""
HEADING = 0.1
"""A radian counts as so many metres."""
HOLD = 0.001
"""What a weight e times its first value costs [m]: what the walks don't tell stays as it was."""
TRIALS = 150
"""So many sets of weights are tried."""


def fit(paths: HumanPaths, limits: np.ndarray, first: Weights = FIRST, trials: int = TRIALS,
        progress: Callable[[int], None] = lambda done: None) -> Weights:
    """The weights with which plans within limits (H, 4) are most like the walks, from a first guess whose time and forward are kept."""
    began = np.log(first[2:])
    done = 0

    def miss(logs: np.ndarray) -> float:
        nonlocal done
        done += 1
        progress(done)
        weights = Weights(first.time, first.forward, *np.exp(np.clip(logs, -12.0, 6.0)).tolist())
        distance, heading, _ = likeness(paths, planned_like(paths, weights, limits)).means()
        return distance + HEADING * (heading if np.isfinite(heading) else 0.0) + HOLD * float(np.sum((logs - began) ** 2))

    simplex = np.vstack([began, began + 0.7 * np.eye(3)])
    best = minimize(miss, began, method="Nelder-Mead", options=dict(maxfev=trials, xatol=0.01, fatol=1e-5, initial_simplex=simplex))
    return Weights(first.time, first.forward, *np.exp(best.x).tolist())


def left_out(paths: HumanPaths, limits: np.ndarray, folds: int, first: Weights = FIRST, trials: int = TRIALS,
             progress: Callable[[int], None] = lambda done: None) -> tuple[Likeness, list[Weights]]:
    """How like plans are to walks that their weights were not fitted to: each part of `folds` with the weights of the others."""
    part = np.arange(len(paths)) % folds
    found, all_weights = np.full((3, len(paths)), np.nan), []
    for fold in range(folds):
        weights = fit(paths.of(part != fold), limits, first, trials, lambda done, begun=fold * trials: progress(begun + done))
        rest = paths.of(part == fold)
        found[:, part == fold] = likeness(rest, planned_like(rest, weights, limits))
        all_weights.append(weights)
    return Likeness(*found), all_weights
