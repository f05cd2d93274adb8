"""Where points come from: a recorded performance here, a live one in `osc_stream`, a camera's tracker one day.

All that a reconstruction needs of a source is where the points are at a time.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from scipy.spatial.transform import Rotation

from ...body import Clip
from ..control_points import ControlPoints


class Source(Protocol):
    """Gives the points of `controls`, in their order."""

    controls: ControlPoints

    def at(self, time: float) -> np.ndarray:
        """Where the points are (n, 3) [m] in the world at a time [s], NaN where one is not seen. Times only grow."""
        ...


@dataclass(frozen=True, eq=False)
class Recorded:
    """A recorded performance. points: (T, n, 3) [m], NaN where one is not seen, `frame_time` [s] apart from time 0 on. turns:
    (T, n, 3, 3) of their joints, if they are told, too."""

    controls: ControlPoints
    points: np.ndarray
    frame_time: float
    turns: np.ndarray | None = None

    @staticmethod
    def of(clip: Clip, controls: ControlPoints, turning: bool = False) -> Recorded:
        """The points of a clip, turning or not; it must have the skeleton that the controls were parsed for."""
        positions, orientations = clip.kinematics()
        return Recorded(controls, controls.on(positions, orientations), clip.frame_time,
                        orientations[:, controls.joints].astype(float) if turning else None)

    @property
    def duration(self) -> float:
        """Seconds from the first frame to the last."""
        return (len(self.points) - 1) * self.frame_time

    def noisy(self, deviation: float, rng: np.random.Generator) -> Recorded:
        """The same seen by a poor tracker: normal errors of a standard deviation [m] in each frame and axis."""
        return replace(self, points=self.points + rng.normal(0.0, deviation, self.points.shape))

    def at(self, time: float) -> np.ndarray:
        """See `Source`: on a line between two frames; nothing is seen before the first and after the last."""
        found = self._between(time)
        if found is None:
            return np.full(self.points.shape[1:], np.nan)
        first, share = found
        if share < 1e-6:  # a neighbour that is not seen hides nothing
            return self.points[first].copy()
        return (1.0 - share) * self.points[first] + share * self.points[first + 1]

    def turned_at(self, time: float) -> np.ndarray | None:
        """How the joints are turned (n, 3, 3) then, on the shortest way between two frames; None where it is not told."""
        if self.turns is None:
            return None
        found = self._between(time)
        if found is None:
            return np.full(self.turns.shape[1:], np.nan)
        first, share = found
        start = self.turns[first]
        if share < 1e-6:
            return start.copy()
        way = Rotation.from_matrix(np.swapaxes(start, -1, -2) @ self.turns[first + 1]).as_rotvec()
        return start @ Rotation.from_rotvec(share * way).as_matrix()

    def _between(self, time: float) -> tuple[int, float] | None:
        """The last frame that is not later, and the share of the way to the next; None before the first and after the last."""
        place = time / self.frame_time
        if not -1e-6 <= place <= len(self.points) - 1 + 1e-6:
            return None
        place = min(max(place, 0.0), len(self.points) - 1.0)
        first = min(int(place + 1e-6), len(self.points) - 1)
        return first, max(place - first, 0.0)
