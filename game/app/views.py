"""What a moment of a session looks like: one scene for each player, side by side."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from fractions import Fraction
from itertools import zip_longest
from typing import Any

import numpy as np

from gambol.controllers.jump import HARD, PACE
from gambol.controllers.navigation import clearance

from ..camera import seen_past
from ..explain import AT_ONCE, NO, Preview, broken, explained, ghosts, led, pointed, preview, stepping
from ..input import Aim
from ..scene import Camera, Figure, Overlays, Scene
from ..session import Log, SessionState, replay, strayed
from ..world import RATE, figures


Previews = tuple[Preview | None, ...]
FAINT = 0.3
"""So much is seen of a body that is in something …"""
NEAR, WITHIN = 0.15, -0.05
"""… and all of one that is nowhere nearer to it than the first [m]."""


def previews(moment: SessionState, before: Previews = (), crew: Executor = AT_ONCE) -> Previews:
    """The jumps that players aim at. before: those of a picture earlier; crew: who finds out what takes long."""
    return tuple(preview(character, player.aim, moment.after.about(i), old, crew)
                 for i, (player, character, old) in enumerate(zip_longest(moment.players, moment.after.characters[:len(moment.players)],
                                                           before[:len(moment.players)])))


def scenes(moment: SessionState, fraction: float, cameras: Sequence[Camera], overlays: Overlays,
           text: Sequence[tuple[str, ...]] = (), aimed: Previews | None = None) -> tuple[Scene, ...]:
    """One scene for each camera.

    fraction: how far from `moment.before` to `moment.after` (0 … 1). text: for each camera, the
    lines in its corner; why a jump that is aimed at can't be made comes after them. aimed: `previews`. Whoever stands between a
    player and the camera that follows is seen through in that view.
    """
    before, after, width = moment.before, moment.after, 1.0 / len(cameras)
    aimed = previews(moment) if aimed is None else aimed
    people = explained(figures(before, after, fraction), before, after, fraction, overlays, aimed)
    people = stepping(led(pointed(people, before, after, fraction, overlays), after, overlays, len(moment.players)), after, overlays)
    people += ghosts(aimed, people, after) if overlays.jump else ()
    text = tuple(text) or ((),) * len(cameras)
    text = tuple((*lines, *broken(_told(player.aim, seen))) if seen is not None and seen.fault else lines
                 for lines, seen, player in zip(text, aimed, moment.players, strict=True))
    held = _held(moment)
    def seen(people: tuple[Figure, ...], i: int, camera: Camera) -> tuple[Figure, ...]:
        return people if moment.players[i].camera.flown else seen_past(people, camera, (i, *held))
    return tuple(Scene(camera, _through(seen(people, i, camera), moment), moment.after.props, overlays, lines,
                       part=(i * width, 0.0, width, 1.0))
                 for i, (camera, lines) in enumerate(zip(cameras, text, strict=True)))


def _told(aim: Aim, seen: Preview) -> str:
    """What somebody is told of a jump as he aims. Who has let go is refused only once nothing comes of it, and then told; nor does who moves hear of the pace of each moment: he chooses among his
    next footfalls, and has another pace by then."""
    if not aim.aiming and seen.told.startswith(NO) or aim.moving and seen.fault.startswith((*PACE, HARD)):
        return ""
    return seen.told


def _through(people: tuple[Figure, ...], moment: SessionState) -> tuple[Figure, ...]:
    """The figures, fainter where a body that does beside somebody what he does goes through what stands there."""
    drawn = list(people)
    for number, one in enumerate(moment.after.characters):
        if one.follows is None and one.watches is None or not moment.after.props:
            continue
        trunk = np.ascontiguousarray(drawn[number].positions[: one.controller.skeleton.index("Head") + 1], float)  # from the hips up
        far = float(clearance(trunk, moment.after.props).min())
        share = min(max((far - WITHIN) / (NEAR - WITHIN), 0.0), 1.0)
        drawn[number] = replace(drawn[number], cover=min(drawn[number].cover, FAINT + (1.0 - FAINT) * share * share * (3.0 - 2.0 * share)))
    return tuple(drawn)


def _held(moment: SessionState) -> list[int]:
    """Whose points hands hold, by number: they are looked at as closely as who is played."""
    holds = moment.comparison is not None and moment.comparison.pins is not None
    return [number for number, one in enumerate(moment.after.characters) if one.follows is not None] if holds else []


def frames(log: Log, fps: Fraction, start: float, end: float) -> int:
    """How many frames a part of a log has, from `start` to `end` [s]."""
    return max(int((min(end, log.duration) - start) * float(fps) + 1e-6), 1)


def filmed(log: Log, controller: Any, fps: Fraction, start: float, end: float, overlays: Overlays,
           stray: Callable[[], None] = lambda: None) -> Iterator[tuple[Scene, ...]]:
    """Every frame of a part of a log, as the players saw it; stray: called once if it goes another way.

    LogError where the log can't be played.
    """
    moments, told, aimed = replay(log, controller), False, ()
    moment, first = next(moments), round(start * RATE)
    for frame in range(frames(log, fps, start, end)):
        # in fractions, so that no frame rate drifts
        ticks, rest = divmod(frame * RATE, fps)
        while moment.number < min(first + ticks + 1, len(log.ticks)):
            moment = next(moments)
            if not told and strayed(log, moment):
                stray()
                told = True
        alpha, aimed = float(rest / fps), previews(moment, aimed)
        yield scenes(moment, moment.fraction(alpha), [player.view(alpha) for player in moment.players], overlays, aimed=aimed)
