"""Cameras that a player holds: one on a sprung arm behind a character, one that orbits, one that flies.

All are values of one shape: `step(ground, velocity, wish, dt, props)` gives the camera `dt` later,
`view()` what to draw with, `between` what lies between two steps, `cycled` the next kind, its eye
where it was. Damping is exact: what is left of a distance halves every half-life, however long
the steps are. An eye is never within a prop, under the floor or inside the character.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from gambol.controllers.body import damp, wrap

from ..input import Wish
from ..scene import Camera, Prop
from .arm import Armed, CameraSettings, Turned, angles, finite, forward
from .line_of_sight import above_floor, beside, outside

CUT = 1.5
"""An eye that moves farther than this [m] in one step has been put elsewhere: nothing lies between."""
BESIDE, OVER = 0.62, 0.16
"""How far beside a jump a camera swings that would look along it, and how much higher [rad]: seen from behind, the body
hides where it jumps to."""
CHANGES = 0.3
"""A jump aimed at by so much to the camera's side [rad] makes it swing to the other one."""
COMES, GOES = 0.16, 0.6
"""Half-lives [s] of swinging there and back."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Follow(Armed):
    """Behind a character, on an arm that swings round with the walk.

    focus: (3,) [m] where the character is, ahead: (3,) how far before it the camera looks, slack:
    (3,) what is left of the change from another camera; target is their sum. still: seconds
    since the player turned it. aside: how far it has swung out of the line of a jump [rad], which leaves its yaw, and so
    the sticks' directions, as they are.
    """

    kind: ClassVar[str] = "follow"
    focus: np.ndarray
    ahead: np.ndarray = field(default_factory=lambda: np.zeros(3))
    slack: np.ndarray = field(default_factory=lambda: np.zeros(3))
    still: float = 10.0
    aside: float = 0.0

    @staticmethod
    def behind(ground, settings: CameraSettings = CameraSettings(), yaw: float | None = None,
               pitch: float = 0.25, distance: float = 4.0, level: float = 0.0) -> Follow:
        """A camera at rest behind a character's ground frame (3,), or looking along `yaw` [rad].

        level: how high the character's floor lies [m]."""
        yaw = float(ground[2]) if yaw is None else yaw
        focus = np.array([ground[0], level + settings.height, ground[1]])
        return Follow(eye=focus - distance * forward(yaw, pitch), target=focus, focus=focus, yaw=yaw,
                      wanted_yaw=yaw, pitch=pitch, wanted_pitch=pitch, distance=distance, arm=distance,
                      settings=settings)

    def turned(self, yaw: float, pitch: float = 0.0) -> Follow:
        """The player turns the camera by angles [rad]: yaw to the left, pitch upwards."""
        turned = super().turned(yaw, pitch)
        return self if turned is self else replace(turned, still=0.0)

    def recentred(self, heading: float) -> Follow:
        """The player asks for the view from behind `heading` [rad]."""
        return replace(super().recentred(heading), still=10.0)

    def aimed(self, heading: float | None, dt: float) -> Follow:
        """The camera a little out of the line of a jump along `heading` [rad]; back behind where nobody aims at one."""
        if heading is None:
            return self if self.aside == 0.0 else replace(self, aside=float(damp(self.aside, 0.0, GOES, dt)))
        line = float(wrap(heading - self.yaw))
        side = 1.0 if self.aside >= 0.0 else -1.0
        if side * line > CHANGES:
            side = -side
        wanted = side * max(BESIDE + side * line, 0.0) if abs(line) < 0.5 * math.pi else 0.0
        return replace(self, aside=float(damp(self.aside, wanted, COMES, dt)))

    def _looks(self) -> tuple[float, float]:
        return self.yaw + self.aside, min(self.pitch + OVER * min(abs(self.aside) / BESIDE, 1.0), self.settings.highest)

    def step(self, ground, velocity, wish: Wish, dt: float, props: Sequence[Prop] = (), level: float = 0.0) -> Follow:
        """The camera `dt` seconds later.

        ground: (3,) x, z [m], heading [rad] of whom it follows. velocity: (2,) its world velocity
        along x and z [m/s], which the camera comes round behind. wish: what the hands do. level: how
        high the floor lies that carries it [m].
        """
        told, s = self._told(wish, dt), self.settings
        focus = _near(told.focus, ground, level, s, dt)
        ahead = damp(told.ahead, s.ahead * np.array([velocity[0], 0.0, velocity[1]]), s.ahead_halflife, dt)
        slack = damp(told.slack, 0.0, s.change_halflife, dt)
        speed, wanted = math.hypot(velocity[0], velocity[1]), told.wanted_yaw
        if told.still > s.rest and speed > 1e-3:
            error = float(wrap(math.atan2(velocity[0], velocity[1]) - wanted))
            # strongest for a walker who crosses the view; one who comes towards it stays in front
            pull = speed * abs(math.sin(error))
            wanted = float(damp(wanted, wanted + error, s.swing / max(pull, 1e-6), dt))
        moved = replace(told, focus=focus, ahead=ahead, slack=slack, target=focus + ahead + slack,
                        wanted_yaw=wanted, still=told.still + dt, **told._swung(dt))
        return moved._reached(ground, dt, props, clear=float(slack @ slack) < 0.01)


@dataclass(frozen=True, eq=False, kw_only=True)
class Orbit(Armed):
    """Round a point, as in a viewer of models: the mouse turns it, its middle button pans.

    The point goes with the character (its heading is left alone) until it is panned away; then
    it stays, until the player recentres. pivot: (3,) [m] where it is to be.
    """

    kind: ClassVar[str] = "orbit"
    pivot: np.ndarray
    tracks: bool = True

    @staticmethod
    def round(pivot: np.ndarray, settings: CameraSettings = CameraSettings(), yaw: float = 0.0, pitch: float = 0.25,
              distance: float = 4.0, tracks: bool = True) -> Orbit:
        """A camera at rest that looks at a point (3,) [m] along `yaw`."""
        return Orbit(eye=pivot - distance * forward(yaw, pitch), target=pivot, pivot=pivot, yaw=yaw, wanted_yaw=yaw,
                     pitch=pitch, wanted_pitch=pitch, distance=distance, arm=distance, settings=settings, tracks=tracks)

    def recentred(self, heading: float) -> Orbit:
        """Back to the character, seen from behind `heading` [rad]."""
        return replace(super().recentred(heading), tracks=True)

    def panned(self, right: float, up: float) -> Orbit:
        """The picture pushed by the mouse, in heights of the window; the point stays there."""
        if not finite(right, up):
            return self
        span = 2.0 * self.arm * math.tan(0.5 * self.settings.fov)
        sideways = np.array([-math.cos(self.yaw), 0.0, math.sin(self.yaw)])
        upwards = np.cross(sideways, forward(self.yaw, self.pitch))
        pivot = self.pivot - span * (right * sideways + up * upwards)
        return replace(self, pivot=above_floor(pivot), tracks=False)

    def step(self, ground, velocity, wish: Wish, dt: float, props: Sequence[Prop] = (), level: float = 0.0) -> Orbit:
        """The camera `dt` seconds later; see `Follow.step`. The velocity plays no part."""
        told, s = self._told(wish, dt), self.settings
        if wish.pan != (0.0, 0.0):
            told = told.panned(*wish.pan)
        pivot = np.array([ground[0], level + s.height, ground[1]]) if told.tracks else told.pivot
        target = _near(told.target, ground, level, s, dt) if told.tracks else damp(told.target, pivot, s.focus_halflife, dt)
        moved = replace(told, pivot=pivot, target=target, **told._swung(dt))
        return moved._reached(ground, dt, props, clear=False)

    def _pitches(self) -> tuple[float, float]:
        return -1.2, 1.5


@dataclass(frozen=True, eq=False, kw_only=True)
class Free(Turned):
    """Flies where the sticks push it: moves along the view and across, turning keys up and down.

    velocity: (3,) [m/s]. speed: of a full push [m/s], which the wheel changes.
    """

    kind: ClassVar[str] = "free"
    flown: ClassVar[bool] = True
    velocity: np.ndarray = field(default_factory=lambda: np.zeros(3))
    speed: float = CameraSettings.fly

    def zoomed(self, factor: float) -> Free:
        """The speed divided by `factor`."""
        return replace(self, speed=min(max(self.speed / factor, 0.2), 20.0))

    def step(self, ground, velocity, wish: Wish, dt: float, props: Sequence[Prop] = (), level: float = 0.0) -> Free:
        """The camera `dt` seconds later; see `Follow.step`. It keeps out of whoever stands at `ground`."""
        told, s = self._told(wish, dt), self.settings
        if wish.look != (0.0, 0.0):
            told = told.turned(-s.turn * dt * wish.look[0], -s.turn * dt * wish.look[1])
        sideways = np.array([-math.cos(told.yaw), 0.0, math.sin(told.yaw)])
        push = (wish.move[0] * sideways + wish.move[1] * forward(told.yaw, told.pitch)
                - np.array([0.0, wish.turn, 0.0]))
        wanted = push * told.speed * (0.3 if wish.slow else 1.0 + 2.0 * wish.run)
        # the way of a damped velocity is its integral, which is exact for any dt as well
        now = damp(told.velocity, wanted, s.fly_halflife, dt)
        way = wanted * dt + (told.velocity - now) * (s.fly_halflife / math.log(2.0))
        eye, props = told.eye, tuple(props)
        pieces = max(math.ceil(float(np.abs(way).max()) / 0.1), 1)  # shorter than any wall is thick
        for _ in range(pieces):
            eye = outside(beside(above_floor(eye + way / pieces), ground), props)
        return replace(told, eye=eye, velocity=now, **told._swung(dt))

    def view(self) -> Camera:
        """What to draw with."""
        return Camera(self.eye, self.eye + forward(self.yaw, self.pitch), fov=self.settings.fov)

    def _pitches(self) -> tuple[float, float]:
        return -1.5, 1.5


PlayerCamera = Follow | Orbit | Free


def _near(focus: np.ndarray, ground, level: float, s: CameraSettings, dt: float) -> np.ndarray:
    """What is looked at, `dt` seconds nearer to the character; slower up and down, where jumps go."""
    here = np.array([ground[0], level + s.height, ground[1]])
    nearer = damp(focus, here, s.focus_halflife, dt)
    nearer[1] = damp(focus[1], here[1], s.level_halflife, dt)
    return nearer


def cycled(camera: PlayerCamera, ground, level: float = 0.0) -> PlayerCamera:
    """The next kind of camera: follow, orbit, free and round again; the eye stays where it is.

    ground: (3,) of the character that the new one may look after; level: how high it stands [m].
    """
    s, view = camera.settings, camera.view()
    yaw, pitch, arm = angles(view.target - view.eye)
    here = np.array([ground[0], level + s.height, ground[1]])
    turned = {"eye": view.eye, "yaw": yaw, "wanted_yaw": yaw, "pitch": pitch, "settings": s}
    if isinstance(camera, Orbit):
        return Free(wanted_pitch=pitch, **turned)
    if isinstance(camera, Follow):
        return Orbit(pivot=here, target=view.target, distance=camera.distance, arm=arm, wanted_pitch=pitch, **turned)
    arm = min(max(float(np.linalg.norm(here - view.eye)), s.nearest), s.farthest)
    target = view.eye + arm * forward(yaw, pitch)
    # however near or far one flew, the arm goes back to its usual length
    return Follow(focus=here, slack=target - here, target=target, arm=arm, still=0.0,
                  wanted_pitch=min(max(pitch, s.lowest), s.highest), **turned)


def between(a: PlayerCamera, b: PlayerCamera, alpha: float) -> Camera:
    """What to draw with `alpha` (0 … 1) of the way from one step's camera to the next one's."""
    first, second = a.view(), b.view()
    if np.linalg.norm(second.eye - first.eye) > CUT:
        return second
    return Camera(first.eye + alpha * (second.eye - first.eye), first.target + alpha * (second.target - first.target),
                  fov=first.fov + alpha * (second.fov - first.fov))
