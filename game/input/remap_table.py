"""What a bindings file may say, checked field by field."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, model_validator

from .bindings import Mouse, Sticks
from .key_names import KINDS


class TableError(ValueError):
    """A bindings file of another form. faults: a line for each, that names the field."""

    def __init__(self, faults: list[str]):
        super().__init__("; ".join(faults))
        self.faults = faults


def _names(value: Any) -> Any:
    """One name is a list of one; small letters are as good as capitals."""
    value = [value] if isinstance(value, str) else value
    return [v.strip().upper().removeprefix("KEY_") if isinstance(v, str) else v for v in value] \
        if isinstance(value, list) else value


Names = Annotated[tuple[str, ...], BeforeValidator(_names)]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


class _SticksTable(_Table):
    walk: Literal["left", "right"] = Sticks.walk
    dead_zone: Annotated[float, Field(ge=0, lt=0.9)] = Sticks.dead_zone
    full: Annotated[float, Field(gt=0, le=1)] = Sticks.full
    curve: Annotated[float, Field(ge=0.25, le=4)] = Sticks.curve
    trigger_dead_zone: Annotated[float, Field(ge=0, lt=0.9)] = Sticks.trigger_dead_zone
    invert_x: bool = Sticks.invert_x
    invert_y: bool = Sticks.invert_y

    @model_validator(mode="after")
    def _in_order(self):
        for name in ("dead_zone", "trigger_dead_zone"):
            if not getattr(self, name) < self.full:
                raise ValueError(f"{name} = {getattr(self, name):g} needs to be less than full = {self.full:g}")
        return self


class _MouseTable(_Table):
    turn: Annotated[float, Field(ge=0.1, le=50)] = Mouse.turn
    invert_x: bool = Mouse.invert_x
    invert_y: bool = Mouse.invert_y


class Table(_Table):
    """A bindings file: what it gives anew."""

    keys: dict[str, Annotated[Names, Field(strict=False)]] = {}
    buttons: dict[str, Annotated[Names, Field(strict=False)]] = {}
    sticks: _SticksTable = _SticksTable()
    mouse: _MouseTable = _MouseTable()


def checked(tables: Mapping[str, Any]) -> Table:
    """The tables of a file as they should be; TableError otherwise."""
    try:
        return Table.model_validate(tables)
    except ValidationError as error:
        raise TableError([_fault(fault) for fault in error.errors()]) from None


def _fault(fault: Mapping[str, Any]) -> str:
    """One line about one fault of type: field, what would be right."""
    where = ".".join(str(part) for part in fault["loc"] if not isinstance(part, int))
    text = fault["msg"].removeprefix("Value error, ")
    if fault["type"] == "extra_forbidden":
        tables = {"": Table, "sticks": _SticksTable, "mouse": _MouseTable}
        text = "unknown; choose from " + ", ".join(tables[".".join(map(str, fault["loc"][:-1]))].model_fields)
    elif len(fault["loc"]) == 1 and fault["type"] != "value_error":
        text = f"needs to be a table, [{where}]"
    elif fault["loc"][0] in KINDS:
        text = f'needs names of {fault["loc"][0]} in quotes, such as ["W", "UP"]'
    return f"{where}: {text[0].lower() + text[1:]}"
