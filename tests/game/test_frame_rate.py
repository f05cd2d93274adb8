"""Frame rates: exact whatever way they are written, and refused where they are none."""

from fractions import Fraction

import pytest
from hypothesis import given, strategies as st

from gambol.game.files import frame_rate, plain


@given(st.integers(1, 240))
def test_whole_rates_stay_as_they_are(rate):
    for told in (rate, float(rate), str(rate), Fraction(rate)):
        assert frame_rate(told) == rate
    assert type(plain(frame_rate(rate))) is int


@pytest.mark.parametrize("told, whole", [("23.976", 24), ("23.98", 24), (29.97, 30), ("30000/1001", 30), (59.94, 60), ("59.9401", 60), ("119.88", 120)])
def test_rates_of_television_are_whole_ones_slowed_down(told, whole):
    assert frame_rate(told) == Fraction(whole * 1000, 1001)


@given(st.fractions(1, 240, max_denominator=1001))
def test_what_a_file_tells_is_what_was_written(rate):
    """As a number in JSON and back."""
    assert frame_rate(plain(frame_rate(rate))) == frame_rate(rate)
    assert 1 <= frame_rate(rate) and abs(frame_rate(rate) - rate) <= Fraction(5, 1000)


def test_slow_rates_stay_possible_and_cameras_may_be_faster():
    assert frame_rate("1.001") >= 1 and frame_rate(300, 1000) == 300


@pytest.mark.parametrize("told", ["", "fast", "0", "-3", "241", "nan", "inf", "1/0", "1/2/3", None, True, [30]])
def test_what_is_none_is_refused_by_what_would_be_right(told):
    with pytest.raises(ValueError, match="needs frames a second from 1 to 240, such as 30, 29.97 or 30000/1001; got"):
        frame_rate(told)
