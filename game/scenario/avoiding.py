"""Actors who avoid each other: what their scripts ask of them, changed as little as keeps them out of each other's way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from gambol.controllers.contract import Intent
from gambol.controllers.navigation import in_world
from gambol.controllers.navigation.crowd import Manners, avoid, doors_of, queued, stepping, together

from ..input import STEERING, jumping
from ..world import World

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

    Who jumps, follows points or is not there neither avoids nor is avoided.
    """
    found = list(intents)
    who = [i for i, (one, intent) in enumerate(zip(world.characters, intents))
           if one.there(world.number) and one.follows is None and intent.leap is None and jumping(one.state) is None]
    if len(who) < 2:
        return found
    ground = np.array([world.characters[i].state.ground for i in who], float)
    velocity = np.array([world.characters[i].state.velocity for i in who], float)
    asked = np.array([found[i].velocity for i in who], float)
    wishes = in_world(ground, asked)
    for k, i in enumerate(who):
        wishes[k] = wishes[k] if ways[i] is None else ways[i]
    alone, moving = wishes, in_world(ground, velocity)
    wishes = together(ground[:, :2], wishes, [groups[i] for i in who])
    wishes = queued(ground[:, :2], wishes, ground[:, :2] + LOOKS * wishes, doors_of(world.props), moving)
    chosen = avoid(ground[:, :2], moving, wishes, RADIUS, world.props, ground[:, 2], MANNERS)
    led = stepping(ground, velocity, chosen, STEERING, MANNERS)
    share = np.minimum(np.linalg.norm(chosen - alone, axis=1, keepdims=True) / GIVEN_WAY, 1.0)
    for i, mixed, part in zip(who, asked + share * (led - asked), share[:, 0]):
        if part > 1e-6:
            found[i] = replace(found[i], velocity=mixed)
    return found
