"""Hints: one at a time, gone once followed, remembered, and no part of what is played."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.game.app.app import Play
from gambol.game.app.hints import (FADE, LASTS, NEEDS, ORDER, PAUSE, Hints, Teacher, doing, remember, remembered, whither,
                                   worded)
from gambol.game.hosts.events import KeyEvent
from gambol.game.input import DEFAULT
from gambol.game.input.remap import remapped
from gambol.game.scene.scene import Hint, Scene
from gambol.game.session.input_log import LogWriter, read
from gambol.game.session.replay import replay
from hands import FRAME, pad, press, release, tap, wait
from stand_in import Glide

TICK = 0.05
deeds = st.lists(st.frozensets(st.sampled_from(ORDER), max_size=2), max_size=40)


def after(hints, seconds, *now):
    for _ in range(round(seconds / TICK)):
        hints = hints.step(now, TICK)
    return hints


@given(deeds)
def test_what_was_done_is_never_taught_and_nothing_comes_or_goes_at_once(done):
    hints = Hints()
    for now in (now for now in done for _ in range(12)):
        later = hints.step(now, TICK)
        assert abs(later.opacity - hints.opacity) <= TICK / FADE + 1e-9
        assert hints.done <= later.done and 0.0 <= later.opacity <= 1.0
        if later.name != hints.name and later.name:
            assert not hints.name and later.name not in later.done and later.opacity == 0.0
            assert set(ORDER[:ORDER.index(later.name)]) <= later.done
        hints = later


def test_each_is_followed_by_the_next_and_then_there_are_none():
    hints = after(Hints(), PAUSE + FADE + 0.2)
    for name in ORDER:
        assert hints.name == name and hints.opacity == pytest.approx(1.0)
        hints = after(hints, NEEDS.get(name, 0.0) + 0.2, name)
        assert hints.name == name and hints.opacity < 1.0, "it fades"
        hints = after(hints, 2 * FADE + PAUSE + 0.2)
    assert hints.name == "" and hints.done == set(ORDER)


def test_the_first_one_waits_and_the_others_go_by_themselves():
    assert after(Hints(), 120).name == "walk"
    hints = after(Hints(frozenset(["walk"])), PAUSE + 1)
    assert hints.name == "run" and after(hints, LASTS["run"] + FADE).name != "run"
    assert after(hints, sum(LASTS.values()) + 30).done == set(ORDER)


def test_what_can_not_be_done_yet_is_not_taught():
    """A jump that is still being compiled."""
    hints = Hints(frozenset(["walk", "run"]))
    for _ in range(200):
        hints = hints.step((), TICK, early=("jump", "course"))
        assert hints.name in ("", "study")
    assert after(Hints(frozenset(["walk", "run"])), 2.0).name == "jump"


def test_who_runs_need_not_be_taught_to_walk():
    play = Play(Glide())
    press(play, "LEFT_SHIFT", "W")
    wait(play, 1.5)
    assert {"walk", "run"} <= doing(play.now)


def test_keys_are_called_as_they_are_bound():
    assert worded("walk", DEFAULT, False) == (("W", True), ("A", True), ("S", True), ("D", True), ("to walk", False))
    assert worded("walk", DEFAULT, True)[0] == ("left stick", True)
    assert ("Shift", True) in worded("run", DEFAULT, False) and ("RT", True) in worded("run", DEFAULT, True)
    assert ("Space", True) in worded("jump", DEFAULT, False) and ("A", True) in worded("jump", DEFAULT, True)
    assert ("X", True) in worded("study", DEFAULT, True), "the keyboard's, as no button does that"
    other = remapped(DEFAULT, {"jump": ("V",), "study": ()}, {"jump": ()})
    assert ("V", True) in worded("jump", other, False) and ("V", True) in worded("jump", other, True)
    assert worded("study", other, False) == ()
    assert "study" in Teacher.ready(other, afresh=True).hints.done, "what no key does is not taught"


def test_what_was_done_is_remembered_and_a_broken_file_is_none(tmp_path):
    file = tmp_path / "new" / "hints.toml"
    assert remembered(file) == frozenset()
    remember(file, {"walk", "jump"})
    assert remembered(file) == {"walk", "jump"} and [p.name for p in file.parent.iterdir()] == ["hints.toml"]
    assert Teacher.ready(DEFAULT, file=file).hints.done == {"walk", "jump"}
    assert Teacher.ready(DEFAULT, afresh=True, file=file).hints.done == frozenset()
    for text in ("done = 3", "done = [1, {}]", "done = [", "walk"):
        file.write_text(text)
        assert remembered(file) == frozenset()
    (tmp_path / "file").write_text("")
    remember(tmp_path / "file" / "hints.toml", {"walk"})  # no folder: nothing is said
    remember(tmp_path, {"walk"})  # a folder in its place


@pytest.fixture
def taught(tmp_path):
    return Play(Glide(), teacher=Teacher.ready(DEFAULT, file=tmp_path / "hints.toml"))


def hint(game):
    view = game.scene((320, 180))
    found = (view[0] if isinstance(view, tuple) else view).hint
    return "" if found is None else " ".join(word for word, _ in found.parts)


def test_a_first_minute(taught, tmp_path):
    """Through the game as a host runs it: each hint goes as it is followed, and a second game begins where the first ended."""
    wait(taught, PAUSE + FADE)
    assert hint(taught) == "W A S D to walk"
    press(taught, "W")
    wait(taught, NEEDS["walk"] + 2 * FADE + PAUSE + 0.5)
    assert hint(taught) == "hold Shift as you walk, to run"
    taught.handle(pad((0.0, -1.0)))
    wait(taught, FRAME)
    assert hint(taught) == "hold RT as you walk, to run"
    taught.handle(pad())
    press(taught, "LEFT_SHIFT")
    wait(taught, NEEDS["run"] + 2 * FADE + PAUSE + 1.0)
    release(taught, "LEFT_SHIFT", "W")
    assert hint(taught) == "hold Space to aim, let go to jump"
    assert remembered(tmp_path / "hints.toml") >= {"walk", "run"}
    second = Play(Glide(), teacher=Teacher.ready(DEFAULT, file=tmp_path / "hints.toml"))
    wait(second, PAUSE + FADE)
    assert hint(second) == "hold Space to aim, let go to jump"


def test_hints_keep_out_of_the_way(taught):
    wait(taught, PAUSE + FADE)
    assert hint(taught)
    tap(taught, "F1")
    assert not hint(taught), "the help says more"
    tap(taught, "F1")
    taught.wants_picture = True
    assert not hint(taught), "nothing is written on a screenshot"
    taught.wants_picture = False
    taught.handle(KeyEvent("BACKSPACE", True))
    wait(taught, 0.2)
    assert taught.past.look is not None and not hint(taught), "nor over the past"
    assert not hint(Play(Glide())), "nor where nobody asked for them"


def test_a_log_plays_again_without_them(tmp_path):
    games = [Play(Glide(), log=LogWriter(tmp_path / f"{i}.gambol", Glide(), 1), teacher=teacher) for i, teacher in
             enumerate((None, Teacher.ready(DEFAULT, file=tmp_path / "hints.toml")))]
    for game in games:
        press(game, "W")
        wait(game, 3.0)
        game.close()
    one, other = (read(tmp_path / f"{i}.gambol") for i in range(2))
    assert one.ticks == other.ticks
    last = [list(replay(log, Glide()))[-1].after.characters[0].state.ground for log in (one, other)]
    assert np.array_equal(*last)


def test_the_course_is_said_to_be_where_it_is_seen():
    moment = Play(Glide()).moment
    seen = [whither(replace(moment, players=(replace(moment.players[0], camera=replace(moment.players[0].camera, yaw=np.radians(yaw))),)))
            for yaw in (0, 33, 120, 214, 290)]
    assert seen == ["ahead, to your left", "ahead", "to your right", "behind you", "to your left"]
    assert "course" not in doing(moment)
    assert "course" in doing(replace(moment, after=replace(moment.after, props=()))), "there is none"
    body = moment.after.characters[0]
    there = replace(body, state=replace(body.state, ground=np.array([3.4, 5.0, 0.0])))
    assert "course" in doing(replace(moment, after=replace(moment.after, characters=(there,))))


def test_a_hint_fits_every_picture_and_fades():
    from gambol.game.render.hint_pass import layout

    longest = max((worded(name, DEFAULT, False, "ahead, to your right") for name in ORDER), key=lambda words: len(str(words)))
    for size in ((1280, 720), (640, 360), (320, 180), (360, 640), (3840, 2160)):
        rows, letters = layout(Hint(longest, 0.5), size)
        assert letters >= 11 and rows[:, 11].max() <= 0.5
        assert rows[0, 0] >= 0 and rows[0, 0] + rows[0, 2] <= size[0] and rows[0, 1] + rows[0, 3] <= size[1]
    assert Scene.hint is None


def test_a_hint_keeps_to_the_room_that_panels_leave():
    from gambol.game.render.hint_pass import layout

    for name in ORDER:
        for size, room in (((1280, 720), (0.3, 0.66)), ((1280, 720), (0.0, 0.5)), ((640, 360), (0.42, 0.8)), ((320, 240), (0.6, 1.0))):
            rows, letters = layout(Hint(worded(name, DEFAULT, False, "ahead, to your right"), room=room), size)
            assert letters >= 11 and len(rows)
            assert rows[0, 0] >= room[0] * size[0] and rows[0, 0] + rows[0, 2] <= room[1] * size[0] and rows[0, 1] + rows[0, 3] <= size[1]
            assert (rows[1:, 0] >= rows[0, 0] - 4).all() and (rows[1:, :2] + 0.5 * rows[1:, 2:4] <= rows[0, :2] + rows[0, 2:4]).all()
        assert not len(layout(Hint(worded(name, DEFAULT, False), room=(0.5, 0.52)), (640, 360))[0]), "none rather than half of one"
