"""What a body can't jump, told before it winds up, and the nearest place that it can."""

from __future__ import annotations

import numpy as np

from ..contract import Unable
from ..navigation import gap
from .ballistics import along
from .dynamics import Physique
from .path import Path, measures

CLEAR = 0.05
"""How near to something a flying body may come [m]."""


class Refused(Unable):
    """A jump that this body can't make. nearest: a place (3,) [m] that it can reach, if one was found."""

    def __init__(self, reason: str, nearest: np.ndarray | None = None):
        super().__init__(reason if nearest is None else
                         f"{reason}; it can reach ({nearest[0]:.2f}, {nearest[1]:.2f}, {nearest[2]:.2f})")
        self.nearest = nearest


def fault(physique: Physique, way: Path, around, floor: float) -> str:
    """Why a path can't be gone, or nothing. around: boxes and pillars; floor: of the take-off [m]."""
    size = physique.height / 1.741
    if not all(np.isfinite(part).all() for part in (way.low, way.leave, way.land, way.velocity)):
        return "there is no such arc"
    crouch = floor + measures(physique).stand - way.low[1]
    deepest = 0.46 * size * physique.flexibility
    if crouch > deepest + 1e-6:
        return (f"taking off with {np.linalg.norm(way.velocity):.1f} m/s needs a crouch of {crouch:.2f} m, "
                f"deeper than the {deepest:.2f} m of this body")
    force = np.linalg.norm(way.push.force(np.linspace(0.0, way.push.duration, 24)), axis=-1).max()
    strongest = 9.81 * physique.strength * (4.2 if way.passing.any() else 3.1)
    if force > strongest:
        return f"the push needs {force / 9.81:.1f} times this body's weight on Earth; it has {strongest / 9.81:.1f}"
    if np.linalg.norm((way.land - way.leave)[[0, 2]]) > 1e-6 and way.airtime <= 0.0:
        return "the arc takes no time"
    return blocked(physique, way, around)


def blocked(physique: Physique, way: Path, around) -> str:
    """What the flying body would hit: "" or "its head hits a box at (x, y, z)" and the like."""
    if not len(around):
        return ""
    size = physique.height / 1.741
    time = np.linspace(0.0, way.airtime, 25)
    centre = along(way.leave, way.velocity, time, way.gravity)
    # legs are tucked in the middle of the flight
    tucked = np.interp(time / way.airtime, (0.0, 0.3, 0.75, 1.0), (1.0, 0.72, 0.72, 0.96))
    points, names = [], []
    for name, above, radius in (("head", 0.62, 0.12), ("trunk", 0.28, 0.16), ("hips", -0.05, 0.16),
                                ("legs", None, 0.08)):
        offset = above * size if above is not None else -(measures(physique).stand - 0.12 * size) * tucked
        points.append(centre + np.multiply.outer(offset * np.ones(len(time)), [0.0, 1.0, 0.0]))
        names.append((name, radius * size))
    for place, (name, radius) in zip(points, names):
        # the soles may touch what they leave and where they land
        inner = slice(4, -4) if name == "legs" else slice(1, None)
        for thing in around:
            near = gap(place[inner], thing)
            if near.min() < radius - CLEAR:
                x, y, z = place[inner][int(near.argmin())]
                return f"its {name} would hit something at ({x:.1f}, {y:.1f}, {z:.1f}) m"
    return ""
