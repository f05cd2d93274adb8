"""Somebody is sent to a place: by a scenario, and by the pointer; what is drawn and said of it; taken over, logged and replayed."""

import math

import numpy as np
import pytest

from gambol.controllers.contract import Goal, Intent
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.person import person
from gambol.controllers.supervisor import Supervisor
from gambol.game.app.app import Play
from gambol.game.app.pointing import Pointing
from gambol.game.app.point_picking import project
from gambol.game.explain import led, on_the_way
from gambol.game.explain.way import cost_of
from gambol.game.hosts.events import MouseMove, Scroll
from gambol.game.input.moves import Move
from gambol.game.input.script import Script
from gambol.game.scenario import film
from gambol.game.scenario.scenario import load
from gambol.game.scene.scene import Box, Camera, Line, Overlays
from gambol.game.session.actions import goal_of
from gambol.game.session.input_log import LogWriter, read
from gambol.game.session.replay import replay
from gambol.game.session.settings import SettingError
from gambol.game.world import STAGES
from gambol.game.world.world import DT, Character, World, figures
from hands import FRAME, at, pad, press, release, text, wait
from scenarios import written
from stand_in import Glide

SCENARIO = """
title = "Goals"
duration = 8
props = [{ centre = [0, 0.5, 1.2], size = [0.6, 1, 0.3] }]
[[actors]]
name = "A"
moves = [{ go_to = [0, 1.2] }, { go_to = [0, 2.2], heading = 90, arrive = 60 }, { for = 0.2, stop = true }, { go_to = [0.5, 2.2] }]
"""


@pytest.fixture(scope="module")
def walker():
    return Supervisor({"locomotion": Locomotion.load()})


def test_a_scenario_sends_somebody_from_goal_to_goal(walker, tmp_path):
    scenario = load(written(tmp_path, SCENARIO))
    move = scenario.actors[0].moves[1].move()
    assert move.goal == Goal((0.0, 2.2), math.pi / 2, 60.0) and math.isinf(move.seconds)
    for act in film.acts(scenario, walker.parts["locomotion"]):  # alone he is put under a supervisor
        if act.scripts[0].index == 2 and act.scripts[0].now.steps == 0:
            break
        if act.scripts[0].done or act.world.time > 20:
            break
    assert act.refused == ("A: no way to (0, 1.2): the goal lies in something, or on it and no way leads up: steps rise by 0.21 m at most",), "which is told, and the next move begins"
    for act in film.acts(scenario, walker):
        if act.scripts[0].index == 2:
            break
    ground = act.world.characters[0].state.ground
    assert np.hypot(ground[0], ground[1] - 2.2) < 0.03 and abs(ground[2] - math.pi / 2) < math.radians(3)


def test_who_stands_before_what_is_in_his_way_is_told_of_once(walker, tmp_path):
    blocked = """
title = "Blocked"
duration = 9
[[props]]
centre = [0, 0.6, 2]
size = [2, 1.2, 0.4]
[[actors]]
name = "A"
moves = [{ walk_to = [0, 4] }]
"""
    for act in film.acts(load(written(tmp_path, blocked)), walker):
        if act.world.time > 9:
            break
    assert act.refused == ("A: stands on the way to (0, 4), which goes past nothing that is in it, as go_to does, nor up a step higher than 0.21 m",)


def test_whoever_can_not_walk_goes_on_with_his_moves():
    script, someone = Script((Move(math.inf, goal=Goal((0.0, 1.0))),)), Supervisor({"glide": Glide()})
    state = someone.start()
    for _ in range(3):
        script, intent = script.step(state, DT)
        state, _ = someone.step(state, intent, DT)
    assert script.done and script.refused == ("no way to (0, 1): nobody here walks",)


def test_the_plan_is_drawn_with_its_headings_and_said_with_its_cost(walker):
    world = World((Character("A", walker, walker.start()),))
    assert on_the_way(world.characters[0].state) == () and not led(figures(world, world, 1.0), world, Overlays(path=True))[0].sketches
    for _ in range(30):
        world = world.step([Intent(goal=Goal((1.0, 2.0), 0.0))])
    state = world.characters[0].state
    drawn = figures(world, world, 1.0)
    assert np.allclose(drawn[0].path[-1, [0, 2]], [1.0, 2.0], atol=1e-6), "the path leads to the goal"
    sketches = led(drawn, world, Overlays(path=True))[0].sketches
    assert sum(isinstance(one, Line) for one in sketches) > 5 and {one.layer for one in sketches} == {"path"}
    assert led(drawn, world, Overlays())[0].sketches == ()
    assert "cost" in on_the_way(state)[1] and "time" in on_the_way(state)[1]
    parts = cost_of(state.going.plan)
    assert parts.sum() == pytest.approx(state.going.plan.cost, rel=0.01) and np.all(parts >= 0) and parts[0] == pytest.approx(state.going.plan.seconds)


def test_what_an_action_says_of_a_goal():
    assert goal_of("goto=1.5/-2") == Goal((1.5, -2.0)) and goal_of("goto=1/2/90") == Goal((1.0, 2.0), math.pi / 2) and goal_of("goto=") is None
    for wrong in ("goto=1", "goto=a/b", "goto=1/2/3/4", "goto=nan/0", "goto=0/inf", "goto=0/1/nan", "goto=1e9/0"):
        with pytest.raises(SettingError, match="goto="):
            goal_of(wrong)


def point(game, place):
    """The pointer over a place x, z [m] of the floor."""
    game.scene((1600, 900))
    x, y, _ = project(game.pointing.camera, game.pointing.aspect, np.array([place[0], 0.0, place[1]]))
    game.handle(MouseMove(float(x), float(y), 0.0, 0.0))


def test_the_pointer_sends_somebody_and_a_stick_takes_over(walker, tmp_path):
    game = Play(walker, log=LogWriter(tmp_path / "played.gambol", walker, 1))
    point(game, (-0.5, 2.0))
    press(game, "T")
    wait(game, 0.2)
    goal = game.now.players[0].goal
    assert np.allclose(goal.place, (-0.5, 2.0), atol=0.02) and goal.heading is None
    game.handle(Scroll(0.0, 1.0))
    wait(game, 0.2)
    assert game.now.players[0].goal.heading == pytest.approx(math.radians(15))
    point(game, (0.5, 2.0))
    wait(game, 0.3)
    assert np.allclose(game.now.players[0].goal.place, (0.5, 2.0), atol=0.02), "it is dragged"
    assert game.now.after.characters[0].state.going.plans >= 3 and "cost" in text(game)
    release(game, "T")
    wait(game, 6.0)
    assert np.allclose(at(game)[:2], (0.5, 2.0), atol=0.03) and "at the goal" in text(game)
    point(game, (0.5, 5.0))
    press(game, "T")
    wait(game, 0.2)
    release(game, "T")
    wait(game, 0.8)
    press(game, "D")
    game.tick(FRAME)
    assert game.now.players[0].goal is None and game.now.after.characters[0].state.going is None, "at once"
    wait(game, 0.5)
    game.close()
    *_, last = replay(read(tmp_path / "played.gambol"), walker)
    again, played = last.after.characters[0].state, game.now.after.characters[0].state
    assert again.pose.root.tobytes() == played.pose.root.tobytes() and again.pose.rotations.tobytes() == played.pose.rotations.tobytes()


def test_a_click_sends_and_a_drag_does_not(walker):
    game = Play(walker)
    point(game, (-0.5, 2.0))
    press(game, "LEFT_BUTTON")
    game.tick(FRAME)
    release(game, "LEFT_BUTTON")
    wait(game, 0.1)
    assert np.allclose(game.now.players[0].goal.place, (-0.5, 2.0), atol=0.02)
    press(game, "W")
    wait(game, 0.2)
    release(game, "W")
    point(game, (0.5, 2.5))
    press(game, "LEFT_BUTTON")
    game.handle(MouseMove(game.pointing.pointer[0] + 0.1, game.pointing.pointer[1], 0.1, 0.0))
    release(game, "LEFT_BUTTON")
    wait(game, 0.1)
    assert game.now.players[0].goal is None, "that turned the camera"
    press(game, "LEFT_BUTTON")
    wait(game, 0.5)
    release(game, "LEFT_BUTTON")
    wait(game, 0.1)
    assert game.now.players[0].goal is None, "that was held"


def test_a_pad_sends_to_the_middle_of_the_picture(walker):
    game = Play(walker)
    game.scene((1600, 900))
    middle = game.pointing.place((), middle=True)
    game.handle(pad((0.0, 0.0), (0.0, 0.0), (-1.0, -1.0), "LS"))
    wait(game, 0.1)
    assert np.allclose(game.now.players[0].goal.place, middle, atol=0.02) and middle[1] > 1.0
    plans = game.now.after.characters[0].state.going.plans
    for _ in range(60):  # the camera goes along
        game.scene((1600, 900))
        game.tick(FRAME)
    assert game.now.players[0].goal.place[1] > middle[1] + 0.1 and 1 < game.now.after.characters[0].state.going.plans - plans < 12, "he is led on"
    game.handle(pad())
    wait(game, 0.2)
    kept = game.now.players[0].goal
    game.scene((1600, 900))
    wait(game, 0.3)
    assert game.now.players[0].goal == kept is not None, "let go, the goal stays"


def test_the_pointer_lies_on_what_is_nearest_in_its_way():
    seen = Pointing()
    seen.look(Camera(np.array([0.0, 3.0, -4.0]), np.array([0.0, 0.5, 1.0])), 1.6)
    props = Box((0.0, 0.4, 1.0), (2.0, 0.8, 2.0)), Box((0.0, 0.2, 3.0), (2.0, 0.6, 2.0), 0.0, slope=0.2)
    for place in ((0.2, 0.8, 0.9), (0.1, 0.5, 3.0), (0.1, 0.5 + 0.2 * 0.4, 3.4), (2.5, 0.0, 1.0)):
        x, y, _ = project(seen.camera, seen.aspect, np.array(place))
        seen.move(float(x), float(y))
        assert np.allclose(seen.place(props), (place[0], place[2]), atol=1e-6), place


def test_leaps_ahead_are_drawn_and_said():
    someone = person()
    world = World((Character("A", someone, someone.start((3.4, 5.0, 0.0), 0.3)),), STAGES["course"])
    for _ in range(30):
        world = world.step([Intent(goal=Goal((3.4, 7.2)))])
    sketches = led(figures(world, world, 1.0), world, Overlays(path=True))[0].sketches
    bent = [one for one in sketches if isinstance(one, Line) and one.dashed and len(one.points) == 17]
    assert len(bent) == 1 and bent[0].points[-1, 1] == pytest.approx(0.6, abs=0.05) and bent[0].points[:, 1].max() > 0.7
    assert "to a leap" in on_the_way(world.characters[0].state)[0]


def test_nobody_is_sent_to_the_sky(walker):
    game = Play(walker)
    game.scene((1600, 900))
    game.handle(MouseMove(0.8, 0.0, 0.0, 0.0))
    press(game, "T")
    wait(game, 0.3)
    assert game.now.players[0].goal is None


def test_a_few_steps_another_way_end_at_the_place():
    """Who walks a metre and has to turn first turns on the spot: a turn into a walk would lead past it."""
    walker = Locomotion.load()
    for way in (np.pi / 2, np.pi):
        place = 0.9 * np.array([np.sin(way), np.cos(way)])
        script, state = Script((Move(math.inf, points=(tuple(place),), speed=1.2),)), walker.start()
        for _ in range(330):
            script, intent = script.step(state, 1 / 60)
            state, _ = walker.step(state, intent, 1 / 60)
        assert np.hypot(*(state.ground[:2] - place)) < 0.02
