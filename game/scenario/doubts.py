"""What in a sound scenario is hardly meant: it is filmed as it is written, and told of before."""

from __future__ import annotations

import math
from collections.abc import Iterator

from gambol.controllers.navigation import floor_at, is_pillar

from .scenario import Scenario

FASTEST = 5.0
"""Nobody whose motion ships runs faster than 4.3 m/s; who is told more than this [m/s] was told in other units."""
CLOSE = 0.3
"""Two bodies that stand nearer to each other than this [m] are in each other."""
FLOATING = 0.1
"""A landing so far [m] above or below what stands there is on nothing."""


def doubts(scenario: Scenario) -> Iterator[str]:
    """A line for each thing, which names its field."""
    props = scenario.stage()
    own = [(number, actor) for number, actor in enumerate(scenario.actors) if actor.follows is None and actor.tracks is None]
    for place, (first, one) in enumerate(own):
        for second, other in own[place + 1:]:
            apart = math.dist(one.start[:2], other.start[:2])
            if apart < CLOSE and abs(one.enters - other.enters) < 1.0:
                yield f"actors[{second}].start: {other.name} begins {apart:.2f} m from {one.name}, in actors[{first}]: they stand in each other"
    pillars = [prop for prop in props if is_pillar(prop)]

    def on_pillar(x: float, z: float) -> bool:
        return any(math.dist((x, z), (one.foot[0], one.foot[2])) < one.radius for one in pillars)
    for number, actor in own:
        if on_pillar(actor.start[0], actor.start[1]):
            yield f"actors[{number}].start: {actor.name} begins in a pillar, which nobody stands on: a box can be stood on"
        if actor.enters >= scenario.duration:
            yield f"actors[{number}].enters: {actor.name} enters after {actor.enters:g} s, and the film is over after {scenario.duration:g} s: nobody sees him"
        for k, move in enumerate(actor.moves):
            where = f"actors[{number}].moves[{k}]"
            asked = max([move.speed or 0.0, *(abs(speed[0]) for speed in (move.velocity, move.until) if speed is not None)])
            if asked > FASTEST:
                yield f"{where}: {asked:g} m/s, which is {3.6 * asked:.0f} km/h, is faster than anybody runs here: about 4.3 m/s"
            if move.jump_to is not None and on_pillar(move.jump_to[0], move.jump_to[-1]):
                yield f"{where}.jump_to: lies on a pillar, which nobody stands on: a box can be stood on"
            elif move.jump_to is not None and len(move.jump_to) == 3:
                x, y, z = move.jump_to
                ground = floor_at(x, z, props, below=y + FLOATING)
                if abs(y - ground) > FLOATING:
                    yield f"{where}.jump_to: ({x:g}, {y:g}, {z:g}) is {abs(y - ground):.2f} m {'above' if y > ground else 'below'} what one stands on there"
