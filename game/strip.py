"""A strip of poses: one motion of a scenario in pictures side by side, seen from its side, as Muybridge took them."""

from __future__ import annotations

from typing import Any

import numpy as np

from .film import run
from .input.script import jumping
from .jumping import explained
from .scenario import Scenario, ScenarioError
from .scene import Camera, Overlays, Scene
from .world import figures

FOV = 0.42
"""Of the camera, which stands far off so that all poses are seen alike [rad]."""
AROUND = 0.24
"""What is left free around a body [m]."""
AFTER = 0.35
"""A jump is shown until so long after its landing [s]."""


def strip(scenario: Scenario, controller: Any, count: int, shown: Overlays, size: tuple[int, int],
          start: float | None = None, end: float | None = None, actor: str | None = None) -> tuple[Scene, ...]:
    """`count` moments of an actor (the first by default) in equal steps from `start` to `end` [s].

    By default those of its first jump, from before the wind-up to after the landing, or all of the scenario if
    it makes none. size: of the whole picture in pixels. ScenarioError for an actor or a time that there is not.
    """
    names = [one.name for one in scenario.actors]
    if actor is not None and actor not in names:
        raise ScenarioError(f"no actor is called {actor!r}; there are {', '.join(names)}")
    who, frames = names.index(actor) if actor is not None else 0, list(run(scenario.at_fps(60), controller))
    jumps = [frame.time for frame in frames if (now := jumping(frame.after.characters[who].state)) is not None
             and now.time < now.plan.touch_down + AFTER]
    if start is None and end is None and jumps:
        gaps = np.flatnonzero(np.diff(jumps) > 0.1)
        start, end = jumps[0], jumps[gaps[0]] if len(gaps) else jumps[-1]
    start, end = start or 0.0, frames[-1].time if end is None else min(end, frames[-1].time)
    if not start < end:
        raise ScenarioError(f"nothing lies from {start:g} to {end:g} s of {scenario.title!r}, which has {scenario.duration:g} s")
    chosen = [frames[round(time * 60)] for time in np.linspace(start, end, count)]
    drawn = [explained(figures(f.before, f.after, f.alpha), f.before, f.after, f.alpha, shown) for f in chosen]
    bodies = [np.asarray(people[who].positions) for people in drawn]
    heading = float(chosen[0].after.characters[who].state.ground[2])
    ahead = np.array([np.sin(heading), 0.0, np.cos(heading)])
    middles = [float((0.5 * ((body @ ahead).min() + (body @ ahead).max()))) for body in bodies]
    wide = max(float(np.abs(body @ ahead - middle).max()) for body, middle in zip(bodies, middles)) + AROUND
    low, high = min(body[:, 1].min() for body in bodies) - AROUND, max(body[:, 1].max() for body in bodies) + 2.0 * AROUND
    aspect = size[0] / count / size[1]
    far = max(0.5 * (high - low), wide / aspect) / np.tan(0.5 * FOV)
    beside = np.array([ahead[2], 0.0, -ahead[0]])  # seen from the right, so that forward is to the right
    scenes = []
    for number, (frame, people, body, middle) in enumerate(zip(chosen, drawn, bodies, middles)):
        target = body[0] + (middle - body[0] @ ahead) * ahead
        target[1] = 0.5 * (low + high)
        eye = target - far * beside + [0.0, 0.04 * far, 0.0]
        scenes.append(Scene(Camera(eye, target, fov=FOV), people, frame.after.props, shown,
                            (f"{frame.time - chosen[0].time:.2f} s",), part=(number / count, 0.0, 1.0 / count, 1.0)))
    return tuple(scenes)
