"""Who lets go before an edge stops before it if he can; who can't runs off, and who wishes to go on is not held."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.contract import Intent
from gambol.controllers.locomotion.before_edges import BARELY, HARDEST, slowed
from gambol.controllers.locomotion.held_up import BRAKE, LAG, SUDDEN, _evenly

FPS, HIGH = 60, 1.0
PLATFORM = (SimpleNamespace(centre=(0.0, 0.5 * HIGH, -10.0), size=(40.0, HIGH, 20.0), heading=0.0, slope=0.0),)


def gone(locomotion, speed, rooms, lets_go=True):
    """How far ahead (N,) of an edge characters rest who let go with their middles so far before it (N,) [m], how hard each braked, and how fast each was as he let go."""
    begin = np.stack([np.linspace(-3.0, 3.0, len(rooms)), np.full(len(rooms), -5.0), np.zeros(len(rooms))], -1)
    state, speeds, free = locomotion.start(begin, np.full(len(rooms), HIGH)), [], np.zeros(len(rooms), bool)
    for _ in range(round((6.0 / speed + 4.0) * FPS)):
        free |= lets_go & (state.ground[:, 1] > -rooms)
        wish = np.where(free, 0.0, speed)[:, None] * [1.0, 0.0, 0.0]
        state, _ = locomotion.step(state, Intent(wish, around=PLATFORM), 1 / FPS)
        speeds.append(state.velocity[:, 0].copy())
        if not lets_go and (state.ground[:, 1] > 0.0).all():
            break
    return -state.ground[:, 1], -np.diff(speeds, axis=0).min(0) * FPS


@pytest.mark.few(2)
@pytest.mark.parametrize("speed", (0.6, 1.3, 2.5, 3.2))
def test_who_lets_go_in_time_stays(locomotion, speed):
    """However little room it takes: from where he can just stop, hard, to where he need not brake for it."""
    least = BARELY + 1.15 * speed**2 / (2.0 * HARDEST) + 0.1
    rests, hard = gone(locomotion, speed, np.linspace(least, least + 1.2, 8))
    assert rests.min() > 0.04, "middles are over the platform"
    assert hard.max() < 1.5 * HARDEST, "and no body was stopped harder than bodies are"


def test_who_wishes_to_go_on_is_not_held(locomotion):
    rests, hard = gone(locomotion, 1.3, np.array([0.5, 1.0]), lets_go=False)
    assert rests.max() < 0.0 and hard.max() < 2.0


def test_who_can_not_stop_runs_off_as_fast_as_he_was(locomotion):
    """Braking over an edge would leave him half over it."""
    state = locomotion.start((0.0, -5.0, 0.0), HIGH)
    while state.ground[1] < 0.0:
        state, _ = locomotion.step(state, Intent(np.array([3.2 * (state.ground[1] < -0.4), 0.0, 0.0]), around=PLATFORM), 1 / FPS)
    assert state.velocity[0] > 3.0


@settings(max_examples=60, deadline=None)
@given(st.floats(0.05, 4.0), st.floats(0.0, 3.0))
def test_what_is_slowed_for_an_edge_is_slowed_in_time(speed, room):
    """Led by that alone, whoever can stop does so before it, by little more than he has to."""
    far, goes = room + BARELY + speed**2 / (2.0 * 0.95 * HARDEST) + 0.02, speed
    for _ in range(1200):
        after = min(goes, slowed(goes, far, 1 / FPS))
        assert goes - after <= HARDEST / FPS + 1e-9
        far, goes = far - 0.5 * (goes + after) / FPS, after
    assert goes < 0.03 and far > 0.0


@settings(max_examples=60, deadline=None)
@given(st.floats(0.5, 4.0), st.floats(0.05, 1.5))
def test_who_comes_too_fast_to_a_wall_is_stopped_evenly(speed, room):
    """As hard as the room that is left takes, and not at once."""
    velocity, left, hardest = np.array([0.0, speed]), room, 0.0
    for _ in range(600):
        before = velocity.copy()
        velocity[1] = min(velocity[1], BRAKE * (np.sqrt(LAG**2 + 2.0 * left / BRAKE) - LAG) if left > 0.0 else 0.0)
        _evenly(before, velocity, 1 / FPS)
        hardest = max(hardest, (before[1] - velocity[1]) * FPS)
        left -= 0.5 * (before[1] + velocity[1]) / FPS
    assert velocity[1] < 0.05 and left > -0.02
    assert hardest <= 1.6 * max(SUDDEN, 0.5 * speed**2 / room)


@pytest.mark.parametrize("heading", (0.19, -0.19))
def test_who_is_told_to_rest_where_a_corner_has_no_room_for_his_feet_does_not_tread_on_the_spot(locomotion, heading):
    """He stays as near as they stand, however long he wishes to go on."""
    around, count = (SimpleNamespace(centre=(0.0, 0.5, 0.0), size=(2.0, 1.0, 10.4), heading=heading, slope=0.0),), 12
    aside = np.linspace(-0.15, 0.15, count)
    state = locomotion.start(np.stack([aside, np.linspace(0.5, 0.0, count), np.zeros(count)], -1), np.ones(count))
    wish = Intent(np.array([2.7, 0.0, 0.0]), around=around, halt=np.stack([aside, np.full(count, 5.0), np.full(count, np.nan)], -1))
    for _ in range(360):
        state, _ = locomotion.step(state, wish, 1 / 60)
    stands = state.ground
    for _ in range(60):
        state, _ = locomotion.step(state, wish, 1 / 60)
        assert state.memory["settled"].all(), "at rest"
    assert np.array_equal(state.ground, stands) and np.hypot(*(stands[:, :2] - np.stack([aside, np.full(count, 5.0)], -1)).T).max() < 0.5
