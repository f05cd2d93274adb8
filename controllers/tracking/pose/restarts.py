"""Arms that were lost, held otherwise: contours pull no farther than they reach, and nothing keeps a model's arm out of its own trunk.

So an arm can stay for seconds where silhouettes hide it: in the trunk, or folded into its own upper arm while the other one reaches across
for what it left. Contours that stay worse than usual tell; then arms are tried as people hold them, one way a frame.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..twists import Chain, Configuration

HANGING = {"Arm.x": -0.3, "Arm.z": -1.35, "ForeArm.y": -0.2}
BENT = {"Arm.x": 0.6, "Arm.y": -0.3, "Arm.z": -1.5, "ForeArm.y": -1.7}
FOLDED = {"Arm.x": 0.5, "Arm.y": -1.6, "Arm.z": -0.5, "ForeArm.y": -1.4}
"""How people hold a left arm [rad], T-pose is 0: hanging, as runners do, and before the chest. A right one mirrors it."""
BOTH, LEFT, RIGHT = ("Left", "Right"), ("Left",), ("Right",)
WAYS = ((BOTH, HANGING), (BOTH, FOLDED), (LEFT, HANGING), (RIGHT, HANGING), (BOTH, BENT), (LEFT, BENT), (RIGHT, BENT))
"""Which arms are held how, in the order in which it is tried."""
SMOOTHED = 0.2
"""Half-life of what is remembered of contours' distance [s]: rectangles come and go."""
WORSE = 1.2
"""Contours so many times as far off as they are at their best are doubted."""
FORGETS = 0.01
"""By so much a second is the best forgotten, as people and pictures change."""
RESTS = 0.5
"""So long after all ways were tried are none tried [s]."""


@dataclass(frozen=True)
class Doubt:
    """What is remembered of how far off contours are. now, least: on average lately, and at its best [pixels]. turn: which of WAYS is tried
    next; below 0 for so many frames none is."""

    now: float = np.inf
    least: float = np.inf
    turn: int = 0

    def after(self, residual: float, rate: float) -> Doubt:
        """After one more frame, `rate` of them a second."""
        now = residual if self.now == np.inf else residual + (self.now - residual) * 0.5 ** (1.0 / (SMOOTHED * rate))
        least = min(self.least * (1.0 + FORGETS / rate), now)
        if self.turn >= len(WAYS):
            return Doubt(now, least, -round(RESTS * rate))
        return Doubt(now, least, self.turn + 1 if self.turn < 0 or now > WORSE * least else 0)

    @property
    def way(self) -> int | None:
        """Which of WAYS is to be tried in this frame; None for none."""
        return self.turn - 1 if self.turn > 0 else None

    def mended(self, residual: float) -> Doubt:
        """After one way was better; if contours are still far off, the next is tried."""
        return Doubt(min(self.now, residual), self.least, self.turn)


def held(chain: Chain, where: Configuration, way: int) -> Configuration:
    """A pose with arms held in one of WAYS, and the trunk upright, which went along with them."""
    sides, how = WAYS[way]
    stems = ("Spine1", *(f"{side}{part}" for side in sides for part in ("Arm", "ForeArm", "Hand")))
    angles = np.where([name.startswith(stems) for name in chain.names], 0.0, where.angles)
    for side in sides:
        for name, angle in how.items():
            if f"{side}{name}" in chain.names:  # about x, both sides turn alike
                angles[chain.names.index(f"{side}{name}")] = angle if side == "Left" or name.endswith("x") else -angle
    return Configuration(where.root, np.clip(angles, chain.lower, chain.upper))
