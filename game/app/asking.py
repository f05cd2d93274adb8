"""Whoever wears trackers is asked, in the window, to stand in one pose after the other: a ghost shows it, words say what is waited
for; then the game begins."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gambol.controllers.body import forward_kinematics, human

from ..camera import Follow, between
from ..scene import Dot, Figure, Hint, Overlays, Scene
from .app import Play
from .waiting import Waiting

GHOST, SEEN = (0.30, 0.52, 0.60), (0.95, 0.75, 0.25)
"""The colours of what is asked for and of trackers that are seen."""
_BODY = human()


@dataclass(frozen=True, eq=False)
class Asked:
    """words: what is asked for. pose: (J, 3, 3) rotations of it. left: for how long it is still waited for [s]; None for as long as it takes.
    points: (n, 3) [m] where trackers are beside a standing body, NaN where not known; None before that is known. known: what is known so far, and how surely."""

    words: str = ""
    pose: np.ndarray | None = None
    left: float | None = None
    points: np.ndarray | None = None
    known: str = ""


class Left(Exception):
    """Whoever was asked has left."""


class Asking(Waiting):
    """The app that a window opens with while trackers are waited for. ask: does it, given whom to tell what is asked and what is known, in
    words; it runs beside the pictures. make: makes the game once that is over. What `ask` raises, `tick` does.
    """

    def __init__(self, ask: Callable[[Callable[[Asked], None], Callable[[str], None]], None], make: Callable[[], Play]):
        super().__init__(make)
        self.asked, self.said = Asked(), ""
        self.fault: BaseException | None = None
        self._ask, self._thread = ask, threading.Thread(target=self._run, name="asking", daemon=True)

    def tick(self, seconds: float) -> None:
        """Let `seconds` pass; the game begins as soon as nothing is asked any more."""
        if self.game is not None:
            self.game.tick(seconds)
        elif self._thread.ident is None:
            self._thread.start()
        elif not self._thread.is_alive() and not self.left:
            if self.fault is not None:
                raise self.fault
            self.game = self.make()

    def scene(self, size: tuple[int, int]) -> Scene | tuple[Scene, ...]:
        """What to show in a picture of `size` pixels."""
        if self.game is not None:
            return self.game.scene(size)
        asked, camera = self.asked, Follow.behind(np.zeros(3), yaw=np.pi)  # face to face, like a mirror
        pose = np.tile(np.eye(3), (len(_BODY), 1, 1)) if asked.pose is None else asked.pose
        points = () if asked.points is None else tuple(
            Dot("points", place, SEEN, 0.035, through=True, look="ball") for place in asked.points if np.isfinite(place).all())
        ghost = Figure(*stood(pose), GHOST, sketches=points, opacity=0.55)
        words = asked.words + ("" if asked.left is None else f"   {asked.left:.0f} s")
        return Scene(between(camera, camera, 1.0), (ghost,), overlays=Overlays(points=True), text=tuple(filter(None, (asked.known or self.said,))),
                     hint=Hint(((words, False),)) if words else None)

    def close(self) -> None:
        """End the game, if there is one, or what is asked."""
        self.left = True
        if self._thread.ident is not None:
            self._thread.join(2.0)
        if self.game is not None:
            self.game.close()

    def _tell(self, asked: Asked) -> None:
        if self.left:
            raise Left
        self.asked = asked

    def _say(self, text: str) -> None:
        self.said = text

    def _run(self) -> None:
        try:
            self._ask(self._tell, self._say)
        except Left:
            pass
        except BaseException as error:  # noqa: BLE001, whatever it is, the window's thread tells it
            self.fault = error


def stood(pose: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Positions (J, 3) [m] and orientations (J, 3, 3) of a standard body with these rotations (J, 3, 3) at the origin, its feet where they stand."""
    feet = [_BODY.index(side + "Foot") for side in ("Left", "Right")]
    upright = forward_kinematics(_BODY, _BODY.offsets[0], np.tile(np.eye(3), (len(_BODY), 1, 1)))[0][feet].mean(0)
    positions, orientations = forward_kinematics(_BODY, _BODY.offsets[0], pose)
    return positions + (upright - positions[feet].mean(0)), orientations
