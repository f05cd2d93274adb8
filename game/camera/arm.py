"""What cameras that a player holds have in common: being turned, and an arm that props shorten.

Angles: yaw is the heading a camera looks in; pitch is how far its eye stands above what it looks at.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from gambol.controllers.body import damp, wrap
from gambol.controllers.contract import but
from gambol.controllers.navigation import free_way

from ..input import Wish
from ..scene import Camera, Prop
from .line_of_sight import FLOOR, MARGIN, above_floor, beside, off_faces, outside

NEAREST = 1.4
"""An arm that walls make shorter than this [m] lifts the eye over the character instead, so that it stays farther off than 1.2 m."""
SHORTEN = 0.025
"""Half-life [s] of an arm that gives way to what is beside it."""
WHISKER = 0.5
"""A prop this far beside the arm [rad] begins to shorten it, so that it is short when the prop arrives."""
SOON, DRAWN = np.arange(1, 49) / 60, 6.0
"""What will come between at these times [s], as the character goes on, draws the arm in no faster than this [m/s]."""
OFF = 0.4
"""An arm begins so far [m] off what stands beside the point looked at: along its very face it would be as good as in it."""
SPARED = 0.01
"""So far before a prop its way up is looked along [m]."""
MET = 0.01
"""An eye nearer than this to what it looks at [m] sees nothing that way."""
REST = np.zeros(2)
_YAWS, _PITCHES = 0.025 * np.arange(1, 11), 0.05 * np.arange(1, 5)
_FAN = np.concatenate([[(0.0, 0.0)], [(side * a, 0.0) for side in (-1, 1) for a in _YAWS],
                       [(0.0, side * a) for side in (-1, 1) for a in _PITCHES]])


@dataclass(frozen=True)
class CameraSettings:
    """How cameras behave: lengths [m], half-lives [s], angles [rad], rates [rad/s], speeds [m/s].

    height: of the point looked at. nearest, farthest: the arm. lowest, highest: the pitch.
    ahead: how many seconds before a walker it looks. swing: half-life of coming round behind a
    walker at 1 m/s. rest: seconds the camera stays where the player turned it before it swings again.
    """

    height: float = 1.0
    nearest: float = 1.5
    farthest: float = 12.0
    lowest: float = -0.35
    highest: float = 1.35
    ahead: float = 0.35
    ahead_halflife: float = 0.35
    focus_halflife: float = 0.10
    level_halflife: float = 0.16
    orbit_halflife: float = 0.06
    arm_halflife: float = 0.25
    change_halflife: float = 0.30
    swing: float = 1.6
    rest: float = 1.5
    turn: float = 2.5
    notch: float = 0.88
    fly: float = 3.0
    fly_halflife: float = 0.08
    fov: float = 0.8


def finite(*numbers: float) -> bool:
    """Whether all of them are numbers to reckon with."""
    return all(map(math.isfinite, numbers))


def forward(yaw: float, pitch: float) -> np.ndarray:
    """The direction (3,) in which a camera looks."""
    flat = math.cos(pitch)
    return np.array([math.sin(yaw) * flat, -math.sin(pitch), math.cos(yaw) * flat])


def _forwards(yaw: float, pitch: float) -> np.ndarray:
    """The directions (W, 3) of the arm and its whiskers."""
    yaws, pitches = yaw + _FAN[:, 0], pitch + _FAN[:, 1]
    flat = np.cos(pitches)
    return np.stack([np.sin(yaws) * flat, -np.sin(pitches), np.cos(yaws) * flat], -1)


def _foreseen(root: np.ndarray, back: np.ndarray, velocity: np.ndarray, props: tuple[Prop, ...]) -> float:
    """How long an arm from root (3,) along back (3,) may be [m], so that it need not be drawn in faster than `DRAWN` as its root goes on as it does."""
    speed = math.hypot(velocity[0], velocity[1])
    if speed < 0.1:
        return math.inf
    ahead = np.array([velocity[0], 0.0, velocity[1]]) / speed
    times = SOON[SOON * speed < free_way(root, ahead[None], props, MARGIN)[0]]
    free = free_way(root + speed * times[:, None] * ahead, np.tile(back, (len(times), 1)), props, MARGIN)
    return float((free + DRAWN * times).min(initial=math.inf))


def angles(way: np.ndarray) -> tuple[float, float, float]:
    """Yaw, pitch and length of a vector from an eye to what it looks at."""
    flat = math.hypot(way[0], way[2])
    return math.atan2(way[0], way[2]), math.atan2(-way[1], flat), math.hypot(flat, way[1])


def nearer_to(focus: np.ndarray, ground, level: float, s: CameraSettings, dt: float) -> np.ndarray:
    """What is looked at, `dt` seconds nearer to the character; slower up and down, where jumps go."""
    here = np.array([ground[0], level + s.height, ground[1]])
    nearer = damp(focus, here, s.focus_halflife, dt)
    nearer[1] = damp(focus[1], here[1], s.level_halflife, dt)
    return nearer


@dataclass(frozen=True, eq=False, kw_only=True)
class Turned:
    """What all cameras have.

    eye: (3,) [m]. yaw, pitch: [rad]; wanted_yaw, wanted_pitch: where the player turned them.
    """

    eye: np.ndarray
    yaw: float = 0.0
    pitch: float = 0.25
    wanted_yaw: float = 0.0
    wanted_pitch: float = 0.25
    settings: CameraSettings = CameraSettings()

    kind: ClassVar[str]
    flown: ClassVar[bool] = False
    """Whether the sticks move the camera instead of the character."""

    def turned(self, yaw: float, pitch: float = 0.0) -> Self:
        """The player turns the camera by angles [rad]: yaw to the left, pitch upwards."""
        if not finite(yaw, pitch):
            return self
        lowest, highest = self._pitches()
        return but(self, wanted_yaw=self.wanted_yaw + yaw,
                   wanted_pitch=min(max(self.wanted_pitch + pitch, lowest), highest))

    def recentred(self, heading: float) -> Self:
        """The player asks for the view along `heading` [rad]; it turns there the shorter way."""
        return but(self, wanted_yaw=self.yaw + float(wrap(heading - self.yaw)), wanted_pitch=0.25)

    def zoomed(self, factor: float) -> Self:
        """The wheel asks to be `factor` times as far; itself where that means nothing."""
        return self

    def aimed(self, heading: float | None, dt: float) -> Self:
        """The camera `dt` seconds later for somebody who looks where to jump, along `heading` [rad]; None: nobody does."""
        return self

    def _pitches(self) -> tuple[float, float]:
        return self.settings.lowest, self.settings.highest

    def _told(self, wish: Wish, dt: float) -> Self:
        """The camera after what the hands did to it."""
        rate = self.settings.turn * dt
        yaw, pitch = wish.drag[0] + rate * wish.orbit[0], wish.drag[1] + rate * wish.orbit[1]
        told = self.turned(yaw, pitch) if yaw or pitch else self
        if wish.zoom and math.isfinite(wish.zoom):
            told = told.zoomed(self.settings.notch ** min(max(wish.zoom, -10.0), 10.0))
        return told

    def _swung(self, dt: float) -> dict[str, Any]:
        s = self.settings
        return {"yaw": float(damp(self.yaw, self.wanted_yaw, s.orbit_halflife, dt)),
                "pitch": float(damp(self.pitch, self.wanted_pitch, s.orbit_halflife, dt))}


@dataclass(frozen=True, eq=False, kw_only=True)
class Armed(Turned):
    """What cameras on an arm have. target: (3,) [m] the point looked at. distance: the arm that
    was asked for; arm: what props leave of it [m]."""

    target: np.ndarray
    distance: float = 4.0
    arm: float = 4.0

    def zoomed(self, factor: float) -> Self:
        """The arm times `factor`, within its limits."""
        s = self.settings
        return but(self, distance=min(max(self.distance * factor, s.nearest), s.farthest))

    def view(self) -> Camera:
        """What to draw with: along the arm, too, where props have pushed the eye onto what it looks at."""
        met = np.linalg.norm(self.target - self.eye) < MET
        target = self.eye + forward(*self._looks()) if met else self.target
        return Camera(self.eye, target, fov=self.settings.fov)

    def _looks(self) -> tuple[float, float]:
        """Yaw and pitch of the arm."""
        return self.yaw, self.pitch

    def placed(self, ground, props: Sequence[Prop]) -> Self:
        """The camera at rest, as far from its target as props let it; ground: (3,) of whom it spares."""
        return self._reached(ground, math.inf, props, clear=False)

    def _reached(self, ground, dt: float, props: Sequence[Prop], clear: bool, velocity: np.ndarray = REST) -> Self:
        """The camera with its eye at the end of its arm. clear: whether the arm may meet nobody. velocity: (2,) of what it looks at [m/s]."""
        props = tuple(props)
        root = off_faces(outside(self.target, props), OFF, props)
        # the eye slides along the floor instead of going under it
        longest = max(self.arm, damp(self.arm, self.distance, self.settings.arm_halflife, dt))
        yaw, pitch = self._looks()
        pitch = max(pitch, -math.asin(min(max((root[1] - FLOOR) / longest, -1.0), 1.0)))
        back = -_forwards(yaw, pitch)
        free = free_way(root, back, props, MARGIN)
        slope = self.distance / WHISKER
        soft = min(float((free + slope * np.abs(_FAN).sum(-1)).min()), self.distance)
        s = self.settings
        arm = damp(self.arm, soft, SHORTEN if soft < self.arm else s.arm_halflife, dt)
        # what comes between unforeseen shortens the arm at once: nothing hides the character
        arm, nearest = float(min(arm, free[0], _foreseen(root, back[0], velocity, props))), min(NEAREST, self.distance)
        eye = root + arm * back[0]
        if arm < nearest:
            up = np.array([[0.0, 1.0, 0.0]])
            # from a little before what shortened the arm: on its very margin the way up is free or not by rounding
            before = root + max(arm - SPARED, 0.0) * back[0]
            eye = eye + min(nearest * (1.0 - (arm / nearest) ** 2), free_way(before, up, props, MARGIN)[0]) * up[0]
        if not clear or arm < nearest or eye[1] < FLOOR:
            eye = outside(beside(above_floor(eye), ground), props)
        return but(self, eye=eye, arm=arm)
