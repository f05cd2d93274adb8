"""The theatre around the real controller: the same to the bit, and on its way where it was sent."""

import numpy as np
import pytest

from gambol.controllers.locomotion import Locomotion
from gambol.game.app.app import Play
from gambol.game.hosts.events import KeyEvent
from gambol.game.session.fingerprint import fingerprint
from gambol.game.session.input_log import LogWriter, read
from gambol.game.session.replay import of_library, replay
from stand_in import same


@pytest.fixture(scope="module")
def locomotion():
    return Locomotion.load()


def test_a_game_replays_to_the_bit_from_its_log(locomotion, tmp_path):
    path = tmp_path / "a.gambol"
    game = Play(locomotion, log=LogWriter(path, locomotion, 1))
    for key, frames in (("W", 50), ("A", 40), ("BACKSPACE", 30), ("LEFT_SHIFT", 60), ("TAB", 30)):
        game.handle(KeyEvent(key, True))
        game.do("locomotion.acceleration=3")
        for _ in range(frames):
            game.tick(1 / 60)
        if key == "BACKSPACE":
            game.handle(KeyEvent(key, False))
            game.do("resume")
    game.close()
    *_, last = replay(of_library(read(path), locomotion), locomotion)
    assert game.now.after.characters[0].state.ground[1] > 1.0 and game.now.setting("locomotion.acceleration") == 3
    assert same(last.after, game.now.after) and fingerprint(last) == fingerprint(game.now)
    a, b = (moment.after.characters[0].state.memory for moment in (last, game.now))
    assert all(np.array_equal(a[name], b[name]) for name in a.dtype.names)
