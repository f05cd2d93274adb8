"""What a mask says of somebody: where they are, where they are not, and where nobody can tell, as another person stands there.

Such a mask is (H, W) bool, or where others are seen, too, (H, W) int8: 1 where somebody is, 0 where not, `HIDDEN` where others are.
"""

from __future__ import annotations

import numpy as np

HIDDEN = -1
"""In a mask of int8 a pixel of somebody else's: who is looked for may be behind it."""


def of_person(people: np.ndarray, person: int) -> np.ndarray:
    """Somebody's mask among those of all people (H, W), 0 where nobody is, 1 for person 0, …"""
    own = people == person + 1
    if np.count_nonzero(own) == np.count_nonzero(people):
        return own
    return np.where(own, 1, np.where(people != 0, HIDDEN, 0)).astype(np.int8)


def is_mask(seen: np.ndarray) -> bool:
    """Whether what a camera saw is a mask, not a picture."""
    return seen.dtype in (np.bool_, np.int8)


def own(mask: np.ndarray) -> np.ndarray:
    """Where a mask shows whom it is of (H, W) bool."""
    return mask if mask.dtype == np.bool_ else mask > 0


def hidden(seen: np.ndarray | None) -> np.ndarray | None:
    """Where a mask can't tell (H, W) bool; None where it always can, and of a picture."""
    return seen < 0 if seen is not None and seen.dtype == np.int8 else None
