"""Keyboard and gamepad as wishes."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .bindings import BINDINGS, binding, pressed_by
from .wish import Wish, unit_disc

INNER, OUTER = 0.15, 0.95
"""Where a stick starts to count and where it counts in full, as parts of its throw."""


@dataclass(frozen=True)
class Keyboard:
    """The keys and mouse buttons that are down, by name."""

    down: frozenset[str] = frozenset()

    def press(self, key: str) -> Keyboard:
        """With one key more down."""
        return Keyboard(self.down | {key})

    def release(self, key: str) -> Keyboard:
        """With one key up."""
        return Keyboard(self.down - {key})

    def held(self, action: str) -> bool:
        """Whether any key of an action is down."""
        return not self.down.isdisjoint(binding(action).keys)

    def wish(self) -> Wish:
        """What the held keys ask for; opposite keys cancel out."""
        def axis(plus: str, minus: str) -> float:
            return float(self.held(plus)) - float(self.held(minus))
        return Wish(move=unit_disc(axis("right", "left"), axis("forward", "back")),
                    turn=axis("turn_left", "turn_right"), run=float(self.held("run")),
                    slow=self.held("slow"), strafe=self.held("strafe"))


def dead_zone(x: float, y: float, inner: float = INNER, outer: float = OUTER) -> tuple[float, float]:
    """A stick's reading within the unit circle: 0 inside `inner`, rising from 0 to 1 at `outer`.

    Radial, so that the direction stays as it is pushed. A reading that is no number counts as 0.
    """
    if not (math.isfinite(x) and math.isfinite(y)):
        return 0.0, 0.0
    length = math.hypot(x, y)
    if length <= inner:
        return 0.0, 0.0
    wanted = min((length - inner) / (outer - inner), 1.0)
    return x / length * wanted, y / length * wanted


def trigger(value: float) -> float:
    """A trigger's reading, −1 released … 1 pressed, as 0 … 1 with a dead zone; no number counts as 0."""
    return dead_zone(0.5 * (value + 1.0), 0.0, inner=0.08)[0] if value > -1.0 else 0.0


def pad_wish(pad) -> Wish:
    """What a gamepad asks for; `pad` is a `game.hosts.PadState`, or None where none is plugged in."""
    if pad is None:
        return Wish()
    left = dead_zone(pad.left[0], -pad.left[1])
    right = dead_zone(pad.right[0], -pad.right[1])
    def held(action: str) -> bool:
        return not pad.buttons.isdisjoint(binding(action).buttons)
    orbiting = held("orbit")
    return Wish(move=left, look=(0.0, 0.0) if orbiting else right,
                orbit=(-right[0], right[1]) if orbiting else (0.0, 0.0),
                turn=float(held("turn_left")) - float(held("turn_right")),
                run=trigger(pad.right_trigger), slow=held("slow"), strafe=trigger(pad.left_trigger) > 0.3)


def pad_pressed(before, after) -> tuple[str, ...]:
    """The actions that the buttons gone down between two pad states set off.

    A pad that has just been plugged in sets off nothing: what is down then was not pressed here.
    """
    if before is None or after is None:
        return ()
    new = after.buttons - before.buttons
    return tuple(action for row in BINDINGS for button in row.buttons if button in new
                 for action in pressed_by(button, "buttons") if action == row.action)
