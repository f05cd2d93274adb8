"""What walking in a group adds to a wish: one way, the slowest's pace, and no more than a step aside."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.navigation.crowd.groups import BESIDE, MOST, together

numbers = st.floats(-2.5, 2.5)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(numbers, numbers, st.floats(0.5, 2.0)), min_size=2, max_size=6), st.floats(0.0, 6.3))
def test_nobody_hurries_more_to_his_place_than_he_may(people, heading):
    places, ahead = np.array([one[:2] for one in people]), np.array([np.sin(heading), np.cos(heading)])
    wishes = np.array([[one[2]] for one in people]) * ahead
    found = together([*places, [0.3, 0.0]], [*wishes, [0.0, 1.0]], [0] * len(people) + [-1])
    assert np.array_equal(found[-1], [0.0, 1.0])  # who walks alone
    pace = wishes @ ahead
    assert (np.linalg.norm(found[:-1] - pace.min() * ahead, axis=1) <= MOST + 1e-9).all()


@settings(max_examples=30, deadline=None)
@given(st.integers(2, 6), st.floats(0.0, 6.3), st.floats(0.0, 0.2))
def test_who_walk_abreast_go_on_so_and_who_lags_catches_up(count, heading, lag):
    ahead = np.array([np.sin(heading), np.cos(heading)])
    left = np.array([ahead[1], -ahead[0]])
    places = BESIDE * np.arange(count)[:, None] * left
    wishes = np.tile(1.2 * ahead, (count, 1))
    np.testing.assert_allclose(together(places, wishes, [7] * count), wishes, atol=1e-9)
    places[0] -= lag * ahead
    found = together(places, wishes, [7] * count) @ ahead
    assert (found[0] - found[1:] >= 0.5 * lag - 1e-9).all()
