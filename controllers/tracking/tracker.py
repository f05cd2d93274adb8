"""A body followed through a film of several cameras: masks in, a pose out, frame by frame.

A `Track` is all that is remembered; it goes in, and another one comes out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from .cameras import Lens
from .pose import SETTINGS, Evidence, Fit, Observed, SolverSettings, calmed, judged, observed, penalty_of, predicted, solve
from .silhouettes import Surface
from .twists import Configuration

FIRM = 3.0
"""How firmly the penalty holds, times what bounds on acceleration say, where contours are ROUGH."""
ROUGH = 0.6
"""So far off are contours [pixels] on average under the paper's noise: cleaner ones count for more, rougher ones for less."""
CLEANEST, ROUGHEST = 0.03, 1.5
"""Nobody is believed to be better than that [pixels], or worse."""


@dataclass(frozen=True)
class TrackerSettings:
    """start: where a frame's search begins, at the prediction or at the last pose. penalty: draw it to the prediction, too.
    pace: how far joints go on as before where the penalty draws them, 1 as the paper's eq. (16), 0 not at all.
    gate: leave out cameras whose picture is not what could be expected. firmness: of the penalty, times what bounds on
    acceleration say."""

    start: Literal["prediction", "last"] = "prediction"
    penalty: bool = True
    pace: float = 0.0
    gate: bool = True
    firmness: float = FIRM
    solver: SolverSettings = SETTINGS


@dataclass(frozen=True, eq=False)
class Track:
    """What is known after a frame. now, before: the last two poses. fit: how the last one was found; None at the start."""

    now: Configuration
    before: Configuration
    evidence: Evidence
    fit: Fit | None = None


@dataclass(frozen=True, eq=False)
class Tracker:
    """Who follows a body. rate: frames a second of the film."""

    surface: Surface
    lenses: tuple[Lens, ...]
    rate: float = 60.0
    settings: TrackerSettings = field(default_factory=TrackerSettings)

    def start(self, now: Configuration, before: Configuration | None = None) -> Track:
        """A track from a known pose, and the one a frame earlier where that is known; else it stands still."""
        return Track(now, before or now, Evidence.fresh(len(self.lenses)))

    def step(self, track: Track, masks: Sequence[np.ndarray | None]) -> Track:
        """The track after one more frame. masks: (H, W) bool of each camera; None of one whose frame was dropped.

        ValueError for another number of masks, or one of another size than its camera's pictures.
        """
        if len(masks) != len(self.lenses):
            raise ValueError(f"{len(self.lenses)} cameras need as many masks, got {len(masks)}")
        chosen, chain = self.settings, self.surface.chain
        there = [mask is not None for mask in masks]
        views = [_seen(lens, mask) for lens, mask in zip(self.lenses, masks)]
        target = predicted(chain, track.now, track.before)
        start = target if chosen.start == "prediction" else track.now
        rough = ROUGH if track.fit is None else min(max(track.fit.residual, CLEANEST), ROUGHEST)
        firmness = chosen.firmness * (rough / ROUGH) ** 2
        penalty = None
        if chosen.penalty:
            penalty = penalty_of(chain, calmed(chain, track.now, target, chosen.pace), self.rate, firmness)
        kept = [track.evidence]

        def believe(overlaps: np.ndarray) -> np.ndarray:
            if not chosen.gate:
                return np.array(there)
            kept[0], believed = judged(track.evidence, overlaps)
            return believed & there
        fit = solve(self.surface, views, start, penalty, believe, chosen.solver)
        if not fit.believed.any():  # nothing speaks against going on
            fit = replace(fit, where=target)
        return Track(fit.where, track.now, kept[0], fit)


def _seen(lens: Lens, mask: np.ndarray | None) -> Observed:
    return observed(lens, np.zeros(lens.size[::-1], bool) if mask is None else mask)
