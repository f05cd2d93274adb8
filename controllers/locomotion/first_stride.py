"""Setting off: the first strides from rest have something of their own beyond the blend, as recorded people's have.

The gait's phase begins where both feet stand and waits there while the weight is shifted; then the first foot leaves.
What is recorded of starts (`first_stride_build`) is added over that phase, and is nothing where the strides are steady.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..body import spring_kernel
from ..compiled import kernel
from .kernel import COLUMNS, LABELS_AT
from .library import Library
from .spline import in_columns, spline_kernel

BEFORE, END = 0.12, 1.5
"""A start begins this long before its first toe-off and ends this long after it, in phase."""
WAITING, PER_CYCLE = 3.0, 6.0
"""Spline coefficients before the first toe-off, and for each cycle after it."""
SHIFT = 0.16
"""The weight is shifted in this time [s], half of what people take who are in no hurry."""
FIRST_PUSH, LEANING = 0.45, 0.05
"""What it pushes at first, of what legs can, and for how much phase after the first toe-off it does not push its most."""
FASTEST_TURN = 2.2
"""No recorded start turned faster towards its first foot [rad/s]."""
WHOLE_SPEED, WHOLE_TURN = 0.8, 1.2
"""Starts faster than this [m/s], or turning faster [rad/s], show all of it …"""
SIDEWAYS = 0.5
"""… and those that go sideways as fast as this, or back, none."""
SHARE_HALFLIFE = 0.08
"""With this half-life [s] what is shown follows the wish, smoothly, or arms would jerk as it changes."""

AGO = 0.004
"""How fast what is shown changes is told over this time [s]."""


class Starting(NamedTuple):
    """What the step must know: spline coefficients (2, 2, K, COLUMNS): left or right foot first; straight, by turning."""

    coefficients: np.ndarray


def starting(library: Library) -> Starting:
    """The kernel's view of a library's start; no coefficients where it has none."""
    if library.start is None:
        return Starting(np.zeros((2, 2, 0, COLUMNS), np.float32))
    return Starting(in_columns(library.start.coefficients))


@kernel
def leave_rest(m, wish):
    """Set off from rest where there is a wish: which foot goes first, and the phase in which both stand and it is
    about to leave."""
    if not m.settled or wish[0] ** 2 + wish[1] ** 2 + wish[2] ** 2 < 1e-6:
        return
    m.first = 0 if wish[1] > 0.05 or (wish[1] >= -0.05 and wish[2] >= 0.0) else 1
    m.phase = 1.0 - BEFORE if m.first == 0 else 0.5 - BEFORE
    m.settled = 0
    m.onset = BEFORE + END
    m.shares[0] = m.shares[1] = m.shares_rate[0] = m.shares_rate[1] = 0.0


@kernel
def shift_left(m):
    """How much phase is left until a start's first toe-off: none if there is no start, or it has been."""
    return max(m.onset - END, 0.0)


@kernel
def leans(m, ahead):
    """The share of its strength with which a body pushes off, `ahead` further in phase: little until it leans into its
    first stride."""
    if m.onset <= 0.0:
        return 1.0
    done = min((BEFORE + END - m.onset + ahead) / (BEFORE + LEANING), 1.0)
    return FIRST_PUSH + (1.0 - FIRST_PUSH) * done * done * (3.0 - 2.0 * done)


def readiness(memory):
    """The same (...) of what characters (...) remember, before their next step; those who stand as if they set off in it."""
    if not memory.ndim:  # for one it takes a seventh of the time so
        onset = BEFORE + END if memory["settled"] else float(memory["onset"])
        done = min(max((BEFORE + END - onset) / (BEFORE + LEANING), 0.0), 1.0)
        return np.array(FIRST_PUSH + (1.0 - FIRST_PUSH) * done * done * (3.0 - 2.0 * done) if onset > 0.0 else 1.0)
    onset = np.where(memory["settled"], BEFORE + END, memory["onset"].astype(float))
    done = np.clip((BEFORE + END - onset) / (BEFORE + LEANING), 0.0, 1.0)
    return np.where(onset > 0.0, FIRST_PUSH + (1.0 - FIRST_PUSH) * done * done * (3.0 - 2.0 * done), 1.0)


@kernel
def start_kernel(m, start, wish, dt):
    """Lead on how far a start shows. One that comes to rest goes over into the blend's offset, which fades."""
    if m.onset <= 0.0 or start.coefficients.shape[2] == 0:
        return
    if m.settled:
        for d in range(LABELS_AT):
            m.blend[d] += _beyond(m, start, m.first, m.onset, 0.0, d)
        m.fade = SHIFT
        m.onset = 0.0
        return
    ahead = (1.0 - min(abs(wish[2]) / SIDEWAYS, 1.0)) * min(max(1.0 + wish[0] / SIDEWAYS, 0.0), 1.0)
    towards = wish[1] if m.first == 0 else -wish[1]
    whole = ahead * min(max(wish[0] / WHOLE_SPEED, abs(wish[1]) / WHOLE_TURN, 0.0), 1.0)
    turning = ahead * min(max(towards, 0.0), FASTEST_TURN)
    m.shares[0], m.shares_rate[0] = spring_kernel(m.shares[0], m.shares_rate[0], whole, SHARE_HALFLIFE, dt)
    m.shares[1], m.shares_rate[1] = spring_kernel(m.shares[1], m.shares_rate[1], turning, SHARE_HALFLIFE, dt)


@kernel
def add_start(m, start, row):
    """Add to a row (COLUMNS,) what a character's start has beyond the blend."""
    if m.onset > 0.0 and start.coefficients.shape[2] > 0:
        for d in range(LABELS_AT):
            row[d] += _beyond(m, start, m.first, m.onset, 0.0, d)


@kernel
def break_off(m, start, first, onset, pace):
    """A start that a turn breaks off goes over into the pose's offset, which fades. first, onset: its first foot, and how much phase of it was left; pace: how
    fast that ran [1/s]."""
    if start.coefficients.shape[2] == 0:
        return
    for d in range(LABELS_AT):
        now = _beyond(m, start, first, onset, 0.0, d)
        m.blend[d] += now
        m.blend_rate[d] += (now - _beyond(m, start, first, onset + pace * AGO, AGO, d)) / AGO


@kernel
def _beyond(m, start, first, onset, ago, d):
    """One column of what a start adds of which so much phase is left, as far as it showed so long ago [s]."""
    table = start.coefficients[first]
    since = END - onset
    at = WAITING + since * PER_CYCLE if since > 0.0 else WAITING * max(1.0 + since / BEFORE, 0.0)
    straight, turning = m.shares[0] - ago * m.shares_rate[0], m.shares[1] - ago * m.shares_rate[1]
    return straight * spline_kernel(table[0], d, at)[0] + turning * spline_kernel(table[1], d, at)[0]
