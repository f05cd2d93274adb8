"""Scenarios: scripted runs from TOML, checked field by field, the same to the bit every time."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path as File
from typing import Annotated, Any, get_args

from pydantic import AfterValidator, Field, ValidationError, model_validator

from gambol.assets import path as asset

from ..camera import blocked, on_rail
from ..files import did_you_mean, meant, toml
from ..scene import Prop
from ..world import STAGES
from .actor_table import ActorTable
from .fields import FrameRate, Gravity, Moment, Seconds, Table, beside_the_file, one_of, short
from .follows_table import FollowsTable
from .prop_table import PROPS, PropTable
from .shot_table import ShotTable, Shown


class ScenarioError(ValueError):
    """A scenario that cannot be used; the message names file and field, one line for each fault."""


class Scenario(Table):
    """A scripted run, and the short film of it.

    title, under: shown at the beginning. duration [s], fps of the film, size of its frames in
    pixels. overlays: what is drawn where a shot says nothing else. gravity: of jumps [m/s²]. stage: what
    stands there beside its own props; "course" is one. avoid: actors who walk avoid each other. poster: the moment [s] that stands for the film.
    database: what the methods of those who follow points learn from; Gambol's own motion by default. shots: what is seen, one after the other.
    props: what stands about. actors: who is there.
    """

    title: str
    under: str = ""
    duration: Seconds
    fps: FrameRate = Fraction(60)
    size: tuple[Annotated[int, Field(ge=16, le=8192)], Annotated[int, Field(ge=16, le=8192)]] = (1280, 720)
    overlays: Shown = ("mesh",)
    gravity: Gravity = 9.81
    stage_name: Annotated[str, one_of(STAGES)] | None = Field(None, alias="stage")
    avoid: bool = False
    poster: Moment | None = None
    database: Annotated[str, AfterValidator(beside_the_file)] | None = None
    shots: Annotated[tuple[ShotTable, ...], Field(min_length=1)] = (ShotTable(),)
    props: tuple[PropTable, ...] = ()
    actors: Annotated[tuple[ActorTable, ...], Field(min_length=1)]

    @model_validator(mode="after")
    def _consistent(self):
        names = [actor.name for actor in self.actors]
        if len({name.casefold() for name in names}) < len(names):  # some disks know no capitals
            raise ValueError(f"actors need different names, in more than capitals; got {', '.join(names)}")
        for i, actor in enumerate(self.actors):
            if actor.group is not None and not self.avoid:
                raise ValueError(f"actors[{i}].group: who walks together avoids each other: it goes with avoid = true")
        times = [shot.at for shot in self.shots]
        if times[0] != 0.0 or times != sorted(set(times)):
            raise ValueError(f"shots must begin at = 0 and then rise; got {', '.join(f'{t:g}' for t in times)}")
        if self.poster is not None and self.poster >= self.duration:
            raise ValueError(f"poster is a moment of the film, before its end at {self.duration:g} s; got {self.poster:g}")
        _check_followers(self.actors)
        _check_strikes(self.actors, self.duration)
        names += dict.fromkeys(table.performer for _, table in self.followers if table.clip is not None)
        solid = self.stage()
        for i, shot in enumerate(self.shots):
            for j, camera in enumerate(shot.cameras):
                where = f"shots[{i}]" if shot.views is None else f"shots[{i}].views[{j}]"
                for name in camera.names:
                    if name not in names:
                        raise ValueError(f"{where}: no actor is called {name!r}; there are {', '.join(names)}")
                _check_rail(where, camera, solid, len(solid) - len(self.props))
        return self

    def stage(self) -> tuple[Prop, ...]:
        """Everything that stands there, in SI units."""
        return STAGES.get(self.stage_name or "", ()) + tuple(thing for prop in self.props for thing in prop.props())

    @property
    def followers(self) -> tuple[tuple[ActorTable, FollowsTable], ...]:
        """Those who follow points, and whose."""
        return tuple((actor, actor.follows) for actor in self.actors if actor.follows is not None)

    @property
    def files(self) -> tuple[File, ...]:
        """The files and folders that it names."""
        named = [self.database, *(table.clip for _, table in self.followers),
                 *(file for actor in self.actors if actor.tracks is not None for file in (actor.tracks.footage, actor.tracks.start))]
        return tuple(File(name) for name in named if name is not None)

    @property
    def wanted(self) -> tuple[tuple[str, str], ...]:
        """The methods, name and points, that its followers need, so that they can be learnt before."""
        return tuple(dict.fromkeys((table.method, table.points) for _, table in self.followers))

    @property
    def frames(self) -> int:
        """How many frames the film has."""
        return max(round(self.duration * self.fps), 1)

    def at_fps(self, fps: Fraction | int) -> Scenario:
        """The same run filmed at another frame rate; the motion stays as it is."""
        return self.model_copy(update={"fps": Fraction(fps)})

    def at_size(self, size: tuple[int, int]) -> Scenario:
        """The same run filmed in pictures of `size` pixels."""
        return self.model_copy(update={"size": size})


def _check_strikes(actors: tuple[ActorTable, ...], duration: float) -> None:
    """What strikes comes while somebody is there."""
    for i, actor in enumerate(actors):
        left = min(duration, actor.gone) - actor.enters
        for j, strike in enumerate(actor.strikes):
            if strike.at >= left:
                raise ValueError(f"actors[{i}].strikes[{j}].at: comes {strike.at:g} s after he enters; he is there for {left:g} s")


def _check_followers(actors: tuple[ActorTable, ...]) -> None:
    """Whom one follows has a will."""
    seen = [actor.name for actor in actors if actor.follows is None and actor.tracks is None]
    for i, actor in enumerate(actors):
        if actor.tracks is not None and actor.tracks.actor is not None and actor.tracks.actor not in seen:
            raise ValueError(f"actors[{i}].tracks.actor: nobody with moves is called {actor.tracks.actor!r}; "
                             f"there {'are ' + ', '.join(seen) if seen else 'is nobody'}")
    wills = [actor.name for actor in actors if actor.follows is None]
    for i, actor in enumerate(actors):
        table = actor.follows
        if table is not None and table.actor is not None and table.actor not in wills:
            raise ValueError(f"actors[{i}].follows.actor: nobody with moves is called {table.actor!r}; "
                             f"there {'are ' + ', '.join(wills) if wills else 'is nobody'}")
        if table is not None and table.clip is not None and any(table.performer.casefold() == a.name.casefold() for a in actors):
            raise ValueError(f"actors[{i}].follows.clip: its performer is called {table.performer!r}, as an actor is; rename that one")


def _check_rail(where: str, camera, props: tuple[Prop, ...], given: int) -> None:
    """A camera that stands or goes where a prop is would show its inside. given: how many of them the stage has."""
    rail = {"fixed": (camera.eye,), "dolly": camera.path}.get(camera.kind, ())
    for part in [k / 64 for k in range(65)] if len(rail) > 1 else [0.0] * len(rail):
        at = blocked(on_rail(rail, part), props)
        if at is not None:
            name = "eye" if camera.kind == "fixed" else "path"
            what = f"props[{at - given}]" if at >= given else "what stands on its stage"
            raise ValueError(f"{where}.{name}: the camera would be inside of {what}; lead it round or over it")


def shipped() -> tuple[str, ...]:
    """The names of the scenarios that come with Gambol."""
    return tuple(sorted(file.stem for file in asset("scenarios").glob("*.toml")))


_UNCOUNTED = re.compile(r"\[\d+\]")
OTHERS = {".gambol": "an input log is filmed with --replay", **dict.fromkeys((".bvh", ".amc"), "motion is a follower's clip in one, or read by gambol reconstruct"),
          **dict.fromkeys((".glb", ".gltf", ".vrm"), "a body is worn with --character")}
"""What is named in a scenario's place, by the ending of its file."""


def locate(name: str | File) -> File:
    """The file of a scenario: that of a shipped one, or `name` itself. ScenarioError if there is neither."""
    file = File(name)
    if (other := OTHERS.get(file.suffix.lower())) is not None:
        raise ScenarioError(f"{file}: is no scenario, which is a .toml file; {other}")
    if file.suffix == ".toml" or file.is_file():  # a folder of that name shadows nothing
        return file
    if str(name) not in shipped():
        raise ScenarioError(f"no scenario is called {str(name)!r}: name a .toml file or one of {', '.join(shipped())}"
                            + did_you_mean(str(name), shipped()))
    return asset("scenarios", f"{name}.toml")


def load(name: str | File) -> Scenario:
    """A scenario by the name of a shipped one, or from a file. ScenarioError says what is wrong."""
    file = locate(name)
    tables = toml.read(file, ScenarioError)
    try:
        return Scenario.model_validate(tables, context={"folder": file.parent})
    except ValidationError as error:
        raise ScenarioError("\n".join(_fault(file, fault) for fault in _told(error.errors()))) from None


def _told(faults: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """The faults without those that only follow from others."""
    misspelt = {(*fault["loc"][:-1], name) for fault in faults if fault["type"] == "extra_forbidden"
                for name in meant(fault["loc"][-1], _fields(fault["loc"]))}
    return [fault for fault in faults if not (
        # a list whose items are faulty also counts as too short
        fault["type"] == "too_short" and any(f["loc"][:len(fault["loc"])] == fault["loc"] and f is not fault for f in faults)
        or fault["type"] == "missing" and fault["loc"] in misspelt)]


def _fields(loc: tuple[str | int, ...]) -> set[str]:
    """The fields that there could be where a fault is."""
    tables = [Scenario]
    for part in loc[:-1]:
        inner = [one for table in tables for name, field in table.model_fields.items() if (field.alias or name) == part
                 for one in tables_of(field.annotation)]
        tables = inner or tables  # a list's number leads nowhere else
    return {field.alias or name for table in tables for name, field in table.model_fields.items()}


def _instead(loc: tuple[str | int, ...]) -> str:
    """What was meant by a field that there is not where a fault is; else in which tables there is one, or what there is instead."""
    name, known = str(loc[-1]), _fields(loc)
    tables, homes = [("", Scenario)], []
    while tables:
        path, table = tables.pop(0)
        inner = [(field.alias or own, one) for own, field in table.model_fields.items() for one in tables_of(field.annotation)]
        tables += [(f"{path}.{own}".strip("."), one) for own, one in inner]
        if path and name in {field.alias or own for own, field in table.model_fields.items()}:
            homes.append(path)
    near = did_you_mean(name, known)
    if near and len(name) > 2 or not homes:
        return near if len(name) > 2 and near else f"; there are {', '.join(sorted(known))}"
    return f"; it goes into {' or '.join(dict.fromkeys(homes))}"


def tables_of(annotation: object) -> list[type[Table]]:
    """The tables that a field may hold."""
    if isinstance(annotation, type) and issubclass(annotation, Table):
        return [annotation]
    return [one for part in get_args(annotation) for one in tables_of(part)]


def _fault(file: File, fault: Mapping[str, Any]) -> str:
    """One line about one fault: file, field, what would be right."""
    where = ""
    for i, part in enumerate(fault["loc"]):
        if part in PROPS and fault["loc"][i - 2:i - 1] == ("props",):
            continue  # which kind of prop it is: no field of the file
        where += f"[{part}]" if isinstance(part, int) else f"{'.' if where else ''}{part}"
    kind, text = fault["type"], fault["msg"].removeprefix("Value error, ")
    if kind == "extra_forbidden":
        text = "there is no such field" + _instead(fault["loc"])
    elif kind == "missing":
        text = "is missing, and needed"
    elif kind == "union_tag_invalid":
        text = f"kind should be one of {', '.join(PROPS)}, got {short(fault['ctx']['tag'])}"
    elif kind in ("too_long", "too_short"):
        low, high = fault["ctx"].get("min_length"), fault["ctx"].get("max_length")
        text = f"needs {f'at least {low}' if high is None else f'{high} at most'}, has {fault['ctx']['actual_length']}: {short(fault['input'])}"
    elif kind == "tuple_type" and isinstance(fault["input"], dict):
        text = f"is a list of tables: each begins with [[{_UNCOUNTED.sub('', where)}]], or stands in braces in a list"
    elif kind in ("model_type", "model_attributes_type", "dict_type"):
        text = f"needs a table, {{ name = value, … }}, got {short(fault['input'])}"
    elif kind not in ("value_error",):
        text = f"{text[0].lower()}{text[1:]}, got {short(fault['input'])}".replace("tuple", "list", 1)
    return f"{file}: {where + ': ' if where else ''}{text}"
