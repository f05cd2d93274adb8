"""What can be told from poses alone, ours and recorded ones alike: mass centre, friction, joints, feet.

Nothing here knows a label, a phase or a lock. Accelerations are second differences over whole frames 1/30 s
apart, which is how the slowest recordings were made.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.ndimage import maximum_filter1d

from gambol.controllers.body import (Skeleton, anatomy, centre_of_mass, contact_height, contact_points, detect_contacts,
                                     end_positions, feet_apart, foot_drift, forward_kinematics)

GRAVITY = 9.81
LIGHT = 0.5
"""The least load at which friction is told, in body weights."""
RUNS = 1.9
"""A body whose mass centre is faster than this [m/s] is judged as a runner."""
SHORTEST = 4
"""Stances shorter than this many frames of 1/60 s are a point grazing its limits."""
GRAZES = 0.008
"""A toe's end within this of the floor in mid-swing [m] scuffs it."""


@dataclass(frozen=True, eq=False)
class Motion:
    """T frames of N bodies: roots (T, N, 3) [m], rotations (T, N, J, 3, 3), `rate` whole frames a second.

    natural: by family, the 99th percentile (J,) [m/s²] of the recordings' joint accelerations.
    """

    skeleton: Skeleton
    rate: int
    roots: np.ndarray
    rotations: np.ndarray
    natural: dict[str, np.ndarray]

    @property
    def stride(self) -> int:
        """Frames in 1/30 s."""
        return max(1, round(self.rate / 30))

    @cached_property
    def kinematics(self) -> tuple[np.ndarray, np.ndarray]:
        """Positions (T, N, J, 3) [m] and orientations (T, N, J, 3, 3)."""
        return forward_kinematics(self.skeleton, np.asarray(self.roots, float), np.asarray(self.rotations, float))

    @cached_property
    def com(self) -> np.ndarray:
        """The mass centre (T, N, 3) [m]."""
        return centre_of_mass(anatomy(self.skeleton), *self.kinematics)

    @cached_property
    def com_velocity(self) -> np.ndarray:
        """(T, N, 3) [m/s], over 1/15 s."""
        return self._rate(self.com)

    @cached_property
    def com_acceleration(self) -> np.ndarray:
        """(T, N, 3) [m/s²]."""
        return self._second(self.com)

    @cached_property
    def lean(self) -> np.ndarray:
        """How far trunks, from hips to neck, lean ahead of upright as the hips face (T, N) [°]."""
        positions, orientations = self.kinematics
        trunk, ahead = positions[..., self.skeleton.index("Neck"), :] - positions[..., 0, :], orientations[..., 0, :, 2]
        along = (trunk[..., [0, 2]] * ahead[..., [0, 2]]).sum(-1) / np.linalg.norm(ahead[..., [0, 2]], axis=-1)
        return np.degrees(np.arctan2(along, trunk[..., 1]))

    @cached_property
    def running(self) -> np.ndarray:
        """Who runs when (T, N): faster than RUNS, or at more than half of it with a flight a third of a second away."""
        speed = np.linalg.norm(self.com_velocity[..., [0, 2]], axis=-1)
        flight = (self.com_acceleration[..., 1] < -0.7 * GRAVITY) & (speed > 0.5 * RUNS)
        near = maximum_filter1d(flight.astype(np.int8), 2 * (self.rate // 3) + 1, axis=0) > 0
        return (speed > RUNS) | near

    @cached_property
    def friction(self) -> np.ndarray:
        """What the ground must give sideways over what it gives upward (T, N).

        A load below LIGHT weights counts as that much: a body's flight in recordings is no exact parabola, and what
        the model of its masses is off by would read as slipping.
        """
        across = np.linalg.norm(self.com_acceleration[..., [0, 2]], axis=-1)
        return across / np.maximum(GRAVITY + self.com_acceleration[..., 1], LIGHT * GRAVITY)

    @cached_property
    def joints(self) -> np.ndarray:
        """Every joint's acceleration over what recordings of its gait have (T, N, J)."""
        found = np.linalg.norm(self._second(self.kinematics[0]), axis=-1)
        walk, run = self.natural["walk"], self.natural.get("run", self.natural["walk"])
        return found / np.where(self.running[..., None], run, walk)

    @cached_property
    def points(self) -> np.ndarray:
        """Left heel, left ball, right heel, right ball (T, N, 4, 3) [m]."""
        return contact_points(self.skeleton, *self.kinematics)

    @cached_property
    def toe_ends(self) -> np.ndarray:
        """The ends of both feet's toes (T, N, 2, 3) [m]."""
        ends = end_positions(self.skeleton, *self.kinematics)
        return ends[..., [self.skeleton.end_index["LeftToe"], self.skeleton.end_index["RightToe"]], :]

    @cached_property
    def standing(self) -> np.ndarray:
        """Which points stand (T, N, 4): near the floor and slow, from each frame to the next."""
        step = np.diff(self.points, axis=0, append=self.points[-1:]) * self.rate
        heights, speeds = self.points[..., 1], np.linalg.norm(step, axis=-1)
        gate = contact_height(self.skeleton) + 0.01
        walk, run = (detect_contacts(heights, speeds, height_gate=gate, release=1.0, running=r) for r in (False, True))
        return np.where(self.running[..., None], run, walk)

    @cached_property
    def apart(self) -> np.ndarray:
        """How far apart the feet's centre lines are (T, N) [m]."""
        return feet_apart(self.skeleton, *self.kinematics)

    def drift(self) -> np.ndarray:
        """How far every stance of a walking body's point moved [m]."""
        found = []
        for n in range(self.points.shape[1]):
            stances = foot_drift(self.points[:, n], self.standing[:, n] & ~self.running[:, n, None])
            found.append(stances.drift[stances.stop - stances.start >= max(2, SHORTEST * self.rate // 60)])
        return np.concatenate(found)

    def in_the_air(self) -> float:
        """For how long nobody has a foot on the floor at most [s]."""
        longest = 0
        for off in ~self.standing.any(-1).T:
            edges = np.flatnonzero(np.diff(np.concatenate([[0], off.astype(np.int8), [0]])))
            longest = max(longest, int(np.max(edges[1::2] - edges[::2], initial=0)))
        return longest / self.rate

    def scuffs(self) -> np.ndarray:
        """For every swing of a foot above 1 m/s, whether its toe's end comes to the floor in its middle third."""
        found = []
        floor = contact_height(self.skeleton)
        fast = np.linalg.norm(self.com_velocity[..., [0, 2]], axis=-1) > 1.0
        feet = self.standing[..., 0::2] | self.standing[..., 1::2]
        for n in range(feet.shape[1]):
            for foot in range(2):
                edges = np.diff(feet[:, n, foot].astype(np.int8))
                leaves, strikes = np.flatnonzero(edges < 0) + 1, np.flatnonzero(edges > 0) + 1
                for a in leaves:
                    b = strikes[strikes > a]
                    if len(b) and 0.2 * self.rate < b[0] - a < self.rate and fast[a:b[0], n].all():
                        third = (b[0] - a) // 3
                        found.append(self.toe_ends[a + third:b[0] - third, n, foot, 1].min() < floor + GRAZES)
        return np.array(found, bool)

    def _rate(self, x: np.ndarray) -> np.ndarray:
        s = self.stride
        inner = (x[2 * s:] - x[:-2 * s]) * (self.rate / (2 * s))
        return np.pad(inner, ((s, s), *((0, 0),) * (x.ndim - 1)), "edge")

    def _second(self, x: np.ndarray) -> np.ndarray:
        s = self.stride
        inner = (x[2 * s:] - 2 * x[s:-s] + x[:-2 * s]) * (self.rate / s) ** 2
        return np.pad(inner, ((s, s), *((0, 0),) * (x.ndim - 1)), "edge")
