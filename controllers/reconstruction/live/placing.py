"""How a performer stands in the room: told from a second of standing still, so that points fit a standard body.

Trackers know neither where the floor is nor which way one faces nor how tall one is. Whoever stands in T-pose, or
with the arms down, says all of it at once.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from scipy.spatial.transform import Rotation

from ...body import STATURE, carried, exp, forward_kinematics, yaw
from ..control_points import ControlPoints
from ..pose_vector import SKELETON

STILL = 0.05
"""Nobody who stands still moves a point farther than this [m] …"""
SECONDS = 1.0
"""… for so long [s]."""
SIZES = 0.4, 1.6
"""A performer's size over the standard body's."""
LIKE = 0.17
"""Points are on the average no farther than this [m] from a standing body's, once they are placed: trackers worn anyhow, by bodies of all builds, come to
0.16; who sits with his hands in his lap, as before his screen, to 0.18 at least."""


@dataclass(frozen=True, eq=False)
class Placement:
    """Carries points of a tracker's room into the body's world: turned by heading [rad], scaled, moved by shift (3,) [m].

    mounts: (n, 3, 3) how the joints are turned in their trackers' frames, NaN of a tracker that told no turn while its wearer stood;
    None where turns are the joints' own.
    """

    heading: float = 0.0
    scale: float = 1.0
    shift: np.ndarray = field(default_factory=lambda: np.zeros(3))
    mounts: np.ndarray | None = None

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """The points (..., 3) placed."""
        return self.scale * points @ yaw(self.heading).T + self.shift

    def turned(self, turns: np.ndarray) -> np.ndarray:
        """How the joints are turned (n, 3, 3) below trackers with turns (n, 3, 3) of the room."""
        placed = yaw(self.heading) @ turns
        return placed if self.mounts is None else placed @ self.mounts


@dataclass(frozen=True, eq=False)
class Standing:
    """Watches for somebody who stands still. frames: tuple of (time [s], points (n, 3) [m], turns (n, 3, 3)) of the last second."""

    frames: tuple[tuple[float, np.ndarray, np.ndarray], ...] = ()

    def watch(self, time: float, points: np.ndarray, turns: np.ndarray | None = None) -> Standing:
        """With one frame more, turns NaN where not known. A point that is lost or moves begins the second anew."""
        if not np.isfinite(points).all():
            return Standing()
        kept = [frame for frame in self.frames if frame[0] >= time - SECONDS - 1e-6]
        if kept and np.linalg.norm(points - np.mean([p for _, p, _ in kept], 0), axis=-1).max() > STILL:
            kept = []
        return Standing((*kept, (time, points, np.full((len(points), 3, 3), np.nan) if turns is None else turns)))

    @property
    def place(self) -> np.ndarray | None:
        """Where the points are (n, 3) [m] on the average of a second; None until somebody stood still so long."""
        if not self.frames or self.frames[-1][0] - self.frames[0][0] < 0.9 * SECONDS:
            return None
        return np.mean([points for _, points, _ in self.frames], 0)

    @property
    def turn(self) -> np.ndarray | None:
        """How the trackers are turned (n, 3, 3) on the average of a second, NaN of one that told none; None before `place` is known.

        The identity, to the bit, is what programs send for a tracker that knows no turn.
        """
        if (place := self.place) is None:
            return None
        turns = np.full((len(place), 3, 3), np.nan)
        for n in range(len(place)):
            known = [one for one in (frame[2][n] for frame in self.frames) if np.isfinite(one).all() and not np.array_equal(one, np.eye(3))]
            if known:
                turns[n] = Rotation.from_matrix(known).mean().as_matrix()
        return turns


def stances() -> tuple[np.ndarray, np.ndarray]:
    """A standard body that stands at the origin facing +Z, in T-pose and with the arms down: joints (2, J, 3) [m], and how they are
    turned (2, J, 3, 3)."""
    turns = np.tile(np.eye(3), (2, len(SKELETON), 1, 1))
    for side, down in (("Left", -1.3), ("Right", 1.3)):
        turns[1, SKELETON.index(side + "Arm")] = exp(np.array([0.0, 0.0, down]))
    return forward_kinematics(SKELETON, np.tile(SKELETON.offsets[0], (2, 1)), turns)


def placed(seen: np.ndarray, controls: ControlPoints, height: float | None = None, turns: np.ndarray | None = None) -> Placement:
    """What carries a standing performer's points (n, 3) [m] onto a standard body that stands at the origin.

    height: the performer's [m]; by default it is told from the points, and needs two of them apart. turns: (n, 3, 3) of the trackers,
    NaN where not known: however they sit on the joints, joints are turned like the standing body's now.
    ValueError if they are no standing body's.
    """
    stood = stances()
    points, orientations = controls.on(*stood), stood[1][:, controls.joints]
    found = [_align(seen, stance, None if height is None else STATURE / height) for stance in points]
    nearest = min(range(len(found)), key=lambda one: found[one][0])
    away, placement = found[nearest]
    size = STATURE / placement.scale
    if not SIZES[0] <= size / STATURE <= SIZES[1] or away > LIKE:
        if min(_align(seen[:, [0, 2, 1]] * [1.0, 1.0, -1.0], stance, None)[0] for stance in points) < LIKE < away:
            raise ValueError("these points are a standing body's if Z points up, or a lying one's: trackers must be sent with Y up, as the protocols have it")
        tall = f" of one {size:.2f} m tall," if away < 2.0 * LIKE and size < 10.0 else ""  # what is like no body at all is not so tall
        raise ValueError(f"these points are no standing body's: at best{tall} {100 * away:.0f} cm away; "
                         "stand upright, in T-pose or with the arms down; is each tracker on the point that it is said to be?")
    if turns is None:
        return placement
    return replace(placement, mounts=np.swapaxes(placement.turned(turns), -1, -2) @ orientations[nearest])


def _align(seen, target, scale):
    """The least mean distance, and the placement that has it: Procrustes about the vertical, in closed form."""
    middle, goal = seen.mean(0), target.mean(0)
    a, b = seen - middle, target - goal
    along, across = carried(a, b)
    heading = float(np.arctan2(across, along))
    if scale is None:
        scale = max(float((np.hypot(along, across) + np.sum(a[:, 1] * b[:, 1])) / max(np.sum(a * a), 1e-12)), 1e-3)
    placement = Placement(heading, scale, goal - scale * yaw(heading) @ middle)
    return float(np.linalg.norm(placement(seen) - target, axis=-1).mean()), placement
