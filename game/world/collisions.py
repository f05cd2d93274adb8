"""Characters who run into each other: bodies that meet faster than they brush past share their momentum, and each is struck by what it takes.

Two trunks are upright cylinders. As they touch and still close in, an impulse along the line between them leaves both as fast along it as if they had stuck together, but for a little
that flesh gives back. Who is down on the floor, or in the air over another, is met by nobody.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from gambol.controllers.contract import HARDEST, Intent, Strike, but
from gambol.controllers.navigation import in_world
from gambol.controllers.supervisor import both

from .centre_of_mass import physique_of

TRUNK = 0.19
"""The radius of a body [m], at standard height, that others run into: shoulders turn, and arms give way, before it."""
LEAST, DEEP = (0.7, 0.35), 0.1
"""Who closes in slower than the first [m/s] is brushed past, where trunks only touch; slower than the second, where they are so deep in each other [m]."""
BACK = 0.1
"""Flesh gives back so much of the speed with which bodies meet."""
_TOUCH = Strike((0.0, 0.0))
HIGH = 0.35
"""A pelvis that is lower over its floor than this share of the body's height belongs to who is down; one that is farther above another's stands over him."""


def run_into(characters: Sequence[Any], intents: Sequence[Intent], number: int) -> list[Intent]:
    """The intents of characters (`gambol.game.world.Character`), one for each, and how those are struck who run into each other after so many steps of the world; the very same of all
    others. Those count who are there and answer strikes, whoever moves them; who follows points or a camera meets nobody."""
    found = list(intents)
    who = [i for i, one in enumerate(characters) if one.there(number) and one.follows is None and one.watches is None
           and any(part.gain(_TOUCH) is not None for part in one.controller.parts.values())]
    if len(who) < 2:
        return found
    states, bodies = [characters[i].state for i in who], [physique_of(characters[i].controller) for i in who]
    ground, root = np.array([state.ground for state in states], float), np.array([state.pose.root for state in states], float)
    size, mass = np.array([body.size for body in bodies]), np.array([body.mass for body in bodies])
    flow = in_world(ground, np.array([state.velocity for state in states], float))
    high = HIGH * np.array([body.height for body in bodies])
    up = root[:, 1] - np.array([float(state.floor) for state in states]) > high
    apart = ground[:, None, :2] - ground[None, :, :2]
    far = np.linalg.norm(apart, axis=-1)
    meets = (far < TRUNK * (size[:, None] + size)) & up[:, None] & up & (np.abs(root[:, None, 1] - root[:, 1]) < np.minimum(high[:, None], high))
    for k, j in np.argwhere(np.triu(meets, 1)):
        along = apart[k, j] / max(float(far[k, j]), 1e-9)
        closing = -float((flow[k] - flow[j]) @ along)
        into = min((TRUNK * (size[k] + size[j]) - far[k, j]) / DEEP, 1.0)
        if closing > LEAST[0] + into * (LEAST[1] - LEAST[0]) and far[k, j] > 1e-9:
            hard = min((1.0 + BACK) * closing * mass[k] * mass[j] / (mass[k] + mass[j]), 0.5 * HARDEST) * along
            for one, impulse in ((k, hard), (j, -hard)):
                i = who[one]
                found[i] = but(found[i], strike=both(found[i].strike, Strike((float(impulse[0]), float(impulse[1])))))
    return found
