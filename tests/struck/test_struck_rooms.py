"""Who is struck beside walls, on platforms and on stairs: walls hold him, feet find treads, and who is not caught short of an edge goes over it."""

import numpy as np
import pytest

from gambol.controllers.body import contact_points, forward_kinematics
from gambol.controllers.contract import Intent, Strike
from gambol.controllers.jump import Physique
from gambol.controllers.navigation import gap
from gambol.controllers.person import person
from gambol.controllers.struck import DROPS, FALLS, STEPS, flesh
from gambol.game.scene import Box

DT, BODY = 1 / 60, Physique()


@pytest.fixture(scope="module")
def somebody():
    return person()


def played(somebody, things, gained, start=(0.0, 0.0, 0.0), floor=0.0, seconds=4.0):
    """All states of somebody who is struck, by so much velocity (2,) [m/s], amid things."""
    state, states = somebody.start(start, floor), []
    for n in range(10 + round(seconds / DT)):
        strike = Strike(tuple(BODY.mass * np.array(gained))) if n == 10 else None
        state, _ = somebody.step(state, Intent(around=things, strike=strike), DT)
        if n >= 10:
            states.append(state)
    return states


def deep(states, things):
    """How deep [m] flesh is in things at most."""
    placed = forward_kinematics(BODY.skeleton, np.stack([np.asarray(s.pose.root, float) for s in states]), np.stack([np.asarray(s.pose.rotations, float) for s in states]))
    points, thick = flesh(BODY, *placed)
    return max(float((thick - gap(points.reshape(-1, 3), thing).reshape(points.shape[:2])).max()) for thing in things)


@pytest.mark.few(1)
@pytest.mark.parametrize(("far", "hard"), [(0.5, 1.0), (0.7, 2.0), (1.6, 2.6)])
def test_a_wall_holds_who_is_thrown_against_it(somebody, far, hard):
    """Near it he stays on his feet; farther off he falls; nothing of him is in it."""
    walls = (Box((0.0, 1.25, far + 0.1), (6.0, 2.5, 0.2)),)
    states = played(somebody, walls, (0.0, hard), seconds=6.0)
    assert deep([s for s in states if s.active == "struck"], walls) < 0.03  # a nodding head comes nearest; idle hands are another matter
    assert states[0].memory.memory.made.fate == (FALLS if far > 1.0 else STEPS)
    assert states[-1].ground[1] < far - 0.1


@pytest.mark.few(1)
@pytest.mark.parametrize(("things", "gained", "most"), [((Box((0.0, 1.0, 0.8), (6.0, 2.0, 0.2)),), 0.96, 4.0), ((Box((0.0, 0.5, 1.6), (3.0, 1.0, 2.0)),), 0.55, 5.0)])
def test_nobody_stands_for_long_as_his_feet_can_not_come_home(somebody, things, gained, most):
    """He was frozen for six seconds, his feet kept from where they rest by a wall, and heard nothing; with one foot set across the other, too."""
    states = played(somebody, things, (0.0, gained), seconds=6.0)
    assert sum(s.active == "struck" for s in states) * DT < most
    feet = forward_kinematics(BODY.skeleton, states[-1].pose.root.astype(float), states[-1].pose.rotations.astype(float))[0][[BODY.skeleton.index(side + "Foot") for side in ("Left", "Right")]]
    assert feet[0, 0] - feet[1, 0] > 0.1


def test_who_is_pushed_over_an_edge_lands_below_on_his_feet(somebody):
    box = (Box((0.0, 0.5, 0.0), (2.0, 1.0, 2.0)),)
    states = played(somebody, box, (0.0, 1.8), (0.0, 0.6, 0.0), 1.0)
    assert states[0].memory.memory.made.fate == DROPS and any(s.active == "jump" for s in states)
    assert states[-1].floor == pytest.approx(0.0, abs=0.02) and states[-1].active == "locomotion" and states[-1].ground[1] > 1.0


def test_who_can_catches_himself_short_of_an_edge(somebody):
    """His feet stay on the platform, though the step that he would have taken ends beyond it."""
    box = (Box((0.0, 0.5, 0.0), (2.0, 1.0, 2.0)),)
    states = played(somebody, box, (0.0, 0.6), (0.0, 0.45, 0.0), 1.0)
    made = states[0].memory.memory.made
    points = contact_points(BODY.skeleton, *forward_kinematics(BODY.skeleton, made.roots, made.local))
    assert made.fate == STEPS and np.abs(points[-1][:, [0, 2]]).max() < 1.0
    assert states[-1].floor == pytest.approx(1.0) and states[-1].active == "locomotion"


def test_who_steps_aside_puts_a_foot_onto_the_next_tread(somebody):
    step = (Box((0.0, 0.075, 1.25), (3.0, 0.15, 2.0)),)
    made = played(somebody, step, (0.0, 0.8), seconds=0.1)[0].memory.memory.made
    assert made.fate == STEPS and made.floors[-1] == pytest.approx(0.15)
    points = contact_points(BODY.skeleton, *forward_kinematics(BODY.skeleton, made.roots[-1], made.local[-1]))
    assert points[:, 1].min() > 0.15


def test_feet_cross_over_who_is_pushed_aside(somebody):
    """The foot that bears no weight steps across the other, in front of it, and catches what no side step would."""
    made = played(somebody, (), (0.8, 0.0), seconds=0.1)[0].memory.memory.made
    assert made.fate == STEPS
    points = contact_points(BODY.skeleton, *forward_kinematics(BODY.skeleton, made.roots, made.local)).reshape(len(made.times), 2, 2, 3)
    landed = int(np.searchsorted(made.times, made.landings[0, 1])) + 1
    left, right = points[landed].mean(1)
    assert made.landings[0, 0] == 1 and right[0] > left[0] + 0.1 and right[2] > left[2]
    apart = np.linalg.norm(points[:, 0, :, None] - points[:, 1, None], axis=-1).min((1, 2))
    assert apart.min() > 0.06  # and never touches it


def test_legs_that_lose_the_floor_do_not_flail(somebody):
    """Struck hard near an edge he goes over it as his feet leave in haste; they go on no faster than legs swing, and not back through the platform."""
    wide, high, long = 1.391, 1.049, 1.571
    box = (Box((0.0, 0.5 * high, 0.0), (wide, high, long)),)
    start = (-0.194, -0.284, 0.978)
    for gained in ((-0.318, -2.346), (-0.2, -2.3), (0.0, -2.2)):
        states = [s for s in played(somebody, box, gained, start, high, 1.5) if s.active == "jump"]
        placed = forward_kinematics(BODY.skeleton, np.stack([np.asarray(s.pose.root, float) for s in states]), np.stack([np.asarray(s.pose.rotations, float) for s in states]))
        feet = contact_points(BODY.skeleton, *placed) - placed[0][:, :1]
        assert len(states) > 5 and np.linalg.norm(np.diff(feet, axis=0), axis=-1).max() / DT < 14.0
