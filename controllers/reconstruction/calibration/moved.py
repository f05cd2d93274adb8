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
MOVING = 2 * PER_FRAME + 10 * _COUNT + 12 * (2 * _COUNT - 2)
"""… and of many."""
BEFORE = 3
"""So many frames of 1/60 s before each moment there is another one …"""
DT = BEFORE / 60.0
"""… in seconds."""
_SLOW = 0.3, 1.0
"""What is slower than this [m/s] counts as still."""
_LEVEL = 0.9


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


def told(places: np.ndarray, turns: np.ndarray, there: np.ndarray, heard: np.ndarray) -> np.ndarray:
    """What moments of moving tell of people (B, MOVING): mean and deviation of `moved_kernel`'s numbers, and pivots.

    places (B, F, 2, S, 3), lengths as of a standard body, turns (B, F, 2, S, 3, 3): of pairs of frames `BEFORE` apart, newest first. there: (B, S)
    bool, which are worn. heard: (B, F) bool, which moments count; what doesn't is never read. Nothing heard is all zero.
    """
    count, frames, slots = len(there), heard.shape[1], len(WORN)
    some = np.empty((count * frames, PER_FRAME), np.float32)
    known = heard[:, :, None] & there[:, None]
    moved_kernel(places.reshape(-1, 2, slots, 3), turns.reshape(-1, 2, slots, 3, 3), known.reshape(-1, slots), DT, some)
    share = heard / np.maximum(heard.sum(-1, keepdims=True), 1)
    some = some.reshape(count, frames, PER_FRAME).astype(float)
    mean = np.einsum("bf,bfd->bd", share, some)
    spread = np.sqrt(np.maximum(np.einsum("bf,bfd->bd", share, some ** 2) - mean ** 2, 0.0))
    used = known[:, :, None, :, None]
    places, turns = np.where(used, places, 0.0), np.where(used[..., None], turns, np.eye(3))
    return np.concatenate([mean, spread, *_pivots(places, turns, there, heard.astype(float))], -1)


def _pivots(places, turns, there, heard):
    """Where trackers turn about, seen from each, by least squares: a point that stands still in the room, as long as it is slow (a ball of the foot);
    a height that stays (a neck); a point that is fixed to the hips or the head, always, from moment to moment, and while it is slow."""
    found = []
    for s in range(len(WORN)):
        now, before = turns[:, :, 0, s], turns[:, :, 1, s]
        gone = places[:, :, 0, s] - places[:, :, 1, s]
        pace = np.linalg.norm(gone, axis=-1) / DT
        mine = there[:, s, None]
        for slow in _SLOW:
            found.append(mine * _least(now - before, -gone, 0.01, heard * np.exp(-(pace / slow) ** 2)))
        level = np.concatenate([now[:, :, 1], np.ones((*heard.shape, 1))], -1)[:, :, None]
        found.append(mine * _least(level, places[:, :, 0, s, 1, None] - _LEVEL, 0.02, heard))
        for r in range(2):
            if r == s:
                continue
            (turned, seen), (earlier, saw) = ((np.einsum("bfji,bfjk->bfik", turns[:, :, k, r], turns[:, :, k, s]),
                                               np.einsum("bfji,bfj->bfi", turns[:, :, k, r], places[:, :, k, s] - places[:, :, k, r])) for k in (0, 1))
            both, pace = mine * there[:, r, None], np.linalg.norm(seen - saw, axis=-1) / DT
            fixed = np.concatenate([turned, np.broadcast_to(np.eye(3), turned.shape)], -1)
            found.append(both * _least(fixed, seen, 0.05, heard))
            found.append(both * _least(turned - earlier, saw - seen, 0.01, heard))
            found.append(both * _least(turned - earlier, saw - seen, 0.01, heard * np.exp(-(pace / _SLOW[0]) ** 2)))
    return found


def _least(slopes, goals, ridge, weight):
    """x (B, K) of least |w (slopes x − goals)|² + ridge |x|²: slopes (B, F, M, K), goals (B, F, M), weight (B, F)."""
    count, size = slopes.shape[0], slopes.shape[-1]
    slopes, goals = (slopes * weight[..., None, None]).reshape(count, -1, size), (goals * weight[..., None]).reshape(count, -1)
    back = np.swapaxes(slopes, -1, -2)
    return np.linalg.solve(back @ slopes + ridge * np.eye(size), back @ goals[..., None])[..., 0]
