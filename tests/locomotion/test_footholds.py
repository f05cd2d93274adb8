"""Footholds: planned with the way of the root, planned anew when the wish changes, and kept to."""

import numpy as np
import pytest

from gambol.controllers.body.contact import feet_apart
from gambol.controllers.contract import Intent
from playing import FPS, hold, play

SWING = 0.38
"""The share of the cycle for which a walker's foot swings."""


def footholds(motion, share):
    """Of every swing of a walking foot: its character, when `share` of it was over, where its ball was then planned to come
    down and where it stood in the end (K, 2) [m]."""
    memory = np.array([s.memory for s in motion.states])
    walking = memory["family"] == 0
    who, when, planned, stood = [], [], [], []
    for n in range(memory.shape[1]):
        for foot in range(2):
            progress = (memory["phase"][:, n] - 0.5 * foot) % 1.0 / SWING
            for t in np.flatnonzero((progress[:-1] < 1.0) & (progress[1:] >= 1.0)):
                over = np.flatnonzero(progress[:t + 1] < share)
                down = np.flatnonzero(memory["grip"][t:t + 20, n, 2 * foot + 1] == 1.0)
                if len(over) and len(down) and over[-1] > t - 40 and walking[over[-1]:t + 20, n].all() and not memory["settled"][t, n]:
                    at = over[-1]
                    who.append(n)
                    when.append(at)
                    planned.append(memory["coming"][at, n, foot, 1] + memory["land"][at, n, foot])
                    stood.append(motion.points[t + down[0], n, 2 * foot + 1, [0, 2]])
    return np.array(who), np.array(when), np.array(planned), np.array(stood)


def test_in_a_steady_gait_a_foot_comes_down_where_it_was_planned_as_it_left(locomotion):
    motion = play(locomotion, hold(6, (1.3, 0, 0), (0.7, 0, 0), (-0.5, 0, 0), (0, 0, 0.4), (0.9, 0.6, 0)))
    _, when, planned, stood = footholds(motion, 0.1)
    steady = when > 3 * FPS
    assert steady.sum() >= 16
    assert np.linalg.norm(planned - stood, axis=-1)[steady].max() < 0.03


@pytest.mark.few(1)
@pytest.mark.parametrize(("before", "after"), [((1.3, 0, 0), (0, 0, 0)), ((0.5, 0, 0), (1.4, 0, 0)), ((1.0, 0, 0), (0.6, 1.0, 0))], ids=str)
def test_a_plan_is_made_anew_with_the_wish(locomotion, before, after):
    """In the very next step; and halfway through its swing a foot is foretold to go where it then does."""
    start = np.linspace(3.0, 4.2, 12)
    wish = np.zeros((round(5.2 * FPS), 12, 3))
    for n, time in enumerate(start):
        wish[:, n] = before
        wish[round(time * FPS):, n] = after
    motion = play(locomotion, wish)
    asked = (start * FPS).astype(int)
    moved = []
    for n in range(12):
        state = motion.states[round(start[n] * FPS) - 1]
        (same, _), (other, _) = (locomotion.step(state, Intent(np.array(w, float)), 1 / FPS) for w in (before, after))
        phase = float(same.memory["phase"][n])
        for foot in range(2):
            if 0.05 < (phase - 0.5 * foot) % 1.0 < 0.5 * SWING:
                moved.append(np.linalg.norm(other.memory["coming"][n, foot, 1] - same.memory["coming"][n, foot, 1]))
    assert moved and max(moved) > 0.02
    who, when, planned, stood = footholds(motion, 0.5)
    soon = (when >= asked[who]) & (when < asked[who] + FPS)
    assert soon.sum() >= 8
    off = np.linalg.norm(planned - stood, axis=-1)[soon]
    assert np.median(off) < 0.03 and off.max() < 0.1


@pytest.mark.few(1)
@pytest.mark.parametrize("after", ((0, 0, 0.45), (0, -1.5, 0), (0.6, 0, -0.35), (-0.6, 0, 0)), ids=str)
def test_feet_are_set_down_beside_each_other(locomotion, after):
    """Where both feet stand they are a shoe's width apart, whatever was asked before."""
    befores = ((1.3, 0, 0), (0, 0, -0.45), (0, 1.5, 0), (0.6, 0, 0.35))
    wish = np.zeros((6 * FPS, 4 * len(befores), 3))
    for n in range(wish.shape[1]):
        wish[:, n] = befores[n % 4]
        wish[round((3.0 + 0.3 * (n // 4)) * FPS):, n] = after
    motion = play(locomotion, wish)
    apart = feet_apart(locomotion.skeleton, motion.positions, motion.orientations)
    held = np.array([s.memory["grip"] for s in motion.states]).reshape(len(wish), -1, 2, 2).max(-1).min(-1) >= 1.0
    assert held.sum() > 200 and apart[held].min() > 0.055


def test_a_foot_that_leaves_does_not_slide(locomotion):
    """Who stops turning on the spot lifts the foot to set it down elsewhere: near the floor it gets nowhere."""
    wish = np.zeros((6 * FPS, 12, 3))
    for n in range(12):
        wish[:round((3.0 + 0.1 * n) * FPS), n, 1] = 1.5
    motion = play(locomotion, wish)
    grip = np.array([s.memory["grip"] for s in motion.states])
    stood = np.array([s.memory["stood"] for s in motion.states])
    far = np.linalg.norm(motion.points[..., [0, 2]] - stood, axis=-1)
    phase = np.array([s.memory["phase"] for s in motion.states])
    leaving = np.stack([(phase - 0.5 * foot) % 1.0 / SWING for foot in (0, 0, 1, 1)], -1)
    leaving = (grip == 0.0) & ((leaving < 0.3) | (leaving > 2.0))
    low = motion.points[..., 1] < 0.03
    assert leaving.sum() > 100 and far[leaving & low].max() < 0.025


def test_a_heel_that_was_lifted_goes_on_as_its_ball_leaves(locomotion):
    """Its turn about the ball changes no faster than it did while it stood."""
    wish = np.concatenate([hold(3, (2.5, 0, 0)), hold(2, (0, 0, 0))])
    motion = play(locomotion, wish)
    rise = np.array([s.memory["rise"] for s in motion.states])[:, 0]
    assert rise.max() > 0.1, "it was lifted"
    assert np.abs(np.diff(rise, 2, axis=0)).max() * FPS < 6.0
