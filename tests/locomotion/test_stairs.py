"""Stairs of all kinds, bodies of all sizes, as fast as anybody asks: feet stand on treads, and pass over edges."""

import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

sys.path.insert(0, str(Path(__file__).parents[2] / "scripts" / "measure"))
from gambol.controllers.body import forward_kinematics, sole_corners  # noqa: E402
from gambol.controllers.contract import Intent, Leap  # noqa: E402
from gambol.controllers.locomotion.foot_points import ball_kernel  # noqa: E402
from gambol.controllers.locomotion.memory import RUN  # noqa: E402
from gambol.controllers.locomotion.tops import tops  # noqa: E402
from gambol.controllers.locomotion.treads import FOOT, NONE, come_down, most_speed, on_stairs, under_kernel  # noqa: E402
from gambol.controllers.navigation import steer  # noqa: E402
from gambol.controllers.navigation.passing import STEP  # noqa: E402
from stairs import depth, flight, ran, walked  # noqa: E402


def test_a_point_at_the_foot_of_a_riser_is_as_deep_in_it_as_it_is_beyond_it():
    """However little it is below the tread that it stands on."""
    around, _ = flight(0.16, 0.30, 1.0)
    for along, under in ((0.02, 0.0), (0.02, 0.0005), (0.05, -0.001)):
        assert depth(np.array([[0.0, -under, 2.0 + along]]), around) == pytest.approx(np.hypot(along, max(under, 0.0)), abs=0.01)


def finds_the_treads(locomotion, rise, tread, height, speed):
    """Up and down again: no standing foot is in a step, next to none grazes one as it swings, and nobody falls."""
    found = walked(locomotion, rise, tread, height, speed)
    assert found.falls == 0
    assert found.standing < 0.015 and found.deep.max() < 0.06
    assert np.mean(found.deep > 0.01) < 0.005 and found.labels < 0.003
    assert found.jerk < 80e3, "no foot pops out of a step"


@pytest.mark.few(1)
@pytest.mark.parametrize("rise, tread, height, speed", ((0.17, 0.25, 1.74, 0.7), (0.17, 0.29, 1.2, 0.8), (0.17, 0.29, 2.1, 0.9), (0.17, 0.29, 1.74, 3.0)))
def test_feet_find_the_treads_of_stairs(locomotion, rise, tread, height, speed):
    finds_the_treads(locomotion, rise, tread, height, speed)


@pytest.mark.thorough
@settings(max_examples=6, deadline=None)
@given(st.floats(0.12, 0.20), st.floats(0.22, 0.35), st.floats(1.2, 2.1), st.floats(0.5, 3.0))
def test_feet_find_the_treads_of_any_stairs(locomotion, rise, tread, height, speed):
    finds_the_treads(locomotion, rise, tread, height, speed)


@pytest.mark.few(2)
@pytest.mark.parametrize("rise, width, height, speed, askew", ((0.15, 6.0, 1.74, 3.0, 0.0), (0.16, 1.0, 1.74, 2.0, 0.0),
                                                               (0.12, 0.9, 1.5, 3.0, 0.0), (0.16, 6.0, 1.2, 2.5, 0.0), (0.16, 2.0, 1.9, 3.0, 40.0)))
def test_who_runs_goes_on_running_over_a_kerb(locomotion, rise, width, height, speed, askew):
    """At nine tenths of the speed, up and down; feet come down on what is there, or pass over it."""
    found = ran(locomotion, rise, width, height, speed, askew)
    assert found.slowest > 0.9
    assert not found.falls and found.standing < 0.015 and found.deep.max() < 0.06
    assert np.mean(found.deep > 0.01) < 0.005 and found.labels < 0.003
    assert found.jerk < 80e3


def test_short_steps_are_brisk(locomotion):
    """People climb at some 1.7 steps a second: who must take short steps takes more of them than the slow walk whose steps they are."""
    around, end = flight(0.17, 0.29, 1.0)
    state = locomotion.start()
    wish = Intent(np.array([1.3, 0.0, 0.0]), around=around)
    on = 0
    for _ in range(900):
        state, _ = locomotion.step(state, wish, 1 / 60)
        on += 2.29 < state.ground[1] < 2.0 + 5 * 0.29
    assert state.ground[1] > end, "up and down again"
    assert 0.45 < 4 * 0.29 / (on / 60) < 0.7


def test_who_runs_on_stairs_and_wants_to_leap_keeps_to_their_treads(locomotion):
    """He ran on as on level ground, 3.2 m/s over treads that no foot finds, and flew up them."""
    around, _ = flight(0.17, 0.29, 1.0)
    state, speeds = locomotion.start((0.0, -2.0, 0.0)), []
    for _ in range(600):
        on = 2.3 < state.ground[1] < 2.0 + 5 * 0.29
        leap = Leap(np.array([0.0, float(state.floor), state.ground[1] + 2.0])) if on else None
        before = float(state.ground[1])
        state, _ = locomotion.step(state, Intent(np.array([3.0, 0.0, 0.0]), leap=leap, around=around), 1 / 60)
        if on:
            speeds.append((state.ground[1] - before) * 60)
    assert len(speeds) > 30 and max(speeds[15:]) < 1.5


@pytest.mark.few(1)
@pytest.mark.parametrize("height", (1.2, 1.74))
def test_who_runs_is_faster_up_and_down_stairs_than_who_walks(locomotion, height):
    """Recorded people run up stairs at about 1 m/s, a step at a time, where they walk at 0.55; and brake no farther before them than it takes."""
    size = height / 1.74
    around, end = flight(0.17, 0.29, size)
    times, near = [], 0.0
    for speed in (1.3, 3.0):
        state, on = locomotion.start((0.0, -2.0, 0.0)), np.zeros(2)
        wish = Intent(np.array([speed / np.sqrt(size), 0.0, 0.0]), around=around)
        for _ in range(1500):
            before = float(state.ground[1]) * size
            state, _ = locomotion.step(state, wish, 1 / 60)
            at = float(state.ground[1]) * size
            near = (at - before) * 60 / np.sqrt(size) if before < 1.0 <= at else near  # a metre before the first step
            on += (2.0 < at < 2.0 + 5 * 0.29, 0.0 < at - 4.5 - 6 * 0.29 < 5 * 0.29)
            if state.ground[1] > end and at > 4.5 + 11 * 0.29:
                break
        assert state.ground[1] > end, "up and down again"
        times.append(on / 60 * np.sqrt(size))
    walks, runs = 5 * 0.29 / np.array(times)
    assert (runs > 1.2 * walks).all() and (runs > (0.85 if height > 1.5 else 0.7)).all() and (walks < 0.7).all()
    assert near > 1.4


@pytest.mark.few(1)
@pytest.mark.parametrize("height, rise", ((1.2, 0.25), (1.74, 0.33)))
def test_nobody_walks_into_what_is_too_high_for_a_step(locomotion, height, rise):
    """They come to a stop before it, as before a wall."""
    found = walked(locomotion, rise, 0.35, height, 1.4, seconds=6.0)
    assert found.deep.max() < 0.01 and not found.labels


@settings(max_examples=40, deadline=None)
@given(st.floats(0.12, 0.20), st.floats(0.22, 0.35), st.floats(-3.1, 3.1), st.floats(-3.1, 3.1), st.floats(0.05, 0.95), st.integers(2, 6), st.floats(0.8, 3.5))
@example(0.125, 0.234375, 0.0, 3.0, 0.75, 6, 1.5)
def test_who_stands_on_stairs_keeps_to_their_speed_whichever_way_he_turns(locomotion, rise, tread, heading, wish, share, step, speed):
    """Along a tread there is no edge ahead, and askew they are far apart; so a runner who turned on stairs ran off them through the air."""
    around = [SimpleNamespace(centre=(0.0, 0.5 * rise * (n + 1), (n + 0.5) * tread), size=(9.0, rise * (n + 1), tread), heading=0.0, slope=0.0) for n in range(8)]
    memory = locomotion.start(np.array([0.0, (step + share) * tread, heading])).memory.copy().reshape(1)[0]
    memory["level"], memory["wished"], memory["wanted"] = rise * (step + 1), (speed * np.sin(wish), speed * np.cos(wish)), RUN
    memory["velocity"] = speed * np.cos(wish), 0.0, speed * np.sin(wish)
    memory["stairs"] = on_stairs(memory, tops(around), 0.0)
    most = most_speed(memory, tops(around), 0.0)
    runs = min(max(speed * np.cos(wish) - 1.5, 0.0), 1.0)
    fastest = min(max((2.6 + 0.9 * runs) * tread * 1.1, 0.5), 1.0 + 0.4 * runs)
    assert 0.5 - 1e-6 <= most <= fastest or speed <= fastest and most == 0.0


@settings(max_examples=60, deadline=None)
@given(st.floats(-3.1, 3.1), st.floats(0.02, 0.27), st.integers(2, 5), st.integers(0, 1), st.floats(0.1, 0.5), st.floats(-0.25, 0.25), st.floats(0.0, 0.4))
@example(1.87, 0.02, 5, 0, 0.47, 0.02, 0.12)
def test_a_foot_of_who_turns_on_stairs_finds_a_place_on_its_side_a_step_off_at_most(locomotion, heading, into, step, foot, beside, before, speed):
    """Two treads down beside the one on which the other foot stands it stood in the air, as high as that."""
    around = [SimpleNamespace(centre=(0.0, 0.085 * (n + 1), (n + 0.5) * 0.29), size=(9.0, 0.17 * (n + 1), 0.29), heading=0.0, slope=0.0) for n in range(8)]
    memory = locomotion.start(np.array([0.0, 0.29 * step + into, heading])).memory.copy().reshape(1)[0]
    c, s, side = np.cos(heading), np.sin(heading), 1.0 - 2.0 * foot
    other, under, ground = np.empty(2), np.empty(3), np.empty(3)
    memory["level"], memory["base"], memory["velocity"] = 0.17 * (step + 1), 0.17 * (step + 1), (-speed, 0.0, 0.0)
    ball_kernel(memory, 1 - foot, other)
    memory["ground"][:2] += [0.0, 0.29 * step + into] - other  # the other foot's ball stands there
    other[:] = 0.0, 0.29 * step + into
    ball = other + side * beside * np.array([c, -s]) + before * np.array([s, c])
    memory["coming"][foot] = ball - FOOT * np.array([s, c]), ball
    come_down(memory, tops(around), 0.0, foot, 0.3, ground)
    x, z = memory["coming"][foot, 1] + memory["land"][foot]
    assert abs(ground[0] - memory["base"][1 - foot]) < STEP
    assert under_kernel(memory, tops(around), 0.0, x, z, c, s, under) > NONE and under[0] == ground[0]


def test_runners_who_turn_on_stairs_keep_their_feet_on_them(locomotion):
    """Aside, back and between: steps of turns that know no treads led down the air for a second."""
    around = tuple(SimpleNamespace(centre=(0.0, 0.085 * (n + 1), 2.0 + (n + 0.5) * 0.29), size=(8.0, 0.17 * (n + 1), 0.29), heading=0.0, slope=0.0) for n in range(8))
    turn = np.radians([90, 135, 160, 180, -90, -120, -135, -160])
    state, turned, aloft, longest = locomotion.start(np.zeros((len(turn), 3))), np.zeros(len(turn), bool), np.zeros(len(turn)), 0.0
    high, bare = 0.17 * np.arange(9), np.zeros(len(turn))
    for _ in range(480):
        turned |= state.ground[:, 1] > 2.0 + 3.5 * 0.29
        goes = np.where(turned, turn, 0.0)
        wish = steer(state.ground, 3.0 * np.stack([np.sin(goes), np.cos(goes)], -1), None, state.velocity[:, 1])
        state, _ = locomotion.step(state, replace(wish, around=around), 1 / 60)
        on = turned & (np.abs(state.ground[:, 0]) < 3.7) & (state.ground[:, 1] > 2.0) & (state.ground[:, 1] < 2.0 + 8 * 0.29)
        aloft = np.where(state.contacts.any(-1), 0, aloft + 1)
        longest = max(longest, (aloft * on).max() / 60)
        soles = sole_corners(locomotion.skeleton, *forward_kinematics(locomotion.skeleton, np.asarray(state.pose.root, float), np.asarray(state.pose.rotations, float)))
        under = high[np.clip(np.floor((soles[..., 2] - 2.0) / 0.29).astype(int) + 1, 0, 8)]
        bare = np.where((np.abs(soles[..., 1] - under) < 0.02).any(-1), 0, bare + 1)
        assert (bare * on).max() <= 0.3 * 60, "no sole touches a tread, longer than a heel rises over an edge on the way down"
    assert turned.all() and longest < 0.5


@pytest.mark.few(1)
@pytest.mark.parametrize("rise, tread", ((0.17, 0.30), (0.12, 0.40)))
def test_who_climbs_backward_has_no_knee_thrown(locomotion, rise, tread):
    """Where a leg that is straight must rise to the next tread at once."""
    around, _ = flight(rise, tread, 1.0)
    state, knees = locomotion.start((0.0, 1.0, np.pi)), []
    joints = [locomotion.skeleton.index(side + "Leg") for side in ("Left", "Right")]
    for _ in range(480):
        off = (np.pi - float(state.ground[2]) + np.pi) % (2.0 * np.pi) - np.pi
        state, pose = locomotion.step(state, Intent(np.array([-0.5, 2.0 * off, 0.0]), around=around), 1 / 60)
        knees.append(forward_kinematics(locomotion.skeleton, pose.root, pose.rotations)[0][joints])
    change = np.linalg.norm(np.diff(knees, 2, axis=0), axis=-1) * 60.0
    assert state.floor > 3.5 * rise and change.max() < 4.5


@pytest.mark.few(1)
@pytest.mark.parametrize("rise, tread, height, speed", ((0.20, 0.30, 1.74, 0.8), (0.17, 0.29, 1.74, 1.2), (0.17, 0.25, 1.2, 0.8)))
def test_feet_rise_to_the_next_tread_but_one_without_a_jolt(locomotion, rise, tread, height, speed):
    """As they leave, before the riser that their toes stand at: they were thrown up by 4 m/s within a frame as the swing began."""
    found = walked(locomotion, rise, tread, height, speed)
    assert found.jerk < 20e3 and found.deep.max() < 0.015


def test_who_steps_back_from_a_riser_has_no_foot_thrown_up_it(locomotion):
    """The foot whose toes stand at it was thrown up by 4 cm for two frames, and dropped as it swung."""
    around, skeleton = (SimpleNamespace(centre=(0.0, 0.08, 0.8), size=(6.0, 0.16, 1.0), heading=0.0, slope=0.0),), locomotion.skeleton
    feet, thrown = [skeleton.index(name) for name in ("LeftFoot", "RightFoot")], []
    for near in np.arange(-0.09, 0.1, 0.02):
        state, heights = locomotion.start((0.0, -near, 0.0)), []
        for frame in range(150):
            state, pose = locomotion.step(state, Intent(np.array([-0.5 if frame > 20 else 0.0, 0.0, 0.0]), around=around), 1 / 60)
            heights.append(forward_kinematics(skeleton, pose.root, pose.rotations)[0][feet, 1])
        thrown.append(np.abs(np.diff(heights, 2, axis=0)).max())
    assert max(thrown) < 0.01
