"""A game without a window, and hands on its keys and pads."""

import pytest

from gambol.game.app.app import Play
from gambol.game.hosts.events import KeyEvent, PadState
from stand_in import Glide

FRAME = 1 / 60


@pytest.fixture
def game():
    return Play(Glide())


def press(game, *keys):
    for key in keys:
        game.handle(KeyEvent(key, True))


def release(game, *keys):
    for key in keys:
        game.handle(KeyEvent(key, False))


def tap(game, *keys):
    """Press and let go; a tick apart, as hands do."""
    for key in keys:
        press(game, key)
        release(game, key)
        game.tick(FRAME)


def wait(game, seconds, frame=FRAME):
    for _ in range(round(seconds / frame)):
        game.tick(frame)


def at(game, who=0):
    return game.moment.after.characters[who].state.ground


def wanted(game, who=0):
    return game.moment.after.characters[who].intent.velocity


def camera(game, who=0):
    return game.moment.players[who].camera


def text(game):
    view = game.scene((10, 10))
    return "\n".join((view[0] if isinstance(view, tuple) else view).text)


def pad(left=(0.0, 0.0), right=(0.0, 0.0), triggers=(-1.0, -1.0), *buttons, slot=0):
    return PadState("Pad", (*left, *right, *triggers), frozenset(buttons), slot)


def walked(game, seconds=3.0):
    press(game, "W")
    wait(game, seconds)
    release(game, "W")
    return game
