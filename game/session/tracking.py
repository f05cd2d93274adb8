"""Somebody whom cameras track, beside the first player: "track" brings them and takes them away, "penalty" switches theirs on jitter."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ..world import RATE, Character, Filmed, World, beginning, lately, switched, tracked_of, watches_of
from .comparison import ASIDE
from .state import SessionState

NAME, COLOUR = "Tracked", (0.16, 0.30, 0.62)
"""What the tracked one is called, and its colour, linear RGB."""
SPOILT = {"wrong": 0.15, "rectangles": 3}
"""What goes wrong in the silhouettes that cameras see."""
GONE = 0.3
"""Whose joints are farther off than this on average [m] is lost."""


def tracked(moment: SessionState) -> SessionState:
    """The moment with somebody tracked on the first player's left, or with nobody tracked any more."""
    def without(world: World) -> World:
        return replace(world, characters=tuple(one for one in world.characters if one.watches is None))
    if any(one.watches is not None for one in moment.after.characters):
        return replace(moment, before=without(moment.before), after=without(moment.after))
    performer, count = moment.after.characters[0], len(moment.players) + len(moment.passers)
    heading = float(performer.state.ground[2])
    beside = np.array([ASIDE * math.cos(heading), 0.0, -ASIDE * math.sin(heading)])
    watches = watches_of(performer.name, performer.controller.skeleton, beside=beside, **SPOILT)
    someone = tracked_of(performer.controller, watches, RATE)
    new = Character(NAME, someone, beginning(someone, performer.state, beside), COLOUR, watches=watches)

    def among(world: World) -> World:
        return replace(world, characters=(*world.characters[:count], new, *world.characters[count:]))
    return replace(moment, before=among(moment.before), after=among(moment.after))


def otherwise(moment: SessionState) -> SessionState:
    """The moment with every tracker's penalty on jitter off, or on again; whoever is lost begins anew."""
    performer, made = moment.after.characters[0], []
    for one in moment.after.characters:
        if isinstance(one.controller, Filmed):
            one = replace(one, controller=one.controller.switched())
        if one.watches is not None:
            one = replace(one, controller=switched(one.controller))
            now = lately(one.told)
            if one.watches is not None and now is not None and now.mean > GONE:
                one = replace(one, state=beginning(one.controller, performer.state, one.watches.beside), told=one.told[:0])
        made.append(one)
    return replace(moment, after=replace(moment.after, characters=tuple(made)))


def unpenalised(world: World) -> bool:
    """Whether somebody is tracked without the penalty on jitter."""
    trackings = [one.controller.tracker if isinstance(one.controller, Filmed) else one.controller.parts["tracking"]
                 for one in world.characters if isinstance(one.controller, Filmed) or one.watches is not None]
    return any(not one.settings.penalty for one in trackings)
