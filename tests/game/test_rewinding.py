"""Looking back while playing: rewinding, scrubbing, playing on from the past."""

import numpy as np
import pytest

from gambol.game.hosts.events import MouseMove
from gambol.game.session import tick
from gambol.game.world import RATE
from hands import FRAME, at, camera, game, press, release, tap, text, wait, walked  # noqa: F401, the fixture


def test_rewinding_runs_back_in_real_time_and_stops_where_the_key_is_let_go(game):
    walked(game)
    number, where = game.now.after.number, []
    press(game, "BACKSPACE")
    for _ in range(60):
        game.tick(FRAME)
        where.append(game.scene((10, 10)).figures[0].positions[0, 2])
    release(game, "BACKSPACE")
    assert game.moment.after.number == number - 60
    assert np.all(np.diff(where) <= 0) and np.diff(where).min() > -0.05, "no jump on the way"
    wait(game, 1.0)
    assert game.moment.after.number == number - 60 and game.now.after.number == number
    assert game.past.shown[-1] is game.moment and len(game.past.shown) == number - 60 + 1
    assert "1.0 s ago" in text(game)


def test_scrubbing_goes_step_by_step_and_then_by_itself(game):
    walked(game)
    number = game.now.after.number
    tap(game, "BACKSPACE")  # let go before a tick has seen it: as one does who draws few frames
    game.tick(FRAME)
    assert game.past.look is not None and number - 1 <= game.moment.after.number <= number + 1
    press(game, "LEFT")
    wait(game, 0.5)
    release(game, "LEFT")
    for key, step in (("LEFT", -1), ("RIGHT", 1), ("RIGHT", 1)):
        before = game.moment.after.number
        press(game, key)
        game.tick(FRAME)
        release(game, key)
        game.tick(FRAME)
        assert game.moment.after.number == before + step
    before = game.moment.after.number
    press(game, "LEFT")
    wait(game, 1.0)
    assert before - 50 < game.moment.after.number < before - 30
    wait(game, 10.0)
    assert game.moment.after.number == 0 and "3.0 s ago, of 3 s" in text(game)


def test_playing_on_from_the_past_branches_there(game):
    walked(game)
    press(game, "BACKSPACE")
    wait(game, 1.0)
    release(game, "BACKSPACE")
    then, number = at(game).copy(), game.moment.after.number
    tap(game, "ENTER")
    assert game.past.look is None and game.now.after.number == number + 1 and np.linalg.norm(at(game) - then) < 0.05
    press(game, "BACKSPACE")
    wait(game, 0.5)
    release(game, "BACKSPACE")
    wait(game, 0.1)
    number = game.moment.after.number
    tap(game, "P")
    assert game.now.paused and game.now.after.number in (number, number + 1)


def test_a_push_plays_on_but_only_one_made_since(game):
    walked(game)
    press(game, "BACKSPACE", "W")
    wait(game, 1.0)
    release(game, "BACKSPACE")
    wait(game, 0.5)
    assert game.past.look is not None, "W was down all along"
    release(game, "W")
    wait(game, 0.1)
    number = game.moment.after.number
    press(game, "D")
    wait(game, 0.1)
    assert game.past.look is None and number < game.now.after.number <= number + 6


def test_a_past_moment_is_looked_at_from_anywhere_and_nothing_of_it_is_kept(game):
    walked(game)
    press(game, "BACKSPACE")
    wait(game, 0.5)
    release(game, "BACKSPACE")
    press(game, "LEFT_BUTTON")
    before = game.scene((10, 10)).camera.eye
    game.handle(MouseMove(0.5, 0.5, 0.2, 0.0))
    wait(game, 0.5)
    assert np.linalg.norm(game.scene((10, 10)).camera.eye - before) > 1.0
    assert camera(game).yaw == pytest.approx(0.0, abs=0.01)
    game.do("pace.walk=0.9")
    assert "this is the past" in text(game)


def test_half_a_minute_is_kept_and_nobody_goes_back_farther_than_is_kept(game, monkeypatch):
    assert tick.KEPT == 30 * RATE
    monkeypatch.setattr(tick, "KEPT", 150)
    wait(game, 150 * FRAME + 1)
    press(game, "BACKSPACE")
    wait(game, 150 * FRAME + 1)
    assert game.moment.number == game.now.number - 150
