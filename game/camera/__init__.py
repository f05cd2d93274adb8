"""Cameras: the follow camera and the others that a player holds, dollies of films, and what stands in their line of sight."""

from .arm import CameraSettings
from .dolly import dolly, fixed, on_rail
from .held import Follow, Orbit, PlayerCamera, between, cycled
from .line_of_sight import blocked

__all__ = [
    "CameraSettings", "Follow", "Orbit", "PlayerCamera", "between", "blocked", "cycled", "dolly", "fixed", "on_rail",
]
