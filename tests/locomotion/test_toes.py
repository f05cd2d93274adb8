"""Feet that leave the floor: toes straighten smoothly, no foot stands up on its toes' ends, and a heel that has risen is not pulled down again."""

import numpy as np
import pytest

from gambol.controllers.body import end_positions
from gambol.controllers.navigation import steer
from playing import FPS, hold, play, whims


@pytest.fixture(scope="module")
def restless(locomotion):
    return play(locomotion, whims(np.random.default_rng(7), 20.0, 12))


def turned(rotations):
    """How far joints turn from frame to frame [degrees]."""
    traces = np.einsum("t...ij,t...ij->t...", rotations[:-1], rotations[1:])
    return np.degrees(np.arccos(np.clip(0.5 * (traces - 1.0), -1.0, 1.0)))


def test_toes_straighten_smoothly_as_they_leave_the_floor(locomotion, restless):
    """They were free at once: of runners they snapped by 26° in a frame, of restless people by up to 41°."""
    toes = [locomotion.skeleton.index(side + "Toe") for side in ("Left", "Right")]
    steady = play(locomotion, hold(4.0, (1.3, 0, 0), (2.5, 0, 0), (3.0, 0, 0), (3.5, 0, 0)))
    assert turned(steady.rotations[2 * FPS:, :, toes]).max() < 16.0
    assert np.mean(turned(restless.rotations[:, :, toes]).max(-1) > 18.0) * FPS * 60.0 < 6.0


def test_no_foot_stands_up_on_its_toes_ends(locomotion, restless):
    """Heels rose for their leg's sake, however steep their feet were: up to 88° as they left."""
    at = locomotion.skeleton.end_index
    ends = end_positions(locomotion.skeleton, restless.positions, restless.orientations)[..., [at["LeftToe"], at["RightToe"]], :]
    stays = np.linalg.norm(np.diff(ends, axis=0, prepend=ends[:1]), axis=-1) < 0.006
    foot = restless.points[..., 0::2, :] - restless.points[..., 1::2, :]
    steep = np.degrees(np.arctan2(foot[..., 1], np.hypot(foot[..., 0], foot[..., 2])))
    assert steep[stays & (ends[..., 1] < 0.035)].max() < 79.0


def back(locomotion, speed, people, change=None):
    """The states of walkers who are told, each at another phase, to go back where they came from; change: what they are told, and when (step after their turn began)."""
    state, states, since = locomotion.start(np.zeros((people, 3))), [], np.zeros(people, int)
    way = np.zeros((people, 2))
    for k in range(round(6.0 * FPS)):
        way[:] = 0.0, speed
        for n in range(people):
            if k > round((2.0 + 1.1 * n / people) * FPS):
                way[n] = 0.0, -speed
        since += state.memory["turn"] != 0.0
        if change is not None:
            way[since > change[1]] = speed * np.array([np.sin(change[0]), np.cos(change[0])])
        state, _ = locomotion.step(state, steer(state.ground, way, None, state.velocity[:, 1]), 1 / FPS)
        states.append(state.memory.copy())
    return np.array(states)


def test_a_heel_that_has_risen_for_its_leg_takes_no_hold(locomotion):
    """As a turn began whose foot stands flat, heels were held 12 cm up, and knees thrown."""
    memory = back(locomotion, 1.3, 12)
    takes = np.diff(memory["grip"][..., 0::2], axis=0) > 0.02
    assert memory["rise"][1:][takes].max() < 0.25


def test_who_is_told_otherwise_as_a_turn_begins_turns_that_far(locomotion):
    """He let go of the turn, whose leg had been drawn up for a few frames."""
    told = np.pi - 0.8
    memory = back(locomotion, 1.3, 8, (told, 2))
    turning = memory["turn"] != 0.0
    assert turning.any(0).all()
    first = turning.argmax(0)
    assert any(memory["turn"][k, n] > 0.0 for n, k in enumerate(first))
    for n, k in enumerate(first):
        if memory["turn"][k, n] < 0.0:  # the other way round it would be too far
            continue
        assert turning[k:k + 20, n].all(), "it goes on"
        assert np.isclose(memory["turns_to"][k + 10, n], told)
