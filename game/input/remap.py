"""Other keys and buttons from a TOML file, checked name by name, and the table in force as such a file.

A file names only what is to change. [keys] and [buttons] give an action's keys and buttons anew,
an empty list none; [sticks] and [mouse] are the fields of `Sticks` and `Mouse`.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Mapping
from dataclasses import fields, replace
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, model_validator

from ..files import did_you_mean, toml
from .bindings import DEFAULT, Binding, Bindings, Mouse, Sticks
from .key_names import BUTTONS, KEYS

FILE = "bindings.toml"
KINDS = {"keys": KEYS, "buttons": BUTTONS}
HEAD = """\
# Gambol's keys, buttons, sticks and mouse. Leave out what is to stay as it is; [] unbinds.
# Read with `gambol play --bindings FILE`, or always if it lies at
#   {place}
# Keys are named by their place on a US keyboard, mouse buttons are LEFT_BUTTON, RIGHT_BUTTON and
# MIDDLE_BUTTON, a pad's are A B X Y LB RB LT RT LS RS BACK START GUIDE UP DOWN LEFT RIGHT.
"""
ABOUT = {
    "walk": 'the stick that walks, "left" or "right"; the other one looks',
    "dead_zone": "where a stick starts to count, as a part of its throw",
    "full": "where it counts in full",
    "curve": "1 is linear, 2 finer near the middle",
    "trigger_dead_zone": "where a trigger starts to count",
    "invert_x": "turn the camera the other way",
    "invert_y": "tilt the camera the other way",
    "turn": "how far a drag over the window's height turns the camera [rad]",
}


class BindingsError(ValueError):
    """A bindings file that cannot be used; the message names file, action and key, a line for each fault."""


def _names(value: Any) -> Any:
    """One name is a list of one; small letters are as good as capitals."""
    value = [value] if isinstance(value, str) else value
    return [v.strip().upper().removeprefix("KEY_") if isinstance(v, str) else v for v in value] \
        if isinstance(value, list) else value


Names = Annotated[tuple[str, ...], BeforeValidator(_names)]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


class _Sticks(_Table):
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


class _Mouse(_Table):
    turn: Annotated[float, Field(ge=0.1, le=50)] = Mouse.turn
    invert_x: bool = Mouse.invert_x
    invert_y: bool = Mouse.invert_y


class _File(_Table):
    keys: dict[str, Annotated[Names, Field(strict=False)]] = {}
    buttons: dict[str, Annotated[Names, Field(strict=False)]] = {}
    sticks: _Sticks = _Sticks()
    mouse: _Mouse = _Mouse()


def user_file(environment: Mapping[str, str] = os.environ, system: str = sys.platform) -> Path:
    """Where a user's own bindings lie on this system; the file need not be there."""
    if system == "win32":
        folder = Path(environment.get("APPDATA") or Path.home() / "AppData" / "Roaming")
    elif system == "darwin":
        folder = Path.home() / "Library" / "Application Support"
    else:
        folder = Path(environment.get("XDG_CONFIG_HOME") or "")
        if not folder.is_absolute():  # as the XDG specification wants it
            folder = Path.home() / ".config"
    return folder / "gambol" / FILE


def load(file: str | Path | None = None) -> Bindings:
    """The bindings of a file; without one the user's own, where there are any, or else the shipped ones.

    BindingsError says what is wrong.
    """
    if file is None:
        file = user_file()
        if not file.exists():
            return DEFAULT
    tables = toml.read(file, BindingsError)
    try:
        table = _File.model_validate(tables)
    except ValidationError as error:
        raise BindingsError("\n".join(_fault(file, fault) for fault in error.errors())) from None
    faults = [*_unknown("keys", table.keys), *_unknown("buttons", table.buttons)]
    if not faults:
        changed = remapped(DEFAULT, table.keys, table.buttons)
        faults = [*clashes(changed, "keys", table.keys), *clashes(changed, "buttons", table.buttons)]
    if faults:
        raise BindingsError("\n".join(f"{file}: {fault}" for fault in faults))
    return replace(changed, sticks=Sticks(**table.sticks.model_dump()), mouse=Mouse(**table.mouse.model_dump()))


def remapped(bindings: Bindings, keys: Mapping[str, tuple[str, ...]], buttons: Mapping[str, tuple[str, ...]]) -> Bindings:
    """The bindings with other keys and buttons for some actions."""
    def anew(row: Binding) -> Binding:
        return replace(row, keys=keys.get(row.action, row.keys), buttons=buttons.get(row.action, row.buttons))
    return replace(bindings, sections=tuple((title, tuple(map(anew, rows))) for title, rows in bindings.sections))


def clashes(bindings: Bindings, kind: str = "keys", blamed: Iterable[str] = ()) -> list[str]:
    """A line for each key (or button) that would do two things at once in one mode.

    Two things that last while it is held may share it. blamed: the actions to name first.
    """
    blamed, faults, seen = set(blamed), [], {}
    for row in sorted(bindings, key=lambda row: row.action in blamed):
        for name in getattr(row, kind):
            other = seen.setdefault((name, row.mode), row)
            if other is not row and not (row.held and other.held):
                faults.append(f"{kind}.{row.action}: {name} already does {other.action!r}; "
                              f"choose another, or give {other.action} another")
    return faults


def as_toml(bindings: Bindings) -> str:
    """The whole table as a file that `load` reads."""
    lines = [HEAD.format(place=user_file())]
    for kind, known in KINDS.items():
        lines.append(f"[{kind}]")
        rows = [row for row in bindings if row.can_have(kind)]
        wide = max(len(row.action) for row in rows)
        told = ""
        for row in rows:
            names = ", ".join(f'"{name}"' for name in getattr(row, kind))
            line = f"{row.action.ljust(wide)} = [{names}]"
            lines.append(f"{line:<48}  # {row.help}" if row.help != told else line)
            told = row.help
        lines.append("")
    for title, table in (("sticks", bindings.sticks), ("mouse", bindings.mouse)):
        lines.append(f"[{title}]")
        for field in fields(table):
            value = getattr(table, field.name)
            text = str(value).lower() if isinstance(value, bool) else f'"{value}"' if isinstance(value, str) else repr(value)
            lines.append(f"{f'{field.name} = {text}':<48}  # {ABOUT[field.name]}")
        lines.append("")
    return "\n".join(lines)


def _unknown(kind: str, table: Mapping[str, tuple[str, ...]]) -> Iterable[str]:
    """A line for each action and each name that there is not."""
    actions, noun = [row.action for row in DEFAULT if row.can_have(kind)], kind.removesuffix("s")
    for action, names in table.items():
        if action not in actions:
            known = any(row.action == action for row in DEFAULT)
            yield f"{kind}.{action}: " + (f"no {noun} can do that" if known else
                                          f"there is no such action{_near(action, actions)}")
            continue
        for name in names:
            if name not in KINDS[kind]:
                yield f"{kind}.{action}: there is no {noun} {name!r}{_near(name, KINDS[kind])}"


def _near(name: str, known: Iterable[str]) -> str:
    """What somebody may have meant, in words."""
    return did_you_mean(name, known) or "; `gambol bindings` shows the names"


def _fault(file: str | Path, fault: Mapping[str, Any]) -> str:
    """One line about one fault of type: file, field, what would be right."""
    where = ".".join(str(part) for part in fault["loc"] if not isinstance(part, int))
    text = fault["msg"].removeprefix("Value error, ")
    if fault["type"] == "extra_forbidden":
        tables = {"": _File, "sticks": _Sticks, "mouse": _Mouse}
        text = "unknown; choose from " + ", ".join(tables[".".join(map(str, fault["loc"][:-1]))].model_fields)
    elif len(fault["loc"]) == 1 and fault["type"] != "value_error":
        text = f"needs to be a table, [{where}]"
    elif fault["loc"][0] in KINDS:
        text = f'needs names of {fault["loc"][0]} in quotes, such as ["W", "UP"]'
    return f"{file}: {where}: {text[0].lower() + text[1:]}"
