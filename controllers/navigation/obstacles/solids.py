"""What stands about as kernels here take it: a table for all of it, made once of what can't change.

Things are anybody's objects, which may be moved between two steps; only of a tuple of frozen things is a table kept.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import fields, is_dataclass
from functools import lru_cache
from typing import Any, NamedTuple, TypeVar

import numpy as np

from .things import checked, is_box, is_pillar, slope

Made = TypeVar("Made")
KEPT = 64
"""Of so many tuples of things tables are kept."""
PLAIN = (int, float, str, bool, type(None))
"""What can't change in itself."""


class Solids(NamedTuple):
    """boxes: (B, 9) centre, full size [m], cosine and sine of the heading, slope. pillars: (P, 5) foot, radius, height [m]."""

    boxes: np.ndarray
    pillars: np.ndarray


class _Same:
    """Things that are the same where they are one and the same tuple."""

    __slots__ = ("things",)

    def __init__(self, things: tuple[Any, ...]):
        self.things = things

    def __hash__(self) -> int:
        return id(self.things)

    def __eq__(self, other: Any) -> bool:
        return self.things is other.things


def of_the_same(make: Callable[[Sequence[Any]], Made]) -> Callable[[Sequence[Any]], Made]:
    """Decorate what makes something of things alone: it is made once for each tuple of things that can't change. What is made is shared, and not to be written to.
    What things lack for it is a ValueError that names it, see `checked`."""

    def told(around: Sequence[Any]) -> Made:
        try:
            return make(around)
        except (AttributeError, IndexError, TypeError, ValueError):
            checked(around)
            raise

    @lru_cache(KEPT)
    def kept(same: _Same) -> Made | None:
        return told(same.things) if all(map(_frozen, same.things)) else None

    def made(around: Sequence[Any]) -> Made:
        found = kept(_Same(around)) if type(around) is tuple else None
        return told(around) if found is None else found

    made.__doc__, made.__name__ = make.__doc__, make.__name__
    return made


def _frozen(thing: Any) -> bool:
    """Whether nothing that a thing holds can change: a number, a name, a tuple or a frozen dataclass of such."""
    if isinstance(thing, PLAIN):
        return True
    if isinstance(thing, tuple):
        return all(map(_frozen, thing))
    return is_dataclass(thing) and type(thing).__dataclass_params__.frozen and all(_frozen(getattr(thing, one.name)) for one in fields(thing))  # type: ignore[attr-defined]


@of_the_same
def solids_of(around: Sequence[Any]) -> Solids:
    """The boxes and pillars among things."""
    boxes = [(*one.centre, *one.size, math.cos(one.heading), math.sin(one.heading), slope(one)) for one in around if is_box(one)]
    pillars = [(*one.foot, one.radius, one.height) for one in around if is_pillar(one) and not is_box(one)]
    return Solids(np.array(boxes, float).reshape(-1, 9), np.array(pillars, float).reshape(-1, 5))
