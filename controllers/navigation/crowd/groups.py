"""People who walk together: side by side, at one pace, whatever parts them for a while."""

from __future__ import annotations

import numpy as np

BESIDE = 0.78
"""People who walk together walk so far beside each other [m]."""
GAIN, MOST = 0.9, 0.45
"""How fast they come back beside each other, for each metre that they are off [1/s], and at most [m/s]."""
NEAR = 6.0
"""Who is farther from the middle of his group [m] is waited for no more."""


def together(places, wishes, groups) -> np.ndarray:
    """Wishes (N, 2) [m/s] of walkers at places (N, 2) who walk in groups: all of one group go the same way at the same pace, abreast.

    groups: (N,) whole numbers, the same for those who walk together, below 0 for who walks alone. Whoever does not wish to walk is not waited for.
    ValueError for groups of another shape.
    """
    places, found, groups = np.asarray(places, float), np.array(wishes, float), np.asarray(groups, int)
    if groups.shape != (len(places),):
        raise ValueError(f"groups must be ({len(places)},), a number for each walker; got shape {groups.shape}")
    wished = np.linalg.norm(found, axis=1)
    for group in np.unique(groups[groups >= 0]):
        members = np.flatnonzero((groups == group) & (wished > 0.2))
        members = members[np.linalg.norm(places[members] - np.median(places[members], axis=0), axis=1) < NEAR] if len(members) else members
        way = found[members].sum(0)
        if len(members) < 2 or np.hypot(*way) < 0.2 * wished[members].sum():
            continue
        way /= np.hypot(*way)
        left, off = np.array([way[1], -way[0]]), places[members] - places[members].mean(0)
        row = np.argsort(np.argsort(off @ left, kind="stable"), kind="stable") - 0.5 * (len(members) - 1)
        back = GAIN * (BESIDE * row[:, None] * left - off)
        back *= np.minimum(MOST / np.maximum(np.linalg.norm(back, axis=1, keepdims=True), 1e-9), 1.0)
        found[members] = wished[members].min() * way + back
    return found
