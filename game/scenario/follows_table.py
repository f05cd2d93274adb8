"""What a scenario's `follows` may say: whose points an actor follows, which, and what is not seen of them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from gambol.controllers.reconstruction import SKELETON, parse

from ..world import METHODS, TURNING, Follows, Hidden
from .fields import Moment, Point3, Seconds, Table, beside_the_file, one_of

AXES = "x", "y", "z", "-x", "-y", "-z"


def _points(text: str) -> str:
    parse(text, SKELETON)  # says what there is
    return text


Words = Annotated[str, BeforeValidator(lambda v: str(v) if isinstance(v, int | float) and not isinstance(v, bool) else v)]
"""A text, or a number without quotes."""
Points = Annotated[Words, AfterValidator(_points)]


class HiddenTable(Table):
    """Which points are not seen, `from` one moment `to` another [s]."""

    points: Points
    start: Moment = Field(alias="from")
    end: Seconds = Field(alias="to")

    @model_validator(mode="after")
    def _in_order(self):
        if self.start >= self.end:
            raise ValueError(f"`from` comes before `to`; got {self.start:g} and {self.end:g}")
        return self


class FollowsTable(Table):
    """Whose points an actor follows: those of another `actor`, or of a `clip`, a .bvh or .amc file that plays from the origin.

    up, unit: of the clip, the axis that points up, and the unit, m, dm, cm, mm, ft, in or a number of metres, where they are misjudged. points: the paper's sets "2" … "6", or names with commas. method: who makes a body of them. beside: x, y, z [m]
    from the performer to the actor. hidden: what is not seen, and when. noise: of the points [m]; seed: of that.
    turns: whether how the points are turned is seen, too.
    """

    actor: str | None = None
    clip: Annotated[str, AfterValidator(beside_the_file)] | None = None
    up: Annotated[str, one_of(AXES)] | None = None
    unit: Words | None = None
    points: Points = "4"
    method: Annotated[str, one_of(METHODS)] = "ours"
    beside: Point3 = (0.0, 0.0, 0.0)
    hidden: tuple[HiddenTable, ...] = ()
    noise: Annotated[float, Field(ge=0, le=0.5, allow_inf_nan=False)] = 0.0
    seed: Annotated[int, Field(ge=0)] = 0
    turns: bool = False

    @model_validator(mode="after")
    def _one_performer(self):
        if (self.actor is None) == (self.clip is None):
            raise ValueError('needs either actor = "…", another actor, or clip = "….bvh"')
        if self.clip is None and (self.up, self.unit) != (None, None):
            raise ValueError("up and unit go with a clip")
        if self.unit is not None:
            self.reading()
        if self.method == TURNING and not self.turns:
            raise ValueError(f'method = "{TURNING}" hears how points are turned: it goes with turns = true')
        names = parse(self.points, SKELETON).names
        for number, hidden in enumerate(self.hidden):
            for name in parse(hidden.points, SKELETON).names:
                if name not in names:
                    raise ValueError(f"hidden[{number}].points: {name} is none of the points that are followed, {', '.join(names)}")
        return self

    def reading(self) -> Any:
        """How the clip is to be read. ValueError for a unit that there is not."""
        from gambol.controllers.mocap import Reading  # who follows no clip reads none

        return Reading.of(self.up, self.unit)

    @property
    def performer(self) -> str:
        """The name of whom it follows."""
        if self.actor is not None:
            return self.actor
        assert self.clip is not None  # one of the two is given, see `_one_performer`
        return Path(self.clip).stem

    def follows(self) -> Follows:
        """The same for the world."""
        controls = parse(self.points, SKELETON)
        hidden = tuple(Hidden(np.isin(controls.names, parse(table.points, SKELETON).names), table.start, table.end)
                       for table in self.hidden)
        return Follows(self.method, controls, self.performer, np.array(self.beside), hidden, self.noise, self.seed, self.turns)
