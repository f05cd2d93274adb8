"""Scenarios: scripted runs from TOML, checked field by field, the same to the bit every time."""

from __future__ import annotations

import math
from pathlib import Path as File
from typing import Annotated, Literal

import numpy as np
from pydantic import Discriminator, Field, Tag, ValidationError, model_validator

from assets import path as asset
from controllers.body.human import STATURE
from controllers.contract import Intent
from controllers.jump import Jump as JumpController
from controllers.jump import Physique
from controllers.jump.ballistics import apex_airtime
from controllers.jump.path import measures
from controllers.navigation import floor_at

from . import toml
from .fields import (Airtime, Colour, Degrees, FileName, Flexibility, Gravity, Length, Mass, Metres, Moment, Pace, Point,
                     Point3, Seconds, Stature, Strength, Table, Velocity, short)
from .input.script import Jump, Move, Script
from .obstacles import blocked
from .rail import on_rail
from .scene import TINT, Box, Goal, Pillar, Prop
from .shots import ShotTable, Shown
from .stage import STAGES


class ScenarioError(ValueError):
    """A scenario that cannot be used; the message names file and field, one line for each fault."""


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
    jump_to: Point | Point3 | None = None
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
            leap = Jump(airtime=_airtime_up(jumper, self.jump))
        elif self.jump_to is not None:
            x, z = self.jump_to[0], self.jump_to[-1]
            y = self.jump_to[1] if len(self.jump_to) == 3 else floor_at(x, z, props)
            leap = Jump((x, y, z), self.airtime, self.within)
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


class ActorTable(Table):
    """Somebody. start: x, z [m], on whatever is highest there, and heading [degrees].

    body: an adult by default. gravity: what pulls it down as it jumps [m/s²]; the scenario's by default.
    """

    name: FileName = "A"
    tint: Colour = TINT
    start: tuple[Metres, Metres, Degrees] = (0.0, 0.0, 0.0)
    body: BodyTable | None = None
    gravity: Gravity | None = None
    moves: tuple[MoveTable, ...] = ()

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


_PROPS = ("box", "pillar", "goal")


def _kind(prop) -> str:
    return prop.get("kind", "box") if isinstance(prop, dict) else getattr(prop, "kind", "box")


PropTable = Annotated[Annotated[BoxTable, Tag("box")] | Annotated[PillarTable, Tag("pillar")] | Annotated[GoalTable, Tag("goal")],
                      Discriminator(_kind)]


class Scenario(Table):
    """A scripted run, and the short film of it.

    title, under: shown at the beginning. duration [s], fps of the film, size of its frames in
    pixels. overlays: what is drawn where a shot says nothing else. gravity: of jumps [m/s²]. stage: what
    stands there beside its own props. poster: the moment [s] that
    stands for the film.
    """

    title: str
    under: str = ""
    duration: Seconds
    fps: Annotated[int, Field(ge=1, le=240)] = 60
    size: tuple[Annotated[int, Field(ge=16, le=8192)], Annotated[int, Field(ge=16, le=8192)]] = (1280, 720)
    overlays: Shown = ("mesh",)
    gravity: Gravity = 9.81
    stage_name: Literal[tuple(STAGES)] | None = Field(None, alias="stage")
    poster: Moment | None = None
    shots: Annotated[tuple[ShotTable, ...], Field(min_length=1)] = (ShotTable(),)
    props: tuple[PropTable, ...] = ()
    actors: Annotated[tuple[ActorTable, ...], Field(min_length=1)]

    @model_validator(mode="after")
    def _consistent(self):
        names = [actor.name for actor in self.actors]
        if len({name.casefold() for name in names}) < len(names):  # some disks know no capitals
            raise ValueError(f"actors need different names, in more than capitals; got {', '.join(names)}")
        times = [shot.at for shot in self.shots]
        if times[0] != 0.0 or times != sorted(set(times)):
            raise ValueError(f"shots must begin at = 0 and then rise; got {', '.join(f'{t:g}' for t in times)}")
        if self.poster is not None and self.poster >= self.duration:
            raise ValueError(f"poster is a moment of the film, before its end at {self.duration:g} s; got {self.poster:g}")
        solid = self.stage()
        for i, shot in enumerate(self.shots):
            for j, camera in enumerate(shot.cameras):
                where = f"shots[{i}]" if shot.views is None else f"shots[{i}].views[{j}]"
                for name in camera.names:
                    if name not in names:
                        raise ValueError(f"{where}: no actor is called {name!r}; there are {', '.join(names)}")
                _check_rail(where, camera, solid)
        return self

    def stage(self) -> tuple[Prop, ...]:
        """Everything that stands there, in SI units."""
        return STAGES.get(self.stage_name or "", ()) + tuple(prop.prop() for prop in self.props)

    @property
    def frames(self) -> int:
        """How many frames the film has."""
        return max(round(self.duration * self.fps), 1)

    def at_fps(self, fps: int) -> Scenario:
        """The same run filmed at another frame rate; the motion stays as it is."""
        return self.model_copy(update={"fps": fps})

    def at_size(self, size: tuple[int, int]) -> Scenario:
        """The same run filmed in pictures of `size` pixels."""
        return self.model_copy(update={"size": size})


def _check_rail(where: str, camera, props: tuple[Prop, ...]) -> None:
    """A camera that stands or goes where a prop is would show its inside."""
    rail = {"fixed": (camera.eye,), "dolly": camera.path}.get(camera.kind, ())
    for part in [k / 64 for k in range(65)] if len(rail) > 1 else [0.0] * len(rail):
        at = blocked(on_rail(rail, part), props)
        if at is not None:
            name = "eye" if camera.kind == "fixed" else "path"
            raise ValueError(f"{where}.{name}: the camera would be inside of props[{at}]; lead it round or over it")


def _airtime_up(jumper: JumpController, height: float) -> float:
    """The airtime [s] in which a body rises by `height` [m] after it has left the floor."""
    heights = measures(jumper.physique)
    start, end = np.array([0.0, heights.leave, 0.0]), np.array([0.0, heights.touch, 0.0])
    return apex_airtime(start, end, max(height, end[1] - start[1]), jumper.gravity)


def shipped() -> tuple[str, ...]:
    """The names of the scenarios that come with Gambol."""
    return tuple(sorted(file.stem for file in asset("scenarios").glob("*.toml")))


def locate(name: str | File) -> File:
    """The file of a scenario: that of a shipped one, or `name` itself. ScenarioError if there is neither."""
    file = File(name)
    if file.suffix == ".toml" or file.is_file():  # a folder of that name shadows nothing
        return file
    if str(name) not in shipped():
        raise ScenarioError(f"no scenario is called {str(name)!r}: name a .toml file or one of {', '.join(shipped())}")
    return asset("scenarios", f"{name}.toml")


def load(name: str | File) -> Scenario:
    """A scenario by the name of a shipped one, or from a file. ScenarioError says what is wrong."""
    file = locate(name)
    tables = toml.read(file, ScenarioError)
    try:
        return Scenario.model_validate(tables)
    except ValidationError as error:
        faults = error.errors()
        # a list whose items are faulty also counts as too short: that line would only mislead
        inner = [fault for fault in faults if not (fault["type"] == "too_short" and any(
            f["loc"][:len(fault["loc"])] == fault["loc"] and f is not fault for f in faults))]
        raise ScenarioError("\n".join(_fault(file, fault) for fault in inner)) from None


def _fault(file: File, fault: dict) -> str:
    """One line about one fault: file, field, what would be right."""
    where = ""
    for i, part in enumerate(fault["loc"]):
        if part in _PROPS and fault["loc"][i - 2:i - 1] == ("props",):
            continue  # which kind of prop it is: no field of the file
        where += f"[{part}]" if isinstance(part, int) else f"{'.' if where else ''}{part}"
    kind, text = fault["type"], fault["msg"].removeprefix("Value error, ")
    if kind == "extra_forbidden":
        text = "there is no such field"
    elif kind == "missing":
        text = "is missing, and needed"
    elif kind == "union_tag_invalid":
        text = f"kind should be one of {', '.join(_PROPS)}, got {short(fault['ctx']['tag'])}"
    elif kind not in ("value_error",):
        text = f"{text[0].lower()}{text[1:]}, got {short(fault['input'])}"
    return f"{file}: {where + ': ' if where else ''}{text}"


def _forward(velocity) -> tuple[float, float, float]:
    """(v_f, ω, v_l) of (v_t, ω, v_l)."""
    return tuple(float(v) for v in Intent.tangential(*velocity).velocity)
