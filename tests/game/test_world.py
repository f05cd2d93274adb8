"""The world: a fixed step, replay to the bit, drawing in between."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.contract import Intent
from gambol.game.world.world import DT, Character, FixedStep, World, figures, ground_between, pose_between
from stand_in import Glide


def world(*names):
    glide = Glide()
    return World(tuple(Character(n, glide, glide.start((i, 0, 0.3 * i))) for i, n in enumerate(names or ("A",))))


def intents(seed, steps, count=1):
    rng = np.random.default_rng(seed)
    return [tuple(Intent(rng.normal(size=3)) for _ in range(count)) for _ in range(steps)]


def replay(world, log):
    for wanted in log:
        world = world.step(wanted)
    return world


def same(a, b):
    return all(np.array_equal(x.state.ground, y.state.ground) and np.array_equal(x.state.pose.rotations, y.state.pose.rotations)
               for x, y in zip(a.characters, b.characters))


def test_intents_lead_to_the_same_worlds_from_any_one_kept():
    start, log = world("A", "B"), intents(1, 200, 2)
    halfway = replay(start, log[:90])
    assert same(replay(start, log), replay(halfway, log[90:]))
    assert replay(start, log).time == 200 / 60


def test_stepping_leaves_the_old_world_as_it_was():
    start = world()
    before = start.characters[0].state.ground.copy()
    start.step([Intent(np.ones(3))])
    assert np.array_equal(start.characters[0].state.ground, before) and start.number == 0


def test_every_character_needs_an_intent():
    with pytest.raises(ValueError, match="2 characters.*got 1"):
        world("A", "B").step([Intent()])
    with pytest.raises(KeyError, match="C"):
        world("A").index("C")


@given(st.lists(st.floats(0, 0.5), min_size=1, max_size=100))
def test_no_time_is_lost_or_won(frames):
    """What is neither simulated nor owed is counted as dropped, whatever the frames are like."""
    clock, steps = FixedStep(), 0
    for seconds in frames:
        made, clock = clock.add(seconds)
        steps += made
        assert 0 <= clock.alpha <= 1 and made <= clock.cap
    assert steps * DT + clock.owed + clock.dropped == pytest.approx(sum(frames), abs=1e-9)
    assert clock.dropped == 0 or max(frames) > clock.cap * DT


@given(st.floats(0.2, 1e6))
def test_late_frames_are_capped(seconds):
    made, clock = FixedStep(cap=4).add(seconds)
    assert made == 4 and clock.owed == 0 and clock.dropped == pytest.approx(seconds - 4 * DT)
    assert clock.add(DT)[0] == 1


@pytest.mark.parametrize("seconds", [math.nan, math.inf, -1.0])
def test_time_that_is_none_counts_as_none(seconds):
    assert FixedStep().add(seconds) == (0, FixedStep())


def test_a_display_at_sixty_makes_one_step_a_frame():
    clock = FixedStep()
    for _ in range(10_000):
        made, clock = clock.add(DT)
        assert made == 1


def test_poses_in_between_are_rotations_and_meet_at_both_ends():
    start = world()
    after = replay(start, intents(2, 5))
    a, b = start.characters[0].state, after.characters[0].state
    for alpha in (0.0, 0.3, 1.0):
        r = pose_between(a.pose, b.pose, alpha).rotations
        assert np.allclose(np.swapaxes(r, -1, -2) @ r, np.eye(3)) and np.allclose(np.linalg.det(r), 1)
    assert pose_between(a.pose, b.pose, 0.0) is a.pose and pose_between(a.pose, b.pose, 1.0) is b.pose


def test_headings_in_between_go_the_shorter_way():
    glide = Glide()
    a, b = glide.start((0, 0, 3.1)), glide.start((0, 0, -3.1))
    assert ground_between(a, b, 0.5)[2] == pytest.approx(math.pi)


def test_figures_show_trail_and_path():
    before = replay(world(), [(Intent(np.array([1.0, 0.0, 0.0])),)] * 119)
    after = before.step((Intent(np.array([1.0, 0.0, 0.0])),))
    figure, = figures(before, after, 0.5)
    middle = 0.5 * (before.characters[0].state.ground[1] + after.characters[0].state.ground[1])
    assert figure.positions.shape == (22, 3) and figure.positions[0, 2] == pytest.approx(middle)
    assert np.all(np.diff(figure.trail[:, 2]) > 0) and figure.trail[-1, 2] == pytest.approx(middle)
    assert figure.path[-1] == pytest.approx([0, figure.path[0, 1], middle + 1.5])


def test_the_trail_is_bounded():
    end = replay(world(), [(Intent(),)] * 2000)
    assert len(end.characters[0].trail) <= 150
