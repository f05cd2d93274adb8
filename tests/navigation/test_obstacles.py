"""Walkers keep out of what stands about, whatever their speed, and get out again where they stand in it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation import steer
from gambol.controllers.navigation.obstacles import HEAD, SHOULDER, changed, floor_at, gap, matters, slide
from gambol.game.scene.scene import Box, Pillar

BOX = Box((0.0, 0.3, 4.0), (1.6, 0.6, 1.0), 0.0)
WALL = Box((0.0, 0.5, 4.0), (2.6, 1.0, 0.1), 0.4)
angles = st.floats(-np.pi, np.pi)
speeds = st.floats(0.1, 4.0)


@pytest.mark.parametrize("thing", [BOX, WALL], ids=["box", "wall"])
@pytest.mark.parametrize("speed", [1.3, 3.2])
def test_nobody_walks_or_runs_into_a_box(thing, speed):
    """Steered as in play, where somebody turns to where he goes."""
    walker = Locomotion.load()
    for aside in (0.0, 0.7):
        state, nearest = walker.start((aside, 0.0, 0.0)), np.inf
        for _ in range(240):
            wish = slide(state.ground[:2], (0.0, speed), 0.0, [thing])
            state, _ = walker.step(state, steer(state.ground, wish, turning=state.velocity[1]), 1 / 60)
            nearest = min(nearest, gap(np.array([[state.ground[0], 0.5, state.ground[1]]]), thing)[0])
        assert 0.1 < nearest < 1.0, "he came to it, and not into it"


@given(angles, speeds)
def test_with_nothing_near_a_wish_stays_as_it_is(angle, speed):
    wish = speed * np.array([np.sin(angle), np.cos(angle)])
    assert np.array_equal(slide((0.0, -5.0), wish, 0.0, [BOX]), wish)
    assert np.array_equal(slide((0.0, 3.0), wish, 0.0, []), wish)


@given(angles, st.floats(0.0, 0.29), speeds)
def test_who_came_too_near_may_only_leave(angle, away, speed):
    """The way he is let go leads from the wall."""
    place = np.array([0.2, 3.5 - away])
    found = slide(place, speed * np.array([np.sin(angle), np.cos(angle)]), 0.0, [BOX])
    assert np.array_equal(found, np.zeros(2)) or found[1] < 0.0


@given(angles, speeds)
def test_what_is_left_of_a_wish_is_its_part_along_the_way_that_is_free(angle, speed):
    wish = speed * np.array([np.sin(angle), np.cos(angle)])
    found = slide((0.0, 3.0), wish, 0.0, [BOX])
    assert found @ found == pytest.approx(wish @ found, abs=1e-12)


def test_edges_stop_and_what_hangs_high_does_not():
    on_top = (0.0, 4.0)
    assert floor_at(*on_top, [BOX]) == pytest.approx(0.6)
    assert slide((0.0, 4.3), (0.0, 1.0), 0.6, [BOX])[1] < 0.5, "it is an edge"
    beam = Box((0.0, HEAD + SHOULDER + 0.2, 1.0), (2.0, 0.2, 0.2), 0.0)
    assert np.array_equal(slide((0.0, 0.0), (0.0, 1.0), 0.0, [beam]), (0.0, 1.0))


@pytest.mark.parametrize("wide, stops", [(0.03, False), (0.12, False), (0.25, False), (0.5, True)])
@pytest.mark.parametrize("askew", [0.0, 0.6])
def test_sticks_lead_over_crevices_and_stop_at_gaps(wide, stops, askew):
    """From any place before it, on it and beyond: who stood with his middle over a crevice could not go on."""
    things = [Box((0.0, 0.3, 0.0), (9.0, 0.6, 4.0)), Box((0.0, 0.3, 4.0 + wide), (9.0, 0.6, 4.0))]
    wish = 1.3 * np.array([np.sin(askew), np.cos(askew)])
    if not stops:
        for z in np.arange(1.5, 2.5, 0.02):
            assert np.array_equal(slide((0.0, z), wish, 0.6, things), wish)
    else:
        place = np.array([0.0, 0.0])
        for _ in range(240):
            place = place + slide(place, wish, 0.6, things) / 60
        assert place[1] < 2.0


def test_what_changed_is_told_whatever_its_numbers_are_held_in_and_as_it_was_and_is():
    still, moved, gone = Box((0, 1, 2), (1, 2, 3)), Box((5, 1, 2), (1, 2, 3)), Pillar((3, 0, 3))
    later = Box((5.2, 1, 2), (1, 2, 3))
    as_arrays = Box(np.array([0.0, 1.0, 2.0]), np.array([1.0, 2.0, 3.0]))
    assert changed((still, moved, gone), (as_arrays, later)) == [moved, later, gone]
    assert changed((still, moved), (as_arrays, later), 0.3) == []
    assert changed((still,), (Box((0, 1, 2), (1, 2, 3), heading=0.1),), 0.3) != []


def test_what_matters_to_a_way_is_what_a_shorter_one_could_lead_past():
    assert matters([Box((1.0, 1, 2.0), (1, 2, 1))], (0, 0), (0, 4), 4.5)
    assert not matters([Box((3.0, 1, 2.0), (1, 2, 1))], (0, 0), (0, 4), 4.5)
    assert matters([Pillar((3.0, 0, 2.0))], (0, 0), (0, 4), 7.0), "round about it might be as short"
    assert not matters([], (0, 0), (0, 4), 100.0)


@pytest.mark.parametrize("slope", [-2.5, 1.2, 4.0])
def test_a_ramp_too_steep_to_walk_on_holds_up(slope):
    """He walked through the inside of it."""
    locomotion, ramp = Locomotion.load(), Box((0.0, 3.0 * abs(slope) - 20.0, 5.0), (3.0, 40.0, 6.0), np.pi * (slope < 0.0), slope=slope)
    state = locomotion.start()
    for _ in range(240):
        state, _ = locomotion.step(state, Intent(np.array([1.2, 0.0, 0.0]), around=(ramp,)), 1 / 60)
    assert 1.5 < state.ground[1] < 2.0 - 0.15 and state.floor < 0.05
