"""The fly camera: it goes where the sticks push it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar, Self

import numpy as np

from gambol.controllers.body import damp

from ..input import Wish
from ..scene import Camera, Prop
from .arm import CameraSettings, Turned, forward
from .line_of_sight import above_floor, beside, outside


@dataclass(frozen=True, eq=False, kw_only=True)
class Free(Turned):
    """Flies where the sticks push it: moves along the view and across, turning keys up and down.

    velocity: (3,) [m/s]. speed: of a full push [m/s], which the wheel changes.
    """

    kind: ClassVar[str] = "free"
    flown: ClassVar[bool] = True
    velocity: np.ndarray = field(default_factory=lambda: np.zeros(3))
    speed: float = CameraSettings.fly

    def zoomed(self, factor: float) -> Self:
        """The speed divided by `factor`."""
        return replace(self, speed=min(max(self.speed / factor, 0.2), 20.0))

    def step(self, ground, velocity, wish: Wish, dt: float, props: Sequence[Prop] = (), level: float = 0.0) -> Self:
        """The camera `dt` seconds later; see `Follow.step`. It keeps out of whoever stands at `ground`."""
        told, s = self._told(wish, dt), self.settings
        if wish.look != (0.0, 0.0):
            told = told.turned(-s.turn * dt * wish.look[0], -s.turn * dt * wish.look[1])
        sideways = np.array([-math.cos(told.yaw), 0.0, math.sin(told.yaw)])
        push = (wish.move[0] * sideways + wish.move[1] * forward(told.yaw, told.pitch)
                - np.array([0.0, wish.turn, 0.0]))
        wanted = push * told.speed * (0.3 if wish.slow else 1.0 + 2.0 * wish.run)
        # the way of a damped velocity is its integral, which is exact for any dt as well
        now = damp(told.velocity, wanted, s.fly_halflife, dt)
        way = wanted * dt + (told.velocity - now) * (s.fly_halflife / math.log(2.0))
        eye, props = told.eye, tuple(props)
        pieces = max(math.ceil(float(np.abs(way).max()) / 0.1), 1)  # shorter than any wall is thick
        for _ in range(pieces):
            eye = outside(beside(above_floor(eye + way / pieces), ground), props)
        return replace(told, eye=eye, velocity=now, **told._swung(dt))

    def view(self) -> Camera:
        """What to draw with."""
        return Camera(self.eye, self.eye + forward(self.yaw, self.pitch), fov=self.settings.fov)

    def _pitches(self) -> tuple[float, float]:
        return -1.5, 1.5
