"""Sending a character to the place on the floor, or on a box, that the pointer is over, as actions that a log keeps."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..scene import Box, Camera, Prop
from ..session import SessionState
from .point_picking import unproject

FARTHEST = 60.0
"""Nobody is sent farther away than this [m]."""
NOTCH = 15
"""What a notch of the wheel turns the heading at the goal by [degrees]."""
CLICKED = "LEFT_BUTTON"
"""What a click sends with: held, it turns the camera."""
CLICK, STILL = 15, 0.01
"""A button that is let go within so many ticks, the pointer no farther than this from where it was [heights of the picture], has been clicked."""
DRAGS = 0.15
"""The middle of the picture drags a goal where it is so far from it [m]: the camera goes along with who walks."""
EVERY = 6
"""While it is dragged, a goal moves at most every so many ticks: each time the way is planned anew."""


class Pointing:
    """The pointer over the floor while the key is held that sends somebody there, or as a button is clicked. heading: at the goal [degrees]; None as
    one comes. down: where the button went down, and for how many ticks it has been held; None where it is up. clicked: since the last tick."""

    def __init__(self):
        self.camera: Camera | None = None
        self.aspect, self.pointer = 1.0, (0.0, 0.0)
        self.held, self.waited = False, EVERY
        self.heading: int | None = None
        self.asked: tuple[tuple[float, float], int | None] | None = None
        self.down: tuple[tuple[float, float], int] | None = None
        self.clicked = False

    def look(self, camera: Camera, aspect: float) -> None:
        """How the floor is seen from now on. aspect: width over height of the picture that has it."""
        self.camera, self.aspect = camera, aspect

    def move(self, x: float, y: float) -> None:
        """The pointer is at x, y, in heights of the picture."""
        self.pointer = (x, y)

    def button(self, pressed: bool) -> None:
        """The button goes down or up; what moved the pointer meanwhile was a drag."""
        if not pressed and self.down is not None:
            at, ticks = self.down
            self.clicked = ticks <= CLICK and math.dist(at, self.pointer) < STILL
        self.down = (self.pointer, 0) if pressed else None

    def scroll(self, notches: float) -> bool:
        """The wheel; whether it turns the heading at a goal that is held."""
        if self.held and notches:
            self.heading = ((self.heading or 0) + round(math.copysign(max(abs(notches), 1.0), notches)) * NOTCH) % 360
        return self.held

    def actions(self, now: SessionState, points: bool, sends: str) -> list[str]:
        """What the hands ask for in this tick. points: whether the pointer points anywhere; sends: what is held to send somebody, as
        `Hands.sends` says it."""
        clicked, self.clicked = self.clicked and points, False
        self.down = None if self.down is None else (self.down[0], self.down[1] + 1)
        held = bool(sends) and points
        if clicked and not held:
            place = self.place(now.after.props)
            return [] if place is None else ["goto={:.2f}/{:.2f}".format(*place)]
        if held and not self.held:
            self.heading, self.asked, self.waited = None, None, EVERY
        self.held, self.waited = held, self.waited + 1
        middle = sends == "middle"
        if not held or self.waited < EVERY or not middle and (self.pointer, self.heading) == self.asked:  # a camera that moves drags no pointer
            return []
        place = self.place(now.after.props, middle)
        if place is None or self.asked is not None and middle and math.dist(place, self.asked[0]) < DRAGS:
            return []
        self.asked, self.waited = (place if middle else self.pointer, self.heading), 0
        return ["goto={:.2f}/{:.2f}".format(*place) + ("" if self.heading is None else f"/{self.heading}")]

    def place(self, props: Sequence[Prop], middle: bool = False) -> tuple[float, float] | None:
        """Where x, z [m] the pointer is on the floor, or on a box among props, or the middle of the picture; None above the horizon, or too far away."""
        if self.camera is None:
            return None
        eye = np.asarray(self.camera.eye, float)
        along = unproject(self.camera, self.aspect, np.array([*((0.5 * self.aspect, 0.5) if middle else self.pointer), 1.0])) - eye
        if along[1] > -1e-6:
            return None
        far = min((share for share in (_met(eye, along, box) for box in props if isinstance(box, Box)) if share is not None), default=math.inf)
        way = along * min(far, -eye[1] / along[1])
        return (float(eye[0] + way[0]), float(eye[2] + way[2])) if way[1] < 0.0 and float(np.hypot(way[0], way[2])) < FARTHEST else None


def _met(eye: np.ndarray, along: np.ndarray, box: Box) -> float | None:
    """How many times `along` (3,) from the eye (3,) a line of sight meets the top of a box; None where it does not."""
    c, s = math.cos(box.heading), math.sin(box.heading)
    rise = box.slope * np.array([s, 0.0, c])  # of the top, by x and z
    fall, height = along[1] - rise @ along, eye[1] - box.centre[1] - 0.5 * box.size[1] - rise @ (eye - box.centre)
    if fall > -1e-9 or height < 0.0:
        return None
    x, _, z = eye - height / fall * along - box.centre
    return -height / fall if abs(c * x - s * z) <= 0.5 * box.size[0] and abs(s * x + c * z) <= 0.5 * box.size[2] else None
