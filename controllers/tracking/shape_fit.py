"""How tall and how wide somebody is, from the first frames of a film: the size whose silhouettes cover best what cameras see."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize

from .pose import overlap
from .silhouettes import Surface, hidden, is_mask, own, rendered, shaped, skinned
from .tracker import Tracker
from .twists import Configuration, posed

ROUNDS = {False: 1, True: 2}
"""How often masks and size are taken in turns: masks given, found in pictures."""
SPREAD, TRIALS = 0.04, 34
"""How far off a size is looked for first, and how many are tried."""


@dataclass(frozen=True, eq=False)
class Shape:
    """stature, girth: over the given body's. surface: the body in them. overlap: of its silhouettes with those seen, 0 … 1;
    before: of the given body's."""

    stature: float
    girth: float
    surface: Surface
    overlap: float
    before: float


def fitted_shape(tracker: Tracker, now: Configuration, before: Configuration, frames: Sequence[Sequence[np.ndarray | None]]) -> Shape:
    """The size of whoever is tracked, by frames of all cameras, masks or pictures, that follow after the poses `before` and `now`."""
    shown = any(one is not None and not is_mask(one) for seen in frames for one in seen)
    stature = girth = 1.0
    value = first = 0.0
    for turn in range(ROUNDS[shown]):
        body = replace(tracker, surface=shaped(tracker.surface, stature, girth))
        masks = _masks(body, now, before, frames)

        def cost(x: np.ndarray, masks=masks) -> float:
            trial = replace(tracker, surface=shaped(tracker.surface, *np.exp(np.clip(x, -0.5, 0.5))),
                            settings=replace(tracker.settings, gate=False))
            return 1.0 - _covered(trial, now, before, masks)
        start = np.log([stature, girth])
        if turn == 0:
            first = 1.0 - cost(start)
        found = minimize(cost, start, method="Nelder-Mead", options={
            "initial_simplex": start + [[0.0, 0.0], [SPREAD, 0.0], [0.0, 2 * SPREAD]], "maxfev": TRIALS, "xatol": 2e-3, "fatol": 1e-5})
        (stature, girth), value = np.exp(found.x), 1.0 - float(found.fun)
    return Shape(float(stature), float(girth), shaped(tracker.surface, stature, girth), value, first)


def _masks(tracker: Tracker, now: Configuration, before: Configuration, frames: Sequence[Sequence[np.ndarray | None]]
           ) -> list[list[np.ndarray | None]]:
    """What is found of somebody in each camera's frames; masks as they are."""
    track, made = tracker.start(now, before), []
    for seen in frames:
        track = tracker.step(track, seen)
        made.append([one if one is None or is_mask(one) else mask for one, mask in zip(seen, tracker.masks(seen, track.now))])
    return made


def _covered(tracker: Tracker, now: Configuration, before: Configuration, frames: Sequence[Sequence[np.ndarray | None]]) -> float:
    """The mean overlap of a tracked body's silhouettes with masks."""
    track, shares = tracker.start(now, before), []
    for seen in frames:
        track = tracker.step(track, seen)
        vertices = skinned(tracker.surface, *posed(tracker.surface.chain, track.now)[:2])
        shares += [overlap(own(one), rendered(lens, vertices, tracker.surface.triangles).mask, hidden(one))
                   for lens, one in zip(tracker.lenses, seen) if one is not None and own(one).any()]
    return float(np.mean(shares)) if shares else 0.0
