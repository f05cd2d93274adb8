"""When packets were sent that a network makes late: by their sender's clock, or by the even pace at which they are sent.

Whichever it is, a packet has a stamp, and a line tells when a stamp arrives if the network takes as long as it usually does. The sender's
stamps are its seconds. Without them packets are numbered, and the line is what is even about their arrivals, by least squares; whether a
packet is late or one before it is missing, its tracker's own motion tells, and else the packets that follow it.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

MEMORY = 150
"""The pace is that of a line through about so many arrivals, the older the less."""
OFFSET = 0.02
"""The sender's clock is off by the mean lateness, of which this is the newest packet's share."""
USUAL = 3.0
"""Who is later than so many times the mean lateness, and than the pace, is no later than that to the line: the network stood still."""
COUNTED = 20
"""So many packets are counted before their pace is believed …"""
PAUSE = 0.05
"""… and where two of them are farther apart than this [s], and than most are, some were lost; else the network held them up."""
GOOD = 2.0
"""The line is good for so long a silence [s]."""
GAP = 1.5
"""Between two packets that come by more than so many times the pace one after the other, some may be missing."""
UNREST = 0.35
"""How late a packet is, in times the pace: the standard deviation by which missing ones are told at least."""
RARE = 4.0
"""How unlikely it is that some are missing, in squared standard deviations."""
MOST = 4
"""If so many packets or more seem to be missing they are, until those that follow say otherwise."""
LOST = 0.7
"""By more than this share of the pace no packet is earlier than all before the gap were, nor are all of those after it later …"""
FEW, MANY = 8, 56
"""… as soon as there are so many; and so many are remembered."""


@dataclass(eq=False)
class Pace:
    """The line from stamps to arrivals. `by_clock` and `by_number` take a packet and tell its stamp.

    period: [s] between packets, NaN while it is not known. newest: the newest stamp. even: when that would have arrived [s], NaN of none.
    scale: [s] a stamp lasts. back: by how many stamps packets whose stamps are above `since` were found to be too late by the last one.
    """

    period: float = math.nan
    newest: float = 0.0
    even: float = math.nan
    back: int = 0
    since: float = math.inf
    _clocked: bool = False
    _spread: float = 0.0  # the mean of how late or early packets are [s]
    _missing: int = 0  # how many were thought to be missing just after `since` …
    _after: int = 0  # … and how many came after those
    _began: float = -math.inf  # when the line's first packet came [s]
    _followed: int = 0
    _moved: float = 0.0  # by how much the line was moved [s] since …
    _lates: deque[float] = field(default_factory=lambda: deque(maxlen=MANY))  # … and how late packets were to it as it was then
    _early: list[float] = field(default_factory=list)  # the first arrivals, till their pace is known

    @property
    def scale(self) -> float:
        """[s] that a stamp lasts."""
        return 1.0 if self._clocked else self.period

    @property
    def unsure(self) -> bool:
        """Whether the last stamps may yet turn out to be others."""
        return not self._clocked and (len(self._lates) < FEW or (self._after < 2 * FEW if self._missing else self._after == FEW - 1))

    def arrival(self, stamp: float) -> float:
        """When a stamp arrives [s]."""
        return self.even + (stamp - self.newest) * self.scale

    def broken(self, time: float, sent: float | None, silence: float) -> bool:
        """Whether a packet can't be on this line: it has a stamp of the other kind, or its sender's clock was set, by more than so long [s]."""
        if math.isnan(self.even):
            return False
        return self._clocked != (sent is not None) or sent is not None and (sent < self.newest - silence or self.arrival(sent) - time > silence)

    def silent(self, seconds: float) -> None:
        """Forget the line, but not the pace, if no packet came for longer than that is good for [s]."""
        if seconds <= GOOD:
            return
        self.even, self.since, self._missing, self._spread = math.nan, math.inf, 0, 0.0
        self._followed = min(self._followed, COUNTED)
        self._lates.clear()

    def by_clock(self, time: float, before: float, sent: float) -> float:
        """The stamp of a packet that was sent at `sent` [s] by its sender's clock."""
        self.back = 0
        if math.isnan(self.even):
            self._clocked, self.newest, self.even = True, sent, time
            return sent
        gap, late = sent - self.newest, time - self.arrival(sent)
        if gap > 0.0:
            self.period = gap if math.isnan(self.period) else self.period + OFFSET * (min(gap, 1.5 * self.period) - self.period)
            self.newest, self.even = sent, self.arrival(sent)
        self.even += OFFSET * self._usual(late, time - before)
        return sent

    def by_number(self, time: float, before: float, unlike: Callable[[int], float]) -> float:
        """The stamp of a packet that came after another, at `before` [s].

        unlike: how unlikely it is that the tracker got in so many packets to where it is, −1 for between the last two; in squared standard deviations.
        """
        self.back = 0
        if math.isnan(self.period) or math.isnan(self.even):
            if math.isnan(self.period):
                self._learn(time)
            self._clocked, self._began, self.newest, self.even = False, time, self.newest + 1.0, time
            return self.newest
        step = self._step((time - self.even) / self.period, time - before, unlike)
        if step < 0:  # it was overtaken
            self._missing -= 1
            return self.newest - 1.0
        if step > 1 or time - before > GAP * self.period:
            self.since, self._missing, self._after = self.newest, step - 1, 0
        self._after += 1
        self.newest, self.even = self.newest + step, self.even + step * self.period
        self._recount(time)
        late = self._usual(time - self.even, time - before)
        self._followed = n = min(self._followed + 1, MEMORY)  # recursive least squares of a line
        moved = late * 2.0 * (2 * n - 1) / (n * (n + 1))
        self.even, self._moved = self.even + moved, self._moved + moved
        self.period += min(max(late, -self.period), self.period) * 6.0 / (n * (n + 1))
        return self.newest

    def _learn(self, time: float) -> None:
        """Count the first packets."""
        self._early.append(time)
        if len(self._early) < COUNTED:
            return
        gaps = np.diff(self._early)
        period = float(np.mean(gaps[gaps <= max(2.5 * np.median(gaps), PAUSE)]))
        self._early.clear()
        if period >= 1e-3:  # else all came at once: nothing can be told yet
            self.period, self._followed = period, COUNTED

    def _usual(self, late: float, silent: float) -> float:
        """How late a packet is [s] as far as the line heeds it: no more than is usual, and little where packets come at once that were held up."""
        most = math.inf if math.isnan(self.period) else max(self.period, USUAL * self._spread)
        heed = 1.0 if math.isnan(self.period) else min(silent / self.period, 1.0)
        late = heed * min(max(late, -most), most)
        self._spread += OFFSET * heed * (abs(late) - self._spread)
        return late

    def _step(self, late: float, silent: float, unlike: Callable[[int], float]) -> int:
        """How many packets on from the newest one a packet is that comes so many times the pace after it; −1 if it belongs before the newest."""
        steps = [1]
        if self._missing and self.newest == self.since + self._missing + 1 and late < 1.0 - LOST:
            steps.append(-1)
        if silent > GAP * self.period:
            steps += range(2, max(round(late), 2) + 1)
        if len(steps) == 1:
            return 1
        if max(steps) > MOST:
            return max(round(late), 1)
        unrest = max(UNREST, 1.25 * self._spread / self.period)
        return min(steps, key=lambda one: ((late - one) / unrest)**2 + unlike(one) + RARE * (one > 1))

    def _recount(self, time: float) -> None:
        """Number packets anew where the newest is earlier than it can be, or all those after a gap are later."""
        most, late = LOST * self.period, time - self.even + self._moved
        self._lates.append(late)
        lates = list(self._lates)
        if self._missing:
            early = min(lates[:-self._after], default=late) - late
            if early > most:
                self._renumber(-min(round(early / self.period), self._missing))
        elif self._after == FEW and self._spread < UNREST * self.period:  # else lateness tells nothing
            if min(lates[-FEW:]) > min(lates[-2 * FEW:-FEW], default=late) + most:
                self._renumber(1)
        elif self.even - time > most and time - self._began < PAUSE:  # those before it had been held up
            back = round((self.even - time) / self.period) * self.period
            self.even, self._moved = self.even - back, self._moved - back

    def _renumber(self, on: int) -> None:
        """Set the packets after the last gap on by so many stamps, or back."""
        self.back, self._missing = -on, self._missing + on
        self.newest, self.even = self.newest + on, self.even + on * self.period
        for k in range(1, min(self._after, len(self._lates)) + 1):
            self._lates[-k] -= on * self.period
