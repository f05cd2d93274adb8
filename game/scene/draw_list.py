"""Ink: flat triangles over the picture, as panels are made of, as plain arrays."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

PANELS = {"space": "control space", "plots": "velocities", "quality": "quality", "settings": "settings"}
"""What is drawn in it, and what the title bars say. "NAME_panel" is the action that opens and closes one."""
VERTEX = np.dtype([("place", "f4", 2), ("uv", "f4", 2), ("tint", "u1", 4)])
"""Place [px] from the picture's top-left corner, place in its sheet 0 … 1, display RGB and opacity."""


class Stroke(NamedTuple):
    """Triangles drawn at once. clip: left, top, right, bottom [px]. sheet: the image that they are cut
    from. first, count: which of the indices."""

    clip: tuple[float, float, float, float]
    sheet: int
    first: int
    count: int


@dataclass(frozen=True, eq=False)
class Ink:
    """What to draw over a picture, from back to front.

    size: width, height [px] that places and clips count in; another picture shows it stretched.
    vertices: (V,) VERTEX. indices: (I,) uint32, three for each triangle. strokes: which of them where.
    sheets: images (H, W, 4) uint8 by number. An image that changes is a new array, never the old one
    rewritten.
    """

    size: tuple[int, int]
    vertices: np.ndarray
    indices: np.ndarray
    strokes: tuple[Stroke, ...]
    sheets: Mapping[int, np.ndarray] = field(default_factory=dict)

    def corner(self) -> tuple[float, float]:
        """How far it reaches from the right and from the top of its picture [px]: the width and height of a panel in that corner."""
        if not len(self.vertices):
            return 0.0, 0.0
        places = self.vertices["place"]
        return float(self.size[0] - places[:, 0].min()), float(places[:, 1].max())
