"""Walkers who keep out of each other's way: optimal reciprocal collision avoidance, with people's legs, eyes and manners."""

from .avoidance import Manners, avoid, lag
from .doors import Door, Turns, doors_of, queued, taking_turns
from .groups import together
from .linear_program import half_plane, nearest, nearest_to_all
from .walking import aims, crowd_intent, crowd_turns, stepping, towards

__all__ = ["Door", "Manners", "Turns", "aims", "avoid", "crowd_intent", "crowd_turns", "doors_of", "half_plane", "lag", "nearest", "nearest_to_all", "queued", "stepping", "taking_turns",
           "together", "towards"]
