"""Getting somewhere: from a wish in the world to an intent, along a path, and where it would lead."""

from .path import Path, follow
from .steering import Reach, Steering, drift, in_world, steer, turn_towards

__all__ = ["Path", "Reach", "Steering", "drift", "follow", "in_world", "steer", "turn_towards"]
