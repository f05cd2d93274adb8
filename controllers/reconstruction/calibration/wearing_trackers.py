"""Trackers while they are worn: what they say becomes joints of a standing body's world; after five seconds of moving, how they are worn is told anew."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

import numpy as np

from ...body import Skeleton, forward_kinematics, yaw
from ..control_points import ControlPoints
from ..live import Placement
from ..pose_vector import SKELETON
from .calibration_network import CalibrationNetwork
from .moved import BEFORE
from .set_poses import fitted
from .simulated import FRAMES, STRIDE
from .stood import JOINTS, WORN, Stood
from .worn import Calibration, calibrated

MOVING = STRIDE * (FRAMES + 1)
"""So many frames of 1/60 s are heard, five seconds."""
_HEAD = WORN.index("Head")
EASE = 60
"""In so many frames what is told anew takes the place of what was known."""
LEVELLED = 0.3
"""A room's floor that is farther than this [m] from its height 0 was never levelled."""
UPRIGHT = 0.95
"""Who moves about holds his head no lower than he stands in one moment of twenty."""
LIKE = 0.94, 1.06
"""So much over or below a calibration's height is nobody else's: standing tells it to 2 %, shoes and carriage add some."""


def calibratable(controls: ControlPoints, turns: np.ndarray) -> bool:
    """Whether all of two or more trackers that tell their turns (n, 3, 3) are worn where calibration knows."""
    return (len(controls) >= 2 and bool(np.isfinite(turns).all()) and set(controls.joints) <= set(JOINTS)
            and len(set(controls.joints)) == len(controls))


def stance(controls: ControlPoints, places: np.ndarray, turns: np.ndarray) -> int:
    """Which of `stood.STANCES`, and of the first of `POSES`, somebody stands in with trackers at places (n, 3) [m] with turns (n, 3, 3) of the room."""
    wide = _wide(slots(controls), 0.0, places, turns)
    return int(Stood.of(wide[0][None], wide[1][None], np.isin(JOINTS, controls.joints)[None]).which[0])


class Wearer:
    """Whoever wears trackers on `controls`. known: how they are worn. ground: (3,) how the world lies to the room: x, z, lengths as of a standard body, and
    heading [rad]. level: [m] the room's floor. network: to hear them move with; none, where that is over. kept: whether it was told another day.
    seems: how tall [m] whoever wears the trackers seems to be, where what was kept is of somebody of another size; None while nothing speaks for that."""

    def __init__(self, controls: ControlPoints, known: Calibration, ground: np.ndarray, level: float = 0.0, network: CalibrationNetwork | None = None,
                 kept: bool = False):
        self.controls, self.known, self.ground, self.level, self._network = controls, known, np.asarray(ground, float), level, network
        self._slots = slots(controls)
        self._heard: list[tuple[np.ndarray, np.ndarray]] = []
        self._before: Calibration | None = None
        self._eased = 0
        self.seems: float | None = None
        self._measured = kept and JOINTS[_HEAD] in controls.joints
        self._heads: deque[float] = deque(maxlen=4 * MOVING)
        self._counted = 0

    @staticmethod
    def standing(controls: ControlPoints, placement: Placement, places: np.ndarray, turns: np.ndarray, network: CalibrationNetwork) -> Wearer:
        """Who stood with trackers at places (n, 3) [m] and turns (n, 3, 3) of the room, which `placement` carries to the origin; see `calibratable`."""
        level = _level(placement)
        there = np.isin(JOINTS, controls.joints)
        wide = _wide(slots(controls), level, places, turns)
        known = calibrated(network, Stood.of(wide[0][None], wide[1][None], there[None]))
        return Wearer(controls, known, np.array([placement.shift[0], placement.shift[2], placement.heading]), level, network)

    @staticmethod
    def posed(controls: ControlPoints, placement: Placement, places: np.ndarray, turns: np.ndarray, poses: Sequence[int]) -> Wearer:
        """Who stood in set poses, numbers of `POSES`, with trackers at places (K, n, 3) [m] and turns (K, n, 3, 3) of the room; the first is the one that
        `placement` carries to the origin."""
        level, there = _level(placement), np.isin(JOINTS, controls.joints)
        wide = [_wide(slots(controls), level, *one) for one in zip(places, turns, strict=True)]
        points, turned = np.array([one[0] for one in wide]), np.array([one[1] for one in wide])
        stood = Stood.of(points[:1], turned[:1], there[None])
        return Wearer(controls, fitted(stood, points, turned, poses), np.array([placement.shift[0], placement.shift[2], placement.heading]), level)

    @property
    def skeleton(self) -> Skeleton:
        """The performer's, lengths as of a standard body."""
        return self.known.skeleton

    @property
    def moving(self) -> bool:
        """Whether it is still heard how they move."""
        return self._network is not None

    def __call__(self, places: np.ndarray, turns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Points (n, 3) [m] of a standard body's world, and their joints' turns (n, 3, 3), for trackers at places (n, 3) [m] in the room with turns
        (n, 3, 3); NaN where not known. A point is not known while its tracker's turn is not. Call it 60 times a second."""
        wide = _wide(self._slots, self.level, places, turns)
        self._hear(*wide)
        if self._measured:
            self._measure(*wide)
        points, turned = self._joints(self.known, *wide)
        if self._before is not None:
            share = self._eased / EASE
            points = share * points + (1.0 - share) * self._joints(self._before, *wide)[0]
            self._eased += 1
            if self._eased >= EASE:
                self._before = None
        return points, turned

    def said(self, names: Sequence[str]) -> str:
        """What is known, and how surely, in a line."""
        known, scale = self.known, self.known.stood.scale[0]
        worn = ", ".join(f"{name.partition('+')[0]} {100 * np.linalg.norm(known.offsets[s]) / scale:.0f} ± {100 * known.unsure[1][s] / scale:.0f}"
                         for name, s in zip(names, self._slots, strict=True))
        return f"{known.height:.2f} m tall; trackers sit beside their joints by cm: {worn}" + ("; move about" if self.moving else "")

    def _measure(self, places, turns):
        """How high heads are held says how tall somebody is."""
        high = float(self.known.joints(places, turns)[0][_HEAD, 1])
        if not np.isfinite(high):
            return
        self._heads.append(high)
        self._counted += 1
        if self._counted % MOVING == 0:
            share = float(np.quantile(self._heads, UPRIGHT)) / head_height(self.skeleton)
            self.seems = None if LIKE[0] < share < LIKE[1] else share * self.known.height

    def _joints(self, known, places, turns):
        points, turned = known.joints(places, turns)
        turn = yaw(self.ground[2])
        points, turned = points[self._slots] @ turn.T + [self.ground[0], 0.0, self.ground[1]], turn @ turned[self._slots]
        return points + np.einsum("nij,nj->ni", turned, self.controls.offsets), turned

    def _hear(self, places, turns):
        if self._network is None:
            return
        self._heard.append((places, turns))
        if len(self._heard) < MOVING + BEFORE:
            return
        at = len(self._heard) - 1 - STRIDE * np.arange(FRAMES)
        places, turns = (np.array(some) for some in zip(*self._heard, strict=True))
        pairs = np.stack([at, at - BEFORE], 1)
        self._before, self._eased = self.known, 0
        self.known = calibrated(self._network, self.known.stood, places[pairs], turns[pairs])
        self._network, self._heard = None, []


def head_height(skeleton: Skeleton) -> float:
    """How high [m] the head's joint is of somebody who stands upright on a floor at 0."""
    def above(body: Skeleton) -> np.ndarray:
        return forward_kinematics(body, np.zeros(3), np.tile(np.eye(3), (len(body), 1, 1)))[0][:, 1]
    feet = [SKELETON.index(name) for name in ("LeftFoot", "RightFoot")]
    own = above(skeleton)
    return float(own[JOINTS[_HEAD]] - own[feet].mean() + (above(SKELETON) + SKELETON.offsets[0, 1])[feet].mean())


def _level(placement: Placement) -> float:
    """The room's floor [m], where it is not levelled."""
    floor = -placement.shift[1] / placement.scale
    return floor if abs(floor) > LEVELLED else 0.0


def slots(controls: ControlPoints) -> np.ndarray:
    """The number in `WORN` of each control point (n,)."""
    return np.array([int(np.flatnonzero(joint == JOINTS)[0]) for joint in controls.joints])


def _wide(mine, level, places, turns):
    """Trackers by `WORN`, above the floor."""
    wide = np.full((len(WORN), 3), np.nan), np.full((len(WORN), 3, 3), np.nan)
    wide[0][mine], wide[1][mine] = places - [0.0, level, 0.0], turns
    return wide
