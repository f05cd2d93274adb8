"""What a window shows until there is a game to show: one waits, and can leave."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..hosts import Event, KeyEvent
from .app import Play


class Waiting:
    """An app that hands everything on to the game as soon as there is one. make: makes it. left: whether somebody has left before."""

    full_screen = property(lambda self: self.game is not None and self.game.full_screen)
    mouse_captured = property(lambda self: self.game is not None and self.game.mouse_captured)
    wants_picture = property(lambda self: self.game is not None and self.game.wants_picture)

    def __init__(self, make: Callable[[], Play]):
        self.make, self.left = make, False
        self.game: Play | None = None

    @property
    def done(self) -> bool:
        """Whether it wants to end."""
        return self.left or self.game is not None and self.game.done

    def handle(self, event: Event) -> None:
        """Take an event; before the game begins one can only leave."""
        if self.game is not None:
            self.game.handle(event)
        elif event == KeyEvent("ESCAPE", True):
            self.left = True

    def take(self, pixels: np.ndarray) -> None:
        """Keep the picture that the game asked for."""
        if self.game is not None:
            self.game.take(pixels)
