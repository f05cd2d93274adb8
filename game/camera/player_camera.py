"""The cameras that a player holds: the follow camera, one that orbits, one that flies.

All are values of one shape: `step(ground, velocity, wish, dt, props)` gives the camera `dt` later,
`view()` what to draw with, `between` what lies between two steps, `cycled` the next kind, its eye
where it was. Damping is exact: what is left of a distance halves every half-life, however long
the steps are. An eye is never within a prop, under the floor or inside the character.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from ..scene import Camera
from .arm import angles, forward
from .fly_camera import Free
from .follow_camera import Follow
from .orbit_camera import Orbit

CUT = 1.5
"""An eye that moves farther than this [m] in one step has been put elsewhere: nothing lies between."""
PlayerCamera = Follow | Orbit | Free


class Seeing(Protocol):
    """Whatever says what to draw with."""

    def view(self) -> Camera:
        """The camera."""
        ...


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


def between(a: Seeing, b: Seeing, alpha: float) -> Camera:
    """What to draw with `alpha` (0 … 1) of the way from one step's camera to the next one's."""
    first, second = a.view(), b.view()
    if np.linalg.norm(second.eye - first.eye) > CUT:
        return second
    return Camera(first.eye + alpha * (second.eye - first.eye), first.target + alpha * (second.target - first.target),
                  fov=first.fov + alpha * (second.fov - first.fov))
