"""Wishes played into a log."""

import numpy as np

from gambol.game.input import Wish
from gambol.game.session.input_log import LogWriter
from gambol.game.session.state import opening
from gambol.game.session.tick import Timeline
from stand_in import Glide

GLIDE = Glide()


def play(path, ticks, controller=GLIDE, players=1, every=45, clip=None):
    """Play wishes into a log; the moments after each tick."""
    timeline, writer, moments = Timeline(opening(controller, players)), LogWriter(path, controller, players, clip), []
    for number, wishes in enumerate(ticks, 1):
        wishes = tuple(wish.rounded() for wish in wishes[:len(timeline.now.players)])
        timeline.advance(wishes)
        writer.add(wishes)
        moments.append(timeline.now)
        if number % every == 0:
            writer.flush(timeline.now)
    writer.flush(timeline.now)
    writer.close()
    return moments


def walk(count, seed=0):
    rng = np.random.default_rng(seed)
    return [(Wish(move=tuple(rng.uniform(-1, 1, 2)), drag=tuple(rng.normal(size=2))),) for _ in range(count)]
