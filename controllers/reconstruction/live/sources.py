"""Where points come from: a recorded performance here, a live one in `stream`, a camera's tracker one day.

All that a reconstruction needs of a source is where the points are at a time.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

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
    """A recorded performance. points: (T, n, 3) [m], NaN where one is not seen, `frame_time` [s] apart from time 0 on."""

    controls: ControlPoints
    points: np.ndarray
    frame_time: float

    @staticmethod
    def of(clip: Clip, controls: ControlPoints) -> Recorded:
        """The points of a clip; it must have the skeleton that the controls were parsed for."""
        return Recorded(controls, controls.extract(clip), clip.frame_time)

    @property
    def duration(self) -> float:
        """Seconds from the first frame to the last."""
        return (len(self.points) - 1) * self.frame_time

    def noisy(self, deviation: float, rng: np.random.Generator) -> Recorded:
        """The same seen by a poor tracker: normal errors of a standard deviation [m] in each frame and axis."""
        return replace(self, points=self.points + rng.normal(0.0, deviation, self.points.shape))

    def at(self, time: float) -> np.ndarray:
        """See `Source`: on a line between two frames; nothing is seen before the first and after the last."""
        place = time / self.frame_time
        if not -1e-6 <= place <= len(self.points) - 1 + 1e-6:
            return np.full(self.points.shape[1:], np.nan)
        place = min(max(place, 0.0), len(self.points) - 1.0)
        first = min(int(place + 1e-6), len(self.points) - 1)
        share = max(place - first, 0.0)
        if share < 1e-6:  # a neighbour that is not seen hides nothing
            return self.points[first].copy()
        return (1.0 - share) * self.points[first] + share * self.points[first + 1]
