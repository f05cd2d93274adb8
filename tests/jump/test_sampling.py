"""Sampling finds about the crouch that control finds, and says what it tried."""

import numpy as np
import pytest

from controllers.jump.dynamics import Physique
from controllers.jump.sampling import KEPT, sample
from controllers.jump.windup import crouch


def test_the_best_sample_is_the_most_balanced_of_the_nearest_tenth():
    physique, wish = Physique(), 2.4
    found = sample(physique, wish, 0.109, count=1000)
    assert 0 < found.possible.sum() < len(found.tried)
    miss = np.abs(found.momenta - physique.mass * wish)[found.possible]
    assert abs(found.momentum - physique.mass * wish) <= np.quantile(miss, KEPT) + 1e-9
    near = found.possible & (np.abs(found.momenta - physique.mass * wish) <= np.quantile(miss, KEPT))
    assert found.balance == pytest.approx(found.balances[near].min())
    assert found.depth == pytest.approx(crouch(physique, wish, 0.109).depth, abs=0.1)
    assert sample(physique, wish, 0.109, count=200).depth == sample(physique, wish, 0.109, count=200).depth


def test_a_body_that_can_take_no_sample_is_told():
    with pytest.raises(ValueError, match="none of 5"):
        sample(Physique(flexibility=0.3), 2.4, 0.1, count=5)
