"""What the fields of a scenario may hold: sound numbers with their units, points, colours, names."""

from __future__ import annotations

import re
from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

NAME = re.compile(r"[\w-]+( [\w-]+)*")


def _signed(most: float):
    return Annotated[float, Field(ge=-most, le=most, allow_inf_nan=False)]


def _positive(most: float):
    return Annotated[float, Field(gt=0, le=most, allow_inf_nan=False)]


def _file_name(name: str) -> str:
    if not NAME.fullmatch(name) or len(name) > 40:
        raise ValueError("files are named after it, so it needs letters, digits, - and _, with single spaces "
                         f"between, 40 at most; got {short(name)}")
    return name


# as far, fast and long as anybody can mean it: more is a slip, and numbers stay sound
Metres, Length = _signed(1e5), _positive(1e5)
Speed, Pace = _signed(20), _positive(20)  # m/s
Turning = _signed(20)  # rad/s
Degrees = _signed(3600)
Seconds = _positive(3600)
Moment = Annotated[float, Field(ge=0, le=3600, allow_inf_nan=False)]  # s
Point = tuple[Metres, Metres]
Point3 = tuple[Metres, Metres, Metres]
Place = Annotated[tuple[Metres, ...], Field(min_length=2, max_length=3)]  # x, z on whatever is highest there, or x, y, z
Velocity = tuple[Speed, Turning, Speed]
Colour = tuple[*(Annotated[float, Field(ge=0, le=1)],) * 3]
Gravity = Annotated[float, Field(ge=0.2, le=50, allow_inf_nan=False)]  # m/s²
Stature = Annotated[float, Field(ge=0.5, le=3, allow_inf_nan=False)]  # m, as far as `gambol.controllers.jump.Physique` goes
Mass = Annotated[float, Field(ge=5, le=400, allow_inf_nan=False)]  # kg
Strength = Annotated[float, Field(ge=0.05, le=20, allow_inf_nan=False)]
Flexibility = Annotated[float, Field(ge=0.3, le=2, allow_inf_nan=False)]
Airtime = Annotated[float, Field(ge=0.05, le=10, allow_inf_nan=False)]  # s
FileName = Annotated[str, AfterValidator(_file_name)]


class Table(BaseModel):
    """A table of a scenario: frozen, and with no field that is not known."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=False)


def short(value) -> str:
    """A value as it is quoted in an error."""
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "…"
