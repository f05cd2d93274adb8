"""Poses are asked for in the window: what is waited for is seen, then the game begins; whoever leaves ends it."""

import sys
import time
from pathlib import Path

import numpy as np
import pytest
from stand_in import Glide

sys.path.insert(0, str(Path(__file__).parents[1] / "reconstruction"))

from gambol.controllers.reconstruction.calibration import POSES  # noqa: E402
from gambol.controllers.reconstruction.live import placed  # noqa: E402
from gambol.game.app.app import Play  # noqa: E402
from gambol.game.app.asking import Asked, Asking, stood  # noqa: E402
from gambol.game.cli import set_poses  # noqa: E402
from gambol.game.hosts import KeyEvent  # noqa: E402
from test_set_poses import Wearing  # noqa: E402


def ended(asking):
    """Once what is asked is over; ten seconds are far more than that takes."""
    until = time.monotonic() + 10.0
    while asking._thread.is_alive() and time.monotonic() < until:
        time.sleep(0.001)


def test_what_is_asked_is_shown_and_then_the_game_begins():
    shown, pose = [], list(POSES.values())[2]

    def ask(tell, say):
        say("nobody was heard")
        shown.append(asking.scene((640, 360)))
        tell(Asked("2 of 8: arms out in front", pose, 7.4, np.array([[0.0, 1.5, 0.4], [np.nan] * 3]), "1.70 m tall"))
        shown.append(asking.scene((640, 360)))
    asking = Asking(ask, lambda: Play(Glide()))
    asking.tick(0.0)
    ended(asking)
    assert shown[0].text == ("nobody was heard",) and shown[0].hint is None
    assert shown[1].hint.parts == (("2 of 8: arms out in front   7 s", False),) and shown[1].text == ("1.70 m tall",)
    ghost = shown[1].figures[0]
    assert np.allclose(ghost.positions, stood(pose)[0]) and ghost.opacity < 1.0
    assert [dot.place.tolist() for dot in ghost.sketches] == [[0.0, 1.5, 0.4]] and shown[1].overlays.points
    asking.tick(0.0)
    assert asking.game is not None and not asking.done
    asking.close()


def test_whoever_leaves_is_asked_no_more():
    told = []

    def ask(tell, say):
        while True:
            tell(Asked("stand upright"))
            told.append(1)
            time.sleep(0.001)
    asking = Asking(ask, lambda: pytest.fail("no game"))
    asking.tick(0.0)
    asking.handle(KeyEvent("ESCAPE", True))
    ended(asking)
    assert asking.done
    asking.tick(0.0)
    asking.close()
    assert asking.fault is None and not asking._thread.is_alive()


def test_what_goes_wrong_while_asking_is_told_by_the_window():
    def ask(tell, say):
        raise ValueError("no such trackers")
    asking = Asking(ask, lambda: pytest.fail("no game"))
    asking.tick(0.0)
    ended(asking)
    with pytest.raises(ValueError, match="no such trackers"):
        asking.tick(0.0)


@pytest.mark.parametrize("number", range(len(POSES)))
def test_a_ghost_stands_with_its_feet_where_they_are_asked(number):
    """On the average of both, on the floor."""
    upright, asked = (stood(list(POSES.values())[k])[0] for k in (0, number))
    feet = [k for k in range(len(upright)) if upright[k, 1] < 0.12]
    assert np.allclose(upright[feet].mean(0), asked[feet].mean(0), atol=0.06)


def test_poses_tell_the_window_what_is_asked_and_what_is_known_so_far():
    said, told = [], []
    source = Wearing(list(range(8)), said)
    place, turn = source.places[0], source.turned[0]
    set_poses.worn(source, placed(place, source.controls, turns=turn), place, turn, (k / 30 for k in range(9000)), told.append, said.append)
    words = list(dict.fromkeys(one.words for one in told))
    assert [word[:6] for word in words] == [f"{k} of 8" for k in range(2, 9)]
    assert all(0.0 <= one.left <= set_poses.MOST for one in told) and np.isfinite(told[0].points).all()
    assert not told[0].known and "m tall" in told[-1].known and "±" in told[-1].known
