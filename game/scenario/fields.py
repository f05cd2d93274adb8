"""What the fields of a scenario may hold: sound numbers with their units, points, colours, names."""

from __future__ import annotations

import re
from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, GetPydanticSchema, PlainSerializer, ValidationInfo
from pydantic_core import core_schema

from ..files import frame_rate, plain

NAME = re.compile(r"[\w-]+( [\w-]+)*")


def _signed(most: float) -> Any:
    return Field(ge=-most, le=most, allow_inf_nan=False)


def _positive(most: float) -> Any:
    return Field(gt=0, le=most, allow_inf_nan=False)


def one_of(names: Iterable[str]) -> GetPydanticSchema:
    """One of some names, as `Literal` would have them if they stood in the source."""
    known = list(names)
    return GetPydanticSchema(lambda _source, _handler: core_schema.literal_schema(known))


def _file_name(name: str) -> str:
    if not NAME.fullmatch(name) or len(name) > 40:
        raise ValueError("files are named after it, so it needs letters, digits, - and _, with single spaces "
                         f"between, 40 at most; got {short(name)}")
    return name


# as far, fast and long as anybody can mean it: more is a slip, and numbers stay sound
Metres = Annotated[float, _signed(1e5)]
Length = Annotated[float, _positive(1e5)]  # m
Speed = Annotated[float, _signed(20)]  # m/s
Pace = Annotated[float, Field(ge=0.1, le=20, allow_inf_nan=False)]  # m/s; slower is no walk
Turning = Annotated[float, _signed(20)]  # rad/s
Degrees = Annotated[float, _signed(3600)]
FrameRate = Annotated[Fraction, BeforeValidator(frame_rate), PlainSerializer(plain)]
Seconds = Annotated[float, _positive(3600)]
Moment = Annotated[float, Field(ge=0, le=3600, allow_inf_nan=False)]  # s
Point = tuple[Metres, Metres]
Point3 = tuple[Metres, Metres, Metres]
Place = Annotated[tuple[Metres, ...], Field(min_length=2, max_length=3)]  # x, z on whatever is highest there, or x, y, z
Velocity = tuple[Speed, Turning, Speed]
Share = Annotated[float, Field(ge=0, le=1)]
Colour = tuple[Share, Share, Share]
Gravity = Annotated[float, Field(ge=0.2, le=50, allow_inf_nan=False)]  # m/s²
Stature = Annotated[float, Field(ge=0.5, le=3, allow_inf_nan=False)]  # m, as far as `gambol.controllers.jump.Physique` goes
Mass = Annotated[float, Field(ge=1, le=400, allow_inf_nan=False)]  # kg
Strength = Annotated[float, Field(ge=0.05, le=20, allow_inf_nan=False)]
Flexibility = Annotated[float, Field(ge=0.3, le=2, allow_inf_nan=False)]
Airtime = Annotated[float, Field(ge=0.05, le=10, allow_inf_nan=False)]  # s
FileName = Annotated[str, AfterValidator(_file_name)]


class Table(BaseModel):
    """A table of a scenario: frozen, and with no field that is not known."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=False)


def beside_the_file(name: str, info: ValidationInfo) -> str:
    """The path of a file or a folder that a scenario names: beside the scenario's own, or from where one stands."""
    for path in ((info.context or {}).get("folder", Path()) / name, Path(name)):
        if path.exists():
            return str(path)
    raise ValueError(f"there is no file {name!r} beside the scenario")


def short(value) -> str:
    """A value as it is quoted in an error."""
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "…"
