"""The first start: the window opens at once, with the floor and the course, and then somebody who walks round by a single
primitive; the game begins as soon as all that walking takes is compiled."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from gambol.controllers.locomotion import Library
from gambol.controllers.navigation import drift

from ..camera import Follow, between
from ..scene import Figure, Scene
from ..world import COURSE, nearest, posed
from .app import Play
from .preparing import Preparing
from .waiting import Waiting

REST, LONGEST = 3.0, 0.4
"""Between pictures, so many times as long as one takes [s], and at most: the cores have other things to do."""
STROLL = (0.9, 0.6, 0.0)
"""How somebody walks round meanwhile: v_f [m/s], ω [rad/s], v_l [m/s]."""
SETS_OFF = np.array([0.0, 0.0, -np.pi / 2])
"""From where the game begins [m], to the right [rad], so that all of the round lies in the picture."""


class Opening(Waiting):
    """The app that a window opens with: somebody who walks by themselves until one can steer them, and then the game.

    make: makes the game, once it can begin. time: that it was waited for [s]; slept: of that, since the last picture.
    """

    def __init__(self, make: Callable[[], Play], preparing: Preparing):
        super().__init__(make)
        self.preparing, self.drawn = preparing, False
        self.time = self.slept = 0.0

    def tick(self, seconds: float) -> None:
        """Let `seconds` pass; the game begins as soon as it can."""
        if self.game is not None:
            self.game.tick(seconds)
        elif self.preparing.walks:
            self.game = self.make()
        else:
            self.time += seconds
            self.slept = min(max(REST * (seconds - self.slept), 0.01), LONGEST)
            time.sleep(self.slept)

    def scene(self, size: tuple[int, int]) -> Scene | tuple[Scene, ...]:
        """What to show in a picture of `size` pixels."""
        if self.game is not None:
            return self.game.scene(size)
        camera, people = Follow.behind(np.zeros(3)), ()
        if self.drawn and self.preparing.walker is not None:  # not at first: where bodies are placed is compiled for it
            people = (strolling(self.preparing.walker.library, self.time),)
        self.drawn = True
        return Scene(between(camera, camera, 1.0), people, props=COURSE, text=self.preparing.said)

    def close(self) -> None:
        """End the game, if there is one, and whatever is still compiled for it."""
        if self.game is not None:
            self.game.close()
        self.preparing.close()


def strolling(library: Library, seconds: float) -> Figure:
    """Somebody who has walked round for so long, past where the game begins."""
    number = nearest(library, STROLL)
    ground = drift(SETS_OFF, library.velocities[number], np.array([seconds]))[0]
    return Figure(*posed(library, number, seconds / library.primitives[number].period % 1.0, ground))
