"""Walkers who keep out of each other's way: optimal reciprocal collision avoidance, with people's legs, eyes and manners."""

from .avoidance import Manners, avoid, lag
from .doors import Door, doors_of, queued
from .groups import together
from .linear_program import half_plane, nearest, nearest_to_all
from .walking import aims, crowd_intent, stepping, towards

__all__ = ["Door", "Manners", "aims", "avoid", "crowd_intent", "doors_of", "half_plane", "lag", "nearest", "nearest_to_all", "queued", "stepping", "together", "towards"]
