"""Being pushed in the game: the key, the log, the scenario."""

import numpy as np
import pytest

from gambol.controllers.person import person
from gambol.game.input import DEFAULT, Wish
from gambol.game.scenario import ScenarioError, load
from gambol.game.session import Timeline, opening
from gambol.game.session.fingerprint import fingerprint


@pytest.fixture(scope="module")
def somebody():
    return person()


def test_a_push_goes_away_from_the_camera_and_plays_again_to_the_bit(somebody):
    assert DEFAULT.row("push").keys == ("M",)
    prints, far = [], []
    for _ in range(2):
        timeline = Timeline(opening(somebody))
        for n in range(120):
            timeline.advance((Wish(pressed=("push",) if n == 20 else ()),))
            if n == 60:
                assert timeline.now.after.characters[0].state.active == "struck"
        prints.append(fingerprint(timeline.now))
        far.append(timeline.now.after.characters[0].state.ground)
    assert prints[0] == prints[1]
    assert far[0][1] > 0.2 and abs(far[0][0]) < 0.5 * far[0][1]  # the camera is behind


def test_a_scenario_says_what_strikes(tmp_path):
    good = '[[actors]]\nname = "A"\nstrikes = [{ at = 1, impulse = 40, towards = 90 }]\n'
    file = tmp_path / "one.toml"
    file.write_text('title = "one"\nduration = 2\n' + good, "utf-8")
    (number, strike), = load(file).actors[0].script().strikes
    assert number == 60 and np.allclose(strike.impulse, (40.0, 0.0))
    file.write_text('title = "one"\nduration = 2\n' + good.replace("impulse = 40", "impulse = -40"), "utf-8")
    with pytest.raises(ScenarioError, match="impulse"):
        load(file)
