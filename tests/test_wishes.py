"""Wishes of a wrong kind are refused where they are made, by the name of the field; and states of another controller where they are given."""

import numpy as np
import pytest

from gambol.controllers.contract import Goal, Intent, Leap, Strike
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.person import person


@pytest.mark.parametrize("fields, says", [
    ({"goal": (1, 2)}, "goal is a Goal"), ({"velocity": 1.0}, "a velocity is"), ({"velocity": None}, "a velocity is"), ({"velocity": [1, 0]}, "a velocity is"),
    ({"around": (1, 2)}, "what stands about has"), ({"around": ({},)}, "what stands about has"), ({"around": None}, "around is a sequence"),
    ({"velocity": ("a", "b", "c")}, "a velocity is"), ({"velocity": np.array([None, 0, 0])}, "a velocity is"), ({"velocity": np.array([1j, 0, 0])}, "a velocity is"),
    ({"velocity": [[1, 0], [0]]}, "a velocity is"), ({"look": np.zeros(2)}, "intent's look is"), ({"look": "there"}, "intent's look is"),
    ({"halt": np.zeros(2)}, "intent's halt is .* x, z .*, heading"), ({"towards": np.zeros(3)}, "intent's towards is"), ({"towards": "x"}, "intent's towards is"),
    ({"aside": np.zeros(7)}, "intent's aside is"), ({"aside": (None, 0, 0)}, "intent's aside is"),
    ({"leap": (0, 0, 1)}, "leap is a Leap"), ({"strike": 50}, "strike is a Strike")])
def test_an_intent_names_the_field_that_is_of_another_kind(fields, says):
    with pytest.raises(ValueError, match=says):
        Intent(**fields)


def test_wishes_that_are_not_finite_are_none_and_refused_nowhere():
    somebody = person()
    state, nan = somebody.start(), np.full(3, np.nan)
    for intent in (Intent(nan), Intent(look=nan), Intent((1, 0, 0), halt=nan, towards=nan[:2]), Intent(np.array([np.inf, 0, 0], np.float32), aside=nan)):
        assert np.isfinite(somebody.step(state, intent, 1 / 60)[1].rotations).all()


@pytest.mark.parametrize("fields", [{"slack": np.nan}, {"slack": -1.0}, {"slack": "x"}, {"airtime": "x"}, {"heading": [1.0, 2.0]}])
def test_a_leap_names_the_field_that_is_no_number(fields):
    with pytest.raises(ValueError, match=f"a leap's {next(iter(fields))}"):
        Leap(np.zeros(3), **fields)
    with pytest.raises(ValueError, match="a leap's place"):
        Leap("here")  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize("wish, says", [
    (lambda: Goal((0, 1), heading="x"), "a goal's heading"), (lambda: Goal((0, 1), heading=[1.0, 2.0]), "a goal's heading"),
    (lambda: Goal((0, 1), within="x"), "a goal's time"),
    (lambda: Strike((1.0, 0.0), height="x"), "a strike's height"), (lambda: Strike((1.0, 0.0), height=[1.0]), "a strike's height"),
    (lambda: Leap(None, slack=None), "a leap's slack")])
def test_what_is_no_number_is_named(wish, says):
    with pytest.raises(ValueError, match=says):
        wish()


def test_a_body_is_a_physique():
    with pytest.raises(ValueError, match="physique is a Physique, such as"):
        person(physique={"height": 1.2})  # pyright: ignore[reportArgumentType]


def test_what_a_person_is_given_is_one_persons_and_its_own():
    somebody = person()
    with pytest.raises(ValueError, match="come singly"):
        somebody.start(np.zeros((2, 3)))
    with pytest.raises(ValueError, match="enter it first"):
        somebody.step(Locomotion.load().start(), Intent(), 1 / 60)


def test_a_step_may_be_as_short_as_rounding_leaves_it_and_a_goal_not_too_far():
    somebody = person()
    state = somebody.start()
    state, pose = somebody.step(state, Intent(np.array([1.0, 0.0, 0.0])), 7e-18)
    assert np.isfinite(pose.rotations).all()
    for _ in range(30):
        state, _ = somebody.step(state, Intent(goal=Goal((0.0, 1e4))), 1 / 60)
    assert somebody.status(state).kind == "failed" and "10000 m away" in somebody.status(state).reason
