"""What a player wishes, as the hands say it: seen from the camera, without units."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from gambol.controllers.contract import Strike

STEPS = (127,) * 6 + (1, 1, 1) + (127,) * 2 + (4096,) * 2 + (16,) + (4096,) * 2
"""How finely a log keeps the controls, in the order of `Wish`: steps in 1, a radian, a notch."""


@dataclass(frozen=True)
class Wish:
    """The state of the controls at one moment.

    move, look: (x to the right, y away from the camera) within the unit circle; look is (0, 0)
    when no direction is to be faced. turn: −1 … 1, positive to the left. run: 0 … 1. jump: held to
    aim, let go to jump.
    orbit: rates −1 … 1 at which the camera turns (left, up). drag: angles [rad] by which the mouse
    turned it (left, up) since the last moment, zoom: notches of the wheel, positive nearer.
    pan: how far the mouse pushed the picture (right, up), in heights of the window.
    pressed: the actions that were set off since then, in order; "name=value" sets a setting.
    """

    move: tuple[float, float] = (0.0, 0.0)
    look: tuple[float, float] = (0.0, 0.0)
    turn: float = 0.0
    run: float = 0.0
    slow: bool = False
    strafe: bool = False
    jump: bool = False
    orbit: tuple[float, float] = (0.0, 0.0)
    drag: tuple[float, float] = (0.0, 0.0)
    zoom: float = 0.0
    pan: tuple[float, float] = (0.0, 0.0)
    pressed: tuple[str, ...] = ()

    def merged(self, other: Wish) -> Wish:
        """Two devices in one pair of hands: of each control the one that is further out."""
        def further(a, b):
            return a if math.hypot(*a) >= math.hypot(*b) else b
        return Wish(further(self.move, other.move), further(self.look, other.look),
                    max(self.turn, other.turn, key=abs), max(self.run, other.run),
                    self.slow or other.slow, self.strafe or other.strafe, self.jump or other.jump,
                    further(self.orbit, other.orbit), (self.drag[0] + other.drag[0], self.drag[1] + other.drag[1]), self.zoom + other.zoom,
                    (self.pan[0] + other.pan[0], self.pan[1] + other.pan[1]), self.pressed + other.pressed)

    def numbers(self) -> tuple[int, ...]:
        """All but `pressed` in whole steps (see `STEPS`), as a log keeps them; no number counts as 0."""
        values = (*self.move, *self.look, self.turn, self.run, self.slow, self.strafe, self.jump, *self.orbit, *self.drag,
                  self.zoom, *self.pan)
        return tuple(round(min(max(value * steps, -32767), 32767)) if math.isfinite(value) else 0
                     for value, steps in zip(values, STEPS))

    @staticmethod
    def of(numbers: Sequence[int], pressed: tuple[str, ...] = ()) -> Wish:
        """The wish of such whole steps."""
        v = [number / steps for number, steps in zip(numbers, STEPS, strict=True)]
        return Wish((v[0], v[1]), (v[2], v[3]), v[4], v[5], v[6] > 0, v[7] > 0, v[8] > 0, (v[9], v[10]), (v[11], v[12]),
                    v[13], (v[14], v[15]), pressed)

    def rounded(self) -> Wish:
        """The wish as a log would give it back: what is played is what is logged."""
        return Wish.of(self.numbers(), self.pressed)


def unit_disc(x: float, y: float) -> tuple[float, float]:
    """(x, y), shortened to length 1 where it is longer: keyboard diagonals are no faster."""
    length = math.hypot(x, y)
    return (x / length, y / length) if length > 1.0 else (x, y)


PUSHES = 45.0, 130.0
"""How hard a push is [N·s]: to be caught by a step, and, as one runs or holds the key for running, not to be caught."""


def push(camera_yaw: float, wish: Wish) -> Strike:
    """A push away from the camera."""
    x, z = in_view((0.0, 1.0), camera_yaw)
    hard = PUSHES[1] if wish.run > 0.5 else PUSHES[0]
    return Strike((hard * x, hard * z))


def in_view(seen: tuple[float, float], camera_yaw: float) -> tuple[float, float]:
    """A direction seen from the camera (right, away) as x, z in the world."""
    cosine, sine = math.cos(camera_yaw), math.sin(camera_yaw)
    right, away = seen
    return away * sine - right * cosine, away * cosine + right * sine
