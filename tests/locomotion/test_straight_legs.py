"""A leg that is held straight bends evenly as it is let go, or as the ground bears it: its knee does not snap."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.body import forward_kinematics
from gambol.controllers.locomotion.short_leg import give_way, nearer_kernel
from gambol.controllers.navigation import floor_at, steer

COUNT, FPS, CHANGES, WISHES = 60, 60, 30, 6
"""So many people; steps a second; a wish holds for so many steps; so many wishes."""
STRAIGHT, SNAPS = 0.9975, 0.009
"""Legs are straight that are so long [of what they are at most]; by so much shorter a step later, they snap: a knee by 14° at least."""


def box(x, z, wide, high, deep):
    return SimpleNamespace(centre=(x, 0.5 * high, z), size=(wide, high, deep), heading=0.0, slope=0.0)


STAIRS = tuple(box(0.0, 0.29 * k, 4.0, 0.17 * (k + 1), 0.29) for k in range(6))


def snaps(locomotion, things, fastest, seed):
    """How many times a minute and person a straight leg snaps of restless people among things, who go any way, no faster than that [m/s], and face there or ahead."""
    rng, lengths = np.random.default_rng(seed), []
    ground = np.stack([rng.uniform(-0.8, 0.8, COUNT), rng.uniform(-0.8, 1.4, COUNT), rng.uniform(-np.pi, np.pi, COUNT)], -1)
    state = locomotion.start(ground, np.array([floor_at(x, z, things, 9.0) for x, z, _ in ground]))
    joints = np.array([[locomotion.skeleton.index(side + name) for name in ("UpLeg", "Leg", "Foot")] for side in ("Left", "Right")])
    for k in range(WISHES * CHANGES):
        if k % CHANGES == 0:
            way, speed = rng.uniform(-np.pi, np.pi, COUNT), rng.choice([1.0, 1.0, 1.0, 0.0], COUNT) * rng.uniform(0.3, fastest, COUNT)
            facing = np.where(rng.random(COUNT) < 0.3, state.ground[:, 2], np.nan)
        wish = steer(state.ground, speed[:, None] * np.stack([np.sin(way), np.cos(way)], -1), facing, state.velocity[:, 1])
        state, pose = locomotion.step(state, replace(wish, around=things), 1 / FPS)
        hip, knee, ankle = np.moveaxis(forward_kinematics(locomotion.skeleton, np.asarray(pose.root, float), np.asarray(pose.rotations, float))[0][:, joints], 2, 0)
        lengths.append(np.linalg.norm(ankle - hip, axis=-1) / (np.linalg.norm(knee - hip, axis=-1) + np.linalg.norm(ankle - knee, axis=-1)))
    lengths = np.array(lengths)
    return np.sum((lengths[:-1] > STRAIGHT) & (lengths[1:] < lengths[:-1] - SNAPS)) / (COUNT * len(lengths) / FPS / 60.0)


def test_knees_do_not_snap_as_treads_come_to_bear(locomotion):
    """The pelvis had been lowered for a leg whose heel had risen for the same lack: 5 to 7 times a minute."""
    assert snaps(locomotion, STAIRS, 1.3, 0) < 3.0


def test_a_leg_is_let_go_more_slowly_than_its_ball(locomotion):
    """A ball may be free within two frames; a knee that was straight snapped by 23° in one."""
    memory = locomotion.start((0.0, 0.0, 0.0)).memory.copy()
    m, body, legs = memory.reshape(-1).view(np.recarray)[0], locomotion.tables.body, locomotion.tables.legs
    hip, firm = legs.hip[0], []
    positions, orientations = (a.astype(np.float32) for a in forward_kinematics(locomotion.skeleton, np.array([0.0, 0.9, 0.0]), np.tile(np.eye(3), (len(locomotion.skeleton), 1, 1))))
    for grip in (1.0, 0.5, *9 * (0.0,)):
        m.grip[:2] = grip
        firm.append(give_way(m, body, 0, hip, 0.8, 0.0, positions, orientations.copy(), positions[hip] + [0.0, -0.9, 0.0], 1 / FPS, np.empty((5, 3, 3)))[2])
    assert firm[0] == 1.0 and firm[-1] == 0.0 and np.abs(np.diff(firm)).max() < 0.35
    for grip in (1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1):  # one that is let go slowly is straight no longer for it
        m.grip[:2] = grip
        later = give_way(m, body, 0, hip, 0.8, 0.0, positions, orientations.copy(), positions[hip] + [0.0, -0.9, 0.0], 1 / FPS, np.empty((5, 3, 3)))[2]
    assert later < 0.05


def test_a_ball_that_comes_to_bear_stretches_no_leg_at_once(locomotion):
    """Firm within five steps of 1/144 s, it pulled its leg straight, since its heel was not yet free to rise: the knee left from there at once."""
    memory = locomotion.start((0.0, 0.0, 0.0)).memory.copy()
    m, body, legs = memory.reshape(-1).view(np.recarray)[0], locomotion.tables.body, locomotion.tables.legs
    hip, firm = legs.hip[0], []
    positions, orientations = (a.astype(np.float32) for a in forward_kinematics(locomotion.skeleton, np.array([0.0, 0.9, 0.0]), np.tile(np.eye(3), (len(locomotion.skeleton), 1, 1))))
    m.bears[:] = m.bears_rate[:] = m.taut[:] = 0.0
    for grip in (0.2, 0.4, 0.6, 0.8, *25 * (1.0,)):
        m.grip[:2] = grip
        firm.append(give_way(m, body, 0, hip, 0.8, 0.0, positions, orientations.copy(), positions[hip] + [0.0, -0.9, 0.0], 1 / 144, np.empty((5, 3, 3)))[2])
    assert firm[3] < 0.4 and firm[-1] > 0.9 and np.diff(firm).min() >= 0.0


def test_a_heel_that_rises_is_let_go_smoothly(locomotion):
    """As its ball let go it was turned back by twice as much a step as it had risen: ankle and knee were thrown at 4 m/s within a step of 1/144 s."""
    memory = locomotion.start((0.0, 0.0, 0.0)).memory.copy()
    m, body, legs = memory.reshape(-1).view(np.recarray)[0], locomotion.tables.body, locomotion.tables.legs
    hip, rises = legs.hip[0], []
    positions, orientations = (a.astype(np.float32) for a in forward_kinematics(locomotion.skeleton, np.array([0.0, 0.9, 0.0]), np.tile(np.eye(3), (len(locomotion.skeleton), 1, 1))))
    m.bears[:] = m.taut[:] = 1.0
    c, s = np.float32(np.cos(0.8)), np.float32(np.sin(0.8))
    orientations[hip + 2] = [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]  # as steep as feet are that leave
    for grip in (*5 * (1.0,), 0.83, 0.66, 0.49, 0.32, 0.15, *5 * (0.0,)):
        m.grip[:2] = 0.0, grip
        give_way(m, body, 0, hip, 0.8, 0.0, positions, orientations.copy(), positions[hip] + np.float32([0.0, -0.8, -0.45]), 1 / 144, np.empty((5, 3, 3)))
        rises.append(float(m.rise[0]))
    assert max(rises) > 0.25 and np.abs(np.diff(rises, 2)[2:]).max() < 0.025


@given(st.floats(0.0, 0.05), st.floats(0.0, 1.0))
def test_a_leg_comes_to_be_long_enough_smoothly(lacks, firm):
    """A heel that had risen too late gave more than its leg lacked from one step to the next; a knee was thrown from straight at 2.5 m/s."""
    lengths = []
    for distance in np.arange(0.76, 0.84, 0.0005):
        ankle = np.array([0.0, -distance, 0.0])
        nearer_kernel(np.zeros(3), ankle, 0.8, 0.8 + lacks, firm, np.inf)
        lengths.append(-ankle[1])
    assert np.abs(np.diff(lengths, 2)).max() < (1.0 - firm) * 0.0005 * min(1.0, 0.0005 / (2.0 * min(0.006, 0.3 * lacks) + 1e-9)) * 1.05 + 1e-9
