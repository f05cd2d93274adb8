"""Where a tracker was when: its packets in time, read one packet late, so that a network's unrest is not seen.

Packets are sent at an even pace and arrive unevenly; what is even about them is found again by a phase-locked loop, or by the
sender's own clock where packets have one. Between packets, places lie on cubics through them.
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
"""A packet that is late by this share of the pace, as far from the one before, has a lost one before it …"""
MISSING = 0.15
"""… or packets are that late on the average, of which this is the newest one's share."""
COUNTED = 20
"""So many packets are counted before their pace is believed."""
ANEW = 0.1
"""A packet later than this [s], and than four are apart, begins anew."""
KEPT = 16
"""So many packets are kept."""
AHEAD = 1.0
"""A packet that is late is waited for along the tracker's last motion for so many times the pace."""


@dataclass(eq=False)
class Timeline:
    """The packets of one tracker. `heard` takes one, `at` tells where the tracker was one packet ago.

    period: [s] between packets, as far as is known. last: when the newest arrived [s].
    """

    period: float = math.nan
    last: float = -math.inf
    _even: float = math.nan  # when the newest would have arrived if packets came evenly [s]
    _late: float = 0.0
    _followed: int = 0
    _offset: float = math.nan  # of our clock to the sender's [s]
    _early: list[float] = field(default_factory=list)  # the first arrivals, till their pace is known
    _known: list[tuple[float, int, np.ndarray]] = field(default_factory=list)  # moments, count, places, in order
    _count: int = 0

    def heard(self, time: float, place: np.ndarray, sent: float | None = None) -> None:
        """Take a packet that arrived at a time [s] and was sent, by the sender's clock, at `sent` [s] if that is known."""
        if time - self.last > max(4.0 * self.period, ANEW):
            self._known.clear()
            self._even = self._offset = math.nan
            self._late = 0.0
        before, self.last = self.last, time
        moment = self._by_pace(time, before) if sent is None else self._by_clock(time, sent)
        self._count += 1
        insort(self._known, (moment, self._count, place))
        del self._known[:-KEPT]

    @property
    def newest(self) -> np.ndarray:
        """The newest place (3,), NaN of none."""
        return self._known[-1][2] if self._known else np.full(3, np.nan)

    def at(self, time: float) -> np.ndarray:
        """Where the tracker was (3,) one packet before a time [s]: the newest place while the pace is not known, NaN of none."""
        if len(self._known) < 3 or math.isnan(self.period):
            return self.newest
        moment = time - self.period
        k = min(max(bisect_right(self._known, moment, key=lambda one: one[0]), 1), len(self._known) - 1)
        (a, _, from_), (b, _, to) = self._known[k - 1:k + 1]
        if b - a < 1e-6:
            return to
        u = (moment - a) / (b - a)
        if u > 1.0:  # it is late
            beyond = min(moment - b, AHEAD * self.period)
            return to + self._velocity(k) * beyond
        start, end = self._velocity(k - 1) * (b - a), self._velocity(k) * (b - a)
        u = max(u, 0.0)
        rest = 1.0 - u
        return (rest * rest * ((1.0 + 2.0 * u) * from_ + u * start)) + u * u * ((3.0 - 2.0 * u) * to - rest * end)

    def _velocity(self, k: int) -> np.ndarray:
        """How the tracker moved at the k-th known packet [m/s], by the parabola through it and two beside it."""
        first = min(max(k - 1, 0), len(self._known) - 3)
        (a, _, x), (b, _, y), (c, _, z) = self._known[first:first + 3]
        if min(b - a, c - b) < 1e-6:
            return (z - x) / max(c - a, 1e-6)
        before, after = (y - x) / (b - a), (z - y) / (c - b)
        bend, t = (after - before) / (c - a), self._known[k][0]
        return before + bend * (2.0 * t - a - b)

    def _by_clock(self, time: float, sent: float) -> float:
        """When a packet would have arrived by the sender's clock, whose offset is what packets are late by on the average."""
        late = time - sent
        self._offset = late if math.isnan(self._offset) else self._offset + OFFSET * (late - self._offset)
        if self._known:
            gap = sent + self._offset - self._known[-1][0]
            if gap > 0.0:
                self.period = gap if math.isnan(self.period) else self.period + OFFSET * (min(gap, 1.5 * self.period) - self.period)
        return sent + self._offset

    def _by_pace(self, time: float, before: float) -> float:
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
        due = self._even + self.period
        late, gap = time - due, time - before
        if late > LOST * self.period and gap > (1.0 + LOST) * self.period:  # one or more are missing before it
            steps = max(round(late / self.period), 1) * self.period
            due, late = due + steps, late - steps
        self._late += MISSING * (late - self._late)
        if abs(self._late) > LOST * self.period:  # not unrest: packets were missing, or too many were thought to be
            steps = math.copysign(self.period, self._late)
            due, late, self._late = due + steps, late - steps, self._late - steps
        self._followed = n = min(self._followed + 1, MEMORY)  # recursive least squares of a line
        late = min(max(late, -self.period), self.period)
        self._even = max(due + late * 2.0 * (2 * n - 1) / (n * (n + 1)), self._even + 0.3 * self.period)
        self.period += late * 6.0 / (n * (n + 1))
        return self._even
