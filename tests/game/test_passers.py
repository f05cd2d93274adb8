"""Passers-by walk about a player, past each other and him; they are in the log, and played again to the bit."""

import numpy as np
import pytest

from gambol.controllers.locomotion import Locomotion
from gambol.controllers.supervisor import Supervisor
from gambol.game.app.app import Play
from gambol.game.app.views import scenes
from gambol.game.input import Wish
from gambol.game.scene import Overlays
from gambol.game.session import Timeline, opening, tick
from gambol.game.session.input_log import LogWriter, read
from gambol.game.session.replay import replay
from gambol.game.session.settings import SettingError
from hands import press, wait


@pytest.fixture(scope="module")
def walker():
    return Supervisor({"locomotion": Locomotion.load()})


def pressed(*actions):
    return [Wish(pressed=actions)]


def test_they_walk_and_nobody_runs_into_anybody(walker):
    line, places = Timeline(opening(walker)), []
    line.advance(pressed("crowd=9"))
    for _ in range(60 * 4):
        line.advance([Wish()])
        places.append([one.state.ground[:2] for one in line.now.after.characters])
    places = np.array(places)
    assert places.shape[1] == 10 and np.ptp(places[:, 1:], axis=0).max(-1).min() > 0.5, "all of them get somewhere"
    apart = np.linalg.norm(places[:, :, None] - places[:, None], axis=-1) + 9.0 * np.eye(10)
    assert apart.min() > 0.44, "bodies of 0.22 m"
    assert np.ptp(places[:, 0], axis=0).max() < 1e-6, "the player stands where he stood"


def test_with_many_people_one_goes_back_less_far(walker, monkeypatch):
    monkeypatch.setattr(tick, "KEPT", 20)
    line = Timeline(opening(walker))
    line.advance(pressed("crowd=15"))
    for _ in range(20):
        line.advance([Wish()])
    assert len(line.past) == 10, "half as far with twice as many as are kept for all of it"


def test_they_come_and_go_and_begin_again(walker):
    line = Timeline(opening(walker))
    line.advance(pressed("crowd=3"))
    begun = [one.state.ground.copy() for one in line.now.after.characters]
    for _ in range(60):
        line.advance([Wish()])
    line.advance(pressed("join"))
    assert [one.name for one in line.now.after.characters] == ["Player 1", "Player 2", "Passer 1", "Passer 2", "Passer 3"]
    line.advance([Wish(pressed=("reset",)), Wish()])
    assert np.allclose(line.now.after.characters[2].state.ground, begun[1], atol=1e-3) and line.now.passers[0].index == 0
    line.advance([Wish(pressed=("crowd=0",)), Wish()])
    assert len(line.now.after.characters) == 2 and not line.now.passers


@pytest.mark.parametrize("wrong", ["crowd=", "crowd=-1", "crowd=51", "crowd=2.5", "crowd=many"])
def test_what_is_no_number_of_people_is_refused(walker, wrong):
    with pytest.raises(SettingError, match="0 to 50"):
        Timeline(opening(walker)).advance(pressed(wrong))


def test_a_log_has_them(walker, tmp_path):
    game = Play(walker, log=LogWriter(tmp_path / "played.gambol", walker, 1))
    game.do("crowd=4")
    press(game, "W")
    wait(game, 1.0)
    game.close()
    *_, last = replay(read(tmp_path / "played.gambol"), walker)
    assert len(last.after.characters) == 5
    for one, other in zip(last.after.characters, game.now.after.characters):
        assert one.state.pose.root.tobytes() == other.state.pose.root.tobytes()


def test_nobody_wears_what_players_wear(walker):
    line = Timeline(opening(walker, 2))
    line.advance([Wish(pressed=("crowd=12",)), Wish()])
    players, passers = line.now.after.characters[:2], line.now.after.characters[2:]
    assert min(np.abs(np.subtract(one.tint, other.tint)).max() for one in players for other in passers) > 0.12


def test_only_who_is_played_shows_his_plan(walker):
    """Passers-by have plans, too, which would cover the floor."""
    line = Timeline(opening(walker))
    line.advance([Wish(pressed=("crowd=2", "goto=-2/3"))])
    for _ in range(30):
        line.advance([Wish()])
    assert all(one.state.going is not None for one in line.now.after.characters)
    scene, = scenes(line.now, 1.0, [line.now.players[0].view(1.0)], Overlays(path=True))
    drawn = [any(sketch.layer == "path" for sketch in figure.sketches) for figure in scene.figures]
    assert drawn == [True, False, False]
