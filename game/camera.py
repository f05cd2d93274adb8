"""Cameras: one that follows a character on a sprung arm, and the fixed and dolly shots of films.

Damping is exact: what is left of a distance halves every half-life, however long the frames are.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from controllers.body.rotations import wrap

from .scene import Box, Camera


NEAREST = 0.8
"""No wall or floor brings the eye nearer to the focus than this [m]."""


def damp(value, target, halflife: float, dt: float):
    """`value` after `dt` seconds on its way to `target`; a half-life of 0 arrives at once."""
    if halflife <= 0.0:
        return target
    return value + (target - value) * -math.expm1(-math.log(2.0) * dt / halflife)


@dataclass(frozen=True)
class FollowSettings:
    """How the follow camera behaves: lengths [m], half-lives [s], angles [rad].

    height: of the point looked at. nearest, farthest: the arm. lowest, highest: the pitch.
    floor: the eye stays above this. swing: half-life of coming round behind a walker at 1 m/s.
    rest: seconds the camera stays where the player turned it before it swings again.
    """

    height: float = 1.0
    nearest: float = 1.5
    farthest: float = 12.0
    lowest: float = -0.35
    highest: float = 1.35
    floor: float = 0.15
    focus_halflife: float = 0.10
    orbit_halflife: float = 0.06
    arm_halflife: float = 0.25
    swing: float = 1.6
    rest: float = 1.5
    fov: float = 0.8


@dataclass(frozen=True, eq=False)
class Follow:
    """A follow camera at one moment.

    focus: (3,) [m] the point looked at. yaw: the direction it looks in [rad], as a heading.
    pitch: how far above the focus the eye stands [rad]. distance: [m] the arm that was asked
    for. arm: [m] what walls leave of it. wanted_yaw, wanted_pitch: where the player turned it.
    still: seconds since then.
    """

    focus: np.ndarray = field(default_factory=lambda: np.array([0.0, 1.0, 0.0]))
    yaw: float = 0.0
    pitch: float = 0.25
    distance: float = 4.0
    arm: float = 4.0
    wanted_yaw: float = 0.0
    wanted_pitch: float = 0.25
    still: float = 10.0
    settings: FollowSettings = FollowSettings()

    @staticmethod
    def behind(ground, settings: FollowSettings = FollowSettings()) -> Follow:
        """A camera at rest behind a character's ground frame (3,)."""
        yaw = float(ground[2])
        return Follow(np.array([ground[0], settings.height, ground[1]]), yaw=yaw, wanted_yaw=yaw,
                      settings=settings)

    def turned(self, yaw: float, pitch: float = 0.0) -> Follow:
        """The player turns the camera by angles [rad]: yaw to the left, pitch upwards."""
        if not (math.isfinite(yaw) and math.isfinite(pitch)):
            return self
        s = self.settings
        return replace(self, wanted_yaw=self.wanted_yaw + yaw, still=0.0,
                       wanted_pitch=min(max(self.wanted_pitch + pitch, s.lowest), s.highest))

    def zoomed(self, factor: float) -> Follow:
        """The arm times `factor`, within its limits."""
        s = self.settings
        return replace(self, distance=min(max(self.distance * factor, s.nearest), s.farthest))

    def recentred(self, heading: float) -> Follow:
        """The player asks for the view from behind `heading` [rad]."""
        return replace(self, wanted_yaw=self.yaw + float(wrap(heading - self.yaw)),
                       wanted_pitch=0.25, still=10.0)

    def step(self, ground, velocity, dt: float, boxes: Sequence[Box] = ()) -> Follow:
        """The camera `dt` seconds later.

        ground: (3,) x, z [m], heading [rad] of whom it follows. velocity: (2,) its world
        velocity along x and z [m/s], which the camera comes round behind.
        """
        s = self.settings
        focus = damp(self.focus, np.array([ground[0], s.height, ground[1]]), s.focus_halflife, dt)
        speed = math.hypot(velocity[0], velocity[1])
        wanted = self.wanted_yaw
        if self.still > s.rest and speed > 1e-3:
            error = float(wrap(math.atan2(velocity[0], velocity[1]) - wanted))
            # strongest for a walker who crosses the view; one who comes towards it stays in front
            pull = speed * abs(math.sin(error))
            wanted = damp(wanted, wanted + error, s.swing / max(pull, 1e-6), dt)
        moved = replace(self, focus=focus, wanted_yaw=wanted, still=self.still + dt,
                        yaw=damp(self.yaw, wanted, s.orbit_halflife, dt),
                        pitch=damp(self.pitch, self.wanted_pitch, s.orbit_halflife, dt))
        free = moved._free_arm(boxes)
        # a wall shortens the arm at once, so that it never hides the character; it grows back gently
        arm = min(free, damp(self.arm, free, s.arm_halflife, dt))
        return replace(moved, arm=arm)

    def view(self) -> Camera:
        """What to draw with."""
        eye = self.focus - self.arm * self._forward()
        eye[1] = max(eye[1], self.settings.floor)
        return Camera(eye, self.focus, fov=self.settings.fov)

    def _forward(self) -> np.ndarray:
        flat = math.cos(self.pitch)
        return np.array([math.sin(self.yaw) * flat, -math.sin(self.pitch), math.cos(self.yaw) * flat])

    def _free_arm(self, boxes: Sequence[Box]) -> float:
        arm, back, s = self.distance, -self._forward(), self.settings
        if back[1] < 0.0:
            arm = min(arm, max((s.floor - self.focus[1]) / back[1], NEAREST))
        for box in boxes:
            arm = min(arm, max(_distance_to(box, self.focus, back) - 0.2, NEAREST))
        return arm


def _distance_to(box: Box, origin: np.ndarray, direction: np.ndarray) -> float:
    """How far along a ray [m] it enters a box; infinite if it misses or starts inside."""
    cosine, sine = math.cos(box.heading), math.sin(box.heading)
    local = np.array([[cosine, 0.0, -sine], [0.0, 1.0, 0.0], [sine, 0.0, cosine]])
    start, ray = local @ (origin - np.array(box.centre)), local @ direction
    ray = np.where(np.abs(ray) < 1e-12, 1e-12, ray)
    half = 0.5 * np.array(box.size)
    first, second = (-half - start) / ray, (half - start) / ray
    enter, leave = np.minimum(first, second).max(), np.maximum(first, second).min()
    return float(enter) if 0.0 < enter <= leave else math.inf


def above_floor(eye: np.ndarray, floor: float = FollowSettings.floor) -> np.ndarray:
    """An eye (3,) [m] no lower than `floor`."""
    return np.array([eye[0], max(eye[1], floor), eye[2]])


def fixed(eye, target, fov: float = 0.8) -> Camera:
    """A camera that stands still; eye, target: (3,) [m]."""
    return Camera(above_floor(np.asarray(eye, float)), np.asarray(target, float), fov=fov)


def dolly(start, end, target, progress: float, fov: float = 0.8) -> Camera:
    """A camera on rails from `start` to `end` (3,) [m], gently set off and stopped; progress 0 … 1."""
    u = min(max(progress, 0.0), 1.0)
    u = u * u * (3.0 - 2.0 * u)
    start, end = np.asarray(start, float), np.asarray(end, float)
    return fixed(start + u * (end - start), target, fov)
