"""Where the ring of a standing body may lie: both feet find floor of one height there, or it lies a little beside where hands left it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from gambol.controllers.navigation import floor_at, slope_at

from .straight_ahead import UP

ROUND = np.stack([np.sin(np.arange(8) * math.pi / 4.0), np.cos(np.arange(8) * math.pi / 4.0)], axis=-1)
"""Ways (8, 2) all round."""
SOLES = 0.19
"""Both soles side by side lie within so much of their middle [m]."""
ASIDE, FINE = 0.3, 0.05
"""The ring is moved by no more than this, and is looked for so finely [m]."""
LEVEL = 0.03
"""Floor of one height is no more uneven than this [m]."""


def on_top(place: tuple[float, float], floor: float, around: Sequence[Any]) -> tuple[float, float]:
    """The nearest place x, z [m] to another at which both feet find floor of one height, that lies no higher over a body's own [m] than can be leapt to; the same place
    where there is none near, and on a slope."""
    if not len(around) or slope_at(*place, around, floor + UP).any() or _even(place, floor, around):
        return place
    places = (np.asarray(place) + np.arange(FINE, ASIDE + 0.5 * FINE, FINE)[:, None, None] * ROUND).reshape(-1, 2)  # the nearest first
    return next(((float(x), float(z)) for x, z in places if _even((x, z), floor, around)), place)


def _even(place: tuple[float, float], floor: float, around: Sequence[Any]) -> bool:
    """Whether the floor is of one height all round a place (2,)."""
    here = floor_at(*place, around, floor + UP)
    return all(abs(floor_at(x, z, around, floor + UP) - here) < LEVEL for x, z in np.asarray(place) + SOLES * ROUND)
