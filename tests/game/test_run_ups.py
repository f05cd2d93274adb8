"""Run-ups with a leap that can't be made: he comes to rest before what he can't leap, and is told why; one that can be made goes off as ever."""

from dataclasses import replace

import numpy as np
import pytest

from gambol.controllers.body import Pose, forward_kinematics
from gambol.controllers.contract import Intent
from gambol.controllers.jump import Jump as Jumper
from gambol.controllers.jump import Jumping
from gambol.controllers.jump.reach import reach
from gambol.controllers.locomotion import Locomotion, Settings
from gambol.controllers.navigation import gap
from gambol.controllers.navigation.thinking import steps_of
from gambol.controllers.person import person
from gambol.game.input import Jump, Move, RunUp, Script, Wish
from gambol.game.input import run_up as run_ups
from gambol.game.input.run_up import last_chance
from gambol.game.input.straight_ahead import before
from gambol.game.scene.scene import Box, Pillar
from gambol.game.session.state import begin
from gambol.game.session.tick import Timeline, refused
from gambol.game.world.world import DT, Character, World
from stand_in import Glide

LEGS = [side + part for side in ("Left", "Right") for part in ("Leg", "Foot", "Toe")]


@pytest.fixture(scope="module")
def library():
    return Locomotion.load()


def box(far, high, deep=4.0):
    return Box((0.0, 0.5 * high, far + 0.5 * deep), (4.0, high, deep))


def run_up(who, things, pace, place, floor=0.0, seconds=4.0):
    """All states of somebody whose script runs up to a leap, and its script after them."""
    return led(who, things, (Move(seconds, (pace, 0.0, 0.0), jump=Jump(place)), Move(0.2)), seconds + 0.04, floor)


def led(who, things, moves, seconds, floor=0.0):
    """All states of somebody who makes moves for so long [s], and his script after them."""
    script = Script(moves)
    world, states = World((Character("A", who, who.start((0.0, 0.0, 0.0), floor)),), things), []
    for _ in range(round(seconds / DT)):
        states.append(world.characters[0].state)
        script, intent = script.step(states[-1], DT)
        script, intent = script.held(who, states[-1], intent, things, DT)
        world = world.step([intent])
    return states, script


def deepest(who, states, things):
    """How deep [m] knees, ankles and toes are in anything."""
    at = [who.skeleton.index(name) for name in LEGS]
    positions, _ = forward_kinematics(who.skeleton, np.stack([s.pose.root for s in states]).astype(float),
                                      np.stack([s.pose.rotations for s in states]).astype(float))
    return max(float(-gap(positions[:, at].reshape(-1, 3), thing).min()) for thing in things)


@pytest.mark.few(1)
@pytest.mark.parametrize("agility, pace, far", [(0.5, 1.3, 2.2), (1.0, 3.2, 3.6), (2.0, 3.0, 1.9)])
def test_nobody_runs_into_what_is_too_high_to_leap(library, agility, pace, far):
    who, things = person(library.tuned(Settings(idle=0.0, agility=agility))), (box(far, 1.5),)
    states, script = run_up(who, things, pace, (0.0, 1.5, far + 0.5))
    assert deepest(who, states, things) < 0.02
    assert np.hypot(*states[-1].velocity[[0, 2]]) < 0.15 and far - 1.0 < states[-1].ground[1] < far
    assert len(script.refused) == 1 and "too" in script.refused[0]


@pytest.mark.thorough
def test_nobody_runs_over_the_edge_of_a_gap_that_is_too_wide(library):
    who, things = person(library.tuned(Settings(idle=0.0))), (box(-3.0, 1.0, 6.0), box(7.0, 1.0))
    states, script = run_up(who, things, 2.8, (0.0, 1.0, 7.4), floor=1.0)
    assert all(s.active == "locomotion" for s in states) and states[-1].floor == 1.0 and 2.0 < states[-1].ground[1] < 3.0
    assert script.refused


def test_a_leap_that_goes_off_is_not_braked_for(library):
    who, things = person(library.tuned(Settings(idle=0.0))), (box(3.9, 0.4),)
    states, script = run_up(who, things, 1.4, (0.0, 0.4, 4.2))
    first = next(n for n, s in enumerate(states) if s.active == "jump")
    assert states[first - 1].velocity[0] > 1.2, "he goes as he went"
    assert isinstance(states[first].memory.memory, Jumping) and not script.refused


def landed(states):
    """After how many states somebody has come down from his first leap."""
    return next(n for n, s in enumerate(states) if s.active == "locomotion" and any(now.active == "jump" for now in states[:n]))


@pytest.mark.few(1)
@pytest.mark.parametrize("far, askew", [(9.0, 0.5), (9.3, 0.0), (9.6, 0.5), (9.9, 0.0)])
def test_who_has_just_landed_from_a_run_stops_before_what_he_can_not_leap_from_there(library, far, askew):
    """He went on with his leap in mind, and through its edge."""
    hurdle, high = Box((0.0, 0.14, 5.2), (4.0, 0.28, 0.12)), Box((0.0, 0.45, far + 1.5), (3.0, 0.9, 3.0), askew)
    who = person(library.tuned(Settings(idle=0.0)))
    states, script = led(who, (hurdle, high), (Move(4.0, (3.4, 0.0, 0.0), jump=Jump((0.0, 0.0, 6.2))), Move(4.0, (2.4, 0.0, 0.0), jump=Jump((0.0, 0.9, far + 0.6)))), 6.0)
    assert deepest(who, states[landed(states):], (high,)) < 0.01 and np.hypot(*states[-1].velocity[[0, 2]]) < 0.1
    assert script.now.run_up.halt is not None


@pytest.mark.few(1)
@pytest.mark.parametrize("pace", [1.2, 3.4])
def test_nobody_leaps_back_to_what_his_run_up_has_gone_past(library, pace):
    """Who was braked before a wall asked for his leap wherever it led."""
    who, wall = person(library.tuned(Settings(idle=0.0))), box(1.4, 1.8)
    states, script = run_up(who, (wall,), pace, (0.0, 0.0, -0.2), seconds=3.0)
    assert all(s.active == "locomotion" for s in states) and script.refused[0].endswith("its run-up ended 1.2 m away")


def test_who_was_braked_before_a_box_has_room_to_leap_onto_it_from_where_he_rests(library):
    """No footfall of his run was one to leap from."""
    who = person(library.tuned(Settings(idle=0.0)))
    states, script = led(who, (box(6.0, 0.6),), (Move(1.2, (3.0, 0.0, 0.0)), Move(5.0, (3.0, 0.0, 0.0), jump=Jump((0.0, 0.6, 6.3))), Move(0.2)), 6.3)
    off = next(n for n, s in enumerate(states) if s.active == "jump")
    assert not script.refused and states[-1].floor == pytest.approx(0.6, abs=0.01) and np.hypot(*states[off - 1].velocity[[0, 2]]) < 0.25  # as who stands


def test_what_kept_a_runner_from_leaping_is_told_not_what_keeps_him_where_he_stands(library):
    """He is braked, as no footfall was one to leap from; asked at rest, he is told of a leap from there, which nobody meant."""
    who = person(library.tuned(Settings(idle=0.0)))
    states, script = led(who, (box(6.0, 0.9),), (Move(1.2, (3.4, 0.0, 0.0)), Move(4.0, (3.4, 0.0, 0.0), jump=Jump((0.0, 0.9, 6.6))), Move(0.2)), 5.3)
    assert all(s.active == "locomotion" for s in states) and "from this run" in script.refused[0] and script.refused[0].endswith("m away")


def test_leaps_one_after_another_go_off_each_once_he_stands_who_could_not_leap_from_the_landing(library):
    """Asked as he still stood up he could not, and nobody asked again."""
    who = person(library)
    things = Box((0.0, 0.2, 3.0), (0.5, 0.4, 0.6)), Box((0.6, 0.3, 4.2), (0.5, 0.6, 0.6)), Box((0.0, 0.2, 5.4), (0.4, 0.4, 0.4))
    states, script = led(who, things, (Move(4.0, (1.4, 0.0, 0.0), jump=Jump((0.0, 0.4, 3.0))), Move(np.inf, jump=Jump((0.6, 0.6, 4.2))),
                                       Move(np.inf, jump=Jump((0.0, 0.4, 5.4), heading=np.pi / 2)), Move(np.inf, jump=Jump((0.0, 0.0, 6.4), heading=-np.pi / 2))), 14.0)
    assert script.done and not script.refused and np.hypot(*(states[-1].ground[:2] - [0.0, 6.4])) < 0.1


def test_straight_ahead_he_is_to_stop_before_a_wall_and_short_of_an_edge():
    who = Glide()
    assert before(who, who.start((0.0, 0.0, 0.0)), (0.0, 0.0), (box(2.0, 1.0),)) is None
    assert before(who, who.start((0.0, 0.0, 0.0)), (0.0, -3.0), (box(2.0, 1.0),)) is None
    assert before(who, who.start((0.0, -9.0, 0.0)), (0.0, 3.0), (box(2.0, 1.0),)) is None, "far away"
    x, z = before(who, who.start((0.0, 0.0, 0.0)), (0.0, 3.0), (box(2.0, 1.0),))
    assert x == 0.0 and 1.4 < z < 1.7
    assert 1.6 < before(who, who.start((0.0, 0.0, 0.0), 1.0), (0.0, 3.0), (box(-2.0, 1.0),))[1] < 1.8


def test_who_has_come_to_rest_there_stays():
    who = Glide()
    intent = RunUp(0, (0.0, 0.1)).heeded(who.start((0.0, 0.0, 0.0)), Intent(np.array([3.0, 0.0, 0.0])))
    assert not intent.velocity.any() and intent.halt is None


@pytest.mark.thorough
def test_hands_that_walk_at_a_platform_leap_onto_it_and_at_a_wall_stop(library):
    who, ends, told = person(library.tuned(Settings(idle=0.0))), [], []
    for high in (0.35, 1.5):
        line = Timeline(begin(World((Character("A", who, who.start((0.0, 0.0, 0.0))),), (box(3.0, high),)), 1))
        held, states = True, []
        for _ in range(300):
            state, aim = line.now.after.characters[0].state, line.now.players[0].aim
            states.append(state)
            held = held and not (state.ground[1] + aim.offset[1] > 3.2)
            was = line.now
            line.advance((Wish(move=(0.0, 1.0) if state.floor == 0.0 else (0.0, 0.0), jump=held and state.ground[1] > 0.8).rounded(),))
            told += refused(was, line.now)
        assert deepest(who, states, line.now.after.props) < 0.02
        ends.append(states[-1])
    assert ends[0].floor == pytest.approx(0.35) and ends[1].floor == 0.0


def running(who, things, floor, far, held=True):
    """All states of somebody whose hands run at something `far` away, the leap held from 3 m before it, if at all."""
    line, states = Timeline(begin(World((Character("A", who, who.start((0.0, 0.0, 0.0), floor)),), things), 1)), []
    while len(states) < 420 and (not states or states[-1].ground[1] < far + 3.5):
        states.append(line.now.after.characters[0].state)
        z = states[-1].ground[1]
        line.advance((Wish(move=(0.0, 1.0), run=0.9, jump=held and z > far - 3.0).rounded(),))
    return states


@pytest.mark.few(1)
@pytest.mark.parametrize("things, floor, far", [((box(-3.0, 1.0, 8.0), box(6.1, 1.0)), 1.0, 5.0), ((box(5.3, 0.35, 8.0),), 0.0, 5.3), ((box(5.6, 0.4, 0.15),), 0.0, 5.6),
                                                ((box(5.3, 0.25, 8.0),), 0.0, 5.3)])
def test_a_leap_held_at_a_run_goes_off_at_the_last_footfall_and_he_runs_on(library, things, floor, far):
    who = person(library.tuned(Settings(idle=0.0)))
    states = running(who, things, floor, far)
    leapt = [s for s in states if s.active == "jump"]
    first = next(n for n, s in enumerate(states) if s.active == "jump")
    assert states[first - 1].velocity[0] > 2.2, "nothing braked him"
    assert not any(s.memory.memory.fault for s in leapt) and states[-1].ground[1] > far + 3.4
    assert min(s.velocity[0] for s in states[first:]) > 1.2
    assert sum(now.active == "jump" and was.active != "jump" for was, now in zip(states, states[1:])) == 1, "the held button means one leap"


@pytest.mark.few(1)
@pytest.mark.parametrize("pace", [2.8, 3.4])
def test_who_runs_and_is_told_to_jump_up_does_so_once_he_has_come_to_rest(library, pace):
    """He asked for it for a second, as he still ran, and gave it up."""
    states, script = led(person(library), (), (Move(2.0, (pace, 0.0, 0.0)), Move(8.0, jump=Jump(airtime=0.45))), 5.5)
    leapt = next(n for n, state in enumerate(states) if state.active == "jump")
    assert not script.refused and states[leapt].memory.memory.plan.path.airtime == pytest.approx(0.45)


def test_a_leap_that_goes_off_by_itself_is_not_asked_about_for_ever(monkeypatch):
    """Each place from each footfall cost a second; who asked about all of them knew only once he had come to the obstacle."""
    asked, looked = [], []

    class Slow(Glide):
        def found(self, state, intent, ask):
            looked.append(intent.leap.place)
            for _ in range(4):
                ask()
    footfalls = [run_ups.Footfall(n, None, np.array([0.0, 1.0]), Intent(), np.array([0.0, 0.0, 1.0 + n])) for n in range(10)]
    monkeypatch.setattr(run_ups, "_footfalls", lambda *given: (footfalls, np.array([0.0, 0.0])))
    assert last_chance(Slow(), Glide().start(), (0.0, 3.0), lambda state: Intent(), (), DT, lambda: asked.append(1)) is None
    assert len(asked) == len(looked) and run_ups.MOST <= 5 * len(looked) < run_ups.MOST + 5 and looked[0][2] > 9.0, "the last footfall comes first"


def test_who_thought_of_his_leap_makes_one_plan_as_it_goes_off(library, monkeypatch):
    """Along the arc that was found; which is the plan that he finds if he looks at all of them, and from a hair elsewhere, too."""
    who, things = person(library.tuned(Settings(idle=0.0))), (box(5.6, 0.4, 0.15),)
    states = running(who, things, 0.0, 5.6)
    state, after = next(pair for pair in zip(states, states[1:]) if pair[1].active == "jump")
    state, intent = who.active(state)[1], Intent(leap=replace(after.memory.memory.asked, how=None), around=things)
    leap = Jumper().found(state, intent)
    elsewhere = replace(state, pose=Pose(state.pose.root + np.float32(1e-5), state.pose.rotations))
    plans, plan = [], reach.drafted
    monkeypatch.setattr(reach, "drafted", lambda *given: plans.append(plan(*given)) or plans[-1])
    counts = {}
    for name, now, asked in (("all", state, intent), ("found", state, replace(intent, leap=leap)), ("elsewhere", elsewhere, replace(intent, leap=leap))):
        Jumper().seek(now, asked)  # one who remembers nothing
        counts[name] = len(plans)
        plans.clear()
    assert counts["all"] > 1 and counts["found"] == counts["elsewhere"] == 1
    whole, again = (Jumper().plan(state, asked) for asked in (intent, replace(intent, leap=leap)))
    assert np.array_equal(whole.local, again.local) and np.array_equal(whole.roots, again.roots)


def test_a_leap_held_at_a_run_over_a_gap_too_wide_for_it_is_braked(library):
    who = person(library.tuned(Settings(idle=0.0)))
    states = running(who, (box(-3.0, 1.0, 8.0), box(8.5, 1.0)), 1.0, 5.0)
    assert all(s.active == "locomotion" or s.velocity[0] < 0.3 for s in states) and states[-1].floor == 1.0 and states[-1].ground[1] < 5.0


@pytest.mark.few(1)
@pytest.mark.parametrize("agility", [0.5, 1.0])
def test_nobody_whose_hands_run_at_an_edge_goes_over_it(library, agility):
    who = person(library.tuned(Settings(idle=0.0, agility=agility)))
    states = running(who, (box(-3.0, 1.0, 8.0), box(6.3, 1.0)), 1.0, 5.0, held=False)
    assert all(s.active == "locomotion" and s.ground[1] < 5.0 for s in states) and np.hypot(*states[-1].velocity[[0, 2]]) < 0.2


def test_what_a_runner_can_leap_is_thought_of_beside_his_steps(library):
    """He runs on meanwhile, the leap goes off at the step that was thought of, and all is the same again, however fast the machine is."""
    who, things = person(library.tuned(Settings(idle=0.0))), (box(-3.0, 1.0, 8.0), box(6.1, 1.0))
    twice = []
    for _ in range(2):
        line, known, states = Timeline(begin(World((Character("A", who, who.start((0.0, 0.0, 0.0), 1.0)),), things), 1)), [], []
        while not states or states[-1].active != "jump":
            line.advance((Wish(move=(0.0, 1.0), run=0.9, jump=bool(states) and states[-1].ground[1] > 1.0).rounded(),))
            states.append(line.now.after.characters[0].state)
            known.append(line.now.players[0].run_up)
        thinks = [n for n, one in enumerate(known) if one.thought is not None]
        found = next(n for n, one in enumerate(known) if one.leap is not None)
        assert len(thinks) >= steps_of(1, DT) and found == thinks[-1] + 1 and all(one.halt is None for one in known[thinks[0]:])
        assert known[found].free > 0 and len(states) - 1 == found + known[found].free
        assert min(s.velocity[0] for s in states[thinks[0]:]) > 2.2
        twice.append(np.array([s.ground for s in states]))
    assert np.array_equal(*twice)


class Known:
    """A thought that is used after so many steps."""

    def __init__(self, found, due):
        self.found, self.due = found, due

    def after(self, steps, hurried=False):
        return self.found if hurried or steps >= self.due else None


@pytest.mark.parametrize("due", [0, 3, 20])
@pytest.mark.parametrize("number", [0, 3, 12])
def test_a_leap_that_was_thought_of_goes_off_as_many_steps_sooner_as_he_thought(number, due):
    leap = Jump((0.0, 0.0, 1.0))
    known, steps = RunUp(-1, thought=Known(RunUp(number, leap=leap), due)), 0
    while known.thought is not None:
        known, steps = known.known(False, (0.0, 2.0)), steps + 1
    assert steps == due + 1
    assert (known.leap, known.free, known.halt) == ((leap, number - due, None) if number >= due else (None, -1, (0.0, 2.0)))
    assert RunUp(-1, thought=Known(RunUp(number, leap=leap), due)).known(True, None).leap is leap, "who is near waits for it"


def pressed(who, things, far, ahead, run=0.9, floor=0.0, steps=420):
    """All states of somebody whose hands run straight on and press the leap's key from so near [m] before something `far` away on, if at all, and what was known of his run-up."""
    line, states, known = Timeline(begin(World((Character("A", who, who.start((0.0, 0.0, 0.0), floor)),), things), 1)), [], []
    for _ in range(steps):
        states.append(line.now.after.characters[0].state)
        known.append(line.now.players[0].run_up)
        line.advance((Wish(move=(0.0, 1.0), run=run, jump=ahead is not None and states[-1].ground[1] > far - ahead).rounded(),))
    return states, known


@pytest.mark.few(1)
@pytest.mark.parametrize("things, floor, far", [((box(5.0, 0.33),), 0.0, 5.0), ((box(-3.0, 1.0, 8.0), box(7.0, 1.0)), 1.0, 5.0), ((box(5.0, 1.8),), 0.0, 5.0)])
@pytest.mark.parametrize("run", [0.0, 0.9])
def test_hands_that_go_straight_at_what_is_ahead_come_to_rest_before_it_and_are_not_led_aside(library, things, floor, far, run):
    who = person(library.tuned(Settings(idle=0.0)))
    states, _ = pressed(who, things, far, None, run, floor)
    assert max(abs(float(s.ground[0])) for s in states) < 0.05 and all(s.active == "locomotion" for s in states)
    assert far - 0.8 < states[-1].ground[1] < far and np.hypot(*states[-1].velocity[[0, 2]]) < 0.05


def test_hands_that_go_at_a_wall_askew_or_at_a_pillar_are_led_on(library):
    who, wall = person(library.tuned(Settings(idle=0.0))), Box((0.0, 1.0, 3.0), (30.0, 2.0, 0.2), 0.8)
    for things, on in (((wall,), 3.0), ((Pillar((0.1, 0.0, 3.0), 0.15, 2.0),), 5.0)):
        states, known = pressed(who, things, 3.0, None, steps=360)
        assert np.hypot(*states[-1].ground[:2]) > on and all(one.halt is None for one in known)


@pytest.mark.few(1)
@pytest.mark.parametrize("ahead", [0.75, 0.9])
def test_the_key_pressed_late_by_who_brakes_before_a_box_takes_him_straight_up_onto_it(library, ahead):
    """He was led aside along it and leapt askew, and fell off its side; and who let go of braking while he thought of his leap came to stand in it."""
    who = person(library.tuned(Settings(idle=0.0)))
    states, known = pressed(who, (box(6.8, 0.33, 8.0),), 6.8, ahead, steps=330)
    thinks = [one for one in known if one.thought is not None]
    leapt = [s for s in states if s.active == "jump"]
    assert thinks and all(one.halt is not None for one in thinks), "he brakes on as he thinks"
    assert deepest(who, states, (box(6.8, 0.33, 8.0),)) < 0.02
    assert leapt and not any(isinstance(s.memory.memory, Jumping) and s.memory.memory.fault for s in leapt)
    assert max(abs(float(s.ground[2])) for s in states) < 0.1


def test_a_run_up_to_what_can_not_be_leapt_is_given_up_and_told_why(library):
    """Who stood before it on his way along a path stood there for ever, and what he was told spoke of a walk."""
    things = (box(4.5, 0.7),)
    _, script = led(person(library), things, (Move(np.inf, points=((0.0, 4.0),), speed=2.6, jump=Jump((0.0, 0.7, 5.2))), Move(0.2)), 9.5)
    assert script.index >= 1 and len(script.refused) == 1
    assert script.refused[0].startswith("no jump to (0, 0.7, 5.2): ") and "way to" not in script.refused[0]
