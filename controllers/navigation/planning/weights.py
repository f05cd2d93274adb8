"""The weights of the cost: published ones, fitted ones, and those in files."""

from __future__ import annotations

import math
import tomllib
from os import PathLike

from gambol import assets

from ...files import reason, tables
from .walking_cost import Weights

PUBLISHED = Weights(1.0, 1.2, 1.7, 0.7, 5.2)
"""Those of Mombaur, Truong and Laumond 2010, as the code beside Maroger 2020 has them."""
TABLE = "weights"
"""The table of a file that holds them."""


class WeightsError(ValueError):
    """A file of weights can't be used; the message names it and what is wrong."""


def read_weights(path: str | PathLike[str]) -> Weights:
    """The weights in a TOML file: [weights] with time, forward, turning, lateral and facing, as `gambol navigate fit` writes it.

    WeightsError, naming the file and the field, unless all are there, the first four greater than 0 and the last no less than 0.
    """
    try:
        table = tables(path).get(TABLE)
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise WeightsError(f"{path}: not a file of weights ({reason(error)})") from None
    if not isinstance(table, dict):
        raise WeightsError(f"{path}: has no table [{TABLE}]")
    for name in Weights._fields:
        value = table.get(name)
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value) or value < 0.0 or (
                value == 0.0 and name != "facing"):
            raise WeightsError(f"{path}: {TABLE}.{name} must be a finite number greater than 0, got {value!r}")
    return Weights(*(float(table[name]) for name in Weights._fields))


def in_toml(weights: Weights, notes: str = "") -> str:
    """Weights as the text of a file, notes above them."""
    lines = [f"# {line}".rstrip() for line in notes.splitlines()]
    return "\n".join([*lines, f"[{TABLE}]", *(f"{name} = {value:.6g}" for name, value in weights._asdict().items()), ""])


HUMAN = read_weights(assets.path("navigation", "weights.toml"))
"""Fitted to people's walks; what they are from stands in the file."""
