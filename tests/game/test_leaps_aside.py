"""Who is to leap to a place beside his way turns to it with the steps that are left and leaps along the line to it; so do hands whose stick points aside as they tap."""

import math

import numpy as np
import pytest

from gambol.controllers.contract import but
from gambol.controllers.jump import Jumping
from gambol.controllers.jump.reach import arcs, reach
from gambol.controllers.jump.body import soles
from gambol.controllers.locomotion import Locomotion, Settings
from gambol.controllers.navigation import in_world, room
from gambol.controllers.person import person
from gambol.game.input import Jump, Move, Script, Wish
from gambol.game.input.aside import EACH, beside, lands
from gambol.game.scene.scene import Box
from gambol.game.session import Timeline, begin, refused
from gambol.game.world import DT, RATE, Character, World

HELD = 0.1
"""So long hands hold the button [s]."""


@pytest.fixture(scope="module")
def someone():
    return person(Locomotion.load(settings=Settings(idle=0.0)))


@pytest.fixture(scope="module")
def under_way(someone):
    """Somebody who walks straight on at 1.3 m/s, at two moments of his stride."""
    state, found = someone.start(), []
    for step in range(205):
        script, intent = Script((Move(9.0, (1.3, 0.0, 0.0)),)).step(state, DT)
        state, _ = someone.step(state, intent, DT)
        if step in (180, 204):
            found.append(state)
    return found


def told(someone, state, aside, far, path=False):
    """What becomes of one who is told a place so far to the left of his way [°], so far away [m]: his states, the plan that he leaps, None where there is none, the place (2,), and the script."""
    course = math.atan2(*in_world(state.ground, state.velocity)) + math.radians(aside)
    place = state.ground[:2] + far * np.array([math.sin(course), math.cos(course)])
    jump = Jump((float(place[0]), 0.0, float(place[1])))
    walks = Move(9.0, points=(tuple(map(float, place)),), speed=1.3, jump=jump) if path else Move(5.0, (1.3, 0.0, 0.0), jump=jump)
    script, states = Script((walks, Move(3.0, (1.3, 0.0, 0.0)))), []
    for _ in range(round(4.0 * RATE)):
        script, intent = script.step(state, DT)
        script, intent = script.held(someone, state, intent, (), DT)
        state, _ = someone.step(state, intent, DT)
        states.append(state)
        if isinstance(state.memory.memory, Jumping):
            return states, state.memory.memory.plan, place, script
    return states, None, place, script


@pytest.mark.few(1)
@pytest.mark.parametrize("path", [False, True])
@pytest.mark.parametrize("aside", [40.0, -40.0, -60.0])
def test_who_has_time_for_a_step_turns_to_the_place_and_leaps_on_along_the_line_to_it(someone, under_way, aside, path):
    """It was refused, as too near for his run, or he sat down on the foot that had struck and stopped where he came down, facing on."""
    strides = []
    for state in under_way:
        states, made, place, script = told(someone, state, aside, 2.2, path)
        assert made is not None, script.refused
        assert len(states) * DT < 2.0
        one, way = made.path.lands, place - states[-1].ground[:2]
        strides.append(one is not None)
        landed = soles(made.feet if one is None else made.feet[one:one + 1], someone.parts["jump"].physique.tables)[:, [0, 2]].mean(0)
        assert np.linalg.norm(landed - place) < 0.05
        assert abs(math.remainder(made.path.heading + made.path.turn - math.atan2(*way), math.tau)) < 0.3
        assert abs(math.remainder(float(states[-1].ground[2]) - math.atan2(*way), math.tau)) < 0.75, "the steps before it turned him most of the way"
    assert any(strides), "he walks on from there"


@pytest.mark.few(1)
@pytest.mark.parametrize("aside, far", [(40.0, 0.8), (-60.0, 0.8), (90.0, 1.0)])
def test_what_is_near_and_aside_is_leapt_to_at_once_or_after_a_stop(someone, under_way, aside, far):
    for state in under_way:
        states, made, place, script = told(someone, state, aside, far)
        assert made is not None, script.refused
        feet = made.feet if made.path.lands is None else made.feet[made.path.lands:made.path.lands + 1]
        assert np.linalg.norm(soles(feet, someone.parts["jump"].physique.tables)[:, [0, 2]].mean(0) - place) < 0.05
        assert abs(made.path.turn) < 0.8


def test_what_lies_ahead_is_none_beside_him_and_nobody_turns_farther_in_the_air_than_he_can(under_way):
    state = under_way[0]
    ahead = np.array(in_world(state.ground, state.velocity)) / 1.3
    assert not beside(state, 2.0 * ahead) and not beside(state, 2.0 * ahead + [0.05, 0.0]) and beside(state, 2.0 * ahead + [0.5, 0.0])
    for aside in np.linspace(-3.0, 3.0, 13):
        there = float(state.ground[2]) + aside
        off = math.remainder(lands(state, np.array([math.sin(there), math.cos(there)])) - float(state.ground[2]), math.tau)
        assert abs(off - min(max(aside, -0.75), 0.75)) < 0.06


def tapped(someone, aside, back=None, speed=1.3):
    """The plan of somebody who goes straight on and taps the leap as the stick is thrown so far to the left [°], and let go after so long [s]; and which way he flies [rad], and when he begins [s]."""
    line = Timeline(begin(World((Character("A", someone, someone.start()),)), 1))
    pressed, throw, run = round(3.1 * RATE), min(speed / 1.3, 1.0), max((speed - 1.3) / 1.7, 0.0)
    for step in range(pressed + round(1.5 * RATE)):
        yaw, since, before = line.now.players[0].camera.yaw, (step - pressed) / RATE, line.now
        there, on = math.radians(aside) * (since >= 0.0), throw * (back is None or since < back)
        line.advance((Wish(move=(-on * math.sin(there - yaw), on * math.cos(there - yaw)), run=run, jump=0.0 <= since < HELD).rounded(),))
        assert not refused(before, line.now)
        memory = line.now.after.characters[0].state.memory.memory
        if isinstance(memory, Jumping):
            flown = (memory.plan.path.land - memory.plan.path.leave)[[0, 2]]
            return memory.plan, math.atan2(*flown), since
    raise AssertionError("he did not leap")


@pytest.mark.few(1)
@pytest.mark.parametrize("speed", [1.3, 2.5])
@pytest.mark.parametrize("aside", [40.0, -60.0, 90.0])
def test_hands_that_throw_the_stick_aside_as_they_tap_leap_where_it_points(someone, aside, speed):
    """He leapt on the way that he had gone, as the foot came that sent him there: 37° beside the stick in the median."""
    made, way, since = tapped(someone, aside, speed=speed)
    assert abs(way - math.radians(aside)) < math.radians(25.0) and since < 1.5
    assert made.path.lands is not None


def test_hands_that_let_go_of_the_stick_as_he_turns_leap_at_once_on_the_way_that_he_goes_by_then(someone):
    _, way, since = tapped(someone, 90.0, 0.3)
    _, _, turned = tapped(someone, 90.0)
    assert since < turned and 0.0 < way < math.radians(80.0)


def at_a_run(someone, speed):
    """Somebody who goes straight on so fast [m/s]."""
    state = someone.start()
    for _ in range(200):
        state, _ = someone.step(state, Script((Move(9.0, (speed, 0.0, 0.0)),)).step(state, DT)[1], DT)
    return state


@pytest.mark.few(1)
@pytest.mark.parametrize("speed, aside, far", [(1.3, -60.0, 2.0), (2.8, 60.0, 2.5)])
def test_no_step_of_who_thinks_of_a_leap_aside_has_more_to_work_out_than_a_few_paths_or_a_plan_and_it_is_the_same_again(someone, monkeypatch, speed, aside, far):
    """It was found out at once, in a quarter to one and a half seconds: a live theatre stood still. Nor does it matter what is known already of a leap that was thought of before."""
    paths, plans, steps = [], [], []
    path, plan, step, held = arcs.grounded, reach.drafted, type(someone.parts["locomotion"]).step, Script.held
    most = []
    monkeypatch.setattr(arcs, "grounded", lambda *given: paths.append(1) or path(*given))
    monkeypatch.setattr(reach, "drafted", lambda *given: plans.append(1) or plan(*given))
    monkeypatch.setattr(type(someone.parts["locomotion"]), "step", lambda *given: steps.append(1) or step(*given))

    def counted(*given):
        for some in (paths, plans, steps):
            some.clear()
        after = held(*given)
        most.append((len(paths), len(plans), len(steps)))
        return after
    monkeypatch.setattr(Script, "held", counted)
    state = at_a_run(someone, speed)
    states, made, _, script = told(someone, state, aside, far)
    assert made is not None, script.refused
    assert max(paths for paths, _, _ in most) <= 3 and max(plans for _, plans, _ in most) <= 1 and max(steps for _, _, steps in most) <= EACH + 1
    again, _, _, _ = told(someone, state, aside, far)
    assert len(again) == len(states) and all(np.array_equal(one.pose.root, other.pose.root) for one, other in zip(states, again))


def test_who_walks_slowly_to_a_place_aside_goes_faster_and_leaps_on_one_foot(someone):
    """At 0.8 m/s nobody pushes off one foot: he sat down over both, and stood."""
    state = at_a_run(someone, 0.8)
    for aside in (-40.0, 60.0):
        _, made, _, script = told(someone, state, aside, 2.0)
        assert made is not None and made.path.lands is not None, script.refused


@pytest.mark.few(1)
@pytest.mark.parametrize("speed, aside, far", [(3.0, 0.0, 1.3), (1.3, 180.0, 1.3), (2.5, 150.0, 1.3)])
def test_who_is_told_of_a_place_that_he_runs_past_or_that_lies_behind_turns_back_and_leaps_there(someone, speed, aside, far):
    """He was refused, and ran on."""
    states, made, place, script = told(someone, at_a_run(someone, speed), aside, far)
    assert made is not None, script.refused
    feet = made.feet if made.path.lands is None else made.feet[made.path.lands:made.path.lands + 1]
    assert np.linalg.norm(soles(feet, someone.parts["jump"].physique.tables)[:, [0, 2]].mean(0) - place) < 0.05


@pytest.mark.few(1)
@pytest.mark.parametrize("aside", [25.0, -25.0])
def test_who_thinks_of_a_leap_aside_onto_a_box_does_not_walk_into_it_meanwhile(someone, under_way, aside):
    """He thought for a second, walked into it at 1.3 m/s, and was lifted up onto it without a leap."""
    state = under_way[0]
    course = math.atan2(*in_world(state.ground, state.velocity)) + math.radians(aside)
    x, z = state.ground[:2] + 2.3 * np.array([math.sin(course), math.cos(course)])
    things = (Box((float(x), 0.3, float(z)), (1.5, 0.6, 1.5), course),)
    script = Script((Move(5.0, (1.3, 0.0, 0.0), jump=Jump((float(x), 0.6, float(z)))),))
    for _ in range(round(1.5 * RATE)):
        script, intent = script.step(state, DT)
        script, intent = script.held(someone, state, but(intent, around=things), things, DT)
        after, _ = someone.step(state, but(intent, around=things), DT)
        if after.active == "jump":
            break
        lost = np.hypot(*state.velocity[::2]) - np.hypot(*after.velocity[::2])
        assert lost < 0.3, f"he lost {lost:.2f} m/s in a step"
        assert float(after.floor) < 0.05
        state = after
    assert room(state.ground[:2], 0.0, things) > 0.0
