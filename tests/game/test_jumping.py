"""Scenarios that jump, from end to end: where they land, refusals, what is drawn of them. One library, one run each."""

import re

import numpy as np
import pytest

from gambol.controllers.contract import Intent
from gambol.controllers.jump import Crouching, Physique
from gambol.controllers.person import person
from gambol.game.explain.forces import pushed
from gambol.game.explain.jump import LAYERS, explained
from gambol.game.input.making import jumping
from gambol.game.output.pose_strip import strip
from gambol.game.render.sketches import sketched
from gambol.game.scenario import film
from gambol.game.scenario.scenario import ScenarioError, load
from gambol.game.scene.scene import Camera, Line, Overlays
from gambol.game.world.world import Character, figures
from scenarios import tells, written

TEXT = """
title = "Jumps"
duration = 11
props = [{ centre = [0, 0.15, 2.0], size = [2, 0.3, 2] }]
[[actors]]
name = "A"
moves = [
    { for = 0.3, stop = true },
    { jump_to = [0, 1.4] },
    { for = 1.2, stop = true },
    { jump = 0.2 },
    { for = 1.6, stop = true },
    { jump_to = [0, 0, 40] },
    { for = 0.2, stop = true },
]
[[actors]]
name = "B"
start = [3, 0, 0]
body = { height = 1.2, mass = 24 }
moves = [{ for = 0.4, stop = true }, { jump_to = [3.4, 0.3] }]
[[actors]]
name = "C"
start = [-3, 0, 0]
gravity = 1.62
moves = [{ velocity = [2.6, 0, 0], jump_to = [-3, 6], for = 6 }, { for = 1, stop = true }]
"""


@pytest.fixture(scope="module")
def somebody():
    return person()


@pytest.fixture(scope="module")
def played(tmp_path_factory, somebody):
    scenario = load(written(tmp_path_factory.mktemp("jumps"), TEXT))
    return scenario, list(film.run(scenario, somebody))


@pytest.fixture
def same_run(played, monkeypatch):
    """The scenario of that run; who would run it once more gets its frames."""
    scenario, frames = played

    def run(wanted, controller):
        assert wanted == scenario, "at another rate it would be another run"
        return iter(frames)
    monkeypatch.setattr("gambol.game.output.pose_strip.run", run)
    return scenario


def jumps_of(frames, who):
    """The plans that an actor carried out, in order."""
    plans = []
    for frame in frames:
        now = jumping(frame.after.characters[who].state)
        if now is not None and all(now.plan is not plan for plan in plans):
            plans.append(now.plan)
    return plans


def soles_at(plan, someone):
    """The middle of both soles (3,), from heel to tip, as they come to stand."""
    from gambol.controllers.body import forward_kinematics
    from gambol.controllers.body.support_polygon import sole_corners
    skeleton = someone.controller.skeleton
    pose = plan.at(plan.lowest)
    return sole_corners(skeleton, *forward_kinematics(skeleton, pose.root, pose.rotations))[[0, 1, 4, 5, 6, 7, 10, 11]].mean(0)


def test_everybody_lands_where_the_script_says(played):
    _, frames = played
    first, up = jumps_of(frames, 0)
    people = frames[-1].after.characters
    assert np.linalg.norm(soles_at(first, people[0]) - [0, 0.3, 1.4]) < 0.02, "on the platform, whose height it finds"
    assert np.ptp(np.array([plan.feet[:, 1].min() for plan in (first, up)])) < 1e-6, "and up from there"
    risen = up.centres[:, 1].max() - up.path.leave[1]
    assert risen == pytest.approx(0.2, abs=0.005)
    child, = jumps_of(frames, 1)
    assert np.linalg.norm(soles_at(child, people[1]) - [3.4, 0, 0.3]) < 0.02
    runner, = jumps_of(frames, 2)
    lands = runner.feet if runner.path.lands is None else runner.feet[[runner.path.lands]]
    assert np.abs(lands[:, [0, 2]].mean(0) - [-3, 6]).max() < 0.06 and runner.path.passing[2] > 1.2
    assert runner.path.gravity[1] == -1.62 and child.path.gravity[1] == -9.81


def test_a_child_is_as_large_as_it_is(played):
    _, frames = played
    adult, child, _ = frames[0].before.characters
    assert child.state.pose.root[1] / adult.state.pose.root[1] == pytest.approx(1.2 / 1.741, abs=0.02)
    assert child.controller.parts["jump"].physique.mass == 24


def test_a_jump_that_nobody_can_make_is_told_and_the_run_goes_on(played):
    _, frames = played
    line, = frames[-1].refused
    assert line.startswith("A: no jump to (0, 0, 40): ") and "reach" in line
    assert not frames[200].refused


def test_a_run_up_that_ends_too_early_tells_how_far_away(tmp_path, somebody):
    text = 'title = "Short"\nduration = 3\n[[actors]]\nname = "A"\nmoves = [{ velocity = [3, 0, 0], for = 1.5, jump_to = [0, 8] }, { for = 1, stop = true }]'
    frames = list(film.run(load(written(tmp_path, text)), somebody))
    line, = frames[-1].refused
    ended = next(frame for frame in frames if frame.refused).before.characters[0].state.ground
    told = re.search(r"it never came to where it could jump from, and its run-up ended (.*) m away$", line)
    assert told and abs(float(told[1]) - (8.0 - ended[1])) < 0.11, "rounded, within the step's way of 5 cm"


@pytest.mark.thorough
def test_a_run_with_jumps_is_the_same_to_the_bit(played, somebody):
    scenario, frames = played
    for frame, again in zip(frames[::20], list(film.run(scenario, person()))[::20], strict=True):
        for a, b in zip(frame.after.characters, again.after.characters):
            assert np.array_equal(a.state.pose.root, b.state.pose.root)
            assert np.array_equal(a.state.pose.rotations, b.state.pose.rotations)


FAULTS = [
    ("{ jump = 0.2 }", "{ jump = -1 }", "actors[0].moves[3].jump: input should be greater than 0, got -1"),
    ("{ jump = 0.2 }", "{ jump = 0.2, airtime = 0.5 }", "actors[0].moves[3]: `airtime` goes with jump_to"),
    ("{ jump = 0.2 }", "{ jump = 0.2, velocity = [1, 0, 0], for = 1 }", "actors[0].moves[3]: needs exactly one of"),
    ("{ jump_to = [0, 1.4] }", "{ jump_to = [0, 1.4], within = 1 }", "actors[0].moves[1]: `within` goes with jump_to and a run-up"),
    ("jump_to = [-3, 6], for = 6", "jump_to = [-3, 6], for = 6, aim = 1", "actors[2].moves[0]: `aim` goes with jump, hops or jump_to without a run-up"),
    ("{ jump_to = [0, 1.4] }", "{ jump_to = [0, 1.4], facing = 3 }", "actors[0].moves[1]: `facing` goes with"),
    ("jump_to = [-3, 6], for = 6", "jump_to = [-3, 6]", "actors[2].moves[0]: velocity needs `for`"),
    ("{ jump = 0.2 }", "{ hops = 0 }", "actors[0].moves[3].hops: input should be greater than or equal to 1, got 0"),
    ("{ jump = 0.2 }", "{ jump = 0.2, ahead = 1 }", "actors[0].moves[3]: `ahead` goes with hops"),
    ("mass = 24", "mass = 0", "actors[1].body.mass: input should be greater than or equal to 1, got 0"),
    ("height = 1.2", "height = nan", "actors[1].body.height:"),
    ("gravity = 1.62", "gravity = -9.81", "actors[2].gravity: input should be greater than or equal to 0.2, got -9.81"),
    ("duration = 11", 'duration = 11\nstage = "moon"', "stage: input should be 'course', got 'moon'"),
]


@pytest.mark.parametrize(("old", "new", "says"), FAULTS)
def test_a_fault_is_one_line_that_names_the_field(tmp_path, old, new, says):
    tells(tmp_path, TEXT, old, new, says)


def test_an_actor_aims_for_as_long_as_the_script_says(tmp_path, somebody):
    text = 'title = "Aim"\nduration = 2.4\n[[actors]]\nname = "A"\nmoves = [{ for = 0.2, stop = true }, { jump_to = [0, 0.8], aim = 0.9 }]\n'
    frames = list(film.run(load(written(tmp_path, text)), somebody))
    people = [frame.after.characters[0].state for frame in frames]
    crouches = [isinstance(state.memory.memory, Crouching) for state in people]
    first, begins = crouches.index(True), next(k for k, state in enumerate(people) if jumping(state) is not None)
    assert frames[begins].time - frames[first].time == pytest.approx(0.9, abs=0.05) and all(crouches[first:begins])
    assert people[begins - 1].pose.root[1] < people[0].pose.root[1] - 0.06 and jumping(people[begins]).plan.take_off < 0.34


def test_what_is_drawn_is_drawn_for_the_overlays_that_show_it(played):
    _, frames = played
    frame = next(f for f in frames if jumping(f.after.characters[0].state) is not None)
    people = figures(frame.before, frame.after, frame.alpha)
    assert explained(people, frame.before, frame.after, frame.alpha, Overlays()) == people
    drawn = explained(people, frame.before, frame.after, frame.alpha, Overlays(jump=True, balance=True, forces=True))
    assert {sketch.layer for sketch in drawn[0].sketches} == set(LAYERS)
    plan = jumping(frame.after.characters[0].state).plan
    arc = next(s for s in drawn[0].sketches if isinstance(s, Line) and s.layer == "jump")
    assert np.allclose(arc.points[0], plan.path.leave) and np.allclose(arc.points[-1], plan.path.land)
    camera = Camera(np.array([-4.0, 1.0, 1.0]), np.array([0.0, 1.0, 0.0]))
    for layer in LAYERS:
        within, through = sketched(drawn, Overlays(**{layer: True}), camera, 700.0)
        rows = np.concatenate([within, through])
        assert len(rows) and np.isfinite(rows).all() and (rows[:, 6] >= 0).all() and (rows[:, 6] <= 1).all()
    assert not any(map(len, sketched(drawn, Overlays(), camera, 700.0)))


def test_a_strip_shows_the_first_jump_from_its_side_until_the_body_stands(same_run, somebody):
    scenes = strip(same_run, somebody, 6, Overlays(), (1200, 400), actor="A")
    assert [scene.part for scene in scenes] == [pytest.approx((n / 6, 0.0, 1 / 6, 1.0)) for n in range(6)]
    heights = [scene.figures[0].positions[:, 1].max() for scene in scenes]
    assert max(heights) > heights[0] + 0.1
    assert heights[-1] == pytest.approx(heights[0] + 0.3, abs=0.1)  # up again, on the platform
    for scene in scenes:
        sight = scene.camera.target - scene.camera.eye
        assert abs(sight[2]) < 0.01 * abs(sight[0]) and np.linalg.norm(sight) > 3


def test_poses_of_a_strip_tell_when_in_the_scenario_they_are(same_run, somebody):
    scenes = strip(same_run, somebody, 3, Overlays(), (1200, 400), 1.0, 2.0, actor="A")
    assert [scene.text for scene in scenes] == [("1.00 s",), ("1.50 s",), ("2.00 s",)]


def test_every_actor_of_a_strip_has_a_row(same_run, somebody):
    scenes = strip(same_run, somebody, 4, Overlays(), (1200, 900))
    assert [scene.part for scene in scenes] == [pytest.approx((n / 4, row / 3, 1 / 4, 1 / 3)) for row in range(3) for n in range(4)]
    for row, start in enumerate((0.0, 3.0, -3.0)):
        for scene in scenes[4 * row:4 * row + 4]:
            assert len(scene.figures) == 1 and abs(scene.figures[0].positions[0, 0] - start) < 1.0


def test_a_strip_of_nobody_and_of_no_time_is_refused(same_run, somebody):
    with pytest.raises(ScenarioError, match="no actor is called 'Z'; there are A, B, C"):
        strip(same_run, somebody, 6, Overlays(), (1200, 400), actor="Z")
    with pytest.raises(ScenarioError, match="nothing lies from 9 to 5 s"):
        strip(same_run, somebody, 6, Overlays(), (1200, 400), 9.0, 5.0)


def test_the_ground_pushes_whoever_stands_or_walks_and_nobody_in_the_air(played):
    _, frames = played
    shares = []
    for frame in frames[:240]:
        new = frame.after.characters[2]
        if jumping(new.state) is None:
            push = pushed(new, new.controller.parts["jump"].physique, 9.81)
            grounded = bool(new.state.contacts.any())
            assert grounded or not push.any()
            shares.append(push[1] / (73.0 * 9.81))
    # over many steps it carries the weight, and no more
    assert len(shares) > 60 and min(shares) >= 0.0 and np.mean(shares) == pytest.approx(1.0, abs=0.2)


def test_the_ground_s_push_does_not_tremble_and_is_the_same_after_going_back(somebody):
    walker = Character("A", somebody, somebody.start())
    shares, walk = [], Intent(np.array([1.2, 0.0, 0.0]))
    for number in range(1, 301):
        walker = walker.step(walk, number)
        shares.append(pushed(walker, Physique(), 9.81)[1] / (73.0 * 9.81))
    steady = np.array(shares[120:])
    assert np.ptp(steady) > 0.2, "it still tells of the steps"
    # two humps in a step of half a second: no more turns than that
    turns = np.count_nonzero(np.diff(np.sign(np.diff(steady))))
    assert turns / (len(steady) / 60) < 10.0 and np.abs(np.diff(steady)).max() < 0.15
    once, again = (walker.step(walk, 301).centre_of_mass for _ in range(2))
    assert np.array_equal(once.acceleration, again.acceleration)
