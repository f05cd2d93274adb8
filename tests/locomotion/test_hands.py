"""Hands that give a body no time: short bursts of the run key, ways changed before the last one was taken up."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.body import anatomy, centre_of_mass
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion.fading import SINKS, held_up_kernel
from gambol.controllers.locomotion.first_stride import FASTEST_TURN, SHARE_HALFLIFE, start_kernel
from gambol.controllers.locomotion.gaze import QUICKEST, look_on
from gambol.controllers.locomotion.grip import LATE, take_foot
from gambol.controllers.locomotion.kernel import LABELS_AT
from playing import FPS, play

FLIGHT = 0.25
"""No stride of a run of 3.5 m/s or less, and no step of a walk, has longer without a foot on the floor [s]."""


def bursts(count):
    """Wishes (T, count, 3) to run for a moment out of a rest or a walk that is a little longer for each, twice, and to stop."""
    wish = np.zeros((round(6.5 * FPS), count, 3))
    for n in range(count):
        at = 10
        for k, (seconds, asked) in enumerate(((0.6, 3.0), (0.5, 0.0), (0.5 + 0.02 * n, 1.2), (0.3 + 0.015 * n, 3.0), (0.3, 0.8 * (n % 2)), (0.5, 3.0))):
            until = at + round(seconds * FPS)
            wish[at:until, n] = asked, (-1.2, 0.0, 1.2)[n % 3] * (k == 2), 0.0
            at = until
    return wish


def letting_go(before, then=None, moment=0.3, phases=30):
    """Wishes (T, phases, 3) to go on for a while, each a little longer, then for a moment otherwise, and to stop."""
    wish = np.zeros((round(4.8 * FPS), phases, 3))
    for n in range(phases):
        at = round(1.8 * FPS) + 2 * n
        wish[:at, n] = before
        if then is not None:
            wish[at:at + round(moment * FPS), n] = then
    return wish


def longest(mask):
    """How many frames of a mask (T,) on end are true at most."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(int), [0]])))
    return int(np.max(edges[1::2] - edges[::2], initial=0))


def test_nobody_is_carried_through_the_air_as_gaits_change(locomotion):
    """Who begins to run as his hips would go down, and walks again at once, keeps a foot on the floor for all but a run's flight."""
    motion = play(locomotion, bursts(36))
    stands = np.array([s.contacts for s in motion.states]).any(-1)
    assert max(longest(~stands[:, n]) for n in range(stands.shape[1])) < FLIGHT * FPS


@pytest.mark.few(1)
@pytest.mark.parametrize("before", [(1.3, 0, 0), (1.3, 1.0, 0), (1.8, 0, 0), (1.8, -1.2, 0)])
def test_hips_do_not_jerk_as_both_feet_come_to_stand(locomotion, before):
    """The gait stands still from a tick to the next: its movement goes over into what fades."""
    motion = play(locomotion, letting_go(before))
    waits = np.array([s.memory["waits"] for s in motion.states])
    jerk = np.linalg.norm(np.diff(motion.root, 2, axis=0), axis=-1) * FPS
    for t, n in zip(*np.nonzero((waits[1:] == 1) & (waits[:-1] == 0))):
        assert jerk[t - 2:t + 3, n].max() < 0.25


@pytest.mark.few(1)
@pytest.mark.parametrize(("before", "then"), [((1.3, 0, 0), None), ((1.8, 0, 0), None), ((2.4, -1.8, 0), None), ((2.4, 1.2, 0), (1.3, 0.5, 0)),
                                              ((1.0, 0, 0), (1.0, 2.4, 0)), ((1.3, 0, 0), (1.3, 2.4, 0))])
def test_who_stops_ends_over_his_feet(locomotion, before, then):
    """Shoulders that still turn lead the way on, and who is too quick to stop over the foot that stands takes another step: nobody leans away from where he stands."""
    motion = play(locomotion, letting_go(before, then))
    com = centre_of_mass(anatomy(locomotion.skeleton), motion.positions, motion.orientations)
    waits = np.array([s.memory["waits"] for s in motion.states]) == 1
    away = np.hypot(*np.moveaxis((com - motion.points.mean(2))[..., [0, 2]], -1, 0))
    speed = np.pad(np.linalg.norm(np.diff(com[..., [0, 2]], axis=0), axis=-1) * FPS, ((0, 1), (0, 0)))
    assert away[waits & (speed < 0.4)].max() < 0.17


@pytest.mark.parametrize("degrees", [60, 90, 135, 175, -60, -90, -135, -175])
def test_shoulders_turn_on_evenly_as_a_turns_first_foot_leaves(locomotion, degrees):
    """Phase runs five times as fast from there on; who turns does not."""
    state, turning = locomotion.start(), []
    towards = np.array([np.radians(degrees), 1.3])
    for _ in range(30):
        state, _ = locomotion.step(state, Intent(np.zeros(3), towards=towards), 1 / FPS)
        turning.append(state.velocity[1] if state.memory["turn"] else np.nan)
    assert np.nanmax(np.abs(turning)) > 1.2
    assert np.nanmax(np.abs(np.diff(turning))[1:]) < 0.5


@given(st.lists(st.tuples(st.floats(-1.5, 1.5), st.integers(2, 30)), min_size=1, max_size=4))
def test_heads_turn_no_faster_than_heads_do(asked):
    """However often it is told otherwise where it will go."""
    m = np.zeros(1, [("gaze", "f8", 2), ("gaze_rate", "f8", 2)]).view(np.recarray)[0]
    for goal, ticks in asked:
        for _ in range(ticks):
            before = m.gaze_rate.copy()
            look_on.py_func(m, 0, goal, 1 / FPS)
            assert abs(m.gaze_rate[0] - before[0]) <= QUICKEST / FPS + 1e-9
    for _ in range(90):
        look_on.py_func(m, 0, 0.3, 1 / FPS)
    assert abs(m.gaze[0] - 0.3) < 0.02


def test_knees_brake_before_they_lock(locomotion):
    """Who lets go in a run steps farther than a walk does: the leg that swings there straightens the earlier, the farther it is asked to."""
    motion = play(locomotion, letting_go((2.4, 1.2, 0), phases=40))
    bent = []
    for side in ("Left", "Right"):
        hip, knee, ankle = (motion.positions[..., locomotion.skeleton.index(side + joint), :] for joint in ("UpLeg", "Leg", "Foot"))
        up, down = hip - knee, ankle - knee
        cosine = (up * down).sum(-1) / np.linalg.norm(up, axis=-1) / np.linalg.norm(down, axis=-1)
        bent.append(np.pi - np.arccos(np.clip(cosine, -1.0, 1.0)))
    brakes = np.diff(bent, 2, axis=1).max(0) * FPS**2
    assert max(brakes[round(1.8 * FPS) + 2 * n:, n].max() for n in range(40)) < 1150.0


@given(st.floats(0.0, 0.99), st.floats(0.4, 1.0), st.floats(-20.0, -1.5), st.floats(0.31, 1.0))
def test_a_ball_that_leaves_does_not_hold_on_again(locomotion, grip, label, falls, lent):
    """Where its heel is free and its label falls: the leg would be stretched, and its knee whip."""
    memory = locomotion.start().memory.copy().reshape(1)
    memory["settled"], memory["phase"], memory["lent"] = 0, 0.45, lent
    memory["grip"], memory["row"][0, LABELS_AT + 3], memory["row_rate"][0, LABELS_AT + 3] = grip, label, falls
    take_foot(memory[0], 1, locomotion.tables.legs.height, np.zeros((4, 2)), np.zeros((4, 2)), 1 / FPS)
    assert memory["grip"][0, 3] <= np.float32(grip)


@given(st.floats(0.0, 0.99), st.floats(0.4, 1.0), st.floats(0.31, 1.0))
def test_a_heel_that_leaves_does_not_hold_on_again(locomotion, grip, label, lent):
    """Late in its stance, its ball firm: it was pulled down to the floor within a frame as a turn began, and its knee with it."""
    memory = locomotion.start().memory.copy().reshape(1)
    memory["settled"], memory["lent"], memory["phase"] = 0, lent, 0.38 * LATE + 0.02
    memory["grip"], memory["row"][0, LABELS_AT], memory["row_rate"][0, LABELS_AT] = (grip, 1.0, 1.0, 1.0), label, 1.0
    take_foot(memory[0], 0, locomotion.tables.legs.height, np.zeros((4, 2)), np.zeros((4, 2)), 1 / FPS)
    assert memory["grip"][0, 0] <= np.float32(grip)


@given(st.floats(0.0, 2.5), st.floats(0.0, 2.5), st.integers(0, 30))
def test_what_a_start_adds_follows_the_wish_smoothly(locomotion, before, after, ticks):
    """A way that changes meanwhile makes no arm jerk."""
    memory, start = locomotion.start().memory.copy().reshape(1), locomotion.tables.start
    memory["settled"], memory["onset"] = 0, 1.0
    rates = []
    for tick in range(ticks + 20):
        was = memory["shares"].copy()
        start_kernel(memory[0], start, np.array([1.3, before if tick < ticks else after, 0.0]), 1 / FPS)
        rates.append((memory["shares"] - was)[0] * FPS)
    assert np.abs(np.diff(rates, axis=0)).max() < FASTEST_TURN * (2.0 * np.log(2.0) / SHARE_HALFLIFE) ** 2 / FPS


@given(st.floats(-0.2, 0.2), st.floats(-1.5, 1.5), st.integers(2, 40))
def test_what_holds_hips_up_goes_the_same_way_in_any_steps(x, v, pieces):
    """Exact over any step, and never over the ground by more than what it rises by in the shorter half-life."""
    once = held_up_kernel(x, v, 0.18, 0.4)
    at, most = (x, v), x
    for _ in range(pieces):
        at = held_up_kernel(*at, 0.18, 0.4 / pieces)
        most = max(most, at[0])
    assert np.allclose(once, at, atol=1e-9)
    assert most <= max(x, 0.0) + max(v, 0.0) * SINKS * 0.18 / (2.0 * np.log(2.0)) / np.e + 1e-9


@given(st.floats(-0.2, 0.0), st.floats(-1.5, 0.0))
def test_hips_that_sink_as_gaits_change_are_caught(x, v):
    """What they are off by grows downward no longer than what holds them up would be on its way: half as fast as one that is let go, a body went down by 10 cm more."""
    ways = [held_up_kernel(x, v, 0.18, t)[0] for t in np.linspace(0.0, 0.6, 200)]
    assert min(ways) >= x + v * SINKS * 0.18 / (2.0 * np.log(2.0)) / np.e - 1e-9
