"""Jumps from end to end: scripts that jump, refusals, logs with jumps, what is drawn of them. One library, one run each."""

from dataclasses import replace

import numpy as np
import pytest

from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump import Crouching, Physique
from gambol.controllers.person import person
from gambol.game.app.views import previews
from gambol.game.explain.forces import pushed
from gambol.game.explain.jump import LAYERS, explained
from gambol.game.explain.jump_preview import CAN, CANNOT, aimed, previewed
from gambol.game.input.script import jumping
from gambol.game.input.wish import Wish
from gambol.game.output.pose_strip import strip
from gambol.game.render.sketches import sketched
from gambol.game.scenario import film
from gambol.game.scenario.scenario import ScenarioError, load
from gambol.game.scene.scene import Camera, Line, Overlays, Patch
from gambol.game.session.state import begin, opening
from gambol.game.session.tick import Timeline, advance, refused
from gambol.game.world.world import Character, World, figures
from scenarios import tells, written

TEXT = """
title = "Jumps"
duration = 16
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
    ("jump_to = [-3, 6], for = 6", "jump_to = [-3, 6], for = 6, aim = 1", "actors[2].moves[0]: `aim` goes with jump or jump_to without a run-up"),
    ("{ jump_to = [0, 1.4] }", "{ jump_to = [0, 1.4], facing = 3 }", "actors[0].moves[1]: `facing` goes with"),
    ("jump_to = [-3, 6], for = 6", "jump_to = [-3, 6]", "actors[2].moves[0]: velocity needs `for`"),
    ("mass = 24", "mass = 0", "actors[1].body.mass: input should be greater than or equal to 5, got 0"),
    ("height = 1.2", "height = nan", "actors[1].body.height:"),
    ("gravity = 1.62", "gravity = -9.81", "actors[2].gravity: input should be greater than or equal to 0.2, got -9.81"),
    ("duration = 16", 'duration = 16\nstage = "moon"', "stage: input should be 'course', got 'moon'"),
]


@pytest.mark.parametrize(("old", "new", "says"), FAULTS)
def test_a_fault_is_one_line_that_names_the_field(tmp_path, old, new, says):
    tells(tmp_path, TEXT, old, new, says)


def hands(seconds):
    """Up, ahead, and at a run."""
    held, still = Wish(jump=True), Wish()
    ahead, run = Wish(jump=True, move=(0.0, 1.0)), Wish(move=(0.0, 1.0), run=1.0)
    plan = [(held, 20), (still, 150), (ahead, 40), (still, 150), (run, 90), (Wish(move=(0.0, 1.0), run=1.0, jump=True), 10), (run, 140)]
    return [wish.rounded() for wish, ticks in plan for _ in range(ticks)][:seconds * 60]


def test_hands_jump_and_the_same_hands_again_to_the_bit(somebody):
    ends, jumped = [], 0
    for _ in range(2):
        timeline, before = Timeline(opening(somebody)), None
        for wish in hands(10):
            timeline.advance((wish,))
            now = jumping(timeline.now.after.characters[0].state)
            jumped += now is not None and before is None
            before = now
        ends.append(timeline.now.after.characters[0].state)
    assert jumped == 6, "three jumps, twice"
    assert np.array_equal(ends[0].pose.rotations, ends[1].pose.rotations) and np.array_equal(ends[0].ground, ends[1].ground)
    assert ends[0].floor == 0.0 and np.isfinite(ends[0].pose.root).all()


def test_who_holds_the_button_crouches_and_is_off_soon_after_letting_go(somebody):
    """In play; who taps it winds up as ever."""
    took, held = [], Wish(jump=True)
    for wishes in ([Wish(jump=True, move=(0.0, 1.0)).rounded()] * 25 + [held] * 50, [held] * 2):
        timeline = Timeline(opening(somebody))
        for wish in wishes + [Wish()] * 4:
            timeline.advance((wish,))
        made = jumping(timeline.now.after.characters[0].state).plan
        took.append(made.take_off)
    assert took[0] < 0.36 < 0.5 < took[1]


def test_an_actor_aims_for_as_long_as_the_script_says(tmp_path, somebody):
    text = 'title = "Aim"\nduration = 2.4\n[[actors]]\nname = "A"\nmoves = [{ for = 0.2, stop = true }, { jump_to = [0, 0.8], aim = 0.9 }]\n'
    frames = list(film.run(load(written(tmp_path, text)), somebody))
    people = [frame.after.characters[0].state for frame in frames]
    crouches = [isinstance(state.memory.memory, Crouching) for state in people]
    first, begins = crouches.index(True), next(k for k, state in enumerate(people) if jumping(state) is not None)
    assert frames[begins].time - frames[first].time == pytest.approx(0.9, abs=0.05) and all(crouches[first:begins])
    assert people[begins - 1].pose.root[1] < people[0].pose.root[1] - 0.06 and jumping(people[begins]).plan.take_off < 0.34


@pytest.fixture(scope="module")
def beyond(somebody):
    """Somebody who aims farther than it can jump, and what it sees of that."""
    timeline = Timeline(begin(World((Character("A", somebody, somebody.start()),)), 1))
    for wish in [Wish(jump=True)] * 10 + [Wish(jump=True, move=(0.0, 1.0))] * 110:
        timeline.advance((wish.rounded(),))
    return timeline, previews(timeline.now)[0]


def test_where_a_jump_is_refused_the_nearest_place_is_one_that_can_be_jumped_to(beyond, somebody):
    timeline, seen = beyond
    who, jump = timeline.now.after.characters[0], somebody.parts["jump"]
    state = who.controller.active(who.state)[1]
    assert seen.fault and seen.nearest is not None
    assert not previewed(jump, state, Leap(seen.nearest), ()).fault
    assert previewed(jump, state, Leap(seen.nearest + 0.1 * (seen.place - seen.nearest)), ()).fault
    far, near = (np.linalg.norm((place - seen.stand)[[0, 2]]) for place in (seen.place, seen.nearest))
    assert seen.why == f"{far - near:.1f} m farther than this body can jump"
    rings = {sketch.tint for sketch in aimed(seen, ()) if isinstance(sketch, Patch)}
    assert rings == {CAN, CANNOT}


def test_the_nearest_place_is_not_sought_anew_while_one_aims_the_same_way(beyond, somebody, monkeypatch):
    timeline, seen = beyond
    sought = []
    monkeypatch.setattr(type(somebody.parts["jump"]), "nearest", lambda jump, start, place, *_: sought.append(place))
    again, = previews(timeline.now, (seen,))
    assert again.nearest is seen.nearest and not sought
    turned = replace(seen, nearest=seen.stand + [0.5, 0.0, 1.5])
    previews(timeline.now, (replace(turned, place=seen.stand + [0.6, 0.0, 1.8]),))
    assert len(sought) == 1


def test_who_lets_go_is_told_why_not_without_coordinates(beyond):
    timeline, seen = beyond
    moment, told = timeline.now, []
    for _ in range(60):
        after = advance(moment, (Wish(),))
        told += refused(moment, after)
        moment = after
    assert told == [f"no jump: {seen.why}"]


def test_a_runner_sees_one_arc_through_all_of_a_stride(somebody):
    timeline, lengths = Timeline(begin(World((Character("A", somebody, somebody.start()),)), 1)), []
    run = Wish(move=(0.0, 1.0), run=1.0)
    for wish in [run] * 150 + [replace(run, jump=True)] * 50:
        timeline.advance((wish.rounded(),))
        if wish.jump:
            seen, = previews(timeline.now)
            assert not seen.fault
            lengths.append(float(np.linalg.norm((seen.arc[-1] - seen.arc[0])[[0, 2]])))
    assert min(lengths) > 0.5 * max(lengths)


def test_cameras_follow_a_jumper_without_a_jerk(somebody):
    timeline, eyes = Timeline(opening(somebody)), []
    for wish in hands(10):
        timeline.advance((wish,))
        eyes.append(timeline.now.players[0].camera.target[1])
    assert np.abs(np.diff(eyes)).max() < 0.03 and np.ptp(eyes) > 0.05
    assert np.ptp(eyes[-45:]) < 0.05


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


def test_pressed_in_the_air_it_aims_from_where_it_will_land_and_goes_off_again_from_the_landing(somebody):
    """The ring is drawn meanwhile, and the second jump lands in it."""
    timeline, plans, rings = Timeline(opening(somebody)), [], []
    for step in range(260):
        now = jumping(timeline.now.after.characters[0].state)
        if now is not None and (not plans or now.plan is not plans[-1]):
            plans.append(now.plan)
        flies = now is not None and len(plans) == 1 and now.plan.take_off + 0.05 < now.time < now.plan.touch_down - 0.05
        timeline.advance([Wish(jump=20 < step < 60 or flies, move=(0.0, 1.0) if 30 < step < 60 or flies else (0.0, 0.0))])
        seen = previews(timeline.now, ())[0] if flies else None
        rings += [] if seen is None else [seen.place]
    assert len(plans) == 2 and plans[1].take_off < 0.45
    middles = [plan.feet[:, [0, 2]].mean(0) for plan in plans]
    assert len(rings) > 10 and np.linalg.norm(rings[0][[0, 2]] - middles[0]) < 0.1
    assert np.linalg.norm(rings[-1][[0, 2]] - middles[1]) < 0.1 < np.linalg.norm(middles[1] - middles[0])
