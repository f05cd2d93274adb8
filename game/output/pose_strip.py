"""A strip of poses: one motion of a scenario in pictures side by side, seen from its side, as Muybridge took them.

Each actor has a row of its own, all to one scale.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..explain import explained
from ..input import jumping
from ..scenario import Frame, Scenario, ScenarioError, run
from ..scene import Camera, Overlays, Scene
from ..world import Character, figures

FOV = 0.42
"""Of the camera, which stands far off so that all poses are seen alike [rad]."""
AROUND = 0.24
"""What is left free around a body [m]."""
UPRIGHT = 0.94
"""A body stands or walks upright with its pelvis above this share of how high it stands."""


def strip(scenario: Scenario, controller: Any, count: int, shown: Overlays, size: tuple[int, int],
          start: float | None = None, end: float | None = None, actor: str | None = None,
          tell: Callable[[str], None] = lambda line: None) -> tuple[Scene, ...]:
    """`count` moments of an actor, or of each in its row, in equal steps from `start` to `end` [s].

    By default those of the first jump, from before the wind-up until the body stands or walks again, or all of the
    scenario if there is none. Each tells when in the scenario it is. size: of the whole picture in pixels. tell: hears of each
    jump that was not made and each place not reached. ScenarioError for an actor or a time that
    there is not.
    """
    names = [one.name for one in scenario.actors]
    if actor is not None and actor not in names:
        raise ScenarioError(f"no actor is called {actor!r}; there are {', '.join(names)}")
    cast = range(len(names)) if actor is None else [names.index(actor)]
    _check(scenario, start or 0.0, scenario.duration if end is None else end)
    frames = list(run(scenario.at_fps(60), controller))
    for line in frames[-1].refused:
        tell(line)
    if start is None and end is None:
        start, end = _first_jump(frames, cast)
    start, end = start or 0.0, frames[-1].time if end is None else min(end, frames[-1].time)
    _check(scenario, start, end)
    chosen = [frames[round(time * 60)] for time in np.linspace(start, end, count)]
    drawn = [explained(figures(f.before, f.after, f.alpha), f.before, f.after, f.alpha, shown) for f in chosen]
    headings = [float(chosen[0].after.characters[who].state.ground[2]) for who in cast]
    ahead = np.stack([np.sin(headings), np.zeros(len(cast)), np.cos(headings)], 1)
    bodies = [[np.asarray(people[who].positions) for people in drawn] for who in cast]
    reach = np.array([[((body @ way).min(), (body @ way).max()) for body in row] for row, way in zip(bodies, ahead)])
    middles, wide = reach.mean(-1), float(np.ptp(reach, axis=-1).max()) / 2 + AROUND
    heights = np.concatenate([body[:, 1] for row in bodies for body in row])
    low, high = heights.min() - AROUND, heights.max() + 2.0 * AROUND
    aspect = size[0] / count / (size[1] / len(cast))
    far = max(0.5 * (high - low), wide / aspect) / np.tan(0.5 * FOV)
    scenes = []
    for row, who in enumerate(cast):
        beside = np.array([ahead[row, 2], 0.0, -ahead[row, 0]])  # seen from the right, so that forward is to the right
        for number, (frame, people, body) in enumerate(zip(chosen, drawn, bodies[row])):
            target = body[0] + (middles[row, number] - body[0] @ ahead[row]) * ahead[row]
            target[1] = 0.5 * (low + high)
            eye = target - far * beside + [0.0, 0.04 * far, 0.0]
            scenes.append(Scene(Camera(eye, target, fov=FOV), people[who:who + 1], frame.after.props, shown,
                                (f"{frame.time:.2f} s",),
                                part=(number / count, row / len(cast), 1.0 / count, 1.0 / len(cast))))
    return tuple(scenes)


def _check(scenario: Scenario, start: float, end: float) -> None:
    if not start < min(end, scenario.duration):
        raise ScenarioError(f"nothing lies from {start:g} to {end:g} s of {scenario.title!r}, which has {scenario.duration:g} s")


def _up(character: Character) -> bool:
    """Whether somebody who has landed stands upright again."""
    height = float(character.state.pose.root[1]) - float(character.state.floor)
    return height > UPRIGHT * float(character.controller.skeleton.offsets[0, 1])


def _first_jump(frames: Sequence[Frame], cast: Sequence[int]) -> tuple[float | None, float | None]:
    """From when to when [s] the first jump of a cast lasts, with those of others that begin meanwhile; None without one."""
    spans = []
    for who in cast:
        people = [frame.after.characters[who] for frame in frames]
        states = [jumping(one.state) for one in people]
        begins = next((n for n, now in enumerate(states) if now is not None), None)
        if begins is not None:
            # one that strikes something falls under another plan
            own = [now is not None and (now.plan is states[begins].plan or now.hits > 0) for now in states]
            ends = next((n for n in range(begins, len(frames)) if not own[n]), len(frames) - 1)
            spans.append((begins, next((n for n in range(ends, len(frames)) if _up(people[n])), len(frames) - 1)))
    if not spans:
        return None, None
    first, last = min(spans)
    for begins, ends in sorted(spans):
        last = max(last, ends) if begins <= last else last
    return frames[first].time, frames[last].time
