"""Cameras: the follow camera and the others that a player holds, dollies of films, and what stands in their line of sight."""

from .arm import CameraSettings
from .dolly import dolly, fixed, on_rail
from .follow_camera import Follow
from .line_of_sight import blocked
from .near_bodies import seen_past
from .orbit_camera import Orbit
from .player_camera import PlayerCamera, between, cycled

__all__ = [
    "CameraSettings", "Follow", "Orbit", "PlayerCamera", "between", "blocked", "cycled", "dolly", "fixed", "on_rail",
    "seen_past",
]
