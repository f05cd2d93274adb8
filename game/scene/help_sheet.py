"""The help sheet as plain data: tables of text, and gauges that show what the hands do right now."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    """A line of a table; lit while what it tells of is being done. A title stands alone over its lines."""

    cells: tuple[str, ...]
    lit: bool = False
    title: bool = False


@dataclass(frozen=True)
class Dial:
    """A stick. at: where it is, x to the right, y up, −1 … 1. dead_zone, full: radii, 0 … 1."""

    at: tuple[float, float]
    dead_zone: float
    full: float


@dataclass(frozen=True)
class Bar:
    """A trigger: how far it is pulled, 0 … 1."""

    label: str
    filled: float


@dataclass(frozen=True)
class Lamp:
    """A button, lit while it is down."""

    label: str
    lit: bool


@dataclass(frozen=True)
class Pad:
    """One gamepad: what it is and whom it drives, its sticks, its triggers, rows of its buttons."""

    caption: str
    dials: tuple[Dial, ...]
    bars: tuple[Bar, ...]
    lamps: tuple[tuple[Lamp, ...], ...]


@dataclass(frozen=True)
class Sheet:
    """A sheet in the middle of the picture. tables: side by side, their columns aligned. pads: under them.

    note: a line under all, such as that there is no pad. page: which is open where a picture is too small for all, counted round.
    """

    title: str
    tables: tuple[tuple[Row, ...], ...]
    pads: tuple[Pad, ...] = ()
    note: str = ""
    page: int = 0
