"""What a body can't jump, told before it winds up, and the nearest place that it can."""

from __future__ import annotations

import numpy as np

from ..contract import Unable
from ..navigation import gap
from .ballistics import along
from .dynamics import Physique
from .path import Path, measures
from .windup import strongest

RUNNER = 4.2
"""What the leg of a runner gives, stretched as the foot strikes, in an adult's weights on Earth, at strength 1."""
STOPS = 6.0, 0.5
"""What legs give as they stop a fall, in an adult's weights on Earth at strength 1, and over which way [m], at
standard height."""
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
    if not all(np.isfinite(part).all() for part in (way.low, way.leave, way.land, way.velocity)):
        return "there is no such arc"
    if not way.strong:
        most = strongest(physique, way.leave[1] - floor - measures(physique).stand, way.gravity)
        return (f"it would have to take off with {np.linalg.norm(way.velocity):.1f} m/s, "
                f"{way.velocity[1]:.1f} of them upward; this body reaches {most:.1f} m/s straight up")
    force = np.linalg.norm(way.push.force(np.linspace(0.0, way.push.duration, 24)), axis=-1).max()
    if way.passing.any() and force > RUNNER * 9.81 * physique.strength:
        return (f"the push needs {force / 9.81:.1f} times this body's weight on Earth; "
                f"its leg has {RUNNER * physique.strength:.1f}")
    if np.linalg.norm((way.land - way.leave)[[0, 2]]) > 1e-6 and way.airtime <= 0.0:
        return "the arc takes no time"
    size, down = physique.height / 1.741, -float(way.falling[1])
    spare = STOPS[0] * 9.81 * physique.strength + float(way.gravity[1])
    stops = np.sqrt(2.0 * STOPS[1] * size * max(spare, 0.0))
    if down > stops:
        return f"it would land with {down:.1f} m/s downward; its legs stop {stops:.1f} m/s"
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
