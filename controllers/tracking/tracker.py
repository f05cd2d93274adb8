"""A body followed through a film of several cameras: pictures or masks in, a pose out, frame by frame.

A `Track` is all that is remembered; it goes in, and another one comes out. Pictures are segmented with the shape of the
body at the pose that is expected, the pose is fitted to that, and so on by turns, as section 3 of Rosenhahn 2007 has it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from .cameras import Lens
from .pose import (SETTINGS, Doubt, Evidence, Fit, Glimpse, Observed, Penalty, SolverSettings, brought, calmed, carried, held, in_hindsight, judged, observed,
                   overlap, part_way, penalty_of, predicted, solve)
from .segmentation import SEGMENTATION, Segmentation, Segmented, segmented
from .silhouettes import Surface, View, hidden, is_mask, own, redrawn, rendered, skinned
from .together import together
from .twists import Configuration, posed

FIRM = 3.0
"""How firmly the penalty holds, times what bounds on acceleration say, where contours are ROUGH."""
ROUGH = 0.6
"""So far off are contours [pixels] on average under the paper's noise: cleaner ones count for more, rougher ones for less."""
CLEANEST, ROUGHEST = 0.03, 1.5
"""Nobody is believed to be better than that [pixels], or worse."""
EXPLAINED, COLOURED = 0.72, 0.88
"""A pose that covers so much of the usual in every silhouette explains them; where colours say how much, which agree with more."""
GOES_ON, RESTS = 0.1, 0.1
"""Whoever nobody sees goes on as before for so long [s], and then comes to rest: the half-life of their pace [s]."""
FASTEST = 12.0
"""Nobody's hips go faster [m/s]."""
SURE = 0.9
"""A pose that covers so much of the usual in every silhouette is one to begin with again when somebody was lost."""
CLEARLY = 0.02
"""By so much do silhouettes agree more in all with arms that are held otherwise, without the camera that says most for it: a rectangle is in one."""
PAST = 8
"""So many frames before the one that is looked back at say how it moved."""


@dataclass(frozen=True)
class TrackerSettings:
    """start: where a frame's search begins, at the prediction or at the last pose. penalty: draw it to the prediction, too.
    pace: how far joints go on as before where the penalty draws them, 1 as the paper's eq. (16), 0 not at all.
    gate: leave out cameras whose picture is not what could be expected. firmness: of the penalty, times what bounds on
    acceleration say. carriage: how firmly arms are drawn to how people carry them where contours are ROUGH [1/rad²]. rounds: of segmentation and pose, where pictures are seen; pictures: the solver of each.
    restarts: try arms as people hold them where contours stay worse than usual. lag: so many frames late may a pose come, by `Tracker.hindsight`;
    0 keeps nothing for that."""

    start: Literal["prediction", "last"] = "prediction"
    penalty: bool = True
    pace: float = 0.0
    gate: bool = True
    firmness: float = FIRM
    carriage: float = 0.0
    restarts: bool = False
    solver: SolverSettings = SETTINGS
    rounds: int = 2
    pictures: SolverSettings = replace(SETTINGS, outer=2)
    segmentation: Segmentation = replace(SEGMENTATION, rounds=1)
    lag: int = 0


@dataclass(frozen=True, eq=False)
class Track:
    """What is known after a frame. now, before: the last two poses. fit: how the last one was found; None at the start.
    recent: what the last frames said, where a pose may come late. unseen: for so many frames nobody has been seen.
    sure: the last pose that was as it looked. doubt: whether arms are where they seem. restarted: they were found elsewhere in this frame."""

    now: Configuration
    before: Configuration
    evidence: Evidence
    fit: Fit | None = None
    recent: tuple[Glimpse, ...] = ()
    unseen: int = 0
    sure: Configuration | None = None
    doubt: Doubt = Doubt()
    restarted: bool = False


@dataclass(frozen=True, eq=False)
class Tracker:
    """Who follows a body. rate: frames a second of the film. plates: each camera's picture with nobody in it, if there are any."""

    surface: Surface
    lenses: tuple[Lens, ...]
    rate: float = 60.0
    settings: TrackerSettings = field(default_factory=TrackerSettings)
    plates: tuple[np.ndarray, ...] | None = None

    def start(self, now: Configuration, before: Configuration | None = None) -> Track:
        """A track from a known pose, and the one a frame earlier where that is known; else it stands still."""
        return Track(now, before or now, Evidence.fresh(len(self.lenses)))

    def step(self, track: Track, seen: Sequence[np.ndarray | None]) -> Track:
        """The track after one more frame. seen: of each camera a mask (H, W) bool, or int8 where others are seen, too (`silhouettes.masks`),
        or a picture (H, W, 3) or (H, W) uint8; None of one whose frame was dropped.

        ValueError for another number of them, or one of another size than its camera's pictures.
        """
        if len(seen) != len(self.lenses):
            raise ValueError(f"{len(self.lenses)} cameras need as many masks or pictures, got {len(seen)}")
        chosen, chain = self.settings, self.surface.chain
        there = np.array([one is not None for one in seen])
        shown = np.array([one is not None and not is_mask(one) for one in seen])
        target = self._bounded(track.now, predicted(chain, track.now, track.before))
        if track.unseen > GOES_ON * self.rate:
            target = part_way(chain, track.now, target, 0.5 ** (1.0 / (RESTS * self.rate)))
        start = target if chosen.start == "prediction" else track.now
        rough = ROUGH if track.fit is None else min(max(track.fit.residual, CLEANEST), ROUGHEST)
        firmness = chosen.firmness * (rough / ROUGH) ** 2

        def drawn_to(where: Configuration) -> Penalty | None:
            if not chosen.penalty:
                return None
            made = penalty_of(chain, where, self.rate, firmness)
            return carried(chain, made, chosen.carriage * (rough / ROUGH) ** 2) if chosen.carriage else made
        penalty = drawn_to(calmed(chain, track.now, target, chosen.pace))
        hiding = [hidden(one) for one in seen]
        evidence, believed, found, drawn = track.evidence, there, None, None
        for k in range(chosen.rounds if shown.any() else 1):
            found, drawn = self._found(seen, start, found, drawn)
            agreements = np.array([one.agreement for one in found])

            def believe(overlaps: np.ndarray, first=k == 0, agreements=agreements) -> np.ndarray:
                nonlocal evidence, believed
                if chosen.gate and first:
                    evidence, believed = judged(evidence, np.where(shown & ~np.isnan(overlaps), agreements, overlaps))
                return believed & there
            views = together(observed, self.lenses, [one.mask for one in found], hiding)
            fit = solve(self.surface, views, start, penalty, believe, chosen.pictures if shown.any() else chosen.solver, drawn)
            start = fit.where
        doubt, restarted = track.doubt, False
        blind, now = not fit.matrix.any(), track.now
        if chosen.gate and (blind or (there & ~fit.believed).any()) and (
                second := self._second_look(seen, there, shown, track, target, evidence)) is not None:
            fit, evidence, led = second
            blind, now = False, now if led else fit.where  # who is found elsewhere did not go there within a frame
        else:
            fit = replace(fit, where=target if blind else self._bounded(now, fit.where))
            if chosen.restarts and not blind:
                doubt = doubt.after(fit.residual, self.rate)
                if doubt.way is not None and (other := self._otherwise(views, held(chain, fit.where, doubt.way), fit, drawn_to)) is not None:
                    fit, restarted = other, True
                    doubt, now = doubt.mended(fit.residual), Configuration(now.root, fit.where.angles)  # nobody's arms went there within a frame
        recent: tuple[Glimpse, ...] = ()
        if chosen.lag:
            sure = (ROUGH / min(max(fit.residual, CLEANEST), ROUGHEST)) ** 2
            recent = (*track.recent, Glimpse(fit.where, sure * fit.matrix, sure * fit.vector))[-(PAST + 1 + chosen.lag):]
        told = there & ~np.isnan(fit.overlaps)
        sure = fit.where if (fit.overlaps[told] >= SURE * evidence.usual[told]).all() and not blind else track.sure
        return Track(fit.where, now, evidence, fit, recent, track.unseen + 1 if blind else 0, sure, doubt, restarted)

    def hindsight(self, track: Track) -> list[Configuration]:
        """The poses of the last frames as they look now, the newest last: the one `settings.lag` before it is as good as it gets."""
        return in_hindsight(self.surface.chain, track.recent, self.rate)

    def _second_look(self, seen: Sequence[np.ndarray | None], there: np.ndarray, shown: np.ndarray, track: Track, target: Configuration,
                     evidence: Evidence) -> tuple[Fit, Evidence, bool] | None:
        """The fit to all pictures, doubted ones too, if it explains them nearly as well as usual: then it was the prediction that was wrong.

        Pictures of something else are explained by no pose nearby. Whoever was not seen for some frames is looked for where
        they were led, and if not there, with joints as they were: noise in their pace leads the farther astray the longer. Nor
        where they were led, but where masks show them, is whoever was not seen for longer. The last says whether they were where they were led.
        """
        chain, now = self.surface.chain, track.now
        starts = [target, calmed(chain, now, target, 0.0)] if there.any() and track.evidence.doubted.any() else [target]
        usual, hiding = evidence.usual * np.where(shown, COLOURED, EXPLAINED), [hidden(one) for one in seen]
        led = len(starts)
        if track.unseen >= GOES_ON * self.rate and not shown.any():
            if (shifted := brought(self.surface, self.lenses, self.masks(seen, now), hiding, track.sure or now)) is None:
                return None
            starts.append(shifted)
        for k, where in enumerate(starts):
            found, drawn, fit = None, None, None
            for _ in range(2):
                found, drawn = self._found(seen, where, found, drawn)
                views = together(observed, self.lenses, [one.mask for one in found], hiding)
                fit = solve(self.surface, views, where, None, lambda _: there, self.settings.solver, drawn)
                where = fit.where
            found, _ = self._found(seen, where, found, drawn)
            vertices = skinned(self.surface, *posed(chain, where)[:2])
            overlaps = np.array([one.agreement if colours else overlap(one.mask, rendered(lens, vertices, self.surface.triangles).mask, others)
                                 for lens, one, colours, others in zip(self.lenses, found, shown, hiding)])
            told = there & ~np.isnan(overlaps)
            if fit is not None and told.any() and (overlaps[told] >= usual[told]).all():
                return fit, Evidence(evidence.usual, np.where(there, 0, evidence.doubted)), k < led
        return None

    def _otherwise(self, views: Sequence[Observed], start: Configuration, fit: Fit, drawn_to: Callable[[Configuration], Penalty | None]) -> Fit | None:
        """The fit from another start, if it clearly explains silhouettes better than this frame's; of cameras that are believed."""
        other = solve(self.surface, views, start, drawn_to(start), lambda _: fit.believed, self.settings.solver)

        def agreement(where: Configuration) -> np.ndarray:
            vertices = skinned(self.surface, *posed(self.surface.chain, where)[:2])
            return np.array([overlap(view.mask, rendered(view.lens, vertices, self.surface.triangles).mask, view.hidden)
                             for view, told in zip(views, fit.believed) if told])
        gains = np.nan_to_num(agreement(other.where) - agreement(fit.where))
        return replace(other, overlaps=fit.overlaps) if gains.sum() - max(gains.max(initial=0.0), 0.0) >= CLEARLY else None

    def _bounded(self, now: Configuration, target: Configuration) -> Configuration:
        """A pose no farther from another than people go within a frame."""
        far, most = float(np.linalg.norm(target.root[:3, 3] - now.root[:3, 3])), FASTEST / self.rate
        return target if far <= most else part_way(self.surface.chain, now, target, most / far)

    def masks(self, seen: Sequence[np.ndarray | None], where: Configuration) -> list[np.ndarray]:
        """Who is in each camera's picture, (H, W) bool, for somebody near a pose; masks as they are, empty ones of dropped frames."""
        return [one.mask for one in self._found(seen, where, None, None)[0]]

    def _found(self, seen: Sequence[np.ndarray | None], where: Configuration, before: Sequence[Segmented] | None,
               room: list[View | None] | None) -> tuple[list[Segmented], list[View | None] | None]:
        """Who is in each camera's picture near a pose, masks as they are; and the model there, where it had to be drawn.

        before: what an earlier turn found in the same pictures. room: views to draw over.
        """
        many = len(seen)
        if all(one is None or is_mask(one) for one in seen):
            return [Segmented(np.zeros(lens.size[::-1], bool) if one is None else own(one), 0.0) for lens, one in zip(self.lenses, seen)], None
        vertices = skinned(self.surface, *posed(self.surface.chain, where)[:2])

        def act(lens: Lens, one: np.ndarray | None, plate: np.ndarray | None, old: Segmented | None, kept: View | None
                ) -> tuple[Segmented, View | None]:
            if one is None or is_mask(one):
                return Segmented(np.zeros(lens.size[::-1], bool) if one is None else own(one), 0.0), None
            drawn = redrawn(lens, vertices, self.surface.triangles, kept)
            return segmented(one, drawn.mask, plate, self.settings.segmentation, None if old is None else old.cut), drawn
        parts = together(act, self.lenses, seen, self.plates or (None,) * many, before or (None,) * many, room or (None,) * many)
        return [one for one, _ in parts], [view for _, view in parts]
