"""A ghost: one primitive of the library played beside the character, to see what it is."""

from __future__ import annotations

import numpy as np

from gambol.controllers.locomotion import Library

from ..scene import Figure
from ..world import posed

BESIDE = 0.85
"""How far to the right of its character it plays [m]."""
TINT = (0.30, 0.52, 0.60)


def ghost(library: Library, number: int, phase: float, ground: np.ndarray) -> Figure:
    """The figure of primitive `number` at a phase 0 … 1, beside whoever stands at ground (3,) x, z [m], heading."""
    return Figure(*posed(library, number, phase, ground, BESIDE), TINT)
