"""Where a tracker was when: its packets in time, read one packet late, so that a network's unrest is not seen.

Packets are sent at an even pace and arrive unevenly; what is even about them is found again by a phase-locked loop, or by the
sender's own clock where packets have one. Whether a packet is late or one before it is missing, its tracker's own motion tells.
Between packets, places lie on cubics through them, and turns on the shortest way.
"""

from __future__ import annotations

import math
from bisect import bisect_right, insort
from dataclasses import dataclass, field

import numpy as np

MEMORY = 150
"""The pace is that of a line through about so many arrivals, the older the less …"""
OFFSET = 0.02
"""… and the sender's clock is off by the mean lateness, of which this is the newest packet's share."""
LOST = 0.7
"""Packets that are late by this share of the pace on the average had one missing before them …"""
MISSING = 0.15
"""… of which this is the newest one's share."""
UNREST = 0.35
"""The standard deviation of how late a packet is, in times the pace, as far as missing ones are told by it."""
MOST = 4
"""Of so many packets and more that seem to be missing none is thought to be late."""
BEND = 10.0
"""A tracker leaves its line by the way that such an acceleration [m/s²] takes it …"""
NOISE = 0.001
"""… and by its noise [m]."""
COUNTED = 20
"""So many packets are counted before their pace is believed."""
ANEW = 0.1
"""A packet later than this [s], and than four are apart, begins anew."""
NEAREST = 0.5
"""A packet that seems to be from so nearly the same moment as another, in times the pace, tells nothing: cubics through both would fly off."""
KEPT = 16
"""So many packets are kept."""
AHEAD = 3.0
"""A packet that is late is waited for along the tracker's last motion for so many times the pace."""
MENDED = 0.02
"""Time constant [s] in which what a late packet changes comes in."""
_NOWHERE, _UNTURNED = np.full(3, np.nan), np.full(4, np.nan)


@dataclass(eq=False)
class Timeline:
    """The packets of one tracker. `heard` takes one, `at` and `turned_at` tell where it was and how turned one packet ago.

    period: [s] between packets, as far as is known. last: when the newest arrived [s].
    """

    period: float = math.nan
    last: float = -math.inf
    _even: float = math.nan  # when the newest would have arrived if packets came evenly [s]
    _late: float = 0.0
    _gap: bool = False  # whether one is thought to be missing before the newest
    _followed: int = 0
    _offset: float = math.nan  # of our clock to the sender's [s]
    _early: list[float] = field(default_factory=list)  # the first arrivals, till their pace is known
    _known: list[tuple[float, int, np.ndarray, np.ndarray]] = field(default_factory=list)  # moments, count, places, turns
    _count: int = 0
    _mend: tuple[float, np.ndarray, np.ndarray] = (-math.inf, np.zeros(3), np.zeros(3))  # when [s], of place and velocity

    def heard(self, time: float, place: np.ndarray, sent: float | None = None, turn: np.ndarray = _UNTURNED) -> None:
        """Take a packet that arrived at a time [s] and was sent, by the sender's clock, at `sent` [s] if that is known.

        place: (3,) [m]. turn: (4,) a unit quaternion x, y, z, w, NaN where none is known.
        """
        if time - self.last > max(4.0 * self.period, ANEW) or sent is not None and self._set_anew(time, sent):
            self._known.clear()
            self._even = self._offset = math.nan
            self._late, self._mend = 0.0, (-math.inf, np.zeros(3), np.zeros(3))
        step = 1e-3
        waited = len(self._known) >= 3 and not math.isnan(self.period) and time > self._known[-1][0] + 1.1 * self.period
        shown = (self.at(time), self.at(time + step)) if waited else None
        before, self.last = self.last, time
        moment = self._by_pace(time, before, place) if sent is None else self._by_clock(time, sent)
        if not any(abs(moment - one[0]) < NEAREST * self.period for one in self._known[-4:]):
            self._count += 1
            insort(self._known, (moment, self._count, place, turn))
            del self._known[:-KEPT]
        if shown is not None:
            self._mend = (-math.inf, np.zeros(3), np.zeros(3))
            off, later = shown[0] - self.at(time), shown[1] - self.at(time + step)
            self._mend = time, off, (later - off) / step

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
        if len(self._known) < 3 or math.isnan(self.period):
            return self.newest
        since, off, rate = max(time - self._mend[0], 0.0), self._mend[1], self._mend[2]  # it may be asked of a moment before
        if since >= 12.0 * MENDED:
            return self._through(time)
        fading = math.exp(-since / MENDED)
        return self._through(time) + fading * (off + (rate + off / MENDED) * since)

    def turned_at(self, time: float) -> np.ndarray:
        """How the tracker was turned (4,) one packet before a time [s]: on the shortest way between two packets' turns."""
        if len(self._known) < 3 or math.isnan(self.period):
            return self.newest_turn
        k, u = self._share(time - self.period)
        return slerp(self._known[k - 1][3], self._known[k][3], u)

    def _share(self, moment: float) -> tuple[int, float]:
        """The number of the packet after a moment [s], and the share of the way to it; beyond 1 if it is late."""
        k = min(max(bisect_right(self._known, moment, key=lambda one: one[0]), 1), len(self._known) - 1)
        before, after = self._known[k - 1][0], self._known[k][0]
        if after - before < 1e-6:
            return k, 1.0
        return k, max((min(moment, after + AHEAD * self.period) - before) / (after - before), 0.0)

    def _through(self, time: float) -> np.ndarray:
        """On the cubics through the packets' places, and on the line beyond them."""
        k, u = self._share(time - self.period)
        (a, _, from_, _), (b, _, to, _) = self._known[k - 1:k + 1]
        if b - a < 1e-6:
            return to
        if u > 1.0:  # it is late
            return to + self._velocity(k) * ((u - 1.0) * (b - a))
        start, end, rest = self._velocity(k - 1) * (b - a), self._velocity(k) * (b - a), 1.0 - u
        return (rest * rest * ((1.0 + 2.0 * u) * from_ + u * start)) + u * u * ((3.0 - 2.0 * u) * to - rest * end)

    def _velocity(self, k: int) -> np.ndarray:
        """How the tracker moved at the k-th known packet [m/s], by the parabola through it and two beside it."""
        first = min(max(k - 1, 0), len(self._known) - 3)
        (a, _, x, _), (b, _, y, _), (c, _, z, _) = self._known[first:first + 3]
        if min(b - a, c - b) < 1e-6:
            return (z - x) / max(c - a, 1e-6)
        before, after = (y - x) / (b - a), (z - y) / (c - b)
        bend, t = (after - before) / (c - a), self._known[k][0]
        return before + bend * (2.0 * t - a - b)

    def _set_anew(self, time: float, sent: float) -> bool:
        """Whether the sender's clock must have been set: a packet older than all that are kept, or one from times to come."""
        return bool(self._known) and (sent + self._offset < self._known[0][0]
                                      or sent + self._offset - time > max(4.0 * self.period, ANEW))

    def _by_clock(self, time: float, sent: float) -> float:
        """When a packet would have arrived by the sender's clock, whose offset is what packets are late by on the average."""
        late = time - sent
        self._offset = late if math.isnan(self._offset) else self._offset + OFFSET * (late - self._offset)
        if self._known:
            gap = sent + self._offset - self._known[-1][0]
            if gap > 0.0:
                self.period = gap if math.isnan(self.period) else self.period + OFFSET * (min(gap, 1.5 * self.period) - self.period)
        return sent + self._offset

    def _by_pace(self, time: float, before: float, place: np.ndarray) -> float:
        """When a packet would have arrived if they came evenly; those that were lost are counted, too."""
        if math.isnan(self.period):
            self._early.append(time)
            if len(self._early) == COUNTED:
                gaps = np.diff(self._early)
                self.period = float(np.mean(gaps[gaps <= 2.5 * max(np.median(gaps), 1e-3)]))
                if self.period < 1e-3:  # all at once: nothing can be told yet
                    self.period = math.nan
                self._early.clear()
                self._followed = COUNTED
            self._even = time
            return time
        if math.isnan(self._even):
            self._even = time
            return time
        step = self._step(time, before, place)
        if step < 0:  # it was overtaken
            return self._even - self.period
        due = self._even + step * self.period
        late = time - due
        self._late += MISSING * (late - self._late)
        if abs(self._late) > LOST * self.period:  # not unrest: packets were missing, or too many were thought to be
            steps = math.copysign(self.period, self._late)
            due, late, self._late = due + steps, late - steps, self._late - steps
        self._followed = n = min(self._followed + 1, MEMORY)  # recursive least squares of a line
        late = min(max(late, -self.period), self.period)
        self._even = max(due + late * 2.0 * (2 * n - 1) / (n * (n + 1)), self._even + 0.3 * self.period)
        self.period += late * 6.0 / (n * (n + 1))
        return self._even

    def _step(self, time: float, before: float, place: np.ndarray) -> int:
        """How many packets on from the newest one a packet is, 1 if none is missing; −1 if it belongs before the newest.

        The most likely one by how late it would be, and by where its tracker would have got to.
        """
        late = (time - self._even) / self.period
        steps = [1]
        if self._gap and late < 1.0 - LOST:
            steps.append(-1)
        if time - before > 1.5 * self.period:
            steps += range(2, max(round(late), 2) + 1)
        if len(steps) == 1:
            self._gap = False
            return 1
        if max(steps) > MOST:
            step = max(round(late), 1)
        else:
            step = min(steps, key=lambda one: ((late - one) / UNREST)**2 + self._unlike(one, place))
        self._gap = step == 2
        return step

    def _unlike(self, step: int, place: np.ndarray) -> float:
        """How unlikely it is that the tracker got to a place in so many steps: in squared standard deviations."""
        if len(self._known) < 3:
            return 0.0
        ahead = step * self.period
        off = place - self._known[-1][2] - self._velocity(len(self._known) - 1) * ahead
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
