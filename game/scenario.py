"""Scenarios: scripted runs from TOML, checked field by field, the same to the bit every time."""

from __future__ import annotations

import math
import re
import tomllib
from pathlib import Path as File
from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError, model_validator

from assets import path as asset
from controllers.contract import Intent

from .input.script import Move, Script
from .scene import Box, Overlays

OVERLAYS = ("mesh", "skeleton", "contacts", "trail", "path")
NAME = re.compile(r"[\w-]+( [\w-]+)*")


def _signed(most: float):
    return Annotated[float, Field(ge=-most, le=most, allow_inf_nan=False)]


def _positive(most: float):
    return Annotated[float, Field(gt=0, le=most, allow_inf_nan=False)]


# as far, fast and long as anybody can mean it: more is a slip, and numbers stay sound
Metres, Length = _signed(1e5), _positive(1e5)
Speed, Pace = _signed(20), _positive(20)  # m/s
Turning = _signed(20)  # rad/s
Degrees = _signed(3600)
Seconds = _positive(3600)
Point = tuple[Metres, Metres]
Point3 = tuple[Metres, Metres, Metres]
Velocity = tuple[Speed, Turning, Speed]
Colour = tuple[*(Annotated[float, Field(ge=0, le=1)],) * 3]


class ScenarioError(ValueError):
    """A scenario that cannot be used; the message names file and field, one line for each fault."""


def _file_name(name: str) -> str:
    if not NAME.fullmatch(name) or len(name) > 40:
        raise ValueError("files are named after it, so it needs letters, digits, - and _, with single spaces "
                         f"between, 40 at most; got {_short(name)}")
    return name


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=False)


class MoveTable(_Table):
    """One move: exactly one of velocity, walk_to, path and stop. Angles in degrees."""

    seconds: Seconds | None = Field(None, alias="for")
    velocity: Velocity | None = None
    until: Velocity | None = None
    walk_to: Point | None = None
    path: Annotated[tuple[Point, ...], Field(min_length=1)] | None = None
    stop: Literal[True] | None = None
    speed: Pace | None = None
    facing: Degrees | None = None

    @model_validator(mode="after")
    def _one_thing(self):
        kinds = [k for k in ("velocity", "walk_to", "path", "stop") if getattr(self, k) is not None]
        if len(kinds) != 1:
            raise ValueError(f"needs exactly one of velocity, walk_to, path, stop; has {' and '.join(kinds) or 'none'}")
        walks = kinds[0] in ("walk_to", "path")
        if self.seconds is None and not walks:
            raise ValueError(f"{kinds[0]} needs `for`, how many seconds it lasts")
        if self.until is not None and kinds[0] != "velocity":
            raise ValueError("`until` goes with velocity: where it has changed to at the end")
        if self.speed is not None and not walks:
            raise ValueError("`speed` goes with walk_to or path; velocity has its own")
        if self.facing is not None and kinds[0] == "velocity":
            raise ValueError("`facing` goes with walk_to, path or stop; velocity has its own ω")
        for name in ("velocity", "until"):
            value = getattr(self, name)
            if value is not None and abs(value[2]) > abs(value[0]) + 1e-9:
                raise ValueError(f"{name} is [v_t, ω, v_l] and |v_l| ≤ |v_t|, as v_t is the whole speed; "
                                 f"got v_t = {value[0]:g}, v_l = {value[2]:g}")
        return self

    def move(self) -> Move:
        """The same in SI units."""
        points = self.path or ((self.walk_to,) if self.walk_to is not None else ())
        return Move(seconds=math.inf if self.seconds is None else self.seconds,
                    velocity=_forward(self.velocity or (0.0, 0.0, 0.0)),
                    until=None if self.until is None else _forward(self.until),
                    points=points, speed=self.speed or 1.2,
                    facing=None if self.facing is None else math.radians(self.facing))


class ActorTable(_Table):
    """Somebody. start: x, z [m] and heading [degrees]."""

    name: Annotated[str, AfterValidator(_file_name)] = "A"
    tint: Colour = (0.75, 0.42, 0.22)
    start: tuple[Metres, Metres, Degrees] = (0.0, 0.0, 0.0)
    moves: tuple[MoveTable, ...] = ()

    def script(self) -> Script:
        """What it does."""
        return Script(tuple(move.move() for move in self.moves))


class BoxTable(_Table):
    """A wall, pillar or platform: centre and full size [m], heading [degrees]."""

    centre: Point3
    size: tuple[Length, Length, Length]
    heading: Degrees = 0.0
    tint: Colour = (0.55, 0.56, 0.60)

    def box(self) -> Box:
        """The same in SI units."""
        return Box(self.centre, self.size, math.radians(self.heading), self.tint)


class ShotTable(_Table):
    """What the camera does from `at` seconds on.

    follow: an actor, looking `around` degrees to the left of its heading at the cut and from
    `above` degrees over the horizon; with `swing` it comes round behind. fixed: from `eye`. dolly: from `eye` to `to`. Both look at `target`, or
    at the actor named in `look_at`.
    """

    kind: Literal["follow", "fixed", "dolly"] = "follow"
    at: Annotated[float, Field(ge=0, le=3600, allow_inf_nan=False)] = 0.0
    actor: str | None = None
    distance: Length = 4.5
    around: Degrees = 0.0
    above: Annotated[float, Field(gt=-20, lt=80)] = 12.0
    swing: bool = True
    eye: Point3 | None = None
    to: Point3 | None = None
    target: Point3 | None = None
    look_at: str | None = None
    fov: Annotated[float, Field(gt=5, lt=120)] = 46.0

    @model_validator(mode="after")
    def _complete(self):
        if self.kind == "follow":
            wrong = [n for n in ("eye", "to", "target", "look_at") if getattr(self, n) is not None]
            if wrong:
                raise ValueError(f"a follow shot has no {wrong[0]}; use kind = \"fixed\" or \"dolly\"")
            return self
        if self.eye is None:
            raise ValueError(f"a {self.kind} shot needs eye = [x, y, z]")
        if (self.target is None) == (self.look_at is None):
            raise ValueError(f"a {self.kind} shot needs either target = [x, y, z] or look_at = an actor's name")
        if (self.to is None) == (self.kind == "dolly"):
            raise ValueError("`to` = [x, y, z] goes with a dolly shot, and only there")
        return self


class Scenario(_Table):
    """A scripted run. duration [s], fps of the film, size of its frames in pixels."""

    title: str
    duration: Seconds
    fps: Annotated[int, Field(ge=1, le=240)] = 60
    size: tuple[Annotated[int, Field(ge=16, le=8192)], Annotated[int, Field(ge=16, le=8192)]] = (1280, 720)
    overlays: tuple[Literal[OVERLAYS], ...] = ("mesh",)
    shots: Annotated[tuple[ShotTable, ...], Field(min_length=1)] = (ShotTable(),)
    props: tuple[BoxTable, ...] = ()
    actors: Annotated[tuple[ActorTable, ...], Field(min_length=1)]

    @model_validator(mode="after")
    def _consistent(self):
        names = [actor.name for actor in self.actors]
        if len({name.casefold() for name in names}) < len(names):  # some disks know no capitals
            raise ValueError(f"actors need different names, in more than capitals; got {', '.join(names)}")
        for i, shot in enumerate(self.shots):
            for name in (shot.actor, shot.look_at):
                if name is not None and name not in names:
                    raise ValueError(f"shots[{i}]: no actor is called {name!r}; there are {', '.join(names)}")
        times = [shot.at for shot in self.shots]
        if times[0] != 0.0 or times != sorted(set(times)):
            raise ValueError(f"shots must begin at = 0 and then rise; got {', '.join(f'{t:g}' for t in times)}")
        return self

    @property
    def frames(self) -> int:
        """How many frames the film has."""
        return max(round(self.duration * self.fps), 1)

    def at_fps(self, fps: int) -> Scenario:
        """The same run filmed at another frame rate; the motion stays as it is."""
        return self.model_copy(update={"fps": fps})


def overlays(names) -> Overlays:
    """Overlays by name."""
    return Overlays(**{name: name in names for name in OVERLAYS})


def shipped() -> tuple[str, ...]:
    """The names of the scenarios that come with Gambol."""
    return tuple(sorted(file.stem for file in asset("scenarios").glob("*.toml")))


def load(name: str | File) -> Scenario:
    """A scenario by the name of a shipped one, or from a file. ScenarioError says what is wrong."""
    file = File(name)
    if file.suffix != ".toml" and not file.is_file():  # a folder of that name shadows nothing
        if str(name) not in shipped():
            raise ScenarioError(f"no scenario is called {str(name)!r}: name a .toml file or one of {', '.join(shipped())}")
        file = asset("scenarios", f"{name}.toml")
    try:
        text = file.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise ScenarioError(f"{file}: not UTF-8 text (byte {error.start})") from None
    except OSError as error:
        raise ScenarioError(f"{file}: {error.strerror or error}") from None
    try:
        return Scenario.model_validate(tomllib.loads(text))
    except tomllib.TOMLDecodeError as error:
        raise ScenarioError(f"{file}: not TOML: {error}") from None
    except ValidationError as error:
        faults = error.errors()
        # a list whose items are faulty also counts as too short: that line would only mislead
        inner = [fault for fault in faults if not (fault["type"] == "too_short" and any(
            f["loc"][:len(fault["loc"])] == fault["loc"] and f is not fault for f in faults))]
        raise ScenarioError("\n".join(_fault(file, fault) for fault in inner)) from None


def _fault(file: File, fault: dict) -> str:
    """One line about one fault: file, field, what would be right."""
    where = ""
    for part in fault["loc"]:
        where += f"[{part}]" if isinstance(part, int) else f"{'.' if where else ''}{part}"
    kind, text = fault["type"], fault["msg"].removeprefix("Value error, ")
    if kind == "extra_forbidden":
        text = "there is no such field"
    elif kind == "missing":
        text = "is missing, and needed"
    elif kind not in ("value_error",):
        text = f"{text[0].lower()}{text[1:]}, got {_short(fault['input'])}"
    return f"{file}: {where + ': ' if where else ''}{text}"


def _short(value) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "…"


def _forward(velocity) -> tuple[float, float, float]:
    """(v_f, ω, v_l) of (v_t, ω, v_l)."""
    return tuple(float(v) for v in Intent.tangential(*velocity).velocity)
