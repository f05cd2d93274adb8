"""What somebody plays who was struck: one motion, sampled, made as he is struck."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..body import Pose, Skeleton, contact_points, forward_kinematics
from ..jump.motion import between_kernel
from .settled import Settling

BEHIND = 0.019
"""The ground frame of one who stands is so far behind the middle of his heels and balls [m], at standard height."""
BEFORE = (1.2, 1.8, 1.9, 3.1, 4.5), (-0.01, -0.02, 0.09, 0.08, 0.2)
"""That of one who walks, or runs from the third speed on [m/s], is so far before his hips [m], at standard height."""


@dataclass(frozen=True, eq=False)
class Recovery:
    """A motion of N samples. times: (N,) [s]. roots: (N, 3), local: (N, J, 3, 3) poses. centres, velocities: (N, 3) of the mass centre [m, m/s]. contacts: (N, 4) bool of heels
    and balls. headings: (N,) [rad] where it faces. fate: of `capture`; caught: the steps that caught it. landings: (L, 2) which foot lands, and when [s]. rests: when [s] it
    stands, but for trunk and arms. why: what is to be said of it. floors: (N,) how high it stands [m].
    supported: whether the ground carries it in every moment, and it does not lie over an abyss. settling: what of it is still to be bent to the ground; None where nothing is.
    goes: from when on [s] it walks on, as it was meant to when it was made; infinite where it was not."""

    times: np.ndarray
    roots: np.ndarray
    local: np.ndarray
    centres: np.ndarray
    velocities: np.ndarray
    contacts: np.ndarray
    headings: np.ndarray
    fate: int
    caught: int
    landings: np.ndarray
    rests: float
    why: str
    floors: np.ndarray
    supported: bool = True
    settling: Settling | None = None
    goes: float = math.inf

    @property
    def duration(self) -> float:
        """Seconds until it stands at rest."""
        return float(self.times[-1])

    def stands(self, time: float) -> bool:
        """Whether it has come to rest on both feet, but for trunk and arms."""
        return time >= self.rests

    def landing(self, time: float, within: float) -> int:
        """The foot, 0 left or 1 right, that has landed no longer than `within` [s] before, or last before it walks on; −1 for none, or too early."""
        just = (self.landings[:, 1] <= time) & (time < self.landings[:, 1] + within if self.goes == math.inf else time >= self.goes)
        return int(self.landings[just, 0][-1]) if just.any() else -1

    def between(self, time: float) -> tuple[int, float]:
        """The sample before a time [s], and which share of the way to the next one it is on."""
        n = int(np.clip(np.searchsorted(self.times, time, "right") - 1, 0, len(self.times) - 2))
        return n, float(np.clip((time - self.times[n]) / (self.times[n + 1] - self.times[n]), 0.0, 1.0))

    def at(self, time: float) -> Pose:
        """The pose `time` [s] after the strike."""
        n, part = self.between(time)
        root, local = np.empty(3), np.empty_like(self.local[0])
        between_kernel(self.roots[n], self.roots[n + 1], self.local[n], self.local[n + 1], part, root, local)
        return Pose(root, local)

    def moving(self, time: float) -> tuple[np.ndarray, np.ndarray, float]:
        """Where (3,) [m] the mass centre is, how fast (3,) [m/s] it moves, and where it faces [rad]."""
        n, part = self.between(time)
        centre, velocity, heading = (rows[n] + part * (rows[n + 1] - rows[n]) for rows in (self.centres, self.velocities, self.headings))
        return centre, velocity, float(heading)


def ending(skeleton: Skeleton, size: float, made: Recovery, pose: Pose, time: float) -> tuple[float, np.ndarray]:
    """When [s] somebody who plays a recovery, in a pose now, walks on or stands, and where (2,) x, z [m] his ground frame would be now if he did already. size: of his body, over
    standard height."""
    heading = made.moving(time)[2]
    facing = np.array([math.sin(heading), math.cos(heading)])
    if made.goes < math.inf:
        velocity = made.moving(made.goes)[1][[0, 2]]
        return made.goes, pose.root[[0, 2]] + size * np.interp(velocity @ facing / math.sqrt(size), *BEFORE) * facing
    middle = contact_points(skeleton, *forward_kinematics(skeleton, made.roots[-1], made.local[-1]))[:, [0, 2]].mean(0)
    return min(made.rests, made.duration), middle - BEHIND * size * facing
