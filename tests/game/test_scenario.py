"""Scenarios: clear errors, the same to the bit, any frame rate the same motion."""

from fractions import Fraction

import numpy as np
import pytest

from gambol.controllers.contract import Intent
from gambol.game.input.moves import Move
from gambol.game.input.script import Script
from gambol.game.scenario import film
from gambol.game.scenario.scenario import Scenario, ScenarioError, load, shipped
from gambol.game.scenario.shot_table import OVERLAYS
from gambol.game.scene.scene import Overlays
from gambol.game.world.world import DT
from scenarios import tells, written
from stand_in import Glide

GOOD = """
title = "Test"
duration = 2
[[actors]]
name = "A"
moves = [{ for = 1, velocity = [1.2, 0.5, 0.3] }, { walk_to = [0, 0], speed = 1 }]
[[actors]]
name = "B"
start = [2, 0, 90]
moves = [{ for = 1, velocity = [-0.5, 0, 0] }, { for = 0.5, stop = true, facing = 0 }]
"""


def test_all_that_is_shipped_loads_and_is_what_the_issue_lists():
    assert {"speed_sweep", "curve_sweep", "holonomic", "start_stop", "medley", "corridor", "demo",
            "jump_vertical", "jump_far", "jump_up", "jump_down", "jump_gap", "jump_moon", "jump_child", "jump_course"} <= set(shipped())
    for name in shipped():
        scenario = load(name)
        for actor in scenario.actors:
            assert sum(move.seconds or 0 for move in actor.moves) <= scenario.duration + 1e-9, name
    assert load("medley").duration == 60


FAULTS = [
    ("title", "colour = 1\ntitle", "colour: there is no such field"),
    ("title", 'panels = ["space"]\ntitle', "panels: there is no such field; it goes into shots"),
    ("for = 1, velocity = [1.2", "at = 3, for = 1, velocity = [1.2", "actors[0].moves[0].at: there is no such field; it goes into shots or actors.strikes"),
    ("for = 1, velocity = [1.2", "duratino = 1, velocity = [1.2", "actors[0].moves[0].duratino: there is no such field; there are ahead, aim, airtime"),
    ("title", "tilte", "tilte: there is no such field; did you mean title?"),
    ("for = 1, velocity = [1.2", "fro = 1, velocity = [1.2", "actors[0].moves[0].fro: there is no such field; did you mean for?"),
    ("walk_to = [0, 0]", "walkto = [0, 0]", "actors[0].moves[1].walkto: there is no such field; did you mean walk_to?"),
    ("walk_to = [0, 0], speed = 1", 'jump_to = [0, "a"]', "actors[0].moves[1].jump_to[1]: input should be a valid number"),
    ("walk_to = [0, 0], speed = 1", "jump_to = [0]", "actors[0].moves[1].jump_to: needs at least 2, has "),
    ("walk_to = [0, 0], speed = 1", "jump_to = [0, 1, 2, 3]", "actors[0].moves[1].jump_to: needs 3 at most, has 4"),
    ("walk_to = [0, 0], speed = 1", "jump_to = 3", "actors[0].moves[1].jump_to: input should be a valid list, got 3"),
    ('title = "Test"', "", "title: is missing, and needed"),
    ("duration = 2", "duration = -2", "duration: input should be greater than 0, got -2"),
    ("duration = 2", 'duration = "long"', "duration: input should be a valid number"),
    ("duration = 2", "duration = nan", "duration:"),
    ("duration = 2", "duration = 2\nfps = 0", "fps: needs frames a second from 1 to 240, such as 30, 29.97 or 30000/1001; got 0"),
    ("duration = 2", 'duration = 2\noverlays = ["bones"]', "overlays[0]: input should be 'mesh', 'skeleton'"),
    ("velocity = [1.2, 0.5, 0.3]", "velocity = [1.2, 0.5]", "actors[0].moves[0].velocity[2]: is missing, and needed"),
    ("velocity = [1.2, 0.5, 0.3]", "velocity = [0.2, 0.5, 0.3]", "actors[0].moves[0]: velocity is [v_t, ω, v_l] and |v_l| ≤ |v_t|"),
    ("velocity = [1.2, 0.5, 0.3]", "velocity = [1.2, inf, 0.3]", "actors[0].moves[0].velocity[1]: input should be a finite number"),
    ("walk_to = [0, 0], speed", "walk_to = [0, 0], stop = true, speed", "actors[0].moves[1]: needs exactly one of"),
    ("for = 0.5, stop = true, ", "for = 0.5, ", "actors[1].moves[1]: needs exactly one of velocity, walk_to, go_to, path, stop, jump_to, jump, hops, or jump_to with a run-up; has none"),
    ("walk_to = [0, 0], speed = 1", "go_to = [0, 0], facing = 3", "actors[0].moves[1]: `facing` goes with walk_to, path or stop; who goes to a place"),
    ("walk_to = [0, 0], speed = 1", "go_to = [0, 0], speed = 1", "actors[0].moves[1]: `speed` goes with walk_to or path"),
    ("walk_to = [0, 0], speed = 1", "walk_to = [0, 0], heading = 1", "actors[0].moves[1]: `heading` goes with go_to, jump_to or jump"),
    ("walk_to = [0, 0], speed = 1", "walk_to = [0, 0], arrive = 1", "actors[0].moves[1]: `arrive` goes with go_to"),
    ("walk_to = [0, 0], speed = 1", "go_to = [0], heading = 1", "actors[0].moves[1].go_to[1]: is missing, and needed"),
    ("walk_to = [0, 0], speed = 1", "go_to = [0, 0], jump_to = [0, 1]", "actors[0].moves[1]: needs exactly one of"),
    ("for = 1, velocity = [-0.5", "velocity = [-0.5", "actors[1].moves[0]: velocity needs `for`"),
    ('name = "B"', 'name = "a"', "actors need different names, in more than capitals; got A, a"),
    ('name = "B"', 'name = "b/../c"', "actors[1].name: files are named after it, so it needs letters"),
    ("duration = 2", 'duration = 2\n[[shots]]\nkind = "fixed"', "shots[0]: a fixed shot needs eye"),
    ("duration = 2", 'duration = 2\n[[shots]]\nactor = "C"', "shots[0]: no actor is called 'C'; there are A, B"),
    ("duration = 2", "duration = 2\n[[shots]]\n[[shots]]\nat = 0", "shots must begin at = 0 and then rise"),
    ("duration = 2", "duration = ", "not TOML"),
    ("duration = 2", 'duration = 2\n[[shots]]\nkind = "dolly"\npath = [[0, 1, 0]]\ntarget = [0, 1, 9]', "shots[0].path: needs at least 2, has "),
    ("duration = 2", 'duration = 2\n[[shots]]\nkind = "dolly"\ntarget = [0, 1, 9]', "shots[0]: a dolly shot needs path = [[x, y, z], …]"),
    ("duration = 2", 'duration = 2\n[[shots]]\nkind = "fixed"\neye = [0, 1, 0]\ntarget = [0, 1, 0]', "shots[0]: eye and target are the same place"),
    ("duration = 2", 'duration = 2\n[[shots]]\neye = [0, 1, 0]', "shots[0]: a follow shot has no eye; that goes with kind = fixed"),
    ("duration = 2", 'duration = 2\n[[shots]]\nkind = "orbit"\nactor = "A"\ntarget = [0, 1, 0]', "shots[0]: an orbit shot goes round an actor or a target, not both"),
    ("duration = 2", 'duration = 2\n[[shots]]\nunder = "what"', "shots[0]: `under` stands under a caption"),
    ("duration = 2", 'duration = 2\n[[shots]]\nkind = "orbit"\nviews = [{}, {}]', "shots[0]: a shot with views has no kind of its own"),
    ("duration = 2", 'duration = 2\n[[shots]]\nviews = [{}]', "shots[0].views: needs at least 2, has "),
    ("duration = 2", 'duration = 2\n[[shots]]\nviews = [{}, { actor = "C" }]', "shots[0].views[1]: no actor is called 'C'"),
    ("duration = 2", 'duration = 2\n[[shots]]\npanels = ["settings"]', "shots[0].panels[0]: input should be 'space' or 'plots', got 'settings'"),
    ("duration = 2", 'duration = 2\n[[shots]]\npanel = ["space"]', "shots[0].panel: there is no such field; did you mean panels?"),
    ('start = [2, 0, 90]', 'start = [2, 0, 90]\nenters = 1.5\nleaves = 1', "actors[1]: `enters` comes before `leaves`; got 1.5 and 1"),
    ('start = [2, 0, 90]', 'start = [2, 0, 90]\nenters = -1', "actors[1].enters: input should be greater than or equal to 0, got -1"),
    ("duration = 2", 'duration = 2\nposter = 2', "poster is a moment of the film, before its end at 2 s; got 2"),
    ("duration = 2", 'duration = 2\nprops = [{ kind = "tree" }]', "props[0]: kind should be one of box, ramp, stairs, pillar, goal, got 'tree'"),
    ("duration = 2", 'duration = 2\nprops = [{ kind = "pillar", foot = [0, 0, 0], radius = 0 }]', "props[0].radius: input should be greater than 0, got 0"),
    ("duration = 2", 'duration = 2\nprops = [{ kind = "pillar", foot = [0, 0, 0], hight = 1 }]', "props[0].hight: there is no such field; did you mean height?"),
    ("duration = 2", 'duration = 2\nprops = [{ centre = [0, 1, 0] }]', "props[0].size: is missing, and needed"),
    ("duration = 2", 'duration = 2\nprops = [{ centre = [0, 1, 5], size = [1, 2, 1] }]\n[[shots]]\nkind = "dolly"\npath = [[-3, 1, 5], [3, 1, 5]]\ntarget = [0, 1, 0]',
     "shots[0].path: the camera would be inside of props[0]"),
    ("duration = 2", 'duration = 2\nstage = "course"\nprops = [{ centre = [0, 1, -5], size = [1, 2, 1] }]\n[[shots]]\nkind = "fixed"\neye = [0, 1, -5]\ntarget = [0, 1, 0]',
     "shots[0].eye: the camera would be inside of props[0]"),
]


@pytest.mark.parametrize(("old", "new", "says"), FAULTS)
def test_a_fault_is_one_line_that_names_file_and_field(tmp_path, old, new, says):
    tells(tmp_path, GOOD, old, new, says)


BOUNDS = [
    ("duration = 2", "duration = {}", 3600, "duration"),
    ("for = 1, velocity = [1.2", "for = {}, velocity = [1.2", 3600, "actors[0].moves[0].for"),
    ("[1.2, 0.5, 0.3]", "[{}, 0.5, 0.3]", 20, "actors[0].moves[0].velocity[0]"),
    ("[1.2, 0.5, 0.3]", "[20, {}, 0.3]", -20, "actors[0].moves[0].velocity[1]"),
    ("[1.2, 0.5, 0.3]", "[1, 0, 0], until = [20, 0, {}]", -20, "actors[0].moves[0].until[2]"),
    ("walk_to = [0, 0]", "walk_to = [0, {}]", 1e5, "actors[0].moves[1].walk_to[1]"),
    ("walk_to = [0, 0]", "path = [[0, 0], [{}, 0]]", -1e5, "actors[0].moves[1].path[1][0]"),
    ("speed = 1", "speed = {}", 20, "actors[0].moves[1].speed"),
    ("facing = 0", "facing = {}", 3600, "actors[1].moves[1].facing"),
    ("start = [2, 0, 90]", "start = [{}, 0, 90]", -1e5, "actors[1].start[0]"),
    ("start = [2, 0, 90]", "start = [2, 0, {}]", -3600, "actors[1].start[2]"),
    ("duration = 2", "duration = 2\nprops = [{{ centre = [0, 0, 0], size = [1, {}, 1] }}]", 1e5, "props[0].size[1]"),
    ("duration = 2", "duration = 2\nprops = [{{ centre = [0, 0, {}], size = [1, 1, 1] }}]", 1e5, "props[0].centre[2]"),
    ("duration = 2", "duration = 2\nshots = [{{ distance = {} }}]", 1e5, "shots[0].distance"),
]


@pytest.mark.parametrize(("old", "new", "most", "field"), BOUNDS, ids=[b[3] for b in BOUNDS])
def test_numbers_no_one_can_mean_are_refused(tmp_path, old, new, most, field):
    assert old in GOOD
    load(written(tmp_path, GOOD.replace(old, new.format(most), 1)))
    for more in (np.nextafter(most, most * 2), most * 1e200, np.inf, np.nan):
        with pytest.raises(ScenarioError) as error:
            load(written(tmp_path, GOOD.replace(old, new.format(repr(float(more))), 1)))
        assert f"{field}: input should be" in str(error.value) and "\n" not in str(error.value)


def test_several_faults_are_several_lines(tmp_path):
    file = written(tmp_path, GOOD.replace("duration = 2", "duration = 0\nspeed = 3"))
    with pytest.raises(ScenarioError) as error:
        load(file)
    assert len(str(error.value).splitlines()) == 2


def test_names_that_files_can_have(tmp_path):
    for name in ("Änne Müller-2", "_", "a b c"):
        assert load(written(tmp_path, GOOD.replace('"B"', f'"{name}"'))).actors[1].name == name
    for name in ("", " a", "a ", "a  b", "a.b", "a\\\\b", "..", "a:b", "a\\n", "x" * 41):
        with pytest.raises(ScenarioError, match=r"actors\[1\].name: files are named after it"):
            load(written(tmp_path, GOOD.replace('"B"', f'"{name}"')))


def test_a_folder_of_a_scenarios_name_shadows_nothing(tmp_path, monkeypatch):
    (tmp_path / "demo").mkdir()
    monkeypatch.chdir(tmp_path)
    assert load("demo").title


def test_files_that_are_none(tmp_path):
    with pytest.raises(ScenarioError, match="no scenario is called 'nowhere'.*corridor"):
        load("nowhere")
    with pytest.raises(ScenarioError, match="no scenario is called 'jump_fra'.*; did you mean jump_far"):
        load("jump_fra")
    with pytest.raises(ScenarioError, match="missing.toml"):
        load(tmp_path / "missing.toml")
    with pytest.raises(ScenarioError, match="not UTF-8 text .byte 9"):
        load(written(tmp_path, b'title = "\xff"'))
    assert load(written(tmp_path, b"\xef\xbb\xbf" + GOOD.encode())), "editors on Windows begin files with a mark"
    with pytest.raises(ScenarioError, match=tmp_path.name):
        load(tmp_path)


def frames(scenario, seconds=2.0):
    return list(film.run(scenario, Glide()))[: round(seconds * scenario.fps)]


@pytest.fixture
def scenario(tmp_path) -> Scenario:
    return load(written(tmp_path, GOOD))


def test_the_same_scenario_twice_is_the_same_to_the_bit(scenario):
    for a, b in zip(frames(scenario), frames(scenario), strict=True):
        for x, y in zip(a.before.characters, b.before.characters):
            assert np.array_equal(x.state.ground, y.state.ground)
            assert np.array_equal(x.state.pose.rotations, y.state.pose.rotations)


@pytest.mark.few(3)
@pytest.mark.parametrize("fps", [1, 24, Fraction(30000, 1001), 30, 50, 120])
def test_another_frame_rate_films_the_same_motion(scenario, fps):
    reference = {round(f.time * 60): f.before for f in frames(scenario)}
    shots = frames(scenario.at_fps(fps))
    assert len(shots) == round(2 * fps) and shots[-1].time == float((len(shots) - 1) / fps)
    for frame in shots:
        assert 0 <= frame.alpha < 1
        assert frame.before.time + frame.alpha * DT == pytest.approx(frame.time, abs=1e-12)
        assert frame.after.number == frame.before.number + 1
        for x, y in zip(frame.before.characters, reference[frame.before.number].characters):
            assert np.array_equal(x.state.ground, y.state.ground)


def test_scenes_are_filmed_with_cuts_and_overlays(tmp_path):
    text = GOOD.replace("duration = 2", '''duration = 2
overlays = ["skeleton", "trail"]
props = [{ centre = [0, 1, 5], size = [1, 2, 1], heading = 45 }]
[[shots]]
kind = "dolly"
path = [[5, 2, 0], [3, 2, 0]]
look_at = "B"
[[shots]]
at = 1
kind = "follow"
actor = "B"''')
    scenario = load(written(tmp_path, text))
    pictures = [scene for _, (scene,) in film.scenes(scenario, Glide())]
    assert len(pictures) == scenario.frames and len(pictures[0].figures) == 2 and len(pictures[0].props) == 1
    assert pictures[0].overlays == Overlays(mesh=False, skeleton=True, trail=True)
    assert pictures[0].camera.eye == pytest.approx([5, 2, 0]) and pictures[90].caption.text == "Test"
    assert np.linalg.norm(pictures[60].camera.eye - pictures[59].camera.eye) > 0.5
    for a, b in zip(pictures[60:], pictures[61:]):
        assert np.linalg.norm(a.camera.eye - b.camera.eye) < 0.1
    _, (first,) = next(film.scenes(scenario, Glide(), Overlays(path=True)))
    assert first.overlays.path and not first.overlays.trail
    assert set(OVERLAYS) == set(vars(Overlays()))


def played(moves, seconds=20.0, ground=(0.0, 0.0, 0.0)):
    glide = Glide()
    state, script, asked = glide.start(ground), Script(tuple(moves)), []
    for _ in range(round(seconds * 60)):
        script, intent = script.step(state, DT)
        state, _ = glide.step(state, intent, DT)
        asked.append(intent.velocity)
    return state, script, np.array(asked)


def test_moves_take_their_time_and_then_it_rests():
    _, script, asked = played([Move(1.0, (1, 0, 0)), Move(0.5, (0, 1, 0))], seconds=2)
    assert np.all(asked[:60] == [1, 0, 0]) and np.all(asked[60:90] == [0, 1, 0]) and np.all(asked[90:] == 0)
    assert script.done


def test_a_velocity_may_change_on_the_way():
    _, _, asked = played([Move(1.0, (0, 0, 0), until=(1, 0.5, 0))], seconds=1)
    assert np.allclose(asked[30], [0.5, 0.25, 0])


def test_walking_somewhere_arrives_and_goes_on_with_the_next_move():
    state, script, _ = played([Move(np.inf, points=((0, -2), (2, -2)), speed=1.2), Move(np.inf, points=((2, 1),), facing=0.0, speed=0.5)])
    assert script.done and np.linalg.norm(state.ground[:2] - [2, 1]) < 0.2 and abs(state.ground[2]) < 0.05
    state, _, _ = played([Move(3.0, facing=2.0)], seconds=3)
    assert state.ground[2] == pytest.approx(2.0, abs=0.01) and np.allclose(state.ground[:2], 0)


def test_walking_to_where_one_stands_is_over_at_once():
    state, script, asked = played([Move(np.inf, points=((0, 0),)), Move(0.2, (1, 0, 0))], seconds=1)
    assert script.done and np.any(asked == 1.0)


def test_no_moves_at_all():
    assert np.array_equal(played([], seconds=0.1)[2][0], Intent().velocity)
