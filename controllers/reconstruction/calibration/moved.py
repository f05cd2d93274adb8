"""What a moment of moving says of trackers: heights, how they are turned to the vertical, how they move, and where each one sees the
others, in frames of their own; whichever way somebody goes or faces."""

from __future__ import annotations

import numpy as np

from ...compiled import kernel
from ..regression import EXACT
from .stood import WORN

_COUNT = len(WORN)
PER_FRAME = 11 * _COUNT + 3 * _COUNT * (_COUNT - 1) + 6 * (2 * _COUNT - 3)
"""Numbers of a moment."""


@kernel(fastmath=EXACT, error_model="numpy")
def moved_kernel(places, turns, there, dt, out):
    """Fills out (N, PER_FRAME) float32 of moments N, each with one dt [s] before: places (N, 2, S, 3), lengths as of a standard body,
    turns (N, 2, S, 3, 3), newest first. there: (N, S) bool, which are seen: what is not is never read."""
    count = places.shape[2]
    for b in range(len(places)):
        at = 0
        for d in range(out.shape[1]):
            out[b, d] = 0.0
        for s in range(count):
            if there[b, s]:
                out[b, at] = 1.0
                out[b, at + 1] = (places[b, 0, s, 1] - 0.9) / 0.4
                for i in range(3):
                    out[b, at + 2 + i] = turns[b, 0, s, 1, i]
                    total = 0.0
                    for k in range(3):
                        total += turns[b, 0, s, k, i] * (places[b, 0, s, k] - places[b, 1, s, k])
                    out[b, at + 5 + i] = total / dt
                for i in range(3):
                    u, v = (i + 1) % 3, (i + 2) % 3
                    total = 0.0
                    for k in range(3):
                        total += turns[b, 1, s, k, v] * turns[b, 0, s, k, u] - turns[b, 1, s, k, u] * turns[b, 0, s, k, v]
                    out[b, at + 8 + i] = 0.5 * total / (3.0 * dt)
            at += 11
        for s in range(count):
            for o in range(count):
                if o == s:
                    continue
                if there[b, s] and there[b, o]:
                    for i in range(3):
                        total = 0.0
                        for k in range(3):
                            total += turns[b, 0, s, k, i] * (places[b, 0, o, k] - places[b, 0, s, k])
                        out[b, at + i] = total / 0.5
                at += 3
        for s in range(2):
            for o in range(s + 1, count):
                if there[b, s] and there[b, o]:
                    for c in range(2):
                        for i in range(3):
                            total = 0.0
                            for k in range(3):
                                total += turns[b, 0, s, k, i] * turns[b, 0, o, k, c]
                            out[b, at + 3 * c + i] = total
                at += 6
