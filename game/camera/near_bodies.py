"""Bodies between a camera and whom it follows: one sees through them, the more so the more they are in the way.

What is in the way lies within a cone that narrows from the eye to whom the camera looks at. How much of a body is left is
a function of where it and the camera are, and of nothing before, so that pictures need no memory and logs play alike.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from ..scene import Camera, Figure

WIDE, NARROW, FULL = 0.9, 0.15, 1.0
"""The cone's radius at the eye and at its end [m]; it is so wide from this length on [m], less if it is shorter."""
SHORT = 0.9
"""It ends so far before what is looked at [m]: whoever is beside that hides little of it."""
SOFT = 0.35
"""Bodies fade over so many metres around the cone …"""
LEAST = 0.12
"""… to so much of them."""


def seen_past(figures: Sequence[Figure], camera: Camera, followed: Collection[int]) -> tuple[Figure, ...]:
    """The figures with their `cover` as a camera has it that looks at those numbered in `followed`, who never fade."""
    others = [number for number, figure in enumerate(figures) if number not in followed and figure.opacity > 0.0]
    if not others:
        return tuple(figures)
    away = outside_view(np.stack([figures[number].positions for number in others]).astype(float), camera)
    share = np.clip(away.min(-1) / SOFT, 0.0, 1.0)
    covers = LEAST + (1.0 - LEAST) * share * share * (3.0 - 2.0 * share)
    drawn = list(figures)
    for number, cover in zip(others, covers.tolist()):
        if cover < 1.0:
            drawn[number] = replace(figures[number], cover=cover)
    return tuple(drawn)


def outside_view(points: np.ndarray, camera: Camera) -> np.ndarray:
    """How far [m] points (..., 3) are outside of the cone in which a camera looks at its target; less than 0 within."""
    eye = np.asarray(camera.eye, float)
    way = np.asarray(camera.target, float) - eye
    far = float(np.linalg.norm(way))
    way, end = way / max(far, 1e-9), max(far - SHORT, 0.0)
    at = np.clip((points - eye) @ way, 0.0, end)
    wider = (WIDE - NARROW) * min(end / FULL, 1.0)
    radius = NARROW + wider * (1.0 - at / max(end, 1e-9))
    return np.linalg.norm(points - eye - at[..., None] * way, axis=-1) - radius
