"""Passers-by: people who walk from place to place about a player, past each other and him."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from gambol.controllers.contract import Goal, Intent
from gambol.controllers.navigation.routes import distance, shapes_of

from ..input import Move, Script
from ..scene import Prop
from ..world import DT, Character, World, avoiding, walker_of
from .settings import SettingError
from .state import SessionState

MOST = 50
"""So many at most."""
LOW, HIGH = (-11.0, -7.0), (1.8, 13.0)
"""Where they walk: x, z [m], beside the course."""
APART, CLEAR = 1.2, 0.6
"""So far from each other they begin, and from what stands about all their places are [m]."""
PLACES = 40
"""After so many places they begin again with the first."""
RESTS = 0.0, 2.5
"""For so long they stand at each [s]."""
TINTS = ((0.50, 0.46, 0.42), (0.35, 0.58, 0.38), (0.42, 0.50, 0.54), (0.55, 0.40, 0.60), (0.62, 0.58, 0.36))
"""Of clothes that no player wears."""


def peopled(moment: SessionState, action: str) -> SessionState:
    """The moment with as many passers-by as "crowd=N" says, fresh ones. SettingError for what is no number of people."""
    text = action.partition("=")[2]
    if not (text.isascii() and text.isdecimal() and len(text) < 4 and int(text) <= MOST):
        raise SettingError(f"{action}: needs a whole number of people, 0 to {MOST}")
    first, count = len(moment.players), len(moment.passers)
    rng, people = np.random.default_rng(1), [one.state.ground[:2] for one in moment.after.characters[:first]]
    controller, props = walker_of(moment.after.characters[0].controller), moment.after.props
    fresh, scripts = [], []
    for number in range(int(text)):
        place = _free(rng, props, people)
        people.append(place)
        state = controller.start((*place, rng.uniform(-math.pi, math.pi)))
        fresh.append(Character(f"Passer {number + 1}", controller, state, TINTS[number % len(TINTS)]))
        scripts.append(Script(tuple(move for _ in range(PLACES) for move in (
            Move(math.inf, goal=Goal(tuple(_free(rng, props, ())))), Move(rng.uniform(*RESTS))))))

    def among(world: World) -> World:
        return replace(world, characters=(*world.characters[:first], *fresh, *world.characters[first + count:]))
    return replace(moment, before=among(moment.before), after=among(moment.after), opening=among(moment.opening), passers=tuple(scripts))


def asked(moment: SessionState) -> tuple[tuple[Script, ...], list[Intent]]:
    """The passers-by's scripts a step later, and what they ask for."""
    first = len(moment.players)
    steps = [(replace(script, index=0) if script.done else script).step(one.state, DT)
             for script, one in zip(moment.passers, moment.after.characters[first:])]
    return tuple(script for script, _ in steps), [intent for _, intent in steps]


def polite(moment: SessionState, intents: Sequence[Intent]) -> tuple[World, list[Intent]]:
    """The world after, as of `avoiding`, and the intents with which passers-by avoid each other and the players; of players those only avoid others who are sent somewhere."""
    if not moment.passers:
        return moment.after, list(intents)
    world, led = avoiding(moment.after, intents, [None] * len(intents), [-1] * len(intents))
    return world, [own if who < len(moment.players) and own.goal is None else other for who, (own, other) in enumerate(zip(intents, led))]


def _free(rng: Any, props: Sequence[Prop], people: Sequence[np.ndarray]) -> np.ndarray:
    """A place (2,) where nothing stands, and nobody near."""
    shapes, out = shapes_of(props), np.empty(3)
    while True:
        place = rng.uniform(LOW, HIGH).round(2)
        if all(distance(place[0], place[1], shape, out) > CLEAR for shape in shapes) and all(math.dist(place, other) > APART for other in people):
            return place
