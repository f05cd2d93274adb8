"""The tables of a scenario that say who acts, what they do and what stands about; each gives the same in SI units."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag, ValidationInfo, model_validator

from gambol.controllers.body import STATURE
from gambol.controllers.contract import Intent
from gambol.controllers.jump import Jump as JumpController, Physique
from gambol.controllers.jump.body import airtime_up
from gambol.controllers.navigation import floor_at
from gambol.controllers.reconstruction import SKELETON, parse

from ..input import Jump, Move, Script
from ..scene import TINT, Box, Goal, Pillar, Prop
from ..world import METHODS, TINTS, Follows, Hidden
from .fields import (Airtime, Colour, Degrees, FileName, Flexibility, Gravity, Length, Mass, Metres, Moment, Pace, Place,
                     Point, Point3, Seconds, Stature, Strength, Table, Velocity)


class MoveTable(Table):
    """One move: exactly one of velocity, walk_to, path, stop, jump_to and jump. Angles in degrees.

    jump_to: x, z [m], onto whatever is highest there, or x, y, z. jump: how high [m], straight up. A
    velocity, walk_to or path beside jump_to is its run-up; within: no farther from the landing than this
    [m] it jumps. airtime: [s]; by default of the least effort.
    """

    seconds: Seconds | None = Field(None, alias="for")
    velocity: Velocity | None = None
    until: Velocity | None = None
    walk_to: Point | None = None
    path: Annotated[tuple[Point, ...], Field(min_length=1)] | None = None
    stop: Literal[True] | None = None
    jump_to: Place | None = None
    jump: Annotated[float, Field(gt=0, le=100, allow_inf_nan=False)] | None = None
    airtime: Airtime | None = None
    within: Length | None = None
    speed: Pace | None = None
    facing: Degrees | None = None

    @model_validator(mode="after")
    def _one_thing(self):
        kinds = [k for k in ("velocity", "walk_to", "path", "stop", "jump_to", "jump") if getattr(self, k) is not None]
        feet = [k for k in kinds if k in ("velocity", "walk_to", "path")]
        if len(kinds) != 1 and not (len(kinds) == 2 and "jump_to" in kinds and feet):
            raise ValueError("needs exactly one of velocity, walk_to, path, stop, jump_to, jump, or jump_to with a run-up; "
                             f"has {' and '.join(kinds) or 'none'}")
        walks, jumps = kinds[0] in ("walk_to", "path"), kinds[-1] in ("jump_to", "jump")
        for name, fits, with_ in (("airtime", self.jump_to is not None, "jump_to; a jump has its height"),
                                  ("within", self.jump_to is not None and bool(feet), "jump_to and a run-up")):
            if getattr(self, name) is not None and not fits:
                raise ValueError(f"`{name}` goes with {with_}")
        if self.seconds is None and not walks and not (jumps and not feet):
            raise ValueError(f"{kinds[0]} needs `for`, how many seconds it lasts")
        if self.until is not None and kinds[0] != "velocity":
            raise ValueError("`until` goes with velocity: where it has changed to at the end")
        if self.speed is not None and not walks:
            raise ValueError("`speed` goes with walk_to or path; velocity has its own")
        if self.facing is not None and kinds[0] == "velocity":
            raise ValueError("`facing` goes with walk_to, path or stop; velocity has its own ω")
        if self.facing is not None and jumps:
            raise ValueError("`facing` goes with walk_to, path or stop; who jumps faces where it goes")
        for name in ("velocity", "until"):
            value = getattr(self, name)
            if value is not None and abs(value[2]) > abs(value[0]) + 1e-9:
                raise ValueError(f"{name} is [v_t, ω, v_l] and |v_l| ≤ |v_t|, as v_t is the whole speed; "
                                 f"got v_t = {value[0]:g}, v_l = {value[2]:g}")
        return self

    def move(self, jumper: JumpController = JumpController(), props: tuple[Prop, ...] = ()) -> Move:
        """The same in SI units, for somebody who jumps among props."""
        points = self.path or ((self.walk_to,) if self.walk_to is not None else ())
        leap = None
        if self.jump is not None:
            leap = Jump(airtime=airtime_up(jumper.physique, self.jump, jumper.gravity))
        elif self.jump_to is not None:
            x, z = self.jump_to[0], self.jump_to[-1]
            y = self.jump_to[1] if len(self.jump_to) == 3 else floor_at(x, z, props)
            leap = Jump((x, y, z), self.airtime, self.within, math.sqrt(9.81 / -jumper.gravity[1]))
            points = (*points, (x, z)) if points else ()
        return Move(seconds=math.inf if self.seconds is None else self.seconds,
                    velocity=_forward(self.velocity or (0.0, 0.0, 0.0)),
                    until=None if self.until is None else _forward(self.until),
                    points=points, speed=self.speed or 1.2,
                    facing=None if self.facing is None else math.radians(self.facing), jump=leap)


class BodyTable(Table):
    """Whose body: height [m], mass [kg], strength and flexibility as shares of an adult's, sex.

    By default the mass goes with the cube of the height.
    """

    height: Stature = STATURE
    mass: Mass | None = None
    strength: Strength = 1.0
    flexibility: Flexibility = 1.0
    sex: Literal["male", "female"] = "male"

    def physique(self) -> Physique:
        """The same for the controllers."""
        mass = max(Physique.mass * (self.height / STATURE) ** 3, 5.0) if self.mass is None else self.mass
        return Physique(mass, self.height, self.strength, self.flexibility, self.sex)


def beside_the_file(name: str, info: ValidationInfo) -> str:
    """The path of a file that a scenario names: beside the scenario's own, or from where one stands."""
    for path in ((info.context or {}).get("folder", Path()) / name, Path(name)):
        if path.is_file():
            return str(path)
    raise ValueError(f"there is no file {name!r} beside the scenario")


def _points(text: str) -> str:
    parse(text, SKELETON)  # says what there is
    return text


Points = Annotated[str, BeforeValidator(lambda v: str(v) if isinstance(v, int) and not isinstance(v, bool) else v),
                   AfterValidator(_points)]


class HiddenTable(Table):
    """Points that are not seen from one moment to another [s]."""

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

    points: the paper's sets "2" … "6", or names with commas. method: who makes a body of them. beside: x, y, z [m]
    from the performer to the actor. hidden: what is not seen, and when. noise: of the points [m]; seed: of that.
    """

    actor: str | None = None
    clip: Annotated[str, AfterValidator(beside_the_file)] | None = None
    points: Points = "4"
    method: Literal[tuple(METHODS)] = "ours"
    beside: Point3 = (0.0, 0.0, 0.0)
    hidden: tuple[HiddenTable, ...] = ()
    noise: Annotated[float, Field(ge=0, le=0.5, allow_inf_nan=False)] = 0.0
    seed: Annotated[int, Field(ge=0)] = 0

    @model_validator(mode="after")
    def _one_performer(self):
        if (self.actor is None) == (self.clip is None):
            raise ValueError('needs either actor = "…", another actor, or clip = "….bvh"')
        names = parse(self.points, SKELETON).names
        for number, hidden in enumerate(self.hidden):
            for name in parse(hidden.points, SKELETON).names:
                if name not in names:
                    raise ValueError(f"hidden[{number}].points: {name} is none of the points that are followed, {', '.join(names)}")
        return self

    @property
    def performer(self) -> str:
        """The name of whom it follows."""
        return Path(self.clip).stem if self.actor is None else self.actor

    def follows(self) -> Follows:
        """The same for the world."""
        controls = parse(self.points, SKELETON)
        hidden = tuple(Hidden(np.isin(controls.names, parse(table.points, SKELETON).names), table.start, table.end)
                       for table in self.hidden)
        return Follows(self.method, controls, self.performer, np.array(self.beside), hidden, self.noise, self.seed)


class ActorTable(Table):
    """Somebody. start: x, z [m], on whatever is highest there, and heading [degrees].

    body: an adult by default. gravity: what pulls it down as it jumps [m/s²]; the scenario's by default. follows: whose
    points it follows instead of moves of its own. ghost: one sees through it. enters, leaves: when it is there [s], from
    the beginning to the end by default; its moves begin as it enters. Who follows an actor comes and goes with it.
    """

    name: FileName = "A"
    tint: Colour = TINT
    ghost: bool = False
    follows: FollowsTable | None = None
    start: tuple[Metres, Metres, Degrees] = (0.0, 0.0, 0.0)
    body: BodyTable | None = None
    gravity: Gravity | None = None
    enters: Moment = 0.0
    leaves: Seconds | None = None
    moves: tuple[MoveTable, ...] = ()

    @model_validator(mode="after")
    def _own_will_or_points(self):
        if self.follows is not None:
            for name in ("start", "body", "gravity", "enters", "leaves", "moves"):
                if name in self.model_fields_set:
                    raise ValueError(f"who follows points has no {name}: that is the performer's")
        if self.leaves is not None and self.leaves <= self.enters:
            raise ValueError(f"`enters` comes before `leaves`; got {self.enters:g} and {self.leaves:g}")
        return self

    @property
    def stay(self) -> dict[str, float]:
        """When it is there [s], as the world has it."""
        return {"enters": self.enters, "leaves": math.inf if self.leaves is None else self.leaves}

    @property
    def colour(self) -> tuple[float, float, float]:
        """Its tint; that of its method where none is given."""
        return self.tint if self.follows is None or "tint" in self.model_fields_set else TINTS[self.follows.method]

    def jumper(self, gravity: float) -> JumpController:
        """Its jumps, where the scenario has that gravity."""
        return JumpController(Physique() if self.body is None else self.body.physique(),
                              (0.0, -(gravity if self.gravity is None else self.gravity), 0.0))

    def script(self, jumper: JumpController = JumpController(), props: tuple[Prop, ...] = ()) -> Script:
        """What it does, among props."""
        return Script(tuple(move.move(jumper, props) for move in self.moves))


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


def _forward(velocity) -> tuple[float, float, float]:
    """(v_f, ω, v_l) of (v_t, ω, v_l)."""
    return tuple(float(v) for v in Intent.tangential(*velocity).velocity)
