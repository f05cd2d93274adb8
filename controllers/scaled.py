"""A controller for a larger or smaller body: it moves as before, in that body's size.

Small and large animals that move alike do so at equal Froude numbers v²/gℓ (Alexander & Jayes 1983):
with legs k times as long, lengths grow by k, speeds by √k and times by √k. A child trots
where an adult walks.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ceil
from typing import Any

import numpy as np

from .body import Pose, Skeleton
from .contract import HIGHEST, LONGEST, CharacterState, Controller, Intent, Leap, OfSize, Status, grounded, level, seconds
from .navigation import checked, shrunk, speeds

SAME = 1e-6
"""Sizes that differ by no more than this share are one."""


@dataclass(frozen=True, eq=False)
class Scaled(Controller):
    """A walker in another size. It is told that a jump is wanted, which is another's matter, but not where.

    factor: the legs' length over that of the skeleton it is made for.
    """

    controller: Controller
    factor: float

    @property
    def kind(self) -> str:
        """What tells its motion from that of other controllers, beside the library."""
        return self.controller.kind + f" × {self.factor:.6f}"

    @property
    def skeleton(self) -> Skeleton:
        """What it moves."""
        return self.controller.skeleton.scaled(self.factor)

    @property
    def size(self) -> float:
        """How long its legs are, over those of the standard body."""
        return self.factor

    @property
    def library(self) -> Any:
        """The controller's gaits."""
        return self.controller.library

    @property
    def settings(self) -> Any:
        """The controller's settings."""
        return self.controller.settings

    def tuned(self, settings: Any) -> Scaled:
        """The same under other settings."""
        return replace(self, controller=self.controller.tuned(settings))

    def limits(self, share: float = 1.0) -> np.ndarray | None:
        """The half-spaces (H, 4) of the velocities that it walks with, in its own size."""
        planes = self.controller.limits(share)
        return None if planes is None else planes / np.array([*self._speeds, 1.0])

    def readiness(self, state: CharacterState) -> Any:
        """How fast it takes a wish up, as a share of how fast it does as it walks."""
        return self.controller.readiness(self._shrunk(state))

    def start(self, ground=(0.0, 0.0, 0.0), floor: float = 0.0) -> CharacterState:
        """Standing at x, z [m], heading, on a floor so high [m]. ValueError for more than one."""
        if np.ndim(ground) > 1:
            raise ValueError(f"characters come singly in another size: a ground is x, z, heading; got shape {np.shape(ground)}")
        level(floor, self._highest)
        x, z, heading = grounded(ground, self._highest).tolist()
        return self._grown(self.controller.start((x / self.factor, z / self.factor, heading), floor / self.factor))

    def step(self, state: CharacterState, intent: Intent, dt: float) -> tuple[CharacterState, Pose]:
        """One step of `dt` seconds (0 < dt ≤ 0.1; ValueError otherwise, and for a state of a body of another size)."""
        if not self._mine(state):
            was = state.memory.factor if isinstance(state.memory, OfSize) else 1.0
            raise ValueError(f"this state is of a body with legs {was:.3g} times as long as the standard, not {self.factor:.3g} times: "
                             "step it with the controller that it is of")
        level(state.floor, self._highest)
        own, asked = seconds(dt) / self.factor**0.5, self._asked(intent)
        new, count = self._shrunk(state), ceil(own / LONGEST - 1e-6)  # a small body's own time may be too long for one
        try:
            for _ in range(count):
                new, _ = self.controller.step(new, asked, own / count)
        except (AttributeError, TypeError, ValueError):
            checked(intent.around)  # what is wrong with it is told as it was given
            raise
        new = self._grown(new)
        return new, new.pose

    def precondition(self, state: CharacterState, intent: Intent) -> float:
        """How well it could start from here for this intent."""
        return self.controller.precondition(self._shrunk(state), self._asked(intent))

    def enter(self, state: CharacterState, intent: Intent) -> CharacterState:
        """The state with this controller's own memory: anew from its pose, if it is of a body of another size."""
        return self._grown(self.controller.enter(self._shrunk(state if self._mine(state) else replace(state, memory=None)), self._asked(intent)))

    def pushed(self, state: CharacterState, change: np.ndarray) -> CharacterState | None:
        """The state with a velocity that a push has changed by (2,) x, z [m/s]; None where its next steps don't take that in."""
        taken = self.controller.pushed(self._shrunk(state), np.asarray(change, float) / self.factor**0.5)
        return None if taken is None else self._grown(taken)

    def status(self, state: CharacterState) -> Status:
        """Whether it goes on."""
        return self.controller.status(self._shrunk(state))

    def within(self, state: CharacterState, intent: Intent) -> tuple[CharacterState, Intent]:
        """State and intent as the controller within has them, in the size that it is made for."""
        return self._shrunk(state), self._asked(intent)

    def _mine(self, state: CharacterState) -> bool:
        return isinstance(state.memory, OfSize) and abs(state.memory.factor / self.factor - 1.0) <= SAME

    @property
    def _highest(self) -> float:
        """How high floors are at most [m], and how far away places, that are no farther in the size that it is made for."""
        return HIGHEST * min(self.factor, 1.0)

    @property
    def _speeds(self) -> np.ndarray:
        """What v_f, ω and v_l grow by."""
        return speeds(self.factor)

    def _asked(self, intent: Intent) -> Intent:
        look = None if intent.look is None else np.asarray(intent.look, float) / self.factor
        halt = None if intent.halt is None else np.asarray(intent.halt, float) / [self.factor, self.factor, 1.0]
        towards = None if intent.towards is None else np.asarray(intent.towards, float) / [1.0, self.factor**0.5]
        around = shrunk(intent.around, self.factor)
        return Intent(intent.velocity / self._speeds, None if intent.leap is None else Leap(None), around, aim=None if intent.aim is None else Leap(None), look=look, halt=halt, towards=towards)

    def _grown(self, state: CharacterState) -> CharacterState:
        return _resized(state, self.factor, state.velocity * self._speeds, OfSize(state.memory, self.factor))

    def _shrunk(self, state: CharacterState) -> CharacterState:
        return _resized(state, 1.0 / self.factor, state.velocity / self._speeds, state.memory.memory if isinstance(state.memory, OfSize) else state.memory)


def _resized(state: CharacterState, factor: float, velocity: np.ndarray, memory: Any) -> CharacterState:
    def pose(one: Pose | None) -> Pose | None:
        return None if one is None else Pose(one.root * factor, one.rotations)
    return replace(state, ground=state.ground * [factor, factor, 1.0], velocity=velocity, floor=state.floor * factor, memory=memory,
                   pose=pose(state.pose), previous=pose(state.previous), elapsed=state.elapsed * factor**0.5)
