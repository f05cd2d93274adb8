"""Which tracker is on which point of the body: as a file says, or as is usual."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ...files import printable, reason, tables
from ..control_points import ControlPoints, parse
from ..pose_vector import SKELETON

USUAL = {"hmd": "head+0/0.09/0.09", "1": "root", "2": "lankle", "3": "rankle"}
"""Which point a tracker is on unless somebody says so: a head-set is in front of the eyes, and VRChat's first three
trackers are waist, left and right foot."""


class StreamError(ValueError):
    """A stream that can't be had, and what would help."""


def controls_of(points: Mapping[str, str]) -> ControlPoints:
    """The control points that trackers are on. StreamError for a point that there is not, or two trackers on one."""
    try:
        controls = parse(",".join(points.values()), SKELETON)
    except ValueError as error:
        raise StreamError(str(error)) from None
    if len(controls) != len(points):
        raise StreamError(f"each tracker is on one point: {', '.join(points.values())}")
    return controls


def read_tables(path: str | Path) -> dict[str, Any]:
    """What a TOML file says. StreamError, naming the file and what is wrong with it, for one that can't be read."""
    try:
        return tables(path)
    except OSError as error:
        raise StreamError(f"{path}: can't be read: {reason(error)}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise StreamError(f"{path}: {error}") from None


def read_map(path: str | Path) -> dict[str, str]:
    """Which point each tracker is on, from a TOML file's table [trackers]: "LHR-1A2B3C4D" = "lwrist".

    StreamError, naming file and field, for anything else.
    """
    path = Path(path)
    table = read_tables(path)
    trackers = table.get("trackers")
    if not isinstance(trackers, dict) or not trackers:
        raise StreamError(f'{path}: needs a table [trackers] with lines such as "LHR-1A2B3C4D" = "lwrist"')
    for serial, point in trackers.items():
        if not isinstance(point, str):
            raise StreamError(f'{path}: trackers.{printable(serial)}: needs a point in quotes, such as "lwrist"')
    try:
        controls_of(trackers)
    except StreamError as error:
        raise StreamError(f"{path}: trackers: {error}") from None
    return trackers


def usual_map(names: Sequence[str] = ()) -> dict[str, str]:
    """Which tracker is on each of some points where nobody says so, see USUAL; the usual four where none is named."""
    usual = {point.partition("+")[0]: (serial, point) for serial, point in USUAL.items()}
    return dict(usual.get(name, (name, name)) for name in names or usual)
