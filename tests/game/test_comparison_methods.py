"""What bodies from points are made by gets ready beside the game: compiled or learnt, told of, waited for, taken back."""

from types import SimpleNamespace

import pytest

from gambol.game.app.app import Play
from gambol.game.world import learnt_methods as learning
from steady import no_database, walker  # noqa: F401, fixtures
from studies import game, ticks


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


def test_what_can_not_be_learnt_is_told_in_one_line(tmp_path):
    wrong = tmp_path / "wrong.gambolmotion"
    wrong.write_bytes(b"nothing")
    other = learning.Learning([("ours", "4")], wrong)
    other.wait()
    assert other.done and other.fault == f"{wrong}: is no motion database; `gambol database build` makes one"
