"""What a scenario's `[[props]]` may say: walls and platforms, pillars, goals."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Discriminator, Tag

from ..scene import Box, Goal, Pillar
from .fields import Colour, Degrees, Length, Point3, Table


class BoxTable(Table):
    """A wall or platform: centre and full size [m], heading [degrees]."""

    kind: Literal["box"] = "box"
    centre: Point3
    size: tuple[Length, Length, Length]
    heading: Degrees = 0.0
    tint: Colour = Box.tint

    def prop(self) -> Box:
        """The same in SI units."""
        return Box(self.centre, self.size, math.radians(self.heading), self.tint)


class PillarTable(Table):
    """An upright cylinder: the middle of its foot, radius and height [m]."""

    kind: Literal["pillar"]
    foot: Point3
    radius: Length = 0.25
    height: Length = 2.5
    tint: Colour = Pillar.tint

    def prop(self) -> Pillar:
        """The same as the renderer takes it."""
        return Pillar(self.foot, self.radius, self.height, self.tint)


class GoalTable(Table):
    """A place to reach: x, y, z and radius [m]."""

    kind: Literal["goal"]
    place: Point3
    radius: Length = 0.4
    tint: Colour = Goal.tint

    def prop(self) -> Goal:
        """The same as the renderer takes it."""
        return Goal(self.place, self.radius, self.tint)


PROPS = ("box", "pillar", "goal")


def _kind(prop) -> str:
    return prop.get("kind", "box") if isinstance(prop, dict) else getattr(prop, "kind", "box")


PropTable = Annotated[Annotated[BoxTable, Tag("box")] | Annotated[PillarTable, Tag("pillar")] | Annotated[GoalTable, Tag("goal")],
                      Discriminator(_kind)]
