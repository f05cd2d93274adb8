"""Ways round what stands about: distances are true, ways keep them, and what can be reached is reached."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.navigation.obstacles import gap
from gambol.controllers.navigation.planning import HUMAN, PUBLISHED, plan
from gambol.controllers.navigation.planning.limits import keep_clear, keep_velocity
from gambol.controllers.navigation.routes import clear, distance, grid_way, separation, shapes_of, ways
from gambol.game.scene import Box, Goal, Pillar
from test_plans import LIMITS

CLEARANCE = 0.3
places = st.tuples(st.floats(-4, 4), st.floats(-4, 4))
pillars = st.builds(lambda at, r: Pillar((at[0], 0.0, at[1]), r, 1.0), places, st.floats(0.05, 0.6))
boxes = st.builds(lambda at, w, d, a: Box((at[0], 0.5, at[1]), (w, 1.0, d), a), places, st.floats(0.05, 3), st.floats(0.05, 3), st.floats(-4, 4))
things = st.one_of(pillars, boxes)
WALL = Box((0.0, 1.0, 2.0), (6.0, 2.0, 0.1), 0.0)


def far(way):
    return np.linalg.norm(np.diff(way, axis=0), axis=1).sum()


def nearest(ground, shapes):
    return min(separation(*a[:2], *b[:2], shape) for a, b in zip(ground, ground[1:]) for shape in shapes)


@given(places, things)
def test_a_shape_is_as_far_as_the_thing(place, thing):
    out = np.empty(3)
    there = distance(*place, shapes_of([thing])[0], out)
    assert there == pytest.approx(gap(np.array([[place[0], 0.5, place[1]]]), thing)[0], abs=1e-9) or there < -0.4  # nearer to its top
    if there > 1e-3:
        step = 1e-6
        slope = [(distance(place[0] + a, place[1] + b, shapes_of([thing])[0], np.empty(3))
                  - distance(place[0] - a, place[1] - b, shapes_of([thing])[0], np.empty(3))) / (2 * step) for a, b in ((step, 0), (0, step))]
        assert np.allclose(slope, out[:2], atol=1e-3) and np.hypot(*out[:2]) == pytest.approx(1.0)


@given(places, places, things)
def test_a_stretch_is_as_far_as_the_nearest_of_its_places(a, b, thing):
    shape = shapes_of([thing])[0]
    some = min(distance(*(np.array(a) + t * (np.array(b) - a)), shape, np.empty(3)) for t in np.linspace(0, 1, 400))
    found = separation(*a, *b, shape)
    if found > 0:
        assert found <= some + 1e-9 and some - found <= np.hypot(*np.subtract(a, b)) / 400 + 1e-9
    else:
        assert some < 0.02


def test_only_what_stops_somebody_is_a_shape():
    nothing = [Goal((0.0, 0.0, 0.0)), Box((0, 0.05, 0), (1, 0.1, 1), 0.0), Box((0, 2.5, 0), (1, 0.5, 1), 0.0), Box((0, 0.5, 0), (1, 1, 1), 0.0, slope=0.2)]
    assert shapes_of(nothing).shape == (0, 6)
    assert shapes_of([Box((0, 0.5, 0), (1, 1, 1), 0.0)], floor=1.0).shape == (0, 6), "he stands on it"


@settings(max_examples=30)
@given(places, places, st.lists(things, min_size=1, max_size=6))
def test_ways_keep_clear_and_are_no_longer_than_a_grid_finds(start, goal, around):
    shapes = shapes_of(around)
    if min(distance(*place, shape, np.empty(3)) for place in (start, goal) for shape in shapes) < CLEARANCE:
        return
    found, rough = ways(start, goal, shapes, CLEARANCE), grid_way(start, goal, shapes, CLEARANCE)
    for way in [*found, rough] if len(rough) else found:
        assert np.array_equal(way[0], start) or np.allclose(way[0], start)
        assert np.allclose(way[-1], goal)
        assert all(clear(*a, *b, shapes, CLEARANCE - 1e-9) for a, b in zip(way, way[1:]))
    if found and len(rough):
        assert far(found[0]) <= 1.25 * far(rough) + 1e-9 and [far(w) for w in found] == sorted(far(w) for w in found)


def test_a_pillar_is_passed_on_both_sides():
    one, other = ways((0, 0), (0, 4), shapes_of([Pillar((0.1, 0, 2), 0.3, 1)]), CLEARANCE)
    assert one[1:-1, 0].max() < 0 < other[1:-1, 0].min(), "the shorter way first"


def ring(count=16, radius=1.2):
    angles = np.arange(count) * 2 * np.pi / count
    return [Pillar((radius * np.sin(a), 0.0, 3 + radius * np.cos(a)), 0.2, 1.0) for a in angles]


@pytest.mark.parametrize(("goal", "around", "told"), [
    ((0, 3, 0), ring(), "no way leads there that is 0.45 m wide"), ((0, 1.8, 0), [WALL], "the goal is 0.15 m from something, 0.30 m are needed"),
    ((0, 2, 0), [WALL], "the goal lies in something, or on it and no way leads up: steps rise by 0.21 m at most")])
def test_a_goal_that_cant_be_reached_gives_a_reason(goal, around, told):
    made = plan(np.zeros(3), goal, around=around)
    assert made.reason == told and made.cost == np.inf
    ground, velocity = made.at(1.0)
    assert np.array_equal(ground, np.zeros(3)) and np.array_equal(velocity, np.zeros(3)), "whoever has no plan stays"


def test_who_starts_near_a_wall_leaves_it():
    made = plan((0.0, 1.8, 0.0), (0.0, -1.0, 0.0), around=[WALL], limits=LIMITS)
    assert made.reason == "" and nearest(made.sampled(300)[1], shapes_of([WALL])) > 0.14
    assert plan((0.0, 2.0, 0.0), (0.0, -1.0, 0.0), around=[WALL]).reason == "the walk starts within something"


@pytest.mark.few(1)
@pytest.mark.parametrize("weights", [PUBLISHED, HUMAN], ids=["published", "human"])
def test_rooms_are_crossed_and_nothing_is_touched(weights):
    rng = np.random.default_rng(4)
    done = 0
    while done < 12:
        around = [Pillar((*rng.uniform(-2, 2, 1), 0.0, *rng.uniform(0.8, 5.2, 1)), rng.uniform(0.1, 0.4), 1.0) for _ in range(5)]
        around += [Box((*rng.uniform(-2, 2, 1), 0.5, *rng.uniform(0.8, 5.2, 1)), (*rng.uniform(0.1, 1.5, 1), 1.0, *rng.uniform(0.1, 1.5, 1)),
                       rng.uniform(-3, 3)) for _ in range(5)]
        shapes = shapes_of(around)
        goal = np.array([0.0, 6.0, rng.uniform(-3, 3)])
        if min(distance(*place[:2], shape, np.empty(3)) for place in (np.zeros(3), goal) for shape in shapes) < CLEARANCE:
            continue
        done += 1
        made = plan(np.zeros(3), goal, weights=weights, limits=LIMITS, around=around)
        assert made.reason == "" or not len(grid_way((0, 0), goal[:2], shapes, CLEARANCE, 0.025))
        assert made.reason or nearest(made.sampled(600)[1], shapes) > CLEARANCE - 1e-3
        assert made.cost > plan(np.zeros(3), goal, weights=weights, limits=LIMITS).cost * 0.98


def test_the_derivatives_of_limits_are_their_derivatives():
    rng = np.random.default_rng(0)
    shapes = shapes_of([Pillar((0.3, 0, 0.2), 0.4, 1.0)])
    for _ in range(20):
        y, seconds = rng.uniform(-1, 1, 9), rng.uniform(1, 3)
        by_plane, by_shape = rng.uniform(0, 2, len(LIMITS)), rng.uniform(5, 9, 1)

        def penalties(x, t, by_plane=by_plane, by_shape=by_shape):
            g, h, m = np.zeros(9), np.zeros((9, 9)), np.zeros(9)
            cost, by_t, _, _ = keep_velocity(x, t, LIMITS, by_plane, 3.0, 1.0, g, h, m)
            near, _ = keep_clear(x, shapes, np.full(3, 0.5), by_shape, 20.0, 1.0, g, h)
            return cost + near, np.append(g, by_t)

        slopes = [(penalties(y + e[:9], seconds + e[9])[0] - penalties(y - e[:9], seconds - e[9])[0]) / 2e-6 for e in 1e-6 * np.eye(10)]
        assert np.allclose(slopes, penalties(y, seconds)[1], atol=1e-4)
