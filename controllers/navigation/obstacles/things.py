"""What stands about, and what it says of itself.

Anything with a box's centre, full size and heading, or a pillar's foot, radius and height, stands in
the way; anything else stops nobody.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Protocol, TypeGuard

import numpy as np

STEP = 0.21
"""No higher step is taken without a jump [m], by nobody who is no taller than the standard body …"""
REACHES = 0.298
"""… nor than this in the standard body's size: the highest that legs take (`passing.STEP`), a hair less. Of a child of 1.2 m it is 0.206 m, of one of 1.0 m 0.171 m."""
STEEPEST = 0.7
"""A ramp that rises by more metres a metre is not walked on: it is met like a block as high as it rises."""


class Box(Protocol):
    """A solid box: centre [m], full size [m], heading [rad]; it may rise along its own z by its `slope`, a ramp."""

    @property
    def centre(self) -> Sequence[float] | np.ndarray: ...
    @property
    def size(self) -> Sequence[float] | np.ndarray: ...
    @property
    def heading(self) -> float: ...


class Pillar(Protocol):
    """A solid upright cylinder: the middle of its foot, radius and height [m]."""

    @property
    def foot(self) -> Sequence[float] | np.ndarray: ...
    @property
    def radius(self) -> float: ...
    @property
    def height(self) -> float: ...


def highest_step(size: float = 1.0) -> float:
    """The highest step of a body so many times as large as the standard one, in the standard body's size [m]: a small one steps as high as others, as far as its legs let it."""
    return max(STEP, min(STEP / size, REACHES))


def step_among(around: Sequence[Any]) -> float:
    """The highest step [m] of who walks among things: the standard body's, unless they are those of a smaller world, which says it by its `step`."""
    return getattr(around, "step", STEP)


def is_box(thing: Any) -> TypeGuard[Box]:
    """Whether a thing stands in the way as a box."""
    return hasattr(thing, "size")


def slope(box: Box) -> float:
    """How a box rises along its own z, metres a metre; level where it does not say so."""
    return getattr(box, "slope", 0.0)


def ramp(box: Box) -> bool:
    """Whether a box is walked on though it rises."""
    return 0.0 < abs(slope(box)) <= STEEPEST


def span(box: Box) -> tuple[float, float]:
    """How low and how high [m] a box reaches that is no ramp to be walked on."""
    tall = box.size[1] + (0.0 if ramp(box) else abs(slope(box)) * box.size[2])
    return box.centre[1] - 0.5 * tall, box.centre[1] + 0.5 * tall


def is_pillar(thing: Any) -> TypeGuard[Pillar]:
    """Whether a thing stands in the way as a pillar."""
    return hasattr(thing, "foot")


def checked(around: Sequence[Any]) -> None:
    """Nothing, where all that stands about is sound. ValueError, naming the first thing that is not and what it lacks."""
    for thing in around:
        fields = (("centre", (3,)), ("size", (3,)), ("heading", ())) if is_box(thing) else (
            ("foot", (3,)), ("radius", ()), ("height", ())) if is_pillar(thing) else ()
        for name, shape in fields:
            try:
                value = np.asarray(getattr(thing, name), float)
                sound = value.shape == shape and np.isfinite(value).all() and not (name in ("size", "radius", "height") and (value < 0.0).any())
            except (AttributeError, TypeError, ValueError):
                sound = False
            if not sound:
                wanted = "one number" if not shape else "three numbers"
                least = ", 0 or more" if name in ("size", "radius", "height") else ""
                raise ValueError(f"around: the {name} of what stands about is {wanted}{least}; got {getattr(thing, name, 'none')!r} in {thing!r}")
        if is_box(thing) and not math.isfinite(slope(thing)):
            raise ValueError(f"around: the slope of a ramp is metres a metre, finite; got {slope(thing)!r} in {thing!r}")


def changed(before: Sequence[Any], after: Sequence[Any], least: float = 0.0) -> list[Any]:
    """What stands elsewhere than before, as it stood and as it stands, by more than `least` [m]; what came and what went."""
    was, now = ([_numbers(thing) for thing in things] for things in (before, after))
    found: list[Any] = []
    for k in range(max(len(was), len(now))):
        one, other = was[k] if k < len(was) else None, now[k] if k < len(now) else None
        if one == other or one is not None and other is not None and len(one) == len(other) and one[3:] == other[3:] and math.dist(one[:3], other[:3]) <= least:
            continue
        found += [things[k] for things, there in ((before, one), (after, other)) if there]
    return found


def _numbers(thing: Any) -> tuple[float, ...]:
    """What tells a thing from others, its place first, whatever its numbers are held in; empty of what stops nobody."""
    if is_box(thing):
        return (*map(float, thing.centre), *map(float, thing.size), float(thing.heading), float(slope(thing)))
    return (*map(float, thing.foot), float(thing.radius), float(thing.height)) if is_pillar(thing) else ()
