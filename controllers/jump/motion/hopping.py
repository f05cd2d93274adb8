"""Hops: how the leg is carried on which one does not stand."""

from __future__ import annotations

import numpy as np

from ..prior import BETWEEN, EACH, LEGS

HELD = np.array([-1.45, 2.15, 0.3])
"""How hip, knee and ankle are bent [rad] of a leg that is held up: as recorded (CMU 49_02, 49_03)."""
DROPS = np.array([0.3, -0.2, 0.0])
"""How much less as the other leg gives, for it falls with the body and swings up with the push [rad]."""


def hopping(keys: np.ndarray, off: int | None, onto: int | None) -> np.ndarray:
    """The same keys (ROWS, COLUMNS) of one who hops off a foot onto a foot, 0 left, 1 right, None both: the other leg is held up."""
    keys = keys.copy()
    fall = np.clip(1.0 - np.abs(np.arange(len(keys)) - np.array([[BETWEEN], [4 * BETWEEN]])) / BETWEEN, 0.0, 1.0).max(0)
    held = HELD + fall[:, None] * DROPS
    for foot, rows in ((off, slice(0, 2 * BETWEEN + 1)), (onto, slice(3 * BETWEEN, None))):
        if foot is not None:
            free = slice(LEGS + EACH * (1 - foot), LEGS + EACH * (2 - foot))
            keys[rows, free] = held[rows]
    for side in (0, 1):  # in the air from how it was to how it will be
        leg = slice(LEGS + EACH * side, LEGS + EACH * (side + 1))
        before, after = off == 1 - side, onto == 1 - side
        if before or after:
            share = np.linspace(0.0, 1.0, BETWEEN + 1)[:, None]
            mixed = keys[2 * BETWEEN:3 * BETWEEN + 1, leg]
            if before and after:
                mixed = np.tile(HELD, (BETWEEN + 1, 1))
            elif after:
                mixed = (1.0 - share**0.7) * mixed + share**0.7 * HELD
            else:
                mixed = (1.0 - share) * HELD + share * mixed
            keys[2 * BETWEEN:3 * BETWEEN + 1, leg] = mixed
    return keys
