"""What there is to see of points that are followed: where they are, which are lost, and what the followers miss them by."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..scene import Dot, Figure, Line, Overlays, Sketch
from ..world import Character, Errors, World, lately

SEEN, LOST, MISSED = (0.90, 0.72, 0.10), (0.88, 0.88, 0.86), (0.85, 0.06, 0.03)
"""Colours of a point that is seen, of one that is not, and of the way from a point to where the body has it."""
RADIUS = 0.036
"""Of a point [m]."""
SHOWN = 0.01
"""A body misses a point by more than this [m] before it is drawn."""


@dataclass(frozen=True, eq=False)
class Marks:
    """The points (n, 3) [m] of a follower as they are drawn. seen: (n,) bool. body: (n, 3) where the body has them."""

    places: np.ndarray
    seen: np.ndarray
    body: np.ndarray


def pointed(figures: Sequence[Figure], before: World, after: World, alpha: float, overlays: Overlays) -> tuple[Figure, ...]:
    """The figures of `gambol.game.world.world.figures` with the points that are followed, if the overlays show them.

    Followers of the same points at the same place show them once; the performer has them, too.
    """
    if not overlays.points:
        return tuple(figures)
    drawn, shown = list(figures), set()
    for k, (old, new) in enumerate(zip(before.characters, after.characters)):
        follows = new.follows
        if follows is None:
            continue
        performer = next((n for n, one in enumerate(after.characters) if one.name == follows.performer), None)
        marks = marks_of(old, new, figures[k], None if performer is None else figures[performer], alpha)
        if marks is None:
            continue
        same = follows.performer, follows.controls.names
        here = *same, tuple(np.round(follows.beside, 3))
        balls = [] if here in shown else _balls(marks.places, marks.seen)
        if performer is not None and same not in shown and follows.beside.any():
            at = figures[performer]
            balls += _balls(follows.controls.on(np.asarray(at.positions), np.asarray(at.orientations)), marks.seen)
        shown |= {here, same}
        drawn[k] = replace(drawn[k], sketches=(*drawn[k].sketches, *balls, *_misses(marks, new.opacity)))
    return tuple(drawn)


def marks_of(old: Character, new: Character, figure: Figure, performer: Figure | None, alpha: float) -> Marks | None:
    """A follower's points between two worlds; None where it has never been told of any, or follows none.

    figure, performer: as they are drawn. A lost point is drawn where the performer has it, or the body.
    """
    follows, goals = new.follows, new.intent.points
    if follows is None or goals is None:
        return None
    body = follows.controls.on(np.asarray(figure.positions), np.asarray(figure.orientations))
    earlier = old.intent.points if old.follows is not None and old.intent.points is not None else goals
    earlier = earlier if np.shape(earlier) == np.shape(goals) else goals
    between = np.where(np.isfinite(earlier), earlier + alpha * (goals - earlier), goals)
    seen = np.all(np.isfinite(between), -1)
    there = body if performer is None else follows.there(np.asarray(performer.positions), np.asarray(performer.orientations))
    if performer is not None and follows.noise == 0.0:  # the very place, as it is drawn
        between = np.where(seen[:, None], there, between)
    return Marks(np.where(seen[:, None], between, there), seen, body)


def _balls(places: np.ndarray, seen: np.ndarray) -> list[Sketch]:
    return [Dot("points", place, SEEN, RADIUS, through=True, look="ball") if there else
            Dot("points", place, LOST, 1.25 * RADIUS, through=True, look="ring", opacity=0.85)
            for place, there in zip(places, seen)]


def _misses(marks: Marks, opacity: float) -> list[Sketch]:
    """A line from each point that is missed to where the body has it."""
    return [Line("points", np.stack([place, at]), MISSED, 0.012, (0.8 * opacity, 0.8 * opacity), through=True)
            for place, at, seen in zip(marks.places, marks.body, marks.seen)
            if seen and float(np.linalg.norm(place - at)) > SHOWN]


@dataclass(frozen=True)
class Row:
    """A line of the legend: a follower, its colour, linear RGB, and its errors; None before there are any."""

    name: str
    tint: tuple[float, float, float]
    ghost: bool
    errors: Errors | None
    history: tuple[float, ...]


def rows(world: World) -> tuple[Row, ...]:
    """The legend of a world: a row for each follower, its mean errors [m] of the last seconds with it."""
    return tuple(Row(one.name, one.tint, one.opacity < 1.0, lately(one.told), tuple(one.told[:, 0].tolist()))
                 for one in world.characters if one.follows is not None or one.watches is not None)
