"""Walkers who keep out of each other's way: optimal reciprocal collision avoidance, with people's legs, eyes and manners."""

from .avoidance import Manners, avoid, lag
from .linear_program import half_plane, nearest, nearest_to_all
from .walking import aims, crowd_intent, stepping, towards

__all__ = ["Manners", "aims", "avoid", "crowd_intent", "half_plane", "lag", "nearest", "nearest_to_all", "stepping", "towards"]
