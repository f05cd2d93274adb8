"""Sampling finds about the crouch that control finds, and says what it tried."""

from functools import cache

import numpy as np
import pytest

from gambol.controllers.jump.body.dynamics import Physique
from gambol.controllers.jump.muscles.sampling import sample
from gambol.controllers.jump.muscles.windup import crouch

ADULT = Physique()
COUNT = 600
LEAPS = ((0.0, 2.4, 0.0), (0.0, 2.2, 1.2))


@cache
def sampled(wish):
    """What is asked of several tests: two milliseconds a sample."""
    return sample(ADULT, wish, 0.109, count=COUNT)


def misses(found, wish):
    return np.linalg.norm(found.momenta - ADULT.mass * np.asarray(wish), axis=-1)


@pytest.mark.few(1)
@pytest.mark.parametrize("wish", LEAPS, ids=str)
def test_the_best_sample_is_the_most_balanced_of_the_nearest_tenth(wish):
    found = sampled(wish)
    miss = misses(found, wish)
    assert 50 < found.possible.sum() < len(found.tried)
    tenth = np.sort(miss[found.possible])[found.possible.sum() // 10 - 1]  # the thesis: ten percent
    near = found.possible & (miss <= tenth)
    assert found.balance == found.balances[near].min()
    assert found.balance > found.balances[found.possible].min()  # of all, another would be chosen
    best = int(np.flatnonzero((found.tried == found.pelvis).all(1))[0])
    np.testing.assert_array_equal(found.momentum, found.momenta[best])
    assert miss[best] <= tenth and found.depth == pytest.approx(crouch(ADULT, wish, 0.109).depth, abs=0.06)


def test_momenta_go_where_the_jump_goes():
    wish = np.array([0.3, 2.2, 1.2])
    found = sample(ADULT, wish, 0.109, count=100)
    np.testing.assert_allclose(np.cross(found.momenta[found.possible], wish), 0.0, atol=1e-9)


@pytest.mark.few(1)
@pytest.mark.parametrize("wish", LEAPS, ids=str)
def test_what_the_muscles_give_is_what_control_asks_of_them(wish):
    """As deep as control ends, flat feet give about the wished momentum: both read the same muscles."""
    low, found = crouch(ADULT, wish, 0.109), sampled(wish)
    near = np.argsort(misses(found, wish))[:4]
    assert np.median(misses(found, wish)[near]) < 0.01 * ADULT.mass * np.linalg.norm(wish)
    level = found.tried[near, 1]  # pelvises that give it lie about as low
    assert abs(np.median(level) - low.pelvis[1]) < 0.06


def test_seeds_vary_and_repeat():
    def of(seed):
        return sample(ADULT, 2.4, 0.109, count=60, seed=seed).tried
    np.testing.assert_array_equal(of(3), of(3))
    assert np.abs(of(3) - of(4)).max() > 0.01


def test_what_can_not_be_sampled_is_told():
    with pytest.raises(ValueError, match="none of 5"):
        sample(Physique(flexibility=0.3), 2.4, 0.1, count=5)
    with pytest.raises(ValueError, match="must rise"):
        sample(ADULT, [0.0, 0.0, 1.0], 0.1, count=5)
