"""Hands that give a body no time: short bursts of the run key, ways changed before the last one was taken up."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.locomotion.step import SINKS, held_up_kernel
from playing import FPS, play

FLIGHT = 0.25
"""No stride of a run of 3.5 m/s or less, and no step of a walk, has longer without a foot on the floor [s]."""


def bursts(count):
    """Wishes (T, count, 3) to run for a moment out of a rest or a walk that is a little longer for each, twice, and to stop."""
    wish = np.zeros((round(6.5 * FPS), count, 3))
    for n in range(count):
        at = 10
        for k, (seconds, asked) in enumerate(((0.6, 3.0), (0.5, 0.0), (0.5 + 0.02 * n, 1.2), (0.3 + 0.015 * n, 3.0), (0.3, 0.8 * (n % 2)), (0.5, 3.0))):
            until = at + round(seconds * FPS)
            wish[at:until, n] = asked, (-1.2, 0.0, 1.2)[n % 3] * (k == 2), 0.0
            at = until
    return wish


def longest(mask):
    """How many frames of a mask (T,) on end are true at most."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(int), [0]])))
    return int(np.max(edges[1::2] - edges[::2], initial=0))


def test_nobody_is_carried_through_the_air_as_gaits_change(locomotion):
    """Who begins to run as his hips would go down, and walks again at once, keeps a foot on the floor for all but a run's flight."""
    motion = play(locomotion, bursts(36))
    stands = np.array([s.contacts for s in motion.states]).any(-1)
    assert max(longest(~stands[:, n]) for n in range(stands.shape[1])) < FLIGHT * FPS


@given(st.floats(-0.2, 0.2), st.floats(-1.5, 1.5), st.integers(2, 40))
def test_what_holds_hips_up_goes_the_same_way_in_any_steps(x, v, pieces):
    """Exact over any step, and never over the ground by more than what it rises by in the shorter half-life."""
    once = held_up_kernel(x, v, 0.18, 0.4)
    at, most = (x, v), x
    for _ in range(pieces):
        at = held_up_kernel(*at, 0.18, 0.4 / pieces)
        most = max(most, at[0])
    assert np.allclose(once, at, atol=1e-9)
    assert most <= max(x, 0.0) + max(v, 0.0) * SINKS * 0.18 / (2.0 * np.log(2.0)) / np.e + 1e-9
