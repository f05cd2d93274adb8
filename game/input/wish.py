"""What a player wishes, as the hands say it: seen from the camera, without units."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Wish:
    """The state of the controls at one moment.

    move, look: (x to the right, y away from the camera) within the unit circle; look is (0, 0)
    when no direction is to be faced. turn: −1 … 1, positive to the left. run: 0 … 1.
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
                    self.slow or other.slow, self.strafe or other.strafe, further(self.orbit, other.orbit),
                    (self.drag[0] + other.drag[0], self.drag[1] + other.drag[1]), self.zoom + other.zoom,
                    (self.pan[0] + other.pan[0], self.pan[1] + other.pan[1]), self.pressed + other.pressed)


def unit_disc(x: float, y: float) -> tuple[float, float]:
    """(x, y), shortened to length 1 where it is longer: keyboard diagonals are no faster."""
    length = math.hypot(x, y)
    return (x / length, y / length) if length > 1.0 else (x, y)
