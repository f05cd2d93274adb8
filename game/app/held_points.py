"""What pointer and stream do with the points of a comparison, as actions that a log keeps; and what is learnt meanwhile."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..explain import RADIUS, Row
from ..scene import Camera, Dot, Figure, Ink
from ..session import SessionState, Comparison, written
from ..world import SHIPPED, Learning, Methods, compiled
from .point_picking import Grip, nearest

HELD = (0.95, 0.95, 0.92)
"""The colour round a point that is held or could be."""


class HeldPoints:
    """The pointer over the points of a comparison, a stream of them, and the methods that are being learnt.

    stream: a `gambol.controllers.reconstruction.live.sources.Source`; its points are held from the first on, beside the player as
    a comparison's bodies are.
    """

    def __init__(self, methods: Methods, stream: Any = None):
        self.methods, self.stream = methods, stream
        self.camera: Camera | None = None
        self.aspect = 1.0
        self.pointer = (0.0, 0.0)
        self.grip: Grip | None = None
        self.sent = ""
        self.learning: Learning | None = None
        self.reading: threading.Thread | None = None
        self.wanted: Comparison | None = None
        self.usual = Comparison()
        self.panel: Any = None
        self._fault, self._foreseen = "", False

    # --- keys

    def asked(self, action: str, now: SessionState) -> tuple[str, str]:
        """What a key asks of the session, as an action; or why nothing, or not yet, in words."""
        open_ = now.comparison
        if self.wanted is not None and action in ("study", "study_points", "study_ghosts"):
            given_up, waits = self._meanwhile, self.reading is not None
            if waits or action != "study":
                return "", f"one thing after the other: still {given_up}"
            self._give_up()
            return "", f"no longer {given_up}"
        if action == "study":
            return self.open(self.usual) if open_ is None else ("study=", "")
        if open_ is None:
            return "", "nothing is reconstructed yet"
        if self.stream is not None and action != "study_ghosts":
            return "", "the points are the stream's"
        if action == "study_points":
            return self.open(open_.more_points())
        if action == "study_ghosts":
            return self.open(open_.other_ghosts())
        if action == "study_hands":
            self.grip = None
            return "pins=hold" if open_.pins is None else "pins=", ""
        number, pins = self._under(now), open_.pins
        if number is None or pins is None:
            return "", "no point that is held is under the pointer"
        place = self._places(now)[number] if pins[number] is None else np.full(3, np.nan)
        return f"pin={number}:{written(place)}", ""

    def open(self, wanted: Comparison) -> tuple[str, str]:
        """The action that opens a comparison, if all of it is ready; else another program learns it, or compiles what ships, first."""
        if self.stream is not None:  # whose points they are, whenever it is opened again
            self.usual = wanted
        missing = [(name, wanted.points) for name in wanted.methods if not self.methods.knows(name, wanted.points)]
        if not missing:
            return wanted.action, ""
        self.wanted = wanted
        ships = all(name == SHIPPED for name, _ in missing)
        if ships and compiled():
            self._begin_reading(wanted)
        elif not (ships and self.learning is not None):  # else the one that is under way
            self._stop()
            self.learning = Learning(missing, self.methods.file)
        return "", ""

    def ahead(self) -> None:
        """Have what ships compiled by another program before anybody asks for it, so that nobody waits for it."""
        if not self._foreseen and self.learning is None and self.reading is None:
            self._foreseen = True
            if not compiled():
                self.learning = Learning([(SHIPPED, Comparison().points)], self.methods.file)

    def _begin_reading(self, wanted: Comparison) -> None:
        self.reading = threading.Thread(target=self._read, args=(wanted,), daemon=True)
        self.reading.start()

    def _stop(self) -> None:
        if self.learning is not None:
            self.learning.stop()
            self.learning = None

    def _give_up(self) -> None:
        """Want nothing any more; what was learnt or compiled so far is kept."""
        self._stop()
        self.wanted = None

    @property
    def _meanwhile(self) -> str:
        """What one waits for."""
        assert self.wanted is not None
        ships = set(self.wanted.methods) <= {SHIPPED}
        return f"{'getting ready' if ships else 'learning, once,'} for {self.wanted.count} points"

    def learnt(self) -> str:
        """The action that opens what has been learnt by now, or "!" and why it can't be; empty otherwise."""
        if self.learning is not None:
            if not self.learning.done:
                return ""
            fault, self.learning = self.learning.fault, None
            if self.wanted is not None and fault:
                self.wanted = None
                return f"!{fault}"
            if self.wanted is not None:  # it lies on disk now: read it beside the game
                self._begin_reading(self.wanted)
        if self.wanted is None:
            return ""
        if self.reading is not None and self.reading.is_alive():
            return ""
        wanted, self.wanted, self.reading = self.wanted, None, None
        return f"!{self._fault}" if self._fault else wanted.action

    def _read(self, wanted: Comparison) -> None:
        self._fault = ""
        try:
            for name in wanted.methods:
                self.methods(name, wanted.points)
        except (ValueError, OSError) as error:
            self._fault = str(error)

    def status(self, moment: SessionState, key: Callable[[str], str]) -> tuple[str, ...]:
        """What is going on, in lines."""
        lines = []
        if self.wanted is not None:
            said = self.learning.so_far if self.learning is not None else ""
            lines.append(self._meanwhile + (f": {said}" if said else ""))
        if moment.comparison is not None:
            if moment.comparison.pins is None:
                lines.append(f"from {moment.comparison.count} points: {key('study_points')} others, "
                             f"{key('study_ghosts')} ghosts, {key('study_hands')} hold them")
            elif self.stream is None:
                lines.append(f"drag the points, wheel or {key('run')} deeper, {key('study_hide')} unseen, "
                             f"{key('study_hands')} let go")
        if self.stream is not None and self.stream.worn is not None:
            lines.append(self.stream.worn.said(self.stream.controls.names))
        return tuple(lines)

    # --- the pointer

    def look(self, camera: Camera, aspect: float) -> None:
        """How the points are seen from now on. aspect: width over height of the picture that has them."""
        self.camera, self.aspect = camera, aspect

    def move(self, x: float, y: float, dx: float, dy: float, deeper: bool) -> bool:
        """The pointer is at x, y, in heights of the picture; whether it drags a point. deeper: as with Shift."""
        self.pointer = (x, y)
        if self.grip is None:
            return False
        if deeper:
            self.grip = self.grip.slid(dx, dy)
        return True

    def holds(self, now: SessionState) -> bool:
        """Whether hands hold the points."""
        return self.stream is None and now.comparison is not None and now.comparison.pins is not None

    def scroll(self, notches: float) -> bool:
        """The wheel; whether it pushes a point that is held."""
        if self.grip is not None:
            self.grip = self.grip.pushed(notches)
        return self.grip is not None

    def grab(self, now: SessionState) -> bool:
        """Take hold of the point under the pointer; whether there is one."""
        number = self._under(now)
        if number is None or self.camera is None:
            return False
        self.grip, self.sent = Grip.of(self.camera, self.aspect, self._places(now), number, *self.pointer), ""
        return True

    def let_go(self) -> bool:
        """Whether a point was held; it stays where it is."""
        held, self.grip = self.grip is not None, None
        return held

    def actions(self, now: SessionState, time: float) -> list[str]:
        """What the hands or the stream ask for in this tick. time: [s] of the session."""
        if now.comparison is None:
            return []
        if self.stream is not None:
            seen = self.stream.at(time) + np.array(now.comparison.beside)
            return ["pins=" + ";".join(written(place, turn) for place, turn in zip(seen, self.stream.turns))]
        if self.grip is None or not self.holds(now) or self.camera is None:
            return []
        place = written(self.grip.place(self.camera, self.aspect, *self.pointer))
        if place == self.sent:
            return []
        self.sent = place
        return [f"pin={self.grip.number}:{place}"] if place else []

    def _places(self, now: SessionState) -> np.ndarray:
        """Where the points (n, 3) of the comparison are, or the body has them."""
        body, follows = next((one, one.follows) for one in now.after.characters if one.follows is not None)
        own = follows.controls.on(*body.joints)
        goals = None if now.comparison is None else now.comparison.goals
        return own if goals is None else np.where(np.isfinite(goals), goals, own)

    def _under(self, now: SessionState) -> int | None:
        if not self.holds(now) or self.camera is None:
            return None
        return nearest(self.camera, self.aspect, self._places(now), *self.pointer)

    # --- the picture

    def marked(self, figures: Sequence[Figure], moment: SessionState) -> tuple[Figure, ...]:
        """The figures with a ring round the point that is held, or would be."""
        number = self.grip.number if self.grip is not None else self._under(moment)
        if number is None or not self.holds(moment):
            return tuple(figures)
        ring = Dot("points", self._places(moment)[number], HELD, 1.7 * RADIUS, through=True, look="ring")
        return (replace(figures[0], sketches=(*figures[0].sketches, ring)), *figures[1:])

    def legend(self, told: Sequence[Row], size: tuple[int, int], comparison: Comparison | None) -> Ink:
        """The legend over a picture of `size` pixels."""
        if self.panel is None:
            from ..hud import Legend  # loads ImGui, for those only who reconstruct

            self.panel = Legend()
        return self.panel.ink(told, size, "" if comparison is None else f"from {comparison.count} points")

    def close(self) -> None:
        """Give everything back."""
        self._stop()
        if self.panel is not None:
            self.panel.release()
            self.panel = None
