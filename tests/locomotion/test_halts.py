"""Coming to rest at a place: a walker lets go of his wish in time, his last two feet go there, and nobody steps on the spot afterwards."""

import numpy as np
import pytest

from gambol.controllers.contract import Intent
from playing import FPS

FAR = np.array([0.8, 1.0, 1.5, 2.1, 2.6, 3.3])


def gone(locomotion, velocity, halts, seconds):
    """The states of characters who set off from the origin at velocities (N, 3) to come to rest at halts (N, 3)."""
    state, states = locomotion.start(np.zeros((len(halts), 3))), []
    for k in range(round(seconds * FPS)):
        wish = np.where(k < (seconds - 1.0) * FPS, velocity, 0.0)
        state, _ = locomotion.step(state, Intent(wish, halt=halts), 1 / FPS)
        states.append(state)
    return states


def strikes_at_rest(states):
    """How often feet (N,) come down while a body hardly moves."""
    ground = np.array([s.ground for s in states])
    speed = np.linalg.norm(np.diff(ground[..., :2], axis=0), axis=-1) * FPS
    feet = np.array([s.contacts.reshape(-1, 2, 2).any(-1) for s in states])
    struck = (np.diff(feet.astype(int), axis=0) > 0).any(-1)
    return np.array([(struck[:, n] & (speed[:, n] < 0.03) & (np.arange(len(speed)) > FPS)).sum() for n in range(speed.shape[1])])


@pytest.mark.parametrize("speed", (0.8, 1.3))
def test_who_walks_to_a_place_comes_to_rest_at_it(locomotion, speed):
    halts = np.stack([np.zeros_like(FAR), FAR, np.full_like(FAR, np.nan)], -1)
    states = gone(locomotion, np.tile([speed, 0.0, 0.0], (len(FAR), 1)), halts, 8.0)
    assert states[-1].memory["settled"].all()
    assert np.hypot(*(states[-1].ground - halts)[:, :2].T).max() < 0.03
    assert strikes_at_rest(states).max() <= 1, "the last foot"


def test_who_runs_to_a_place_comes_to_rest_at_it_too(locomotion):
    halts = np.array([[0.0, far, np.nan] for far in (5.0, 6.0, 7.0)])
    states = gone(locomotion, np.tile([2.8, 0.0, 0.0], (3, 1)), halts, 9.0)
    assert np.hypot(*(states[-1].ground - halts)[:, :2].T).max() < 0.03


def test_a_place_has_a_heading(locomotion):
    halts = np.array([[0.0, 2.0, 0.3], [0.0, 2.0, -0.3]])
    states = gone(locomotion, np.tile([1.2, 0.0, 0.0], (2, 1)), halts, 7.0)
    assert np.hypot(*(states[-1].ground - halts)[:, :2].T).max() < 0.03
    assert np.abs(states[-1].ground[:, 2] - halts[:, 2]).max() < np.radians(3)


def test_a_place_that_is_not_finite_is_none(locomotion):
    states = gone(locomotion, np.array([[1.2, 0.0, 0.0]] * 2), np.array([[0.0, np.nan, 0.0], [np.inf, 2.0, 0.0]]), 5.0)
    plain = locomotion.start(np.zeros((2, 3)))
    for k in range(5 * FPS):
        plain, _ = locomotion.step(plain, Intent(np.array([1.2 * (k < 4 * FPS), 0.0, 0.0])), 1 / FPS)
    assert np.array_equal(states[-1].ground, plain.ground)


def test_a_wish_takes_a_stop_back(locomotion):
    state = locomotion.start()
    for k in range(6 * FPS):
        halt = np.array([0.0, 2.0, np.nan]) if k < 2 * FPS else None
        state, _ = locomotion.step(state, Intent(np.array([1.2, 0.0, 0.0]), halt=halt), 1 / FPS)
    assert state.velocity[0] == pytest.approx(1.2, abs=0.02) and state.ground[1] > 4.0


def test_who_runs_and_stops_does_not_step_on_the_spot(locomotion):
    """At whatever moment of a run: within 1.6 s the body rests over feet that stay."""
    start = np.linspace(3.0, 3.7, 12)
    state, states = locomotion.start(np.zeros((12, 3))), []
    for k in range(6 * FPS):
        wish = np.zeros((12, 3))
        wish[:, 0] = 3.0 * (k < start * FPS)
        state, _ = locomotion.step(state, Intent(wish), 1 / FPS)
        states.append(state)
    speed = np.linalg.norm(np.diff(np.array([s.ground for s in states])[..., :2], axis=0), axis=-1) * FPS
    for n, time in enumerate(start):
        assert speed[round((time + 1.6) * FPS):, n].max() < 0.1
    assert strikes_at_rest(states).max() == 0


@pytest.mark.thorough
def test_random_scripts_end_where_they_end_at_any_rate(locomotion):
    """Stops and changes of gait among them: a stop told to a tick, or a change, ends them decimetres apart."""
    apart = []
    for seed in (5, 6):
        script = np.random.default_rng(seed).normal(size=(12, 6, 3)) * [1.2, 0.6, 0.2]
        script[::4] = 0.0
        ends = {}
        for rate in (30, 60, 144)[seed != 5:]:
            state = locomotion.start(np.zeros((6, 3)))
            for wish in script:
                for _ in range(round(1.5 * rate)):
                    state, _ = locomotion.step(state, Intent(wish), 1 / rate)
            ends[rate] = state.ground[:, :2]
        assert np.allclose(ends.get(30, ends[60]), ends[60], atol=1e-6), "longer steps are made in parts"
        apart.extend(np.hypot(*(ends[60] - ends[144]).T))
    # a wish that changes in the very tick in which a run may become a walk is heeded at once at one rate and a step later at the other
    assert np.median(apart) < 0.012 and np.mean(np.array(apart) > 0.1) < 1 / 6


def test_who_stands_beside_his_place_steps_to_it(locomotion):
    """However timidly he wishes to: he doesn't stand and set off in turns."""
    state, stood = locomotion.start(np.zeros((4, 3))), []
    wish = Intent(np.array([[0.0, 0.0, 0.08], [0.0, 0.0, -0.08], [0.08, 0.0, 0.0], [-0.08, 0.0, 0.0]]),
                  halt=np.array([[0.05, 0.0, 0.0], [-0.05, 0.0, 0.0], [0.0, 0.05, 0.0], [0.0, -0.05, 0.0]]))
    for _ in range(150):
        state, _ = locomotion.step(state, wish, 1 / 60)
        stood.append(state.memory["settled"])
    assert (np.abs(np.diff(stood, axis=0)).sum(0) <= 4).all()
    assert np.linalg.norm(state.ground[:, :2] - wish.halt[:, :2], axis=-1).max() < 0.03


def test_who_stands_a_step_from_his_place_is_there_in_two_steps(locomotion):
    """He lets go once that leads him there by the first strike that it may be, and doesn't creep."""
    far = np.array([0.04, 0.08, 0.15])
    places = np.concatenate([far[:, None] * way for way in ([1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0])])
    halts = np.column_stack([places, np.full(len(places), np.nan)])
    wish = np.column_stack([places[:, 1], np.zeros(len(places)), places[:, 0]]) * 0.3 / np.hypot(*places.T)[:, None]
    states = gone(locomotion, wish, halts, 4.0)
    feet = np.array([s.contacts.reshape(-1, 2, 2).any(-1) for s in states]).astype(int)
    assert (np.diff(feet, axis=0) > 0).any(-1).sum(0).mean() < 2.3
    assert np.array([s.memory["settled"] for s in states])[round(1.9 * FPS):].mean() > 0.9
    assert np.hypot(*(states[-1].ground - halts)[:, :2].T).max() < 0.01
