"""Characters who avoid each other: what is asked of them, changed as little as keeps them out of each other's way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from gambol.controllers.contract import Intent
from gambol.controllers.navigation import Going, in_world
from gambol.controllers.navigation.crowd import Manners, avoid, doors_of, queued, stepping, together

from ..input import STEERING, jumping
from .world import Character, World

RADIUS = 0.22
"""A body's [m]."""
GIVEN_WAY = 0.2
"""Who is led off what he was asked by more than this [m/s] turns to where he is led."""
LOOKS = 1.5
"""So far ahead [s] people see a door that they go to."""
MANNERS = Manners()


def avoiding(world: World, intents: Sequence[Intent], ways: Sequence[np.ndarray | None], groups: Sequence[int]) -> list[Intent]:
    """The intents, one for each character, with which those who walk avoid each other and what stands about; untouched where nobody is in the way.

    ways: (2,) [m/s] along x and z, where each would go in the world, if he were turned to it; None where his intent says all.
    groups: who walks with whom, as `together` takes it. At doors they queue.

    Who goes to a goal follows his plan and leaves it as far as others make him. Who jumps, follows points or is not there neither avoids nor is avoided.
    """
    found = list(intents)
    who = [i for i, (one, intent) in enumerate(zip(world.characters, intents))
           if one.there(world.number) and one.follows is None and intent.leap is None and jumping(one.state) is None]
    if len(who) < 2:
        return found
    ground = np.array([world.characters[i].state.ground for i in who], float)
    velocity = np.array([world.characters[i].state.velocity for i in who], float)
    asked = np.array([_wished(world.characters[i], found[i]) for i in who], float)
    wishes = in_world(ground, asked)
    for k, i in enumerate(who):
        wishes[k] = wishes[k] if ways[i] is None else ways[i]
    aims = np.array([_ahead(world.characters[i], found[i], place + LOOKS * w) for i, place, w in zip(who, ground[:, :2], wishes)])
    alone, moving = wishes, in_world(ground, velocity)
    wishes = together(ground[:, :2], wishes, [groups[i] for i in who])
    wishes = queued(ground[:, :2], wishes, aims, doors_of(world.props), moving)
    chosen = avoid(ground[:, :2], moving, wishes, RADIUS, world.props, ground[:, 2], MANNERS)
    led = stepping(ground, velocity, chosen, STEERING, MANNERS)
    share = np.minimum(np.linalg.norm(chosen - alone, axis=1, keepdims=True) / GIVEN_WAY, 1.0)
    for i, own, change, part in zip(who, asked, share * (led - asked), share[:, 0]):
        if part > 1e-6:
            found[i] = replace(found[i], velocity=own + change) if found[i].goal is None else replace(found[i], aside=change)
    return found


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
