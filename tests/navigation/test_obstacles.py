"""Walkers keep out of what stands about, whatever their speed, and get out again where they stand in it."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation import steer
from gambol.controllers.navigation.obstacles import HEAD, SHOULDER, changed, clearance, floor_at, floors_at, free_way, gap, matters, room, rooms, slide, solids_of
from gambol.game.scene.scene import Box, Pillar

BOX = Box((0.0, 0.3, 4.0), (1.6, 0.6, 1.0), 0.0)
WALL = Box((0.0, 0.5, 4.0), (2.6, 1.0, 0.1), 0.4)
angles = st.floats(-np.pi, np.pi)
speeds = st.floats(0.1, 4.0)


@pytest.mark.few(2)
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


@pytest.mark.few(2)
@pytest.mark.parametrize("slope", [-2.5, 1.2, 4.0])
def test_a_ramp_too_steep_to_walk_on_holds_up(slope):
    """He walked through the inside of it."""
    locomotion, ramp = Locomotion.load(), Box((0.0, 3.0 * abs(slope) - 20.0, 5.0), (3.0, 40.0, 6.0), np.pi * (slope < 0.0), slope=slope)
    state = locomotion.start()
    for _ in range(240):
        state, _ = locomotion.step(state, Intent(np.array([1.2, 0.0, 0.0]), around=(ramp,)), 1 / 60)
    assert 1.5 < state.ground[1] < 2.0 - 0.15 and state.floor < 0.05


def scattered(seed):
    """Boxes, ramps and pillars at random, and a place that things stop nobody at."""
    rng = np.random.default_rng(seed)
    boxes = [Box(tuple(rng.uniform(-2.0, 2.0, 3)), tuple(rng.uniform(0.1, 2.0, 3)), rng.uniform(-3.0, 3.0), slope=rng.choice([0.0, rng.uniform(-0.3, 0.3)])) for _ in range(4)]
    pillars = [Pillar(tuple(rng.uniform(-2.0, 2.0, 3)), rng.uniform(0.05, 0.5), rng.uniform(0.2, 2.0)) for _ in range(2)]
    return (*boxes, SimpleNamespace(place=(0.0, 0.0, 0.0)), *pillars)


@given(st.integers(0, 10**6))
def test_all_things_at_once_are_as_one_after_the_other(seed):
    things, rng = scattered(seed), np.random.default_rng(seed + 1)
    points, places, floor = rng.uniform(-3.0, 3.0, (2, 5, 3)), rng.uniform(-3.0, 3.0, (2, 5, 2)), rng.uniform(-0.2, 1.0)
    assert np.array_equal(clearance(points, things), np.min([[gap(row, thing) for row in points] for thing in things], 0))
    each = [[max(floor_at(x, z, [thing], floor) for thing in things) for x, z in row] for row in places]
    assert np.array_equal(floors_at(places, things, floor), each)
    assert np.array_equal(rooms(places, floor, things), [[room(place, floor, things) for place in row] for row in places])
    assert (clearance(points, things[4:5]) == np.inf).all()


@given(st.integers(0, 10**6), st.floats(0.0, 0.3))
def test_a_ray_is_free_until_it_is_in_what_is_swollen(seed, margin):
    """Marched along in small steps, where things are swollen by measuring from larger ones."""
    things, rng = scattered(seed), np.random.default_rng(seed + 1)
    large = [replace(thing, size=tuple(np.add(thing.size, 2.0 * margin))) if isinstance(thing, Box) else
             replace(thing, foot=tuple(np.subtract(thing.foot, (0.0, margin, 0.0))), radius=thing.radius + margin, height=thing.height + 2.0 * margin)
             for thing in things if isinstance(thing, (Box, Pillar))]
    origin, way = rng.uniform(-3.0, 3.0, 3), rng.normal(size=3)
    way /= np.linalg.norm(way)
    far = np.arange(0.0, 8.0, 0.004)
    within = clearance(origin + far[:, None] * way, large) < 0.0
    free = free_way(origin, way[None], things, margin)[0]
    assert not within[far < free - 1e-9].any()
    if free < far[-1] - 0.01:
        deepest = clearance(origin + (free + np.linspace(0.0, 0.004, 9))[:, None] * way, large).min()
        assert deepest < 1e-6, "it meets something there"


def test_what_can_be_moved_is_looked_at_anew_and_what_can_not_only_once():
    """A tuple may hold things that its owner moves between two steps."""
    crate = SimpleNamespace(centre=[0.0, 0.5, 0.0], size=(1.0, 1.0, 1.0), heading=0.0)
    moved, fixed = (crate,), (BOX, WALL)
    assert floor_at(0.0, 0.0, moved) == 1.0
    crate.centre[0] = 3.0
    assert floor_at(0.0, 0.0, moved) == 0.0 and floor_at(3.0, 0.0, moved) == 1.0
    in_array = (Box(np.zeros(3), (1.0, 1.0, 1.0), 0.0),)  # frozen, but for what it holds
    assert floor_at(0.0, 0.0, in_array) == 0.5
    in_array[0].centre[1] = 1.0
    assert floor_at(0.0, 0.0, in_array) == 1.5
    assert solids_of(fixed) is solids_of(fixed) and solids_of(moved) is not solids_of(moved)
