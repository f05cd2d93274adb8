"""Bodies from points in play: that all of it is a value and a log, and that nonsense is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest

from gambol.controllers.mocap import write_bvh
from gambol.game.app.app import Play
from gambol.game.explain.points import rows
from gambol.game.hud.legend import cells
from gambol.game.input import Wish
from gambol.game.output.recorder import motion_clip
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
HANDS = [Wish(pressed=("study=ours lpcr@4",)), *[WALK] * 48, Wish(pressed=("pins=hold",)),
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
    timeline, _ = played(walker, HANDS[:2])
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
