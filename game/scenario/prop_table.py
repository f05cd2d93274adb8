"""What a scenario's `[[props]]` may say: walls and platforms, ramps and stairs, pillars, goals."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag

from ..scene import Box, Goal, Pillar
from .fields import Colour, Degrees, Length, Point3, Table


class BoxTable(Table):
    """A wall or platform, which is meant where no kind is told: centre and full size [m], heading [degrees]; tint: red, green, blue, 0 … 1."""

    kind: Literal["box"] = "box"
    centre: Point3
    size: tuple[Length, Length, Length]
    heading: Degrees = 0.0
    tint: Colour = Box.tint

    def props(self) -> tuple[Box, ...]:
        """The same in SI units."""
        return (Box(self.centre, self.size, math.radians(self.heading), self.tint),)


class RampTable(Table):
    """A ramp up to a height, of that kind: its foot, the middle of its lower edge, its length, width and rise [m], the heading of the way up
    [degrees]; its tint."""

    kind: Literal["ramp"]
    foot: Point3
    length: Length
    rise: Length
    width: Length = 2.0
    heading: Degrees = 0.0
    tint: Colour = Box.tint

    def props(self) -> tuple[Box, ...]:
        """The same as a box pushed aslant, which reaches under its own foot."""
        turn, slope, deep = math.radians(self.heading), self.rise / self.length, self.rise + 0.1
        x, y, z = self.foot
        middle = (x + 0.5 * self.length * math.sin(turn), y + 0.5 * (self.rise - deep), z + 0.5 * self.length * math.cos(turn))
        return (Box(middle, (self.width, deep, self.length), turn, self.tint, slope),)


class StairsTable(Table):
    """A flight of stairs, of that kind: its foot, the middle of its lowest edge, how many steps, each one's rise and tread [m], their width [m],
    the heading of the way up [degrees]; their tint."""

    kind: Literal["stairs"]
    foot: Point3
    steps: Annotated[int, Field(ge=1, le=60)]
    rise: Annotated[float, Field(gt=0.0, le=0.2)] = 0.17
    tread: Annotated[float, Field(ge=0.22, le=2.0)] = 0.29
    width: Length = 2.0
    heading: Degrees = 0.0
    tint: Colour = Box.tint

    def props(self) -> tuple[Box, ...]:
        """The same as boxes, each from its own edge to the end of the flight."""
        turn, (x, y, z), end = math.radians(self.heading), self.foot, self.steps * self.tread
        boxes = []
        for number in range(self.steps):
            far, high = 0.5 * (number * self.tread + end), (number + 1) * self.rise
            boxes.append(Box((x + far * math.sin(turn), y + 0.5 * high, z + far * math.cos(turn)),
                             (self.width, high, end - number * self.tread), turn, self.tint))
        return tuple(boxes)


class PillarTable(Table):
    """An upright cylinder, of kind pillar, which nobody stands on: the middle of its foot, radius and height [m]; its tint."""

    kind: Literal["pillar"]
    foot: Point3
    radius: Length = 0.25
    height: Length = 2.5
    tint: Colour = Pillar.tint

    def props(self) -> tuple[Pillar, ...]:
        """The same as the renderer takes it."""
        return (Pillar(self.foot, self.radius, self.height, self.tint),)


class GoalTable(Table):
    """A place to reach, of kind goal: place, x, y, z, and radius [m]; its tint. It stops nobody."""

    kind: Literal["goal"]
    place: Point3
    radius: Length = 0.4
    tint: Colour = Goal.tint

    def props(self) -> tuple[Goal, ...]:
        """The same as the renderer takes it."""
        return (Goal(self.place, self.radius, self.tint),)


PROPS = ("box", "ramp", "stairs", "pillar", "goal")


def _kind(prop) -> str:
    return prop.get("kind", "box") if isinstance(prop, dict) else getattr(prop, "kind", "box")


PropTable = Annotated[Annotated[BoxTable, Tag("box")] | Annotated[RampTable, Tag("ramp")] | Annotated[StairsTable, Tag("stairs")]
                      | Annotated[PillarTable, Tag("pillar")] | Annotated[GoalTable, Tag("goal")], Discriminator(_kind)]
