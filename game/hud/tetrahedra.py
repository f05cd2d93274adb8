"""The control space as something to look at: its edges, and an orbiting view of them. Arrays, nothing drawn."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from gambol.controllers.body import damp
from gambol.controllers.locomotion import SCALE, Locomotion

SEEN = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
"""Scaled (v_f, ω, v_l) to right, up, away."""
TURN = 0.008
"""Radians for each pixel of dragging (at 720 lines)."""
FILL = 0.53
"""How much of the panel's width or height the space reaches to either side."""
DEEP, EYE = 4.0, 3.0
"""Half the depth of what is looked at, in scaled velocity, and how many of those away the eye is."""


@dataclass(frozen=True)
class Orbit:
    """Whence the space is seen: angles [rad], how much nearer than to fit (zoom), the middle of what is
    looked at, in scaled velocity, and how many pixels a unit of that has there (room)."""

    yaw: float = -0.55
    pitch: float = 0.42
    zoom: float = 1.0
    middle: tuple[float, float, float] = (0.0, 0.0, 0.0)
    room: float = 0.0

    def turned(self, dx: float, dy: float) -> Orbit:
        """Turned by a drag [px]; never over its poles."""
        return replace(self, yaw=self.yaw - TURN * dx, pitch=min(max(self.pitch + TURN * dy, -1.55), 1.55))

    def towards(self, velocities: np.ndarray, size: tuple[float, float], dt: float) -> Orbit:
        """On its way to fit velocities (Q, 3) into size [px]; at once where it fits nothing yet."""
        scaled = velocities / SCALE
        middle = 0.5 * (scaled.min(0) + scaled.max(0))
        flat = np.abs(replace(self, middle=tuple(middle), room=1.0, zoom=1.0).project(velocities, (0.0, 0.0)))
        room = FILL * min(size[0] / flat[:, 0].max(), size[1] / flat[:, 1].max())
        halflife = 0.2 if self.room else 0.0
        return replace(self, middle=tuple(damp(np.array(self.middle), middle, halflife, dt)),
                       room=damp(self.room, room, halflife, dt))

    def project(self, velocities: np.ndarray, centre: tuple[float, float]) -> np.ndarray:
        """Velocities (..., 3) v_f, ω, v_l as (..., 3): x, y [px], and depth, about −1 near … 1 far.

        centre: [px] where the middle is shown.
        """
        p = (np.asarray(velocities, float) / SCALE - np.array(self.middle)) @ SEEN.T
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        right, away = c * p[..., 0] + s * p[..., 2], c * p[..., 2] - s * p[..., 0]
        c, s = math.cos(self.pitch), math.sin(self.pitch)
        up, depth = c * p[..., 1] + s * away, (c * away - s * p[..., 1]) / DEEP
        near = self.zoom * self.room * EYE / np.maximum(EYE + depth, 0.2 * EYE)
        return np.stack([centre[0] + near * right, centre[1] - near * up, depth], -1)


@dataclass(frozen=True, eq=False)
class Mesh:
    """A family's space, ready to draw: points (Q, 3), edges (E, 2) and whether they are on the hull
    (E,), simplices (S, 4), and which primitives the points are (Q,)."""

    family: str
    points: np.ndarray
    edges: np.ndarray
    outer: np.ndarray
    simplices: np.ndarray
    members: np.ndarray

    @staticmethod
    def of(controller, name: str) -> Mesh | None:
        """The mesh of a family; None where the controller has no such space."""
        space = controller.space(name) if isinstance(controller, Locomotion) else None
        if space is None:
            return None
        edges, _ = space.edges()
        outside = set()
        for simplex, neighbours in zip(space.simplices, space.neighbours):
            for k in np.flatnonzero(neighbours < 0):
                face = sorted(int(v) for v in np.delete(simplex, k))
                outside |= {(face[0], face[1]), (face[0], face[2]), (face[1], face[2])}
        return Mesh(name, space.points, edges, np.array([tuple(e) in outside for e in edges.tolist()]),
                    space.simplices, controller.library.family(name))
