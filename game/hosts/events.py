"""What a host tells the app it hosts. Plain data: an app is tested without a window.

Keys are named as GLFW names them without KEY_ (W, LEFT_SHIFT, F1, ESCAPE); mouse buttons are keys
too: LEFT_BUTTON, RIGHT_BUTTON, MIDDLE_BUTTON. `gambol.game.input.key_names` lists them all, and a pad's buttons.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..scene import Scene

PADS = 4
"""The most gamepads at once."""


@dataclass(frozen=True)
class KeyEvent:
    """A key or mouse button went down or came up. Held keys repeat nothing."""

    key: str
    pressed: bool


@dataclass(frozen=True)
class MouseMove:
    """The pointer moved to (x, y) by (dx, dy), in parts of the window's height from its top-left corner."""

    x: float
    y: float
    dx: float
    dy: float


@dataclass(frozen=True)
class Scroll:
    """The wheel turned by so many notches; dy positive away from the user."""

    dx: float
    dy: float


@dataclass(frozen=True)
class Resize:
    """The picture now measures so many pixels."""

    width: int
    height: int


@dataclass(frozen=True)
class Focus:
    """The window gained or lost the keyboard. On loss every held key is let go first."""

    gained: bool


@dataclass(frozen=True)
class PadState:
    """A gamepad in this frame. slot: 0 … PADS − 1; a pad keeps its own until it is pulled out. name: ""
    where none is plugged in (its sticks then rest).

    axes: left x, left y, right x, right y (−1 … 1, y downwards), left and right trigger
    (−1 released … 1 pressed). buttons: the names of those that are down.
    """

    name: str = ""
    axes: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0, -1.0, -1.0)
    buttons: frozenset[str] = frozenset()
    slot: int = 0

    @property
    def left(self) -> tuple[float, float]:
        """The left stick, x to the right, y downwards."""
        return self.axes[0], self.axes[1]

    @property
    def right(self) -> tuple[float, float]:
        """The right stick, x to the right, y downwards."""
        return self.axes[2], self.axes[3]

    @property
    def left_trigger(self) -> float:
        """−1 released … 1 pressed."""
        return self.axes[4]

    @property
    def right_trigger(self) -> float:
        """−1 released … 1 pressed."""
        return self.axes[5]


Event = KeyEvent | MouseMove | Scroll | Resize | Focus | PadState


class App(Protocol):
    """What a host runs. It keeps its own fixed step; the host only says how much time has passed."""

    done: bool
    """Whether it wants to end."""
    full_screen: bool
    """Whether it wants the whole screen."""
    mouse_captured: bool
    """Whether it wants the mouse without a pointer, so that no edge of the screen stops it."""
    wants_picture: bool
    """Whether it wants to `take` the next picture."""

    def handle(self, event: Event) -> None:
        """Take an event. For each pad that is there one PadState comes every frame, before the tick;
        and one without a name when it goes."""

    def tick(self, seconds: float) -> None:
        """So much wall time has passed since the last tick."""

    def scene(self, size: tuple[int, int]) -> Scene | tuple[Scene, ...]:
        """What to show now in a picture of width × height pixels: a scene, or several side by side."""
        ...

    def take(self, pixels: np.ndarray) -> None:
        """The picture (H, W, 4) uint8 that it wanted, top row first."""
