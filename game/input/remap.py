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

from ..files import did_you_mean, toml
from .bindings import DEFAULT, Binding, Bindings, Mouse, Sticks
from .key_names import KINDS

FILE = "bindings.toml"
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

OPPOSITE = ({"forward", "back"}, {"left", "right"}, {"turn_left", "turn_right"}, {"scrub_back", "scrub_on"})
"""Actions that undo each other."""


class BindingsError(ValueError):
    """A bindings file that cannot be used; the message names file, action and key, a line for each fault."""


def user_file(environment: Mapping[str, str] = os.environ, system: str = sys.platform) -> Path:
    """Where a user's own bindings lie on this system; the file need not be there."""
    home = Path(os.path.expanduser("~"))  # where somebody has none, it is no folder
    if system == "win32":
        folder = Path(environment.get("APPDATA") or home / "AppData" / "Roaming")
    elif system == "darwin":
        folder = home / "Library" / "Application Support"
    else:
        folder = Path(environment.get("XDG_CONFIG_HOME") or "")
        if not folder.is_absolute():  # as the XDG specification wants it
            folder = home / ".config"
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
    from .remap_table import TableError, checked  # slow to load, for those only who have a file

    try:
        table = checked(tables)
    except TableError as error:
        raise BindingsError("\n".join(f"{file}: {fault}" for fault in error.faults)) from None
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

    Two things that last while it is held may share it, unless one undoes the other. blamed: the actions to name first.
    """
    return [f"{kind}.{row.action}: {name} already does {other.action!r}; choose another, or give {other.action} another"
            for name, row, other in _twice(bindings, kind, blamed) if not _go_together(row, other)]


def shared(bindings: Bindings) -> list[str]:
    """A line for each key (or button) that does two things while it is held, which may be meant, or be a slip."""
    return [f"{kind}.{other.action} and {kind}.{row.action} share {name}: it does both"
            for kind in KINDS for name, row, other in _twice(bindings, kind) if _go_together(row, other)]


def as_toml(bindings: Bindings) -> str:
    """The whole table as a file that `load` reads."""
    lines = [HEAD.format(place=user_file())]
    for kind in KINDS:
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


def _twice(bindings: Bindings, kind: str, blamed: Iterable[str] = ()) -> Iterable[tuple[str, Binding, Binding]]:
    """Each key (or button) of a row that is another row's, too, in the same mode; the other one before it. blamed: actions that come last."""
    blamed, seen = set(blamed), {}
    for row in sorted(bindings, key=lambda row: row.action in blamed):
        for name in dict.fromkeys(getattr(row, kind)):
            other = seen.setdefault((name, row.mode), row)
            if other is not row:
                yield name, row, other


def _go_together(one: Binding, other: Binding) -> bool:
    """Whether a key may do both."""
    return one.held and other.held and {one.action, other.action} not in OPPOSITE


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
