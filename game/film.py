"""A scenario as it runs: the worlds between which each frame lies, and the scenes that film it.

Time is frame / fps and the simulation keeps its own rate, so another frame rate films the same
motion.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from controllers.body.springs import damp
from controllers.navigation import in_world

from .camera import CameraSettings, Follow
from .input import Wish
from .rail import dolly, fixed
from .scenario import Scenario, ShotTable, overlays
from .scene import Camera, Overlays, Scene
from .world import DT, RATE, Character, World, figures, ground_between

TITLE_SECONDS = 3.0
LOOK_HALFLIFE = 0.15
LOOK_HEIGHT = 1.0


@dataclass(frozen=True, eq=False)
class Frame:
    """One frame of a run: it shows the moment `alpha` (0 … 1) of the way from `before` to `after`."""

    number: int
    time: float
    before: World
    after: World
    alpha: float


def opening(scenario: Scenario, controller: Any) -> World:
    """The world before the first step, every actor under the same controller."""
    return World(props=tuple(prop.box() for prop in scenario.props), characters=tuple(
        Character(actor.name, controller, tint=actor.tint,
                  state=controller.start(ground=(actor.start[0], actor.start[1], math.radians(actor.start[2]))))
        for actor in scenario.actors))


def worlds(scenario: Scenario, controller: Any) -> Iterator[World]:
    """The world before the first step and after every one, without end."""
    world = opening(scenario, controller)
    scripts = [actor.script() for actor in scenario.actors]
    while True:
        yield world
        moves = [script.step(character.state, DT) for script, character in zip(scripts, world.characters)]
        scripts = [script for script, _ in moves]
        world = world.step([intent for _, intent in moves])


def run(scenario: Scenario, controller: Any) -> Iterator[Frame]:
    """Every frame of a scenario, in order."""
    steps = worlds(scenario, controller)
    before, after = next(steps), next(steps)
    for number in range(scenario.frames):
        # in whole numbers, so that no frame rate drifts
        wanted, rest = divmod(number * RATE, scenario.fps)
        while before.number < wanted:
            before, after = after, next(steps)
        yield Frame(number, number / scenario.fps, before, after, rest / scenario.fps)


def scenes(scenario: Scenario, controller: Any, shown: Overlays | None = None) -> Iterator[tuple[Frame, Scene]]:
    """Every frame with the scene that films it; `shown` replaces the scenario's own overlays."""
    shown = overlays(scenario.overlays) if shown is None else shown
    shot, operator = None, None
    for frame in run(scenario, controller):
        due = [s for s in scenario.shots if s.at <= frame.time + 1e-9][-1]
        if due is not shot:
            shot, operator = due, Operator.ready(due, frame)
        else:
            operator = operator.step(frame, 1.0 / scenario.fps)
        until = min([s.at for s in scenario.shots if s.at > shot.at], default=scenario.duration)
        camera = operator.view((frame.time - shot.at) / max(until - shot.at, 1e-9))
        text = (scenario.title,) if frame.time < TITLE_SECONDS else ()
        yield frame, Scene(camera, figures(frame.before, frame.after, frame.alpha), frame.after.props,
                           shown, text)


@dataclass(frozen=True, eq=False)
class Operator:
    """Who holds the camera during one shot. whom: the number of the actor watched.

    Props don't shorten the arm here: a film's author sees where they stand.
    """

    shot: ShotTable
    whom: int
    follow: Follow | None = None
    target: np.ndarray | None = None

    @staticmethod
    def ready(shot: ShotTable, frame: Frame) -> Operator:
        """At the cut."""
        name = shot.actor if shot.kind == "follow" else shot.look_at
        whom = 0 if name is None else frame.after.index(name)
        ground = _ground(frame, whom)
        if shot.kind != "follow":
            return Operator(shot, whom, target=_aim(ground) if shot.target is None else np.array(shot.target))
        settings = CameraSettings(fov=math.radians(shot.fov), rest=0.0 if shot.swing else math.inf)
        return Operator(shot, whom, follow=Follow.behind(
            ground, settings, float(ground[2]) + math.radians(shot.around), math.radians(shot.above), shot.distance))

    def step(self, frame: Frame, dt: float) -> Operator:
        """One frame on."""
        ground = _ground(frame, self.whom)
        if self.follow is not None:
            return replace(self, follow=self.follow.step(ground, _velocity(frame, self.whom), Wish(), dt))
        if self.shot.target is None:
            return replace(self, target=damp(self.target, _aim(ground), LOOK_HALFLIFE, dt))
        return self

    def view(self, progress: float) -> Camera:
        """The camera, `progress` (0 … 1) into the shot."""
        if self.follow is not None:
            return self.follow.view()
        fov = math.radians(self.shot.fov)
        if self.shot.kind == "dolly":
            return dolly((self.shot.eye, self.shot.to), self.target, progress, fov)
        return fixed(self.shot.eye, self.target, fov)


def _ground(frame: Frame, whom: int) -> np.ndarray:
    return ground_between(frame.before.characters[whom].state, frame.after.characters[whom].state, frame.alpha)


def _velocity(frame: Frame, whom: int) -> np.ndarray:
    state = frame.after.characters[whom].state
    return in_world(state.ground, state.velocity)


def _aim(ground: np.ndarray) -> np.ndarray:
    return np.array([ground[0], LOOK_HEIGHT, ground[1]])
