"""The follow camera: on a sprung arm behind a character, swinging round with the walk, and beside a jump."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar, Self

import numpy as np

from gambol.controllers.body import damp, settle, wrap
from gambol.controllers.contract import but

from ..input import Wish
from ..scene import Prop
from .line_of_sight import as_far
from .arm import Armed, CameraSettings, forward, nearer_to

BESIDE, OVER = 0.62, 0.16
"""How far beside a jump a camera swings that would look along it, and how much higher [rad]: seen from behind, the body
hides where it jumps to."""
CHANGES = 0.3
"""A jump aimed at by so much to the camera's side [rad] makes it swing to the other one."""
COMES, GOES = 0.2, 0.7
"""Half-lives [s] of swinging there and back, neither of which begins with a jerk."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Follow(Armed):
    """Behind a character, on an arm that swings round with the walk.

    focus: (3,) [m] where the character is, ahead: (3,) how far before it the camera looks, slack:
    (3,) what is left of the change from another camera; target is their sum. still: seconds
    since the player turned it. aside: how far it has swung out of the line of a jump [rad], which leaves its yaw, and so
    the sticks' directions, as they are; swings: how fast it does [rad/s].
    """

    kind: ClassVar[str] = "follow"
    focus: np.ndarray
    ahead: np.ndarray = field(default_factory=lambda: np.zeros(3))
    slack: np.ndarray = field(default_factory=lambda: np.zeros(3))
    still: float = 10.0
    aside: float = 0.0
    swings: float = 0.0

    @staticmethod
    def behind(ground, settings: CameraSettings = CameraSettings(), yaw: float | None = None,
               pitch: float = 0.25, distance: float = 4.0, level: float = 0.0) -> Follow:
        """A camera at rest behind a character's ground frame (3,), or looking along `yaw` [rad].

        level: how high the character's floor lies [m]."""
        yaw = float(ground[2]) if yaw is None else yaw
        focus = np.array([ground[0], level + settings.height, ground[1]])
        return Follow(eye=focus - distance * forward(yaw, pitch), target=focus, focus=focus, yaw=yaw,
                      wanted_yaw=yaw, pitch=pitch, wanted_pitch=pitch, distance=distance, arm=distance,
                      settings=settings)

    def turned(self, yaw: float, pitch: float = 0.0) -> Self:
        """The player turns the camera by angles [rad]: yaw to the left, pitch upwards."""
        turned = super().turned(yaw, pitch)
        return self if turned is self else but(turned, still=0.0)

    def recentred(self, heading: float) -> Self:
        """The player asks for the view from behind `heading` [rad]."""
        return but(super().recentred(heading), still=10.0)

    def aimed(self, heading: float | None, dt: float) -> Self:
        """The camera a little out of the line of a jump along `heading` [rad]; back behind where nobody aims at one."""
        if heading is None:
            return self if self.aside == 0.0 == self.swings else self._beside(0.0, GOES, dt)
        line = float(wrap(heading - self.yaw))
        side = 1.0 if self.aside >= 0.0 else -1.0
        if side * line > CHANGES:
            side = -side
        wanted = side * max(BESIDE + side * line, 0.0) if abs(line) < 0.5 * math.pi else 0.0
        return self._beside(wanted, COMES, dt)

    def _beside(self, wanted: float, halflife: float, dt: float) -> Self:
        """The camera as it swings to `wanted` [rad] beside a jump."""
        left, swings = settle(np.array(self.aside - wanted), np.array(self.swings), halflife, dt)
        return but(self, aside=wanted + float(left), swings=float(swings))

    def _looks(self) -> tuple[float, float]:
        return self.yaw + self.aside, min(self.pitch + OVER * min(abs(self.aside) / BESIDE, 1.0), self.settings.highest)

    def step(self, ground, velocity, wish: Wish, dt: float, props: Sequence[Prop] = (), level: float = 0.0) -> Self:
        """The camera `dt` seconds later.

        ground: (3,) x, z [m], heading [rad] of whom it follows. velocity: (2,) its world velocity
        along x and z [m/s], which the camera comes round behind. wish: what the hands do. level: how
        high the floor lies that carries it [m].
        """
        told, s = self._told(wish, dt), self.settings
        focus = nearer_to(told.focus, ground, level, s, dt)
        ahead = as_far(focus, damp(told.ahead, s.ahead * np.array([velocity[0], 0.0, velocity[1]]), s.ahead_halflife, dt), tuple(props))
        slack = damp(told.slack, 0.0, s.change_halflife, dt)
        speed, wanted = math.hypot(velocity[0], velocity[1]), told.wanted_yaw
        if told.still > s.rest and speed > 1e-3:
            error = float(wrap(math.atan2(velocity[0], velocity[1]) - wanted))
            # strongest for a walker who crosses the view; one who comes towards it stays in front
            pull = speed * abs(math.sin(error))
            wanted = float(damp(wanted, wanted + error, s.swing / max(pull, 1e-6), dt))
        moved = but(told, focus=focus, ahead=ahead, slack=slack, target=focus + ahead + slack,
                    wanted_yaw=wanted, still=told.still + dt, **told._swung(dt))
        return moved._reached(ground, dt, props, clear=float(slack @ slack) < 0.01, velocity=velocity)
