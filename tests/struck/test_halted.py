"""How who fell on uneven ground comes to rest: on the way he fell, ever slower, to the end."""

import numpy as np

from gambol.controllers.body import exp
from gambol.controllers.struck.toppling import HALTS, _halted


def turned(way):
    """Rotations (N, 3, 3, 3) of three joints that turn evenly about one axis."""
    return np.repeat(exp(np.array([0.0, 0.04, 0.01])) @ exp(way[:, None, None] * np.array([0.02, 0.0, 0.0])), 3, axis=1)


def test_a_body_that_halts_goes_the_same_way_ever_slower_and_rests_at_its_end():
    count = HALTS + 7
    share = np.arange(count)[:, None]
    roots, facing = share * [0.01, -0.002, 0.02], 2.0 + 0.03 * share[:, 0]
    local = turned(share[:, 0])
    slow_roots, slow_local, slow_facing = _halted(roots, local, facing)
    assert len(slow_roots) == len(slow_local) == len(slow_facing) == count + HALTS
    begun = count - HALTS
    for slow, was in ((slow_roots, roots), (slow_local, local), (slow_facing, facing)):
        assert np.array_equal(slow[:begun], was[:begun])
        np.testing.assert_allclose(slow[-1], was[-1], atol=1e-6)
    way = slow_roots[:, 2] / 0.02  # how far it is, in moments of the fall
    assert (np.diff(way) > 0.0).all() and (np.diff(way, 2) < 1e-9).all() and way[-1] - way[-2] < 0.02
    np.testing.assert_allclose(slow_facing, 2.0 + 0.03 * way, atol=1e-6)
    np.testing.assert_allclose(slow_local, turned(way), atol=1e-5)
