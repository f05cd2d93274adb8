"""The theatre around the real controller: the same to the bit, and on its way where it was sent."""

import itertools

import numpy as np
import pytest

from gambol.controllers.locomotion import Locomotion
from gambol.controllers.reconstruction.database import store
from gambol.controllers.reconstruction.ours import combined
from gambol.controllers.reconstruction.ours.networks import learn
from gambol.game.app.app import Play
from gambol.game.hosts.events import KeyEvent
from gambol.game.scenario.film import run
from gambol.game.scenario.scenario import load, shipped
from gambol.game.session.fingerprint import fingerprint
from gambol.game.session.input_log import LogWriter, read
from gambol.game.session.replay import of_library, replay
from gambol.game.world.learnt_methods import methods


@pytest.fixture(scope="module")
def locomotion():
    return Locomotion.load()


@pytest.fixture(scope="module")
def hasty(tmp_path_factory):
    """Networks learn for a moment only, and lie apart from those that serve."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(combined, "learn", lambda samples, progress, **_: learn(samples, 1, 300, (64,), progress))
        patch.setattr(store, "cache_folder", lambda: tmp_path_factory.getbasetemp() / "hasty" / "kernels")
        methods.cache_clear()
        yield
        methods.cache_clear()


def same(a, b):
    return all(np.array_equal(x.state.ground, y.state.ground) and np.array_equal(x.state.pose.root, y.state.pose.root)
               and np.array_equal(x.state.pose.rotations, y.state.pose.rotations)
               for x, y in zip(a.characters, b.characters, strict=True))


@pytest.mark.parametrize("name", shipped())
def test_a_scenario_is_the_same_to_the_bit(name, locomotion, hasty):
    """A minute of the medley, and the beginnings of the others: the checks cost more than the steps."""
    scenario = load(name)
    seconds = scenario.duration if name == "medley" else 1.5 if scenario.followers or len(scenario.actors) > 20 else 5.0
    pairs = zip(run(scenario, locomotion), run(scenario, Locomotion.load()))
    for a, b in itertools.islice(pairs, 0, round(seconds * scenario.fps), 30):
        assert same(a.before, b.before)
    assert same(a.after, b.after)


def test_the_two_in_the_corridor_meet_and_pass(locomotion):
    a, b = [], []
    for frame in run(load("corridor"), locomotion):
        one, two = (character.state.ground for character in frame.before.characters)
        a.append(one[:2])
        b.append(two[:2])
    a, b = np.array(a), np.array(b)
    assert np.linalg.norm(a - b, axis=1).min() > 0.8, "nobody is walked through"
    assert a[-1, 1] > 10 and b[-1, 1] < 0, "both get where they were going"
    met = np.argmax(a[:, 1] > b[:, 1])
    assert a[met, 0] < -0.3 < 0.3 < b[met, 0], "A has stepped aside"
    assert np.abs(np.diff(b, axis=0)[met - 30:met]).max() * 60 < 0.1, "B waits while A passes"
    assert np.all(np.abs(a[:, 0]) < 1.1)


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
