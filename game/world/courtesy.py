"""Characters who avoid each other: what is asked of them, changed as little as keeps them out of each other's way."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from gambol.controllers.contract import Intent, but
from gambol.controllers.navigation import Going, in_world
from gambol.controllers.navigation.crowd import Manners, avoid, doors_of, queued, stepping, taking_turns, together
from gambol.controllers.navigation.levels import levels_of

from ..input import STEERING, jumping
from ..scene import Prop
from .collisions import lying
from .world import DT, Character, World

RADIUS = 0.22
"""A body's [m]."""
HALF_WAY = 0.5
"""Who gives way by this share or more stops at no place of his own."""
GIVEN_WAY = 0.2
"""Who is led off what he was asked by more than this [m/s] turns to where he is led."""
LOOKS = 1.5
"""So far ahead [s] people see a door that they go to."""
LEDGE = 0.21
"""Whose ground lies no higher than this over his floor stands on it [m]."""
FREE, BEHIND = 0.7, 0.6
"""Nobody leaps where another is so near to his way [m], up to so far behind where he lands [m]."""
MANNERS = Manners()


def avoiding(world: World, intents: Sequence[Intent], ways: Sequence[np.ndarray | None], groups: Sequence[int]) -> tuple[World, list[Intent]]:
    """The world, whose turn it is at its doors noted, and the intents, one for each character, with which those who walk avoid each other and what stands about; untouched where nobody is in the way.

    ways: (2,) [m/s] along x and z, where each would go in the world, if he were turned to it; None where his intent says all.
    groups: who walks with whom, as `together` takes it. At doors they queue, and both sides take turns.

    Who goes to a goal follows his plan and leaves it as far as others make him, and leaps only where nobody is. Who jumps is avoided, and avoids nobody;
    who follows points or is not there does neither.
    """
    found = list(intents)
    who = [i for i, one in enumerate(world.characters) if one.there(world.number) and one.follows is None]
    if len(who) < 2:
        return world, found
    jumps = [intents[i].leap is not None or jumping(world.characters[i].state) is not None for i in who]
    ground = np.array([world.characters[i].state.ground for i in who], float)
    velocity = np.array([world.characters[i].state.velocity for i in who], float)
    asked = np.array([np.zeros(3) if leaps else _wished(world.characters[i], found[i]) for i, leaps in zip(who, jumps)], float)
    wishes = in_world(ground, asked)
    for k, i in enumerate(who):
        wishes[k] = wishes[k] if ways[i] is None or jumps[k] else ways[i]
    aims = np.array([_ahead(world.characters[i], found[i], place + LOOKS * w) for i, place, w in zip(who, ground[:, :2], wishes)])
    alone, moving = wishes, in_world(ground, velocity)
    wishes = together(ground[:, :2], wishes, [groups[i] for i in who])
    doors = doors_of(world.props)
    if doors:
        world = but(world, turns=taking_turns(ground[:, :2], wishes, aims, doors, moving, world.turns, DT))
        wishes = queued(ground[:, :2], wishes, aims, doors, moving, world.turns)
    regions = _regions(world, ground[:, :2], np.array([float(world.characters[i].state.floor) for i in who]))
    chosen, down = np.empty_like(wishes), lying([world.characters[i] for i in who], world.number)
    for region in np.unique(regions):  # what is a wall to one is a floor to another
        some = regions == region
        chosen[some] = avoid(ground[:, :2], moving, wishes, RADIUS, (*_walls(world.props, int(region)), *down), ground[:, 2], MANNERS)[some]
    led = stepping(ground, velocity, chosen, STEERING, MANNERS)
    share = np.minimum(np.linalg.norm(chosen - alone, axis=1, keepdims=True) / GIVEN_WAY, 1.0)
    for k, (i, own, change, part) in enumerate(zip(who, asked, share * (led - asked), share[:, 0])):
        way = _way(world.characters[i], found[i])
        if way is not None and way.crossings and _taken(way, ground[:, :2], k):
            found[i] = but(found[i], held=True)
        if part > 1e-6 and not jumps[k]:
            halt = found[i].halt if part < HALF_WAY else None  # who has to give way does not stop where he wished to
            found[i] = but(found[i], velocity=own + change, halt=halt) if found[i].goal is None else but(found[i], aside=change)
    return world, found


def _regions(world: World, places: np.ndarray, floors: np.ndarray) -> np.ndarray:
    """The regions of levels (N,) on which people stand at places (N, 2), so high (N,) [m]."""
    levels = levels_of(world.props)
    return levels.regions[levels.ground(places, floors + LEDGE)[0]]


@lru_cache(maxsize=32)
def _walls(props: tuple[Prop, ...], region: int) -> Sequence[Any]:
    """What stops somebody who walks in a region: of a level floor all that stands on it, else the ends of the ground, too."""
    levels = levels_of(props)
    level = levels.regions[levels.floor] == region and np.count_nonzero(levels.regions == region) == 1 and not levels.slopes.any()
    return props if level else levels.stops(region)


def _taken(way: Going, places: np.ndarray, who: int) -> bool:
    """Whether another of the people at places (N, 2) is where the next leap of one of them leads, or on the way there."""
    off, to = way.crossings[0].ground[:2], way.crossings[0].place[[0, 2]]
    along = (to - off) / max(float(np.linalg.norm(to - off)), 1e-9)
    far = np.clip((places - to) @ along, -float(np.linalg.norm(to - off)), BEHIND)
    gaps = np.linalg.norm(places - to - far[:, None] * along, axis=1)
    gaps[who] = np.inf
    return bool(gaps.min() < FREE)


def _wished(one: Character, intent: Intent) -> np.ndarray:
    """The velocity (3,) v_f, ω, v_l that somebody asks for, or that his plan does."""
    way = _way(one, intent)
    if intent.goal is None:
        return np.asarray(intent.velocity, float)
    return np.zeros(3) if way is None else way.wished(one.state.ground, one.state.velocity)


def _ahead(one: Character, intent: Intent, straight: np.ndarray) -> np.ndarray:
    """Where (2,) somebody will be a moment later: on his plan if he has one."""
    way = _way(one, intent)
    return straight if way is None or way.plan.reason else way.plan.at(way.time + LOOKS)[0][:2]


def _way(one: Character, intent: Intent) -> Going | None:
    """How far he is on the way to the goal that he is asked to go to."""
    way = one.state.going
    return way if way is not None and way.goal == intent.goal else None
