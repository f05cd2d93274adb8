"""Laws of walks to goals: ends and limits are kept, cost is what it says, and less of it is not to be had."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body.ground_frame import compose
from gambol.controllers.body.rotations import wrap
from gambol.controllers.locomotion import Library, Locomotion
from gambol.controllers.locomotion.controller import DEFAULT_LIBRARY
from gambol.controllers.locomotion.velocity_correction import space_of
from gambol.controllers.navigation.planning import FREE, HUMAN, PUBLISHED, Weights, WeightsError, in_toml, plan, plans, read_weights
from gambol.controllers.navigation.planning.goal_planner import ALLOWED
from gambol.controllers.navigation.planning.walking_cost import FADE, stage

LIMITS = space_of(Library.load(DEFAULT_LIBRARY), "walk").half_spaces()
REST = np.zeros(3)
far = st.floats(-5.0, 5.0)
angle = st.floats(-np.pi, np.pi)
goals = st.builds(lambda x, z, a: np.array([x, z, a]), far, far, angle).filter(lambda goal: np.hypot(*goal[:2]) > 0.01)
starts = st.builds(lambda f, w, s: np.array([f, w, s]), st.floats(-0.4, 1.2), st.floats(-1.0, 1.0), st.floats(-0.3, 0.3))
few = settings(max_examples=25)


def rate_of_cost(made, times, weights):
    """The integrand (N,) of J, from poses and accelerations alone."""
    ground, _ = made.at(times)
    u = made.acceleration(times)
    dx, dz = (made.goal[:2] - ground[:, :2]).T
    psi = wrap(np.arctan2(dx, dz) - ground[:, 2])
    fade = 1.0 - np.exp(-(dx**2 + dz**2) / FADE**2)
    return weights.time + weights.forward * u[:, 0]**2 + weights.turning * u[:, 1]**2 + weights.lateral * u[:, 2]**2 + weights.facing * fade * psi**2


@few
@given(goals, starts, st.sampled_from([PUBLISHED, HUMAN]))
def test_a_plan_begins_as_the_walker_moves_and_ends_at_rest_at_the_goal(goal, velocity, weights):
    made = plan(REST, goal, velocity, weights)
    assert made.reason == "" and 0.0 < made.seconds < 60.0
    ground, moving = made.at(np.array([0.0, made.seconds]))
    assert np.allclose(ground[0], REST, atol=1e-9) and np.allclose(moving[0], velocity, atol=1e-9)
    assert np.allclose(ground[1, :2], goal[:2], atol=1e-9) and abs(wrap(ground[1, 2] - goal[2])) < 1e-9
    assert np.allclose(moving[1], 0.0, atol=1e-9)


@few
@given(goals, starts, st.floats(0.5, 1.35))
def test_a_plan_may_end_on_the_move(goal, velocity, pace):
    made = plan(REST, goal, velocity, limits=LIMITS, leaving=(pace, 0.0, 0.0))
    assert made.reason == "" and 0.0 < made.seconds < 60.0
    ground, moving = made.at(made.seconds)
    assert np.allclose(ground[:2], goal[:2], atol=1e-9) and abs(wrap(ground[2] - goal[2])) < 1e-9
    assert np.allclose(moving, [pace, 0.0, 0.0], atol=1e-9)
    times = np.linspace(0.0, made.seconds, 4001)
    middle = 0.5 * (times[1:] + times[:-1])
    assert np.mean(rate_of_cost(made, middle, HUMAN)) * made.seconds == pytest.approx(made.cost, rel=0.02), "its cost is what it says"


def test_on_the_move_a_plan_is_found_that_no_shift_betters():
    """The derivative by the time is right where both ends move: other times cost more."""
    made = plan(REST, (0.5, 4.0, 0.1), (0.8, 0.0, 0.0), leaving=(1.2, 0.0, 0.0))
    straight = plan(REST, (0.5, 4.0, 0.1), (0.8, 0.0, 0.0))
    assert made.cost < straight.cost and made.seconds < straight.seconds, "who need not stop is there sooner, and for less"


@few
@given(goals, starts)
def test_poses_velocities_and_accelerations_are_each_others_rates(goal, velocity):
    made = plan(REST, goal, velocity)
    h = 1e-5 * made.seconds
    times = np.linspace(0.1, 0.9, 7) * made.seconds
    (before, v_before), (after, v_after) = made.at(times - h), made.at(times + h)
    ground, moving = made.at(times)
    s, c = np.sin(ground[:, 2]), np.cos(ground[:, 2])
    rate = (after - before) / (2 * h)
    own = np.stack([s * rate[:, 0] + c * rate[:, 1], rate[:, 2], c * rate[:, 0] - s * rate[:, 1]], -1)
    assert np.allclose(own, moving, atol=1e-5)
    assert np.allclose((v_after - v_before) / (2 * h), made.acceleration(times), atol=1e-3)


@few
@given(goals, st.sampled_from([PUBLISHED, HUMAN]))
def test_the_cost_is_the_integral_that_it_says(goal, weights):
    made = plan(REST, goal, weights=weights)
    times = (np.arange(4000) + 0.5) / 4000 * made.seconds
    assert rate_of_cost(made, times, weights).mean() * made.seconds == pytest.approx(made.cost, rel=3e-3)


@given(st.lists(st.floats(-1.5, 1.5), min_size=9, max_size=9), st.floats(0.5, 3.0))
def test_the_derivatives_of_the_cost_are_its_derivatives(values, seconds):
    y, goal, alpha = np.array(values), np.array([0.7, 1.9, 0.3]), np.array(PUBLISHED)
    if abs(abs(wrap(np.arctan2(*(goal - y[:3])[:2]) - y[2])) - np.pi) < 1e-2 or np.hypot(*(goal - y[:3])[:2]) < 0.05:
        return  # straight behind, where left and right are equally near; or at the goal

    def at(x, t):
        g, h, m = np.empty(9), np.empty((9, 9)), np.empty(9)
        cost, by_t, by_tt = stage(x, goal[:2], alpha, t, g, h, m)
        return cost, np.append(g, by_t), np.block([[h, m[:, None]], [m[None], np.array([[by_tt]])]])

    _, gradient, hessian = at(y, seconds)
    step = 1e-6
    ups, downs = ([at(y + sign * step * e[:9], seconds + sign * step * e[9]) for e in np.eye(10)] for sign in (1, -1))
    slopes = np.array([(up[0] - down[0]) / (2 * step) for up, down in zip(ups, downs)])
    bends = np.array([(up[1] - down[1]) / (2 * step) for up, down in zip(ups, downs)])
    size = 1.0 + np.abs(hessian).max()
    assert np.allclose(slopes, gradient, atol=1e-6 * size) and np.allclose(bends, hessian, atol=1e-6 * size)
    assert np.allclose(hessian, hessian.T, rtol=1e-12, atol=1e-12 * size)


@pytest.mark.parametrize("far", [0.3, 3.0, 12.0])
def test_straight_ahead_is_what_the_calculus_says(far):
    """The least of α₀T + 12 α₁ L²/T³ is at T⁴ = 36 α₁ L²/α₀: 4.44 s for 3 m."""
    made = plan(REST, (0.0, far, 0.0), weights=PUBLISHED)
    seconds = (36.0 * PUBLISHED.forward * far**2) ** 0.25
    assert made.seconds == pytest.approx(seconds, rel=3e-3) and made.cost == pytest.approx(4.0 / 3.0 * seconds, rel=1e-5)


@few
@given(goals, goals, st.sampled_from([FREE, LIMITS]))
def test_where_one_stands_and_looks_makes_no_difference(goal, frame, limits):
    one, other = plan(REST, goal, limits=limits), plan(frame, compose(frame, goal), limits=limits)
    assert other.cost == pytest.approx(one.cost, rel=2e-3)


@few
@given(goals)
def test_left_and_right_are_alike(goal):
    assert plan(REST, goal * [-1, 1, -1]).cost == pytest.approx(plan(REST, goal).cost, rel=2e-3)


@few
@given(goals, st.floats(0.5, 2.0))
def test_slower_people_walk_the_same_way(goal, k):
    """α₁, α₂, α₃ larger by k⁴ and α₄ as it is: the same way in k times the time."""
    slow = Weights(HUMAN.time, *(k**4 * w for w in HUMAN[1:4]), HUMAN.facing)
    one, other = plan(REST, goal), plan(REST, goal, weights=slow)
    assert other.cost == pytest.approx(k * one.cost, rel=2e-3)


@few
@given(goals, starts)
def test_velocities_keep_to_their_limits(goal, velocity):
    """To 0.01 where the search looks; between such places two plans of 1500 are out by 0.06. Who starts faster is out at first."""
    at_first = (velocity @ LIMITS[:, :3].T + LIMITS[:, 3]).max()
    made = plan(REST, goal, velocity, limits=LIMITS)
    assert made.reason == ""
    _, _, moving = made.sampled(301)
    assert (moving @ LIMITS[:, :3].T + LIMITS[:, 3]).max() < max(7 * ALLOWED[0], at_first + ALLOWED[0])
    assert made.cost >= plan(REST, goal, velocity).cost * (1 - 1e-2)


@few
@given(goals, st.floats(0.2, 0.7))
def test_the_rest_of_a_best_way_is_a_best_way(goal, share):
    """Bellman: who plans anew on the way goes on as planned, or finds a better way."""
    made = plan(REST, goal)
    times = (np.arange(2000) + 0.5) / 2000 * share * made.seconds
    spent = rate_of_cost(made, times, HUMAN).mean() * share * made.seconds
    ground, velocity = made.at(share * made.seconds)
    again = plan(ground, made.goal, velocity)
    assert spent + again.cost < made.cost * 1.01


def test_many_goals_at_once_are_each_as_alone():
    rng = np.random.default_rng(0)
    wanted = np.column_stack([rng.uniform(-3, 3, (6, 2)), rng.uniform(-3, 3, 6)])
    for goal, one in zip(wanted, plans(REST, wanted, limits=LIMITS)):
        assert one.cost == pytest.approx(plan(REST, goal, limits=LIMITS).cost, rel=1e-3)


@pytest.mark.parametrize("goal", [(0, 0, 0), (1e-7, 0, 0), (0, 0, 1e-9), (0, 0, np.pi), (1e-3, 0, 0), (0, 1e-3, 3.0), (80, -60, 1), (0, 0, 7.0)])
def test_no_goal_is_too_near_or_too_far(goal):
    made = plan(REST, goal, limits=LIMITS)
    assert made.reason == ""
    times, ground, velocity = made.sampled(50)
    assert np.isfinite(np.concatenate([ground, velocity], 1)).all() and np.isfinite(made.acceleration(times)).all()
    assert np.allclose(ground[-1, :2], goal[:2], atol=1e-9)


def test_who_walks_towards_the_goal_too_fast_overshoots_and_comes_back():
    made = plan(REST, (0.0, 0.05, 0.0), (1.4, 0.0, 0.0), limits=LIMITS)
    assert made.reason == "" and made.sampled()[1][:, 1].max() > 0.1


@pytest.mark.parametrize(("given_", "told"), [
    (dict(goal=(0, np.nan, 0)), "goal must be finite"), (dict(ground=(np.inf, 0, 0)), "ground must be finite"), (dict(goal=(0, 1)), "a goal is x, z"),
    (dict(velocity=(0, 99, 0)), "nobody starts faster"), (dict(weights=Weights(1, 0, 1, 1, 1)), "weights:"),
    (dict(limits=np.ones((2, 4))), "limits are"), (dict(limits=np.ones(4)), "limits are")])
def test_what_makes_no_sense_is_told_in_a_line(given_, told):
    with pytest.raises(ValueError, match=told):
        plan(**{"ground": REST, "goal": (0, 1, 0), **given_})


def test_weights_are_written_and_read(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(in_toml(PUBLISHED, "two\nlines"), "utf-8")
    assert read_weights(file) == pytest.approx(PUBLISHED)
    for text, told in (("", "no table"), ("[weights]\ntime = 1", "weights.forward"), ("nonsense", "not a file of weights"),
                       (in_toml(PUBLISHED._replace(turning=-1.0)), "weights.turning"), (in_toml(PUBLISHED).replace("5.2", "nan"), "weights.facing")):
        file.write_text(text, "utf-8")
        with pytest.raises(WeightsError, match=told):
            read_weights(file)
    with pytest.raises(WeightsError, match="nowhere.toml"):
        read_weights(tmp_path / "nowhere.toml")


@pytest.mark.few(1)
@pytest.mark.parametrize("weights", [PUBLISHED, HUMAN], ids=["published", "human"])
@pytest.mark.parametrize("goal", [(0.0, -1.0, 0.0), (-1.5, 1.0, np.pi), (2.0, 1.5, -2.0)])
def test_ipopt_finds_nothing_better(goal, weights):
    pytest.importorskip("casadi")
    from oracle import least_cost
    made = plan(REST, goal, weights=weights)
    times, ground, _ = made.sampled(41)
    least = least_cost(REST, made.goal, weights, around=[(times, ground)], turns=(0,))[0]
    assert made.cost < 1.01 * least and least < 1.01 * made.cost, "and the same cost is meant"


def test_the_library_says_its_own_limits():
    space = Locomotion.load().walk
    some = np.random.default_rng(0).uniform(-2, 2, (200, 3))
    assert np.array_equal(np.all(some @ LIMITS[:, :3].T + LIMITS[:, 3] <= 0, 1), space.inside(some))
