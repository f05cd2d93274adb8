"""A controller in somebody's body: it moves as before, in that body's size, and is drawn in it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from gambol.controllers.jump import Jump
from gambol.controllers.scaled import Scaled
from gambol.controllers.struck import Struck
from gambol.controllers.supervisor import Supervisor

from ..render import Body, leg_length, skin

SMALLEST, LARGEST = 0.4, 1.6
"""Legs shorter or longer than this share of the standard's are taken for another unit, and fitted."""


class Embodied(Supervisor):
    """Controllers in a body's size. body: what they move. factor: its leg length over the standard human's."""

    def __init__(self, controllers, body: Body, factor: float = 1.0):
        super().__init__(controllers)
        self.body, self.factor = body, factor

    @staticmethod
    def of(controller: Any, body: Body) -> Embodied:
        """A person, or one controller alone, in a body; one of unlikely size is fitted to the standard human's."""
        factor = float(leg_length(body.joints) / leg_length(skin.REST))
        factor = factor if SMALLEST <= factor <= LARGEST else 1.0
        controllers = controller.parts or {"locomotion": controller}
        return Embodied({name: sized(one, factor) for name, one in controllers.items()}, body, factor)


def sized(controller: Any, factor: float) -> Any:
    """A controller in a body `factor` times as long as the standard human's."""
    if factor == 1.0:
        return controller
    if isinstance(controller, Jump | Struck):  # planned for whatever body it is
        grown = replace(controller.physique, mass=controller.physique.mass * factor**3, height=controller.physique.height * factor)
        return type(controller)(grown, controller.gravity)
    return Scaled(controller, factor)
