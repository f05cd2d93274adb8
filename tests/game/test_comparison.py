"""Bodies from points in play: that all of it is a value and a log, keys, hands, streams."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from gambol.controllers.mocap import write_bvh
from gambol.game.app.app import Play
from gambol.game.app.point_picking import project
from gambol.game.app.views import scenes
from gambol.game.camera import Follow, between
from gambol.game.explain.points import rows
from gambol.game.hosts.events import KeyEvent, MouseMove, Scroll
from gambol.game.hud.legend import cells
from gambol.game.input import Wish
from gambol.game.output.recorder import motion_clip
from gambol.game.scene import Box
from gambol.game.session.comparison import Comparison, opened, written
from gambol.game.session.input_log import LogWriter, read
from gambol.game.session.log_lines import LogError
from gambol.game.session.replay import of_library, performer_of, replay, strayed
from gambol.game.session.settings import SettingError
from gambol.game.session.state import opening
from gambol.game.session.tick import Timeline
from gambol.game.world import learnt_methods as learning
from gambol.game.world.recorded import Recorded
from gambol.game.world.world import DT
from steady import no_database, walker  # noqa: F401, fixtures


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
HANDS = [Wish(pressed=("study=ours lpcr@4",)), *[WALK] * 44, Wish(pressed=("pins=hold",)),
         *[Wish(pressed=(f"pin=0:{0.9 + 0.01 * k:.4f}/1.2000/1.0000",)) for k in range(20)],
         Wish(pressed=("pin=1:",)), *[Wish()] * 10, Wish(pressed=("study=ours@4",)), *[Wish()] * 5,
         Wish(pressed=("pins=",)), *[WALK] * 20, Wish(pressed=("back=30",)), *[WALK] * 10,
         Wish(pressed=("study=ours lpca@2",)), *[WALK] * 5, Wish(pressed=("reset",)), *[WALK] * 5, Wish(pressed=("study=",)), WALK]


def same(a, b):
    assert a.comparison == b.comparison and [c.name for c in a.after.characters] == [c.name for c in b.after.characters]
    for x, y in zip(a.after.characters, b.after.characters, strict=True):
        assert np.array_equal(x.state.pose.root, y.state.pose.root) and np.array_equal(x.state.pose.rotations, y.state.pose.rotations)
        assert np.array_equal(x.told, y.told, equal_nan=True)


def test_who_joins_stands_apart_from_bodies_of_points_whoever_came_first(walker):
    study, join = Wish(pressed=("study=ours@4",)), Wish(pressed=("join",))
    for wishes in ((study, WALK, WALK, join), (join, WALK, WALK, study)):
        line = Timeline(opening(walker))
        for wish in wishes:
            line.advance((wish, Wish())[:len(line.now.players)])
        first, second, body = line.now.after.characters
        aside = [np.hypot(*(one.state.ground[:2] - first.state.ground[:2])) for one in (second, body)]
        assert np.hypot(*(second.state.ground[:2] - body.state.ground[:2])) > 1.0 and max(aside) < 1.3
        assert body.follows.performer == first.name and [c.name for c in line.now.before.characters] == [first.name, second.name, body.name]


def test_a_log_with_hands_on_points_replays_to_the_bit(tmp_path, walker):
    path = tmp_path / "a.gambol"
    _, moments = played(walker, HANDS, path)
    log = read(path)
    again = list(replay(log, walker))[1:]
    for a, b in zip(moments, again, strict=True):
        same(a, b)
        assert not strayed(log, b)
    held = next(m for m in moments if m.comparison and m.comparison.pins and m.comparison.pins[0] == (1.09, 1.2, 1.0))
    assert held.comparison.pins[1] is not None and len(held.after.characters) == 3
    assert moments[-1].comparison is None and len(moments[-1].after.characters) == 1


def test_a_clip_s_log_plays_again_with_its_clip_and_its_database(tmp_path, walker):
    write_bvh(motion_clip("clip", walker.skeleton, [walker.start().pose] * 40, 60), tmp_path / "clip.bvh")
    database = tmp_path / "mine.gambolmotion"
    database.touch()
    performer = Recorded.load(tmp_path / "clip.bvh", walker)
    game = Play(performer, learnt=learning.methods(str(database)),
                log=LogWriter(tmp_path / "a.gambol", performer, 1, tmp_path / "clip.bvh", database))
    game.do(Comparison(("ours",), "4").action)
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
    goal = np.array(timeline.now.comparison.pins[0]) + [0.05, 0.25, 0.05]
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


def test_points_that_streams_turn_are_turned_for_whoever_follows(walker):
    timeline = Timeline(opening(walker))
    turn = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
    here = written(np.array([0.3, 1.0, 0.2]), turn)
    for action in ("study=ours@2", f"pins={here};0.1/0.1/0.1"):
        timeline.advance((Wish(pressed=(action,)).rounded(),))
    turns = timeline.now.comparison.turns
    assert np.allclose(turns[0], turn, atol=1e-3) and np.isnan(turns[1]).all()
    assert np.array_equal(timeline.now.after.characters[1].intent.turns, turns, equal_nan=True)
    timeline.advance((Wish(pressed=("pins=0.1/0.9/0;0.1/0.1/0.1",)).rounded(),))
    assert timeline.now.comparison.turns is None


@pytest.mark.parametrize("action", ["pin=0:1/2/3/4", "pin=0:1/2/3/1/1/1/1", "pin=9:1/2/3", "pin=0:1/2", "pin=0:nan/1/1", "pin=0:1e9/0/0", "pins=1/2/3", "pin=x:1/2/3"])
def test_pins_that_can_not_be_are_refused(walker, action):
    timeline, _ = played(walker, HANDS[:45])
    with pytest.raises(SettingError, match=action):
        timeline.advance((Wish(pressed=(action,)),))


def test_a_study_reads_as_it_writes():
    for comparison, count in ((Comparison(), 6), (Comparison(("nearest",), "lwrist,head+0/0.1/0"), 2), (Comparison().more_points(), 2), (Comparison().other_ghosts(), 6)):
        assert opened(comparison.action) == comparison and comparison.count == count
    assert opened("study=") is None
    cycle, seen = Comparison(points="2"), []
    for _ in range(5):
        seen.append(cycle.points)
        cycle = cycle.more_points()
    assert seen == ["2", "3", "4", "5", "6"] and cycle.points == "2"


def game(walker, **options):
    play = Play(walker, **options)
    for name in ("trackers", "ours"):
        play.held_points.methods(name, "6")
    return play


def ticks(play, count=1):
    for _ in range(count):
        play.tick(DT)
        play.scene((1280, 720))


def test_keys_open_hold_and_leave(walker):
    play = game(walker)
    play.handle(KeyEvent("X", True))
    ticks(play, 3)
    assert play.now.comparison is not None and [one.name for one in play.now.after.characters[1:]] == ["trackers"], "what ships"
    play.do("study_ghosts")
    ticks(play, 2)
    assert [one.name for one in play.now.after.characters[1:]] == ["trackers", "ours"]
    scene = play.scene((1280, 720))
    assert scene.ink is not None and len(scene.figures) == 3
    play.do("study_hands")
    ticks(play, 2)
    pins = play.now.comparison.pins
    camera, aspect = play.held_points.camera, play.held_points.aspect
    number = 0
    x, y = project(camera, aspect, np.array(pins[number]))[:2]
    play.handle(MouseMove(float(x), float(y), 0.0, 0.0))
    play.handle(KeyEvent("LEFT_BUTTON", True))
    assert play.held_points.grip is not None and play.held_points.grip.number == number
    play.handle(MouseMove(float(x), float(y) - 0.1, 0.0, -0.1))
    ticks(play, 2)
    up = play.now.comparison.pins[number]
    assert up[1] > pins[number][1] + 0.2 and play.now.comparison.pins[1:] == pins[1:]
    before = play.now.players[0].camera.distance
    play.handle(Scroll(0.0, 5.0))
    ticks(play, 2)
    deeper = project(camera, aspect, np.array(play.now.comparison.pins[number]))[2]
    assert deeper > project(camera, aspect, np.array(up))[2] + 0.3 and play.now.players[0].camera.distance == before
    play.handle(KeyEvent("LEFT_BUTTON", False))
    held = play.now.comparison.pins[number]
    play.handle(MouseMove(0.1, 0.9, 0.0, 0.0))
    ticks(play, 3)
    assert play.now.comparison.pins[number] == held  # released, it stays
    x, y = project(play.held_points.camera, aspect, np.array(held))[:2]
    play.handle(MouseMove(float(x), float(y), 0.0, 0.0))
    play.handle(KeyEvent("U", True))
    ticks(play, 2)
    assert play.now.comparison.pins[number] is None
    play.handle(KeyEvent("ESCAPE", True))
    ticks(play, 2)
    assert play.now.comparison.pins is None and not play.done
    play.handle(KeyEvent("ESCAPE", True))
    assert play.done


def test_what_only_compiles_is_told_with_how_much_of_it_there_is(monkeypatch, tmp_path):
    class Sleeps:
        stdout, stderr, returncode = (), (), None

        def __init__(self, *_, **__):
            pass
    monkeypatch.setattr("gambol.game.world.learnt_methods.subprocess.Popen", Sleeps)
    monkeypatch.setattr(learning, "cache_folder", lambda: tmp_path)
    one, said = learning.Learning([("trackers", "6")]), []
    for number in range(2 * learning.KERNELS):
        (tmp_path / f"gambol.controllers.{'reconstruction' if number % 2 else 'jump'}.kernel-{number}.nbc").touch()
        said.append(one.so_far)
    assert said[0] == "0 %" and said[learning.KERNELS - 1] == "50 %" and said[-1] == "99 %"
    one.said = "the database 40 %"
    assert one.so_far == "the database 40 %"
    assert learning.Learning([("ours", "6")]).so_far == ""


class Program:
    """Another program that learns until it is told to be done."""

    begun: list = []

    def __init__(self, wanted, *_):
        self.wanted, self.done, self.so_far, self.fault, self.stopped = wanted, False, "3 %", "", False
        Program.begun.append(self)

    def stop(self):
        self.stopped = True


@pytest.fixture
def programs(monkeypatch):
    monkeypatch.setattr("gambol.game.app.held_points.Learning", Program)
    monkeypatch.setattr("gambol.game.app.held_points.compiled", lambda: False)
    monkeypatch.setattr(Program, "begun", [])
    return Program.begun


def until_read(play):
    """Wait until what has been learnt is read."""
    for _ in range(3):
        ticks(play, 1)
        if play.held_points.reading is not None:
            play.held_points.reading.join()
    ticks(play, 2)


def test_what_ships_is_compiled_before_it_is_asked_for_and_who_asks_early_waits_for_that(walker, programs):
    play = game(walker)
    play.held_points.methods = learning.Methods()  # who knows nothing yet
    play.preparing = SimpleNamespace(tend=lambda _: None, jumps=False, said=())
    ticks(play, 2)
    assert not programs, "jumps come first"
    play.preparing.jumps = True
    ticks(play, 3)
    assert [one.wanted for one in programs] == [[("trackers", "6")]] and play.held_points.status(play.now, str) == ()
    play.do("study")
    ticks(play, 2)
    assert len(programs) == 1 and play.held_points.status(play.now, str) == ("getting ready for 6 points: 3 %",)
    programs[0].done = True
    until_read(play)
    assert play.now.comparison.points == "6"
    ticks(play, 3)
    assert len(programs) == 1


def test_what_was_compiled_for_some_points_is_ready_for_others_without_another_program(walker, programs, monkeypatch):
    monkeypatch.setattr("gambol.game.app.held_points.compiled", lambda: True)
    play = game(walker)
    play.held_points.methods = learning.Methods()
    play.held_points.ahead()
    play.do("study")
    until_read(play)
    play.do("study_points")
    until_read(play)
    assert play.now.comparison.points == "2" and not programs


def test_who_wants_what_is_learnt_does_not_wait_for_what_ships(walker, programs, monkeypatch):
    play = game(walker)
    play.held_points.methods("trackers", "6")
    monkeypatch.setattr(play.held_points.methods, "knows", lambda name, _: name == "trackers")
    play.held_points.ahead()
    play.do("study")
    ticks(play, 2)
    play.do("study_ghosts")
    assert [(one.wanted, one.stopped) for one in programs] == [([("trackers", "6")], True), ([("ours", "6")], False)]


def test_who_waits_for_it_may_take_it_back_and_meanwhile_holds_what_is_there(walker, monkeypatch):
    """X once more ends what gets ready; nothing of it comes later."""
    monkeypatch.setattr("gambol.game.app.held_points.compiled", lambda: False)

    class Endless:
        done, so_far, fault, stopped = False, "3 s", "", 0

        def __init__(self, *_):
            pass

        def stop(self):
            Endless.stopped += 1
    monkeypatch.setattr("gambol.game.app.held_points.Learning", Endless)
    play = Play(walker)
    play.held_points.methods("trackers", "6")
    play.do("study")
    ticks(play, 2)
    play.do("study_points")  # two points, which nobody has learnt yet
    play.do("study_hands")
    ticks(play, 2)
    assert play.held_points.wanted is not None and play.now.comparison.pins is not None
    for _ in range(3):
        play.do("study_ghosts")
    assert "getting ready for 2 points: 3 s" in play.held_points.status(play.now, str)
    assert play.kept.notices == ("one thing after the other: still getting ready for 2 points",), "said once"
    play.do("study")
    ticks(play, 2)
    assert play.held_points.wanted is None and Endless.stopped == 1 and play.now.comparison.points == "6"
    play.do("study")
    ticks(play, 2)
    assert play.now.comparison is None


def test_a_stream_holds_the_points(walker):
    class Somebody:
        worn = None
        turns = np.full((4, 3, 3), np.nan)

        def at(self, time):
            return np.array([[0.4, 1.0, 0.3], [np.nan] * 3, [0.1, 0.07, 0.0], [-0.1, 0.07, 0.0]])
    play = game(walker, stream=Somebody())
    play.held_points.methods("trackers", "4")
    play.open(Comparison(points="4"))
    ticks(play, 5)
    play.do("study")
    ticks(play, 2)
    assert play.now.comparison is None
    play.do("study")  # the same points again
    ticks(play, 5)
    assert play.now.comparison.pins[1] is None
    assert play.now.comparison.pins[0] == pytest.approx(np.array([0.4, 1.0, 0.3]) + play.now.comparison.beside, abs=1e-4)
    play.do("study_points")
    play.do("study_hands")
    ticks(play, 3)
    assert play.now.comparison.points == "4" and play.now.comparison.pins is not None  # they are the stream's
    play.do("quit")
    assert play.done


def test_what_can_not_be_learnt_is_told_in_one_line(tmp_path):
    wrong = tmp_path / "wrong.gambolmotion"
    wrong.write_bytes(b"nothing")
    other = learning.Learning([("ours", "4")], wrong)
    other.wait()
    assert other.done and other.fault == f"{wrong}: is no motion database; `gambol database build` makes one"


def test_where_players_share_the_picture_bodies_stand_within_the_first_ones_part_and_not_in_the_other(walker):
    def placed(players):
        timeline = Timeline(opening(walker, players))
        timeline.advance((Wish(pressed=("study=ours@6",)), *[Wish()] * (players - 1)))
        performer, *others, body = timeline.now.after.characters
        at = np.array([project(timeline.now.players[0].view(1.0), 8.0 / 9.0, body.state.pose.root + [dx, 0.0, 0.0])[0] for dx in (-0.35, 0.35)])
        return at, min(math.dist(body.state.ground[:2], one.state.ground[:2]) for one in (performer, *others))
    alone, apart = placed(1)
    assert alone.max() > 8.0 / 9.0 and apart > 1.3, "half of the picture is not enough for this, and need not be"
    shared, apart = placed(2)
    assert shared.min() > 0.0 and shared.max() < 8.0 / 9.0 and apart > 0.8


def test_the_legend_lies_in_the_first_player_s_part_and_lines_keep_off_it(walker):
    game = Play(walker, players=2)
    game.do("study=ours@6")
    for _ in range(3):
        game.tick(DT)
        first, second = game.scene((640, 360))
    reach = first.ink.vertices["place"][:, 0]
    assert first.ink.size == (640, 360) and reach.max() <= 320 and first.taken == (320 - reach.min(), first.ink.vertices["place"][:, 1].max())
    assert second.ink is None and second.taken == (0.0, 0.0)
    assert not len(game.scene((200, 150))[0].ink.vertices), "none where it has no room"
    game.close()


def test_a_body_beside_that_goes_through_what_stands_there_is_faint_and_nobody_else_is(walker):
    play = game(walker)
    play.do("study")
    ticks(play, 3)
    moment = play.now
    x, _, z = moment.after.characters[1].state.pose.root

    def covers(*props):
        camera = Follow.behind(np.zeros(3), yaw=0.0)
        seen = replace(moment, after=replace(moment.after, props=props))
        return [one.cover for one in scenes(seen, 1.0, (between(camera, camera, 1.0),), play.showing.overlays)[0].figures[:2]]
    assert covers() == [1.0, 1.0]
    own, other = covers(Box((float(x), 1.0, float(z)), (0.6, 2.0, 0.6)))
    assert own == 1.0 and other == pytest.approx(0.3)
    beside = [covers(Box((float(x + far), 1.0, float(z)), (0.2, 2.0, 0.2)))[1] for far in (0.1, 0.15, 0.2, 0.25, 0.35)]
    assert beside == sorted(beside) and beside[0] < 0.5 and beside[-1] == 1.0
