"""The orbit camera: round a point, as in a viewer of models."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from gambol.controllers.body import damp

from ..input import Wish
from ..scene import Prop
from .arm import REST, Armed, CameraSettings, finite, forward, nearer_to
from .line_of_sight import above_floor, outside


@dataclass(frozen=True, eq=False, kw_only=True)
class Orbit(Armed):
    """Round a point, as in a viewer of models: the mouse turns it, its middle button pans.

    The point goes with the character (its heading is left alone) until it is panned away; then
    it stays, until the player recentres. pivot: (3,) [m] where it is to be. keeps: stays as far off as it is told whatever comes between; only out of what
    its eye would be inside of it moves.
    """

    kind: ClassVar[str] = "orbit"
    pivot: np.ndarray
    tracks: bool = True
    keeps: bool = False

    @staticmethod
    def round(pivot: np.ndarray, settings: CameraSettings = CameraSettings(), yaw: float = 0.0, pitch: float = 0.25,
              distance: float = 4.0, tracks: bool = True, keeps: bool = False) -> Orbit:
        """A camera at rest that looks at a point (3,) [m] along `yaw`."""
        return Orbit(eye=pivot - distance * forward(yaw, pitch), target=pivot, pivot=pivot, yaw=yaw, wanted_yaw=yaw,
                     pitch=pitch, wanted_pitch=pitch, distance=distance, arm=distance, settings=settings, tracks=tracks, keeps=keeps)

    def recentred(self, heading: float) -> Self:
        """Back to the character, seen from behind `heading` [rad]."""
        return replace(super().recentred(heading), tracks=True)

    def panned(self, right: float, up: float) -> Self:
        """The picture pushed by the mouse, in heights of the window; the point stays there."""
        if not finite(right, up):
            return self
        span = 2.0 * self.arm * math.tan(0.5 * self.settings.fov)
        sideways = np.array([-math.cos(self.yaw), 0.0, math.sin(self.yaw)])
        upwards = np.cross(sideways, forward(self.yaw, self.pitch))
        pivot = self.pivot - span * (right * sideways + up * upwards)
        return replace(self, pivot=above_floor(pivot), tracks=False)

    def step(self, ground, velocity, wish: Wish, dt: float, props: Sequence[Prop] = (), level: float = 0.0) -> Self:
        """The camera `dt` seconds later; see `Follow.step`. The velocity plays no part."""
        told, s = self._told(wish, dt), self.settings
        if wish.pan != (0.0, 0.0):
            told = told.panned(*wish.pan)
        pivot = np.array([ground[0], level + s.height, ground[1]]) if told.tracks else told.pivot
        target = nearer_to(told.target, ground, level, s, dt) if told.tracks else damp(told.target, pivot, s.focus_halflife, dt)
        moved = replace(told, pivot=pivot, target=target, **told._swung(dt))
        return moved._reached(ground, dt, props, clear=False)

    def _reached(self, ground, dt: float, props: Sequence[Prop], clear: bool, velocity: np.ndarray = REST) -> Self:
        if not self.keeps:
            return super()._reached(ground, dt, props, clear, velocity)
        eye = above_floor(self.target - self.distance * forward(self.yaw, self.pitch))
        return replace(self, eye=outside(eye, tuple(props)), arm=self.distance)

    def _pitches(self) -> tuple[float, float]:
        return -1.2, 1.5
