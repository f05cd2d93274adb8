"""Bodies from points in films and in play: what is seen, what is told of it, and that it is all a value and a log."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from controllers.body import forward_kinematics
from controllers.contract import Intent
from controllers.locomotion import Locomotion
from controllers.mocap import write_bvh
from controllers.reconstruction import metrics
from controllers.reconstruction.beliefs import Gaussian
from controllers.reconstruction.chart import HEIGHT, JOINTS, PITCH, ROLL, SKELETON, WIDTH, YAW_RATE
from controllers.reconstruction.method import Method
from controllers.reconstruction.solver import Solver
from controllers.supervisor import Supervisor
from game import film, methods as learning
from game.follow import Follows, errors, lately
from game.handles import Grip, nearest, project, unproject
from game.hosts.events import KeyEvent, MouseMove, Scroll
from game.hud.legend import cells
from game.input import Wish
from game.log import LogError, LogWriter, of_library, performer_of, read, replay, strayed
from game.play import Play
from game.pointing import pointed, rows
from game.recorded import Recorded
from game.recorder import motion_clip
from game.scenario import ScenarioError, load, shipped
from game.scene import Camera, Dot, Overlays
from game.session import Timeline, opening
from game.settings import SettingError
from game.study import Study, opened, written
from game.world import DT, figures
from test_scenario import written as toml


class Steady:
    """A prior that needs no database: the coming pose is like the last one, and upright."""

    def believe(self, memory, seen, goals):
        deviation = np.full(WIDTH, 0.08)
        deviation[HEIGHT], deviation[YAW_RATE:] = 0.02, 1.0
        mean = memory.frames[0].copy()
        mean[PITCH], mean[ROLL], mean[HEIGHT] = 0.0, 0.0, 0.95
        return Gaussian(mean, deviation**2), None


class NoStarts:
    """Where to begin from points: nowhere, as nobody here has to."""

    def find(self, points, velocities=None):
        raise AssertionError("the body stands where its points are")


@pytest.fixture(autouse=True)
def no_database(monkeypatch):
    """Every method is `Steady`, learnt at once."""
    monkeypatch.setattr(learning, "learnt", lambda name, database, controls, progress=None: Method(
        Steady(), Solver(controls, 1 / 60)))
    monkeypatch.setattr(learning.Methods, "database", lambda self, progress=None: None)
    monkeypatch.setattr(learning.Methods, "starts", lambda self, points: NoStarts())
    learning.methods.cache_clear()
    yield
    learning.methods.cache_clear()


@pytest.fixture(scope="module")
def walker():
    return Supervisor({"locomotion": Locomotion.load()})


SCENE = """
title = "Test"
duration = 3
fps = 60
overlays = ["mesh", "points", "errors"]
[[actors]]
name = "A"
moves = [{ for = 3, velocity = [1.3, 0.3, 0] }]
[[actors]]
name = "shadow"
follows = { actor = "A", points = 4, beside = [-1.5, 0, 0.25], hidden = [{ points = "lwrist", from = 1, to = 2 }] }
[[actors]]
name = "ghost"
ghost = true
follows = { actor = "A", points = "4", method = "lpcr", beside = [-1.5, 0, 0.25] }
"""


# --- films

def test_a_follower_goes_where_its_points_are_and_the_legend_says_what_metrics_says(tmp_path, walker):
    scenario = load(toml(tmp_path, SCENE))
    truth, found, away, last = [], [], [], None
    for frame in film.run(scenario, walker):
        performer, shadow, _ = frame.after.characters
        if frame.after is not last and frame.after.number:
            last = frame.after
            truth.append(performer.joints[0])
            found.append(shadow.joints[0] - shadow.follows.beside)
            away.append(np.linalg.norm(shadow.follows.controls.on(*shadow.joints) - shadow.intent.points, axis=-1))
    told = last.characters[1].told
    assert len(told) == len(truth) == last.number
    assert np.allclose(told[:, 0], metrics.position_error(np.array(found), np.array(truth)), atol=1e-12)
    apart = np.linalg.norm(np.array(found) - np.array(truth), axis=-1)[:, JOINTS]
    assert np.allclose(told[:, 1], apart.max(1)) and np.array_equal(told[:, 2], JOINTS[apart.argmax(1)])
    assert np.allclose(told[:, 3], np.nanmean(away, axis=1))
    assert last.characters[2].told[:, 3].max() < 0.06 and last.characters[2].state.ground[1] > 3.0  # it walks along
    row = rows(last)[0]
    assert row.errors == lately(told) and row.errors.mean == pytest.approx(told[-30:, 0].mean())
    assert cells(row)[1] == f"{100 * told[-30:, 0].mean():.1f}" and cells(row)[3] == f"{100 * told[-30:, 3].mean():.1f}"
    assert [one.name for one in rows(last)] == ["shadow", "ghost"] and [one.ghost for one in rows(last)] == [False, True]


def test_hidden_points_are_not_seen_and_the_film_is_the_same_to_the_bit(tmp_path, walker):
    scenario = load(toml(tmp_path, SCENE.replace("to = 2 }] }", "to = 2 }], noise = 0.01 }")))
    first, second = (list(film.run(scenario, walker)) for _ in range(2))
    for a, b in zip(first, second, strict=True):
        for x, y in zip(a.after.characters, b.after.characters, strict=True):
            assert np.array_equal(x.state.pose.rotations, y.state.pose.rotations) and np.array_equal(x.told, y.told, equal_nan=True)
    for frame in first:
        shadow, ghost = frame.after.characters[1:]
        if frame.after.number:
            hidden = 1 - 1e-9 <= frame.after.time < 2 - 1e-9
            assert np.isfinite(shadow.intent.points).all(-1).tolist() == [not hidden, True, True, True]
            assert np.isfinite(ghost.intent.points).all()
            blur = shadow.intent.points[1:] - ghost.intent.points[1:]
            assert 0.0 < np.abs(blur).max() < 0.06


def test_a_lost_point_comes_back_without_a_pop(tmp_path, walker):
    run = [frame.after.characters[1] for frame in film.run(load(toml(tmp_path, SCENE)), walker)]
    steps = np.linalg.norm(np.diff([one.joints[0] for one in run], axis=0), axis=-1).max(1)
    assert steps[20:].max() < 0.12  # 7 m/s, as fast as a wrist swings


def test_what_is_drawn_of_points(tmp_path, walker):
    scenario = load(toml(tmp_path, SCENE))
    for frame in film.run(scenario, walker):
        people = pointed(figures(frame.before, frame.after, frame.alpha), frame.before, frame.after, frame.alpha, Overlays(points=True))
        dots = [[s for s in one.sketches if isinstance(s, Dot)] for one in people]
        if frame.after.number:
            # the same points of two followers are drawn once, and once on the performer
            assert [len(some) for some in dots] == [0, 8, 0]
            lost = 1 - 1e-9 <= frame.after.time < 2 - 1e-9
            assert {dot.look for dot in dots[1]} == ({"ball", "ring"} if lost else {"ball"})
            assert [one.opacity for one in people] == [1.0, 1.0, pytest.approx(0.34)]


def test_films_show_the_legend_and_a_clip_can_be_the_performer(tmp_path, walker):
    state, poses = walker.start(), []
    for _ in range(70):
        state, pose = walker.step(state, Intent(np.array([1.2, 0.0, 0.0])), DT)
        poses.append(pose)
    write_bvh(motion_clip("walk", walker.skeleton, poses, 60), tmp_path / "walk.bvh")
    scenario = load(toml(tmp_path, """
title = "Clip"
duration = 1.1
overlays = ["mesh", "points", "errors"]
[[shots]]
kind = "follow"
actor = "walk"
[[actors]]
name = "shadow"
follows = { clip = "walk.bvh", points = "6", beside = [1, 0, 0] }
"""))
    seen = list(film.scenes(scenario, walker))
    assert seen[-1][1][0].ink is not None and len(seen[-1][1][0].figures) == 2
    world = seen[-1][0].after
    assert [one.name for one in world.characters] == ["shadow", "walk"]
    assert len(world.characters[0].told) == world.number and world.characters[0].told[-1, 3] < 0.05
    assert abs(world.characters[1].state.ground[2]) < 0.2 and world.characters[1].state.ground[1] > 0.8  # from the origin, ahead


FAULTS = [
    ('actor = "A", points = 4', 'actor = "B", points = 4', "actors[1].follows.actor: nobody with moves is called 'B'; there are A"),
    ('actor = "A", points = 4', 'actor = "ghost", points = 4', "actors[1].follows.actor: nobody with moves is called 'ghost'"),
    ('actor = "A", points = 4', 'points = 4', 'actors[1].follows: needs either actor = "…", another actor, or clip'),
    ('actor = "A", points = 4', 'clip = "none.bvh"', "actors[1].follows.clip: there is no file 'none.bvh' beside the scenario"),
    ("points = 4", 'points = "9"', "actors[1].follows.points: no control point '9': there are root,"),
    ("points = 4", 'points = "lwrist,lwrist"', "actors[1].follows.points: control point 'lwrist' is given twice"),
    ("points = 4", 'points = 4, method = "best"', "actors[1].follows.method: input should be 'ours', 'lpcr'"),
    ("points = 4", "points = 4, noise = -1", "actors[1].follows.noise: input should be greater than or equal to 0"),
    ('points = "lwrist", from', 'points = "head", from', "actors[1].follows: hidden[0].points: head is none of the points that are followed"),
    ("from = 1, to = 2", "from = 2, to = 1", "actors[1].follows.hidden[0]: `from` comes before `to`"),
    ("beside = [-1.5, 0, 0.25]", "beside = [-1.5, 0]", "actors[1].follows.beside[2]: is missing, and needed"),
    ('name = "shadow"\n', 'name = "shadow"\nstart = [1, 0, 0]\n', "actors[1]: who follows points has no start"),
    ('name = "shadow"\n', 'name = "shadow"\nmoves = []\n', "actors[1]: who follows points has no moves"),
    ("duration = 3", 'duration = 3\ndatabase = "none.gambolmotion"', "database: there is no file 'none.gambolmotion'"),
]


@pytest.mark.parametrize(("old", "new", "says"), FAULTS)
def test_a_fault_names_file_and_field(tmp_path, old, new, says):
    assert old in SCENE
    file = toml(tmp_path, SCENE.replace(old, new, 1))
    with pytest.raises(ScenarioError) as error:
        load(file)
    assert says in str(error.value) and str(error.value).startswith(str(file)) and "\n" not in str(error.value)


def test_two_are_shipped():
    for name in ("reconstruct", "dropout"):
        assert name in shipped() and load(name).followers


# --- handles

vectors = st.tuples(*(st.floats(-5, 5),) * 3).map(np.array)


@given(vectors, vectors, st.floats(0.2, 2.0), st.floats(0.5, 3.0), st.floats(0, 3), st.floats(0, 1), st.floats(0.2, 40))
def test_projecting_undoes_unprojecting(eye, away, fov, aspect, x, y, depth):
    camera = Camera(eye, eye + away + [0.0, 0.0, 0.01 + np.linalg.norm(away)], fov=fov)
    place = np.array([x, y, depth])
    assert np.allclose(project(camera, aspect, unproject(camera, aspect, place)), place, atol=1e-6 * depth * (1 + x))


def test_the_renderer_draws_a_point_where_it_is_picked():
    from game.render import view

    camera, size = Camera(np.array([2.0, 1.5, -3.0]), np.array([0.3, 1.0, 0.0]), fov=0.8), (1280, 720)
    rng = np.random.default_rng(0)
    points = rng.uniform(-1, 1, (50, 3)) + [0, 1, 0]
    matrix = view.perspective(camera.fov, size[0] / size[1]) @ view.look_at(camera.eye, camera.target, camera.up)
    clip = np.concatenate([points, np.ones((50, 1))], 1) @ matrix.T
    pixels = (0.5 + 0.5 * clip[:, :2] / clip[:, 3:] * [1, -1]) * size
    assert np.allclose(project(camera, size[0] / size[1], points)[:, :2] * size[1], pixels, atol=1e-6)
    for number in range(50):
        x, y = pixels[number] / size[1]
        picked = nearest(camera, size[0] / size[1], points, x, y)
        assert np.linalg.norm(project(camera, size[0] / size[1], points[picked])[:2] - [x, y]) < 0.0072
    assert nearest(camera, size[0] / size[1], points, -1.0, 0.5) is None
    behind = camera.eye + 2.0 * (camera.eye - camera.target)
    assert nearest(camera, 1.6, behind[None], 0.8, 0.5) is None


def test_a_drag_stays_in_the_plane_and_deeper_stays_on_the_line_of_sight():
    camera = Camera(np.array([0.0, 1.0, -4.0]), np.array([0.0, 1.0, 0.0]), fov=0.8)
    grip = Grip.of(camera, 1.5, np.array([[0.2, 1.3, 0.5]]), 0, 0.74, 0.41)
    assert np.allclose(grip.place(camera, 1.5, 0.74, 0.41), [0.2, 1.3, 0.5])
    moved = grip.place(camera, 1.5, 0.60, 0.30)
    assert moved[2] == pytest.approx(0.5) and moved[1] > 1.3 and moved[0] > 0.2  # left on the screen is +X, seen from behind
    for deeper in (grip.pushed(3.0), grip.slid(0.0, -0.1)):
        place = deeper.place(camera, 1.5, 0.74, 0.41 - (0.1 if deeper.off != grip.off else 0.0))
        assert place[2] > 0.5
        assert np.allclose(project(camera, 1.5, place)[:2], project(camera, 1.5, np.array([0.2, 1.3, 0.5]))[:2])


# --- play

def played(walker, ticks, path=None):
    timeline, moments = Timeline(opening(walker)), []
    writer = None if path is None else LogWriter(path, walker, 1)
    for wish in ticks:
        timeline.advance((wish.rounded(),))
        moments.append(timeline.now)
        if writer is not None:
            writer.add((wish.rounded(),))
            if len(moments) % 30 == 0:
                writer.flush(timeline.now)
    if writer is not None:
        writer.flush(timeline.now)
        writer.close()
    return timeline, moments


WALK = Wish(move=(0.2, 1.0))
HANDS = [Wish(pressed=("study=ours lpcr@4",)), *[WALK] * 40, Wish(pressed=("pins=hold",)),
         *[Wish(pressed=(f"pin=0:{0.9 + 0.01 * k:.4f}/1.2000/1.0000",)) for k in range(20)],
         Wish(pressed=("pin=1:",)), *[Wish()] * 10, Wish(pressed=("study=ours@4",)), *[Wish()] * 5,
         Wish(pressed=("pins=",)), *[WALK] * 20, Wish(pressed=("back=30",)), *[WALK] * 10,
         Wish(pressed=("study=ours lpca@2",)), *[WALK] * 5, Wish(pressed=("reset",)), *[WALK] * 5, Wish(pressed=("study=",)), WALK]


def same(a, b):
    assert a.study == b.study and [c.name for c in a.after.characters] == [c.name for c in b.after.characters]
    for x, y in zip(a.after.characters, b.after.characters, strict=True):
        assert np.array_equal(x.state.pose.root, y.state.pose.root) and np.array_equal(x.state.pose.rotations, y.state.pose.rotations)
        assert np.array_equal(x.told, y.told, equal_nan=True)


def test_a_log_with_hands_on_points_replays_to_the_bit(tmp_path, walker):
    path = tmp_path / "a.gambol"
    _, moments = played(walker, HANDS, path)
    log = read(path)
    again = list(replay(log, walker))[1:]
    for a, b in zip(moments, again, strict=True):
        same(a, b)
        assert not strayed(log, b)
    held = next(m for m in moments if m.study and m.study.pins and m.study.pins[0] == (1.09, 1.2, 1.0))
    assert held.study.pins[1] is not None and len(held.after.characters) == 3
    assert moments[-1].study is None and len(moments[-1].after.characters) == 1


def test_a_clip_s_log_plays_again_with_its_clip_and_its_database(tmp_path, walker):
    write_bvh(motion_clip("clip", walker.skeleton, [walker.start().pose] * 40, 60), tmp_path / "clip.bvh")
    database = tmp_path / "mine.gambolmotion"
    database.touch()
    performer = Recorded.load(tmp_path / "clip.bvh", walker)
    game = Play(performer, learnt=learning.methods(str(database)),
                log=LogWriter(tmp_path / "a.gambol", performer, 1, tmp_path / "clip.bvh", database))
    game.do(Study(("ours",), "4").action)
    for _ in range(60):
        game.tick(DT)
    game.close()
    log = read(tmp_path / "a.gambol")
    again = performer_of(log, walker)
    *_, last = replay(of_library(log, again), again)
    assert not strayed(log, last) and last.methods is learning.methods(str(database)) and len(last.after.characters) == 2
    (tmp_path / "clip.bvh").rename(tmp_path / "other.bvh")
    with pytest.raises(LogError, match=r"a\.gambol: was played with the clip .*clip\.bvh, which is not there"):
        performer_of(log, walker)
    write_bvh(motion_clip("clip", walker.skeleton, [walker.start().pose] * 50, 60), tmp_path / "clip.bvh")
    with pytest.raises(LogError, match="another clip than .*clip.bvh holds now"):
        of_library(log, performer_of(log, walker))
    database.unlink()
    with pytest.raises(LogError, match=r"a\.gambol: was played with the motion database .*mine\.gambolmotion, which is not there"):
        performer_of(log, walker)


def test_going_back_and_the_same_again_is_the_same_again(walker):
    timeline, moments = played(walker, HANDS[:60])
    timeline.advance((replace(HANDS[35], pressed=("back=25",)).rounded(),))
    same(timeline.now, moments[35])
    for wish, wanted in zip(HANDS[36:60], moments[36:], strict=True):
        timeline.advance((wish.rounded(),))
        same(timeline.now, wanted)


def test_the_body_goes_where_it_is_pulled_and_hands_take_it_over_without_a_jump(walker):
    timeline, _ = played(walker, HANDS[:41])
    before = timeline.now.after.characters[1]
    timeline.advance((Wish(pressed=("pins=hold",)),))
    body = timeline.now.after.characters[1]
    assert np.linalg.norm(body.joints[0] - before.joints[0], axis=-1).max() < 0.08
    goal = np.array(timeline.now.study.pins[0]) + [0.05, 0.25, 0.05]
    for k in range(90):
        old = body.joints[0]
        timeline.advance((Wish(pressed=(f"pin=0:{written(goal)}",) if k == 0 else ()),))
        body = timeline.now.after.characters[1]
        if k:
            assert np.linalg.norm(body.joints[0] - old, axis=-1).max() < 0.15
    assert np.linalg.norm(body.follows.controls.on(*body.joints)[0] - goal) < 0.05
    assert math.isnan(body.told[-1, 0]) and cells(rows(timeline.now.after)[0])[1] == "–"


@pytest.mark.parametrize("action", ["study=best@4", "study=ours", "study=ours ours@4", "study=ours@nose", "pin=0:1/2/3",
                                    "pins=hold", "pins=1/2/3"])
def test_actions_that_say_nothing_sound_are_refused(walker, action):
    with pytest.raises(SettingError, match=action.partition("=")[0]):
        Timeline(opening(walker)).advance((Wish(pressed=(action,)),))


@pytest.mark.parametrize("action", ["pin=9:1/2/3", "pin=0:1/2", "pin=0:nan/1/1", "pin=0:1e9/0/0", "pins=1/2/3", "pin=x:1/2/3"])
def test_pins_that_can_not_be_are_refused(walker, action):
    timeline, _ = played(walker, HANDS[:45])
    with pytest.raises(SettingError, match=action):
        timeline.advance((Wish(pressed=(action,)),))


def test_a_study_reads_as_it_writes():
    for study, count in ((Study(), 4), (Study(("nearest",), "lwrist,head+0/0.1/0"), 2), (Study().more_points(), 5), (Study().other_ghosts(), 4)):
        assert opened(study.action) == study and study.count == count
    assert opened("study=") is None
    cycle, seen = Study(points="2"), []
    for _ in range(5):
        seen.append(cycle.points)
        cycle = cycle.more_points()
    assert seen == ["2", "3", "4", "5", "6"] and cycle.points == "2"


def game(walker, **options):
    play = Play(walker, **options)
    for name in ("ours", "lpcr", "lpca"):
        play.reach.methods(name, "4")
    return play


def ticks(play, count=1):
    for _ in range(count):
        play.tick(DT)
        play.scene((1280, 720))


def test_keys_open_hold_and_leave(walker):
    play = game(walker)
    play.handle(KeyEvent("X", True))
    ticks(play, 3)
    assert play.now.study is not None and [one.name for one in play.now.after.characters[1:]] == ["ours", "local PCR", "local PCA"]
    scene = play.scene((1280, 720))
    assert scene.ink is not None and len(scene.figures) == 4
    play.do("study_hands")
    ticks(play, 2)
    pins = play.now.study.pins
    camera, aspect = play.reach.camera, play.reach.aspect
    number = 0
    x, y = project(camera, aspect, np.array(pins[number]))[:2]
    play.handle(MouseMove(float(x), float(y), 0.0, 0.0))
    play.handle(KeyEvent("LEFT_BUTTON", True))
    assert play.reach.grip is not None and play.reach.grip.number == number
    play.handle(MouseMove(float(x), float(y) - 0.1, 0.0, -0.1))
    ticks(play, 2)
    up = play.now.study.pins[number]
    assert up[1] > pins[number][1] + 0.2 and play.now.study.pins[1:] == pins[1:]
    before = play.now.players[0].camera.distance
    play.handle(Scroll(0.0, 5.0))
    ticks(play, 2)
    deeper = project(camera, aspect, np.array(play.now.study.pins[number]))[2]
    assert deeper > project(camera, aspect, np.array(up))[2] + 0.3 and play.now.players[0].camera.distance == before
    play.handle(KeyEvent("LEFT_BUTTON", False))
    held = play.now.study.pins[number]
    play.handle(MouseMove(0.1, 0.9, 0.0, 0.0))
    ticks(play, 3)
    assert play.now.study.pins[number] == held  # released, it stays
    x, y = project(play.reach.camera, aspect, np.array(held))[:2]
    play.handle(MouseMove(float(x), float(y), 0.0, 0.0))
    play.handle(KeyEvent("U", True))
    ticks(play, 2)
    assert play.now.study.pins[number] is None
    play.handle(KeyEvent("ESCAPE", True))
    ticks(play, 2)
    assert play.now.study.pins is None and not play.done
    play.handle(KeyEvent("ESCAPE", True))
    assert play.done


def test_a_stream_holds_the_points(walker):
    class Somebody:
        def at(self, time):
            return np.array([[0.4, 1.0, 0.3], [np.nan] * 3, [0.1, 0.07, 0.0], [-0.1, 0.07, 0.0]])
    play = game(walker, stream=Somebody())
    play.do("study")
    ticks(play, 5)
    assert play.now.study.pins[1] is None
    assert play.now.study.pins[0] == pytest.approx(np.array([0.4, 1.0, 0.3]) + play.now.study.beside, abs=1e-4)
    play.do("study_points")
    play.do("study_hands")
    ticks(play, 3)
    assert play.now.study.points == "4" and play.now.study.pins is not None  # they are the stream's
    play.do("quit")
    assert play.done


def test_what_can_not_be_learnt_is_told_in_one_line(tmp_path):
    wrong = tmp_path / "wrong.gambolmotion"
    wrong.write_bytes(b"nothing")
    other = learning.Learning([("ours", "4")], wrong)
    other.wait()
    assert other.done and other.fault == f"{wrong}: is no motion database; `gambol database build` makes one"


def test_the_errors_of_one_moment_by_hand():
    follows = Follows("ours", learning.methods()("ours", "2")[1], "A", np.array([1.0, 0.0, 0.0]))
    still = np.broadcast_to(np.eye(3), (len(SKELETON), 3, 3))
    truth, turned = forward_kinematics(SKELETON, np.zeros(3), still)
    found = truth + [1.0, 0.0, 0.0]
    found[SKELETON.index("Head")] += [0.0, 0.19, 0.0]
    told = errors(follows, (found, turned), truth, follows.there(truth, turned) + [0.0, 0.0, 0.03])
    assert told == pytest.approx([0.01, 0.19, SKELETON.index("Head"), 0.03])
    assert lately(told[None]).joint == "Head" and lately(told[:0].reshape(0, 4)) is None
