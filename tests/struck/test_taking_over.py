"""Whoever takes over goes on from what was shown: no joint turns in that frame by much more than in the frames before and after it."""

from dataclasses import replace

import numpy as np
import pytest

from gambol.controllers.body import forward_kinematics, log
from gambol.controllers.contract import Intent, Leap, Strike
from gambol.controllers.jump import Physique
from gambol.controllers.person import person
from gambol.controllers.struck.recorded_falls import falls
from gambol.game.scene import Box

DT, BODY = 1 / 60, Physique()
RISE, GOING, TREADS = 0.17, 0.29, 5
STAIRS = (*(Box((0.0, 0.5 * RISE * (n + 1), GOING * n), (3.0, RISE * (n + 1), GOING)) for n in range(TREADS)),
          Box((0.0, 0.5 * RISE * TREADS, GOING * TREADS + 1.5), (3.0, RISE * TREADS, 3.0 + GOING)))
SECONDS = 14.0
MOST = 12.0
"""So many degrees in a frame, beyond its own motion, at most."""


@pytest.fixture(scope="module")
def somebody():
    return person()


def played(somebody, seed):
    """The states of somebody on stairs whose hands wish at random: to walk, run and turn, to leap, and to be pushed."""
    rng = np.random.default_rng(seed)
    on = int(rng.integers(TREADS))
    state = somebody.start((0.0, GOING * on - 0.02, rng.uniform(-np.pi, np.pi)), RISE * (on + 1))
    states, intent, left = [state], Intent(around=STAIRS), 0
    for _ in range(round(SECONDS / DT)):
        strike = None
        if left == 0:
            left = int(rng.uniform(0.2, 1.2) / DT)
            velocity = rng.choice([0.0, 1.0, 1.4, 3.0]) * np.array([1.0, 0.0, 0.0]) + rng.choice([0.0, 1.0]) * rng.uniform(-1, 1, 3) * [0.0, 1.5, 0.4]
            leap = Leap(None) if rng.random() < 0.35 else None
            intent = Intent(velocity, around=STAIRS, leap=leap)
            if leap is None and rng.random() < 0.35:
                angle = rng.uniform(-np.pi, np.pi)
                strike = Strike(tuple(BODY.mass * rng.uniform(0.3, 1.0) * np.array([np.sin(angle), np.cos(angle)])))
        left -= 1
        state, _ = somebody.step(state, replace(intent, strike=strike), DT)
        states.append(state)
    return states


def beyond(states, n):
    """By how much (J,) [degrees] joints turn farther in the frame to the n-th state than in the one before and the one after."""
    a, b, c = (log(np.swapaxes(states[k - 1].pose.rotations, -1, -2) @ states[k].pose.rotations) for k in (n - 1, n, n + 1))
    return np.degrees(np.minimum(np.linalg.norm(b - a, axis=-1), np.linalg.norm(b - c, axis=-1)))


@pytest.mark.few(1)
@pytest.mark.parametrize("seed", range(8))
def test_nobody_sees_who_takes_over_on_stairs(somebody, seed):
    """Shanks turned about themselves, soles rolled and toes bent by 20 to 80° in one frame; and a foot on its way to a lower tread was set up onto the body's own."""
    states = played(somebody, seed)
    over = [n for n in range(2, len(states) - 1) if states[n].active != states[n - 1].active]
    assert len(over) > 3
    for n in over:
        turned = beyond(states, n)
        assert turned.max() < MOST, (n, states[n - 1].active, states[n].active, BODY.skeleton.names[turned.argmax()], float(turned.max()))


@pytest.mark.parametrize("turn", [-2.0, 2.0])
def test_a_head_begins_to_turn_from_rest(somebody, turn):
    """Who leaps with a turn, from a stand, looks round first: his head went off at 300°/s in one frame."""
    state, head, angles = somebody.start(), BODY.skeleton.index("Head"), []
    for _ in range(30):
        state, pose = somebody.step(state, Intent(leap=Leap(np.zeros(3), heading=turn)), DT)
        facing = forward_kinematics(BODY.skeleton, np.asarray(pose.root, float), np.asarray(pose.rotations, float))[1][head][:, 2]
        angles.append(np.arctan2(facing[0], facing[2]))
    rates = np.degrees(np.diff(np.unwrap([0.0, *angles]))) / DT
    assert np.abs(rates).max() > 100.0 and np.abs(np.diff(rates, prepend=0.0)).max() < 75.0


def test_who_has_got_up_is_at_rest():
    """Recordings of falls end while the head still turns, by up to 470°/s: it stopped dead."""
    for fall in falls(BODY):
        late = fall.turns(fall.lasts - np.array([2.0, 1.0, 0.0]) / 240.0)
        assert np.degrees(np.linalg.norm(log(np.swapaxes(late[1], -1, -2) @ late[2]), axis=-1)).max() * 240.0 < 75.0
