"""Who holds a camera of a film during one shot: on an arm behind or round an actor, on a rail, or fixed."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from gambol.controllers.body import damp
from gambol.controllers.navigation import in_world

from ..camera import CameraSettings, Follow, Orbit, dolly, fixed
from ..input import Wish
from ..scene import Camera
from ..world import DT, World
from .shot_table import CameraTable

LOOK_HALFLIFE = 0.15
"""How fast a camera without an arm turns after whom it looks at [s]."""
HANDS_OFF = Wish()


@dataclass(frozen=True, eq=False)
class Operator:
    """Who holds a camera during one shot, at one tick.

    watched: the numbers of the actors that it is about; held: a camera on an arm, else the target
    (3,) [m] that it looks at. start, end: of the shot [s]; time: now.
    """

    table: CameraTable
    watched: tuple[int, ...]
    start: float
    end: float
    time: float
    held: Follow | Orbit | None = None
    target: np.ndarray | None = None

    @staticmethod
    def ready(table: CameraTable, world: World, end: float) -> Operator:
        """At the cut; the shot lasts until `end` [s]."""
        watched = tuple(world.index(name) for name in table.names) or (0,)
        operator = Operator(table, watched, world.time, end, world.time)
        if table.kind in ("fixed", "dolly"):
            return replace(operator, target=_middle(world, watched, table.height) if table.target is None else np.array(table.target))
        ground, level = world.characters[watched[0]].state.ground, world.characters[watched[0]].level
        yaw, above = math.radians(table.around), math.radians(table.above)
        settings = CameraSettings(height=table.height, fov=math.radians(table.fov), nearest=0.5, highest=1.45,
                                  rest=0.0 if table.swing else math.inf)
        if table.target is None:
            held = Follow.behind(ground, settings, float(ground[2]) + yaw, above, table.distance, level)
            if table.kind == "follow":
                return replace(operator, held=held.placed(ground, world.props))
            target, yaw = held.target, held.yaw
        else:
            target = np.array(table.target)
        held = Orbit.round(target, settings, yaw, above, table.distance, tracks=table.target is None, keeps="distance" in table.model_fields_set)
        return replace(operator, held=held.placed(ground, world.props))

    def step(self, world: World) -> Operator:
        """One tick on."""
        moved = replace(self, time=world.time)
        first = world.characters[self.watched[0]]
        state = first.state
        if self.held is None:
            if self.table.target is not None:
                return moved
            assert self.target is not None  # whoever holds no arm looks at something, see `ready`
            return replace(moved, target=damp(self.target, _middle(world, self.watched, self.table.height), LOOK_HALFLIFE, DT))
        held, velocity = self.held, in_world(state.ground, state.velocity)
        if self.table.kind == "orbit":
            held = held.turned(math.radians(self.table.turn) * DT / max(self.end - self.start, DT))
        return replace(moved, held=held.step(state.ground, velocity, HANDS_OFF, DT, world.props, first.level))

    def view(self) -> Camera:
        """The camera."""
        if self.held is not None:
            return self.held.view()
        fov = math.radians(self.table.fov)
        if self.table.kind == "dolly":
            assert self.table.path is not None  # a dolly's table has one
            return dolly(self.table.path, self.target, (self.time - self.start) / (self.end - self.start), fov)
        return fixed(self.table.eye, self.target, fov)


def _middle(world: World, watched: tuple[int, ...], height: float) -> np.ndarray:
    """The middle (3,) [m] of some actors, `height` over what they stand on."""
    people = [world.characters[i] for i in watched]
    ground = np.mean([character.state.ground[:2] for character in people], axis=0)
    return np.array([ground[0], height + np.mean([character.level for character in people]), ground[1]])
