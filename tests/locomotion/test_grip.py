"""How the points of feet take hold and let go: what is held does not move, and what is not does not drag."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.locomotion.grip import LATE, LEFT, hold_kernel, take_foot
from gambol.controllers.locomotion.kernel import LABELS_AT
from gambol.controllers.locomotion.memory import RUN, WALK
from gambol.controllers.locomotion.root_motion import tempo_kernel
from playing import FPS

HEEL, BALL = 0, 1
ON = st.floats(0.05, 0.95)
STILL = np.zeros((4, 2))


def walking(locomotion, progress, height=0.0):
    """A walker's memory (1,) whose left foot is so far through its swing, over the time of that, and whose points are shown so high over where they rest [m]."""
    memory = locomotion.start().memory.copy().reshape(1)
    memory["settled"], memory["phase"] = 0, 0.38 * progress
    memory["points"][0, :, 1], memory["raised"] = locomotion.tables.legs.height + height, 0.0
    memory["grip"], memory["row_rate"], memory["offset_rate"], memory["aside_rate"] = 0.0, 0.0, 0.0, 0.0
    memory["row"][0, LABELS_AT:LABELS_AT + 4] = 0.0
    return memory


def turned(points, angle, about, moves):
    """Points (4, 2) turned about a place (2,) by an angle [rad], and moved."""
    c, s = np.cos(angle), np.sin(angle)
    return about + (points - about) @ np.array([[c, -s], [s, c]]) + moves


@given(ON, st.sampled_from([HEEL, BALL]), st.floats(-0.1, 0.1), st.tuples(ON, ON))
def test_a_foot_turns_about_the_point_that_is_held(locomotion, drags, held, angle, moves):
    """Its ball went by 2 mm a frame as somebody turned over it whose heel, half free, dragged."""
    memory = walking(locomotion, 2.0)
    memory["offset"] = memory["aside"] = 0.0
    memory["grip"][0, 1 - held], memory["grip"][0, held] = drags, 1.0
    before = np.array([[0.0, 0.0], [0.03, 0.15], [0.2, 0.0], [0.2, 0.15]])
    now = turned(before, angle, np.array([0.1, -0.4]), 0.02 * np.array(moves))
    hold_kernel(memory[0], 0, before, now, 1 / FPS)
    x, z, turn = memory["offset"][0, 0]
    shown = turned(now[HEEL], turn, now[BALL], np.zeros(2)) if held == HEEL else now[BALL]
    assert np.abs(shown + [x, z] - before[held]).max() < 1e-6


@pytest.mark.parametrize("progress, height, speed, takes", [(0.9, 0.004, 0.4, True), (0.9, 0.03, 0.4, False), (0.9, 0.004, 2.0, False), (0.6, 0.004, 0.4, False)])
def test_a_heel_that_has_come_down_slowly_takes_hold(locomotion, progress, height, speed, takes):
    """Whatever its label says; one that is high, fast or in mid-swing swings on."""
    memory = walking(locomotion, progress, height)
    take_foot(memory[0], 0, locomotion.tables.legs.height, STILL, STILL + [speed / FPS, 0.0], 1 / FPS)
    assert memory["grip"][0, HEEL] > 0.3 if takes else memory["grip"][0, HEEL] == 0.0


@given(st.floats(0.0, 1.0), st.floats(-0.5, 0.5))
def test_a_foot_that_takes_hold_goes_on_as_it_swung(locomotion, label, rate):
    """What it went beside the blend was lost at once, and its ankle thrown."""
    memory = walking(locomotion, 0.95)
    memory["row"][0, LABELS_AT], memory["row_rate"][0, LABELS_AT], memory["offset_rate"][0, 0, 0] = label, 1.0, rate
    memory["points"][0, :, 1] += 0.02
    take_foot(memory[0], 0, locomotion.tables.legs.height, STILL, STILL, 1 / FPS)
    assert np.isclose(memory["aside_rate"][0, 0, 0], rate if memory["grip"][0, HEEL] > 0.0 else 0.0, atol=1e-6)


@given(st.floats(0.05, LEFT[0] - 0.01), st.floats(0.3, 1.0), st.floats(-5.0, 5.0), st.sampled_from([HEEL, BALL]))
def test_what_has_begun_to_leave_leaves(locomotion, grip, label, rate, k):
    """Late in a stance: half held, it slid on for up to ten frames."""
    memory = walking(locomotion, LATE + 0.1)
    memory["grip"], memory["row"][0, LABELS_AT + k], memory["row_rate"][0, LABELS_AT + k] = grip, label, rate
    for _ in range(4):
        take_foot(memory[0], 0, locomotion.tables.legs.height, STILL, STILL, 1 / FPS)
    assert memory["grip"][0, k] == 0.0


def test_a_strained_ball_that_slips_is_let_go(locomotion):
    """As a turn begins, its heel 12 cm up: held by 0.85 it went by 2.8 cm."""
    memory = walking(locomotion, LATE + 0.4)
    memory["grip"][0, BALL], memory["rise"][0, 0], memory["row"][0, LABELS_AT + BALL], memory["row_rate"][0, LABELS_AT + BALL] = 0.9, 0.45, 1.0, 1.0
    for _ in range(4):
        take_foot(memory[0], 0, locomotion.tables.legs.height, STILL, STILL, 1 / FPS)
    assert memory["grip"][0, BALL] == 0.0


@given(ON, st.floats(0.0, 0.99), st.floats(0.1, 5.0))
def test_nothing_lets_go_while_its_label_rises(locomotion, grip, label, rate):
    """As a gait changes just after a foot came to stand, whose label is lower in the other."""
    memory = walking(locomotion, 1.4)
    memory["family"], memory["grip"], memory["row"][0, LABELS_AT], memory["row_rate"][0, LABELS_AT] = RUN, grip, label, rate
    take_foot(memory[0], 0, locomotion.tables.legs.height, STILL, STILL, 1 / FPS)
    assert memory["grip"][0, HEEL] >= np.float32(grip)


@pytest.mark.parametrize("family, phase", [(WALK, 0.47), (RUN, 0.75)])
@given(ON, st.floats(0.0, 0.99), st.floats(-20.0, 0.0))
def test_what_has_just_come_down_holds_on(locomotion, family, phase, grip, label, rate):
    """While its label wavers, as a run begins: half let go for a frame or two, a heel went on by 1.7 cm."""
    memory = walking(locomotion, 0.0)
    memory["phase"], memory["family"], memory["grip"], memory["row"][0, LABELS_AT], memory["row_rate"][0, LABELS_AT] = phase, family, grip, label, rate
    take_foot(memory[0], 0, locomotion.tables.legs.height, STILL, STILL, 1 / FPS)
    assert memory["grip"][0, HEEL] >= np.float32(grip)


@pytest.mark.parametrize("lift, takes", [(0.0, True), (0.045, False)])
def test_a_foot_that_is_held_up_does_not_take_hold(locomotion, lift, takes):
    """It was let down by 4 cm within four steps, as a turn's long steps ended and as a run became a walk."""
    memory = walking(locomotion, 0.85)
    memory["row"][0, LABELS_AT:LABELS_AT + 2], memory["row_rate"][0, LABELS_AT:LABELS_AT + 2], memory["lift"] = 1.0, 1.0, lift
    take_foot(memory[0], 0, locomotion.tables.legs.height, STILL, STILL, 1 / FPS)
    assert (memory["grip"][0, :2] > 0.3).all() if takes else (memory["grip"][0, :2] == 0.0).all()


@given(st.floats(0.0, 1.0))
def test_steps_hurry_less_and_less_as_a_foot_leaves(locomotion, far):
    """A foot that was far off and half let go ended the hurry within a step: the other one, which swung, was stopped by as much as two fifths."""
    memory, tempo = walking(locomotion, 2.0), []
    memory["offset"] = [[[far, 0.0, 0.0], [0.0, 0.0, 0.0]]]
    for grip in np.linspace(1.0, 0.0, 101):
        memory["grip"][0, :2] = grip
        memory["standing"] = memory["grip"] > 0.5
        tempo.append(tempo_kernel(memory[0]))
    assert np.abs(np.diff(tempo)).max() < 0.07 and tempo[0] == max(tempo)


@pytest.mark.parametrize("progress, takes", [(0.05, False), (0.95, True)])
def test_a_foot_that_has_just_left_does_not_take_hold(locomotion, progress, takes):
    """Its label wavered, and it was stopped for a step or two: a knee was thrown by 2 m/s as a turn's first foot had left."""
    memory = walking(locomotion, progress)
    memory["row"][0, LABELS_AT:LABELS_AT + 2], memory["row_rate"][0, LABELS_AT:LABELS_AT + 2] = 0.3, 1.0
    take_foot(memory[0], 0, locomotion.tables.legs.height, STILL, STILL, 1 / FPS)
    assert (memory["grip"][0, :2] > 0.3).all() if takes else (memory["grip"][0, :2] == 0.0).all()
