"""Where a tracker was when: its packets in time, read one packet late, so that a network's unrest is not seen.

When packets were sent `pace` finds. Between them places lie on cubics through them, and turns on the shortest way.
"""

from __future__ import annotations

import math
from bisect import bisect_right, insort
from dataclasses import dataclass, field

import numpy as np

from .pace import Pace

BEND = 10.0
"""A tracker leaves its line by the way that such an acceleration [m/s²] takes it …"""
NOISE = 0.001
"""… and by its noise [m]."""
ANEW = 0.15
"""A packet later than this [s], and than four are apart, begins anew."""
NEAREST = 0.5
"""A packet that seems to be from so nearly the same moment as another, in times the pace, tells nothing: cubics through both would fly off."""
KEPT = 16
"""So many packets are kept."""
AHEAD = 3.0
"""A packet that is late is waited for along the tracker's last motion for so many times the pace."""
MENDED = 0.02
"""Time constant [s] in which what a late packet changes comes in at least …"""
HURRY = 2.5
"""… and no faster than at this speed [m/s]."""
_NOWHERE, _UNTURNED = np.full(3, np.nan), np.full(4, np.nan)


@dataclass(frozen=True, eq=False)
class _Mend:
    """What a packet changed at a moment [s] of a place (3,) [m] and velocity [m/s], and how fast the place's fades [s]."""

    moment: float
    off: np.ndarray
    rate: np.ndarray
    fading: float

    def left(self, time: float) -> np.ndarray:
        """What is left of it (3,) at a time [s]; it may be asked of a moment before."""
        since = max(time - self.moment, 0.0)
        slow = since / self.fading
        return math.exp(-slow) * (1.0 + slow) * self.off + math.exp(-since / MENDED) * since * self.rate


@dataclass(eq=False)
class Timeline:
    """The packets of one tracker. `heard` takes one, `at` and `turned_at` tell where it was and how turned one packet ago.

    period: [s] between packets, as far as is known. last: when the newest arrived [s].
    """

    last: float = -math.inf
    _pace: Pace = field(default_factory=Pace)
    _known: list[tuple[float, int, np.ndarray, np.ndarray]] = field(default_factory=list)  # stamps, count, places, turns
    _count: int = 0
    _stands: bool = False  # whether the sender's clock was seen to stand, or to be too coarse: it is not heard
    _mend: _Mend | None = None

    @property
    def period(self) -> float:
        """[s] between packets, NaN while it is not known."""
        return self._pace.period

    def heard(self, time: float, place: np.ndarray, sent: float | None = None, turn: np.ndarray = _UNTURNED) -> None:
        """Take a packet that arrived at a time [s] and was sent, by the sender's clock, at `sent` [s] if that is known.

        place: (3,) [m]. turn: (4,) a unit quaternion x, y, z, w, NaN where none is known.
        """
        if sent is not None and self._known and sent == self._pace.newest and (place != self.newest).any():
            self._stands = True
        if self._stands:
            sent = None
        pace, silence = self._pace, max(4.0 * self.period, ANEW)
        broken = pace.broken(time, sent, silence)
        if time - self.last > silence or broken:
            self._known.clear()
            pace.silent(math.inf if broken else time - self.last)
            self._mend = None
        step = 1e-3
        waited = self._paced and (pace.unsure or time > pace.arrival(self._known[-1][0]) + 1.1 * self.period)
        shown = (self.at(time), self.at(time + step)) if waited else None
        before, self.last = self.last, time
        stamp = pace.by_number(time, before, lambda step: self._unlike(step, place)) if sent is None else pace.by_clock(time, before, sent)
        if pace.back:
            self._known = [(one[0] - pace.back * (one[0] > pace.since), *one[1:]) for one in self._known]
        if not any(stamp == one[0] or abs(stamp - one[0]) * pace.scale < NEAREST * self.period for one in self._known):
            self._count += 1
            insort(self._known, (stamp, self._count, place, turn))
            del self._known[:-KEPT]
        if shown is not None:
            self._mend = None
            off, later = shown[0] - self.at(time), shown[1] - self.at(time + step)
            self._mend = _Mend(time, off, (later - off) / step, max(MENDED, float(np.linalg.norm(off)) / (math.e * HURRY)))

    def turned(self, time: float, turn: np.ndarray) -> None:
        """Take a turn (4,) that arrived in a packet of its own: of the newest place, if that was just heard without one."""
        if self._known and time - self.last <= (0.02 if math.isnan(self.period) else 0.5 * self.period):
            k = max(range(len(self._known)), key=lambda one: self._known[one][1])
            self._known[k] = (*self._known[k][:3], turn)

    @property
    def newest(self) -> np.ndarray:
        """The newest place (3,), NaN of none."""
        return self._known[-1][2] if self._known else _NOWHERE.copy()

    @property
    def newest_turn(self) -> np.ndarray:
        """The newest turn (4,), NaN of none."""
        return self._known[-1][3] if self._known else _UNTURNED.copy()

    def at(self, time: float) -> np.ndarray:
        """Where the tracker was (3,) one packet before a time [s]: the newest place while the pace is not known, NaN of none."""
        if not self._paced:
            return self.newest
        return self._through(time) if self._mend is None else self._through(time) + self._mend.left(time)

    def turned_at(self, time: float) -> np.ndarray:
        """How the tracker was turned (4,) one packet before a time [s]: on the shortest way between two packets' turns."""
        if not self._paced:
            return self.newest_turn
        k, u = self._share(time)
        return slerp(self._known[k - 1][3], self._known[k][3], u)

    @property
    def _paced(self) -> bool:
        """Whether there is enough to lay a way through."""
        return len(self._known) >= 3 and not math.isnan(self.period)

    def _share(self, time: float) -> tuple[int, float]:
        """The number of the packet after the stamp of one packet before a time [s], and the share of the way to it; beyond 1 if it is late."""
        pace = self._pace
        stamp = pace.newest + (time - self.period - pace.even) / pace.scale
        k = min(max(bisect_right(self._known, stamp, key=lambda one: one[0]), 1), len(self._known) - 1)
        before, after = self._known[k - 1][0], self._known[k][0]
        return k, max((min(stamp, after + AHEAD * self.period / pace.scale) - before) / (after - before), 0.0)

    def _through(self, time: float) -> np.ndarray:
        """On the cubics through the packets' places, and on the line beyond them."""
        k, u = self._share(time)
        (a, _, from_, _), (b, _, to, _) = self._known[k - 1:k + 1]
        if u > 1.0:  # it is late
            return to + self._velocity(k) * ((u - 1.0) * (b - a))
        start, end, rest = self._velocity(k - 1) * (b - a), self._velocity(k) * (b - a), 1.0 - u
        return (rest * rest * ((1.0 + 2.0 * u) * from_ + u * start)) + u * u * ((3.0 - 2.0 * u) * to - rest * end)

    def _velocity(self, k: int) -> np.ndarray:
        """How the tracker moved at the k-th known packet [m a stamp], by the parabola through it and two beside it."""
        first = min(max(k - 1, 0), len(self._known) - 3)
        (a, _, x, _), (b, _, y, _), (c, _, z, _) = self._known[first:first + 3]
        before, after = (y - x) / (b - a), (z - y) / (c - b)
        bend, t = (after - before) / (c - a), self._known[k][0]
        return before + bend * (2.0 * t - a - b)

    def _unlike(self, step: int, place: np.ndarray) -> float:
        """How unlikely it is that the tracker got to a place in so many steps: in squared standard deviations."""
        if len(self._known) < 3:
            return 0.0
        off, ahead = place - self._known[-1][2] - self._velocity(len(self._known) - 1) * step, step * self.period
        return float(off @ off) / (NOISE**2 + (0.5 * BEND * ahead**2)**2)


def slerp(start: np.ndarray, end: np.ndarray, share: float) -> np.ndarray:
    """The unit quaternion (4,) at a share of the shortest way between two, and beyond them; NaN where both are not known."""
    cosine = float(start @ end)
    if math.isnan(cosine):
        return end if math.isnan(start[0]) else start
    if cosine < 0.0:
        cosine, end = -cosine, -end
    angle = math.acos(min(cosine, 1.0))
    if angle < 1e-6:
        return end
    turn = (math.sin((1.0 - share) * angle) * start + math.sin(share * angle) * end) / math.sin(angle)
    return turn / math.sqrt(turn @ turn)
