"""The course that the game opens on: something to jump onto, over and down from, off to the side of the start."""

from __future__ import annotations

from ..scene import Box, Goal, Prop

_LOW, _MIDDLE, _HIGH, _WALL = (0.40, 0.44, 0.47), (0.34, 0.41, 0.47), (0.30, 0.38, 0.47), (0.42, 0.36, 0.30)

COURSE: tuple[Prop, ...] = (
    Box((3.4, 0.15, 5.0), (2.0, 0.30, 2.0), tint=_LOW),
    Box((3.4, 0.30, 7.2), (2.0, 0.60, 2.0), tint=_MIDDLE),
    Box((3.4, 0.30, 11.4), (2.0, 0.60, 4.2), tint=_MIDDLE),  # a metre and more to jump over
    Box((5.9, 0.50, 12.4), (1.8, 1.00, 2.2), tint=_HIGH),
    Box((6.0, 1.20, 17.6), (6.0, 2.40, 0.30), tint=_WALL),
    Goal((5.9, 0.0, 15.4), 0.5),
)
"""Two steps up, a gap, a step across to one metre, and down to the goal in front of a wall."""
STAGES = {"course": COURSE}
"""Stages by the names that scenarios give them."""
