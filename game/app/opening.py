"""The first start: the window opens at once, with the floor and the course; the game begins as soon as somebody can walk."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from ..camera import Follow, between
from ..hosts import Event, KeyEvent
from ..scene import Scene
from ..world import COURSE
from .app import Play
from .preparing import Preparing

REST = 0.4
"""Between pictures of a world that stands still [s]: the cores have other things to do."""


class Opening:
    """The app that a window opens with: the floor and the course until somebody can walk on it, and then the game.

    make: makes the game, once it can begin.
    """

    full_screen = property(lambda self: self.game is not None and self.game.full_screen)
    mouse_captured = property(lambda self: self.game is not None and self.game.mouse_captured)
    wants_picture = property(lambda self: self.game is not None and self.game.wants_picture)

    def __init__(self, make: Callable[[], Play], preparing: Preparing):
        self.make, self.preparing = make, preparing
        self.game: Play | None = None
        self.left = False

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

    def tick(self, seconds: float) -> None:
        """Let `seconds` pass; the game begins as soon as it can."""
        if self.game is not None:
            self.game.tick(seconds)
        elif self.preparing.walks:
            self.game = self.make()
        else:
            time.sleep(REST)

    def scene(self, size: tuple[int, int]) -> Scene | tuple[Scene, ...]:
        """What to show in a picture of `size` pixels."""
        if self.game is not None:
            return self.game.scene(size)
        camera = Follow.behind(np.zeros(3))
        return Scene(between(camera, camera, 1.0), props=COURSE, text=self.preparing.said)

    def take(self, pixels: np.ndarray) -> None:
        """Keep the picture that the game asked for."""
        if self.game is not None:
            self.game.take(pixels)

    def close(self) -> None:
        """End the game, if there is one, and whatever is still compiled for it."""
        if self.game is not None:
            self.game.close()
        self.preparing.close()
