"""What stands about: how far it is, how high its top lies, and how a walker slides along it.

Anything with a box's centre, full size and heading, or a pillar's foot, radius and height, stands in
the way; anything else stops nobody.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Protocol, TypeGuard

import numpy as np
from numpy.typing import ArrayLike

from ..compiled import kernel

STEP = 0.21
"""No higher step is taken without a jump [m], by nobody who is no taller than the standard body …"""
REACHES = 0.298
"""… nor than this in the standard body's size: the highest that legs take (`passing.STEP`), a hair less. Of a child of 1.2 m it is 0.206 m, of one of 1.0 m 0.171 m."""
STEEPEST = 0.7
"""A ramp that rises by more metres a metre is not walked on: it is met like a block as high as it rises."""
HEAD = 1.9
"""What hangs higher than this over the floor is walked under [m]."""
KNEE = 0.05
"""What stands lower than a step and this beside a walker is in nobody's way [m]."""
SHOULDER = 0.30
"""A walker keeps so far from walls [m] ..."""
DEPTH = 0.25, 0.20
"""... where he faces them, and where they are behind him, so far: what a body takes that side-steps [m] ..."""
CREVICE = 0.25
"""One steps over what is no wider than this [m] ..."""
ASKEW = 0.4
"""... along his way, who comes to it askew."""
EDGES = np.arange(0.01, ASKEW, 0.03)
"""Where its edges are looked for [m]."""
LOOK = 0.75
"""... and looks so far ahead [s]: about what stopping from a run takes."""
PACE = 0.15
"""How far apart the places are that are looked at [m]."""
DEVIATIONS = np.radians([0.0, 25.0, -25.0, 50.0, -50.0, 75.0, -75.0, 88.0, -88.0])
"""The directions that are tried beside the wished one, the nearest first [rad]."""


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


def matters(things: Sequence[Any], here: ArrayLike, there: ArrayLike, way: float) -> bool:
    """Whether any of some things is so near that a way past it from one place (2,) x, z to another could be shorter than `way` [m]."""
    ends = np.array([[here[0], 0.0, here[1]], [there[0], 0.0, there[1]]], float)  # type: ignore[index]
    for thing in things:
        ends[:, 1] = thing.centre[1] if is_box(thing) else thing.foot[1] + 0.5 * thing.height
        if float(np.maximum(gap(ends, thing), 0.0).sum()) < way:
            return True
    return False


def gap(points: np.ndarray, thing: Any) -> np.ndarray:
    """How far points (N, 3) [m] are from a box or a pillar: 0 on its surface, negative inside."""
    out = np.empty(len(points))
    if is_pillar(thing):
        pillar_kernel(np.ascontiguousarray(points, float), np.asarray(thing.foot, float), float(thing.radius), float(thing.height), out)
    elif is_box(thing):
        box_kernel(np.ascontiguousarray(points, float), np.asarray(thing.centre, float), np.asarray(thing.size, float),
                   float(thing.heading), float(slope(thing)), out)
    else:  # a goal stops nobody
        out[:] = np.inf
    return out


@kernel
def pillar_kernel(points, foot, radius, height, out):
    """Write how far points (N, 3) are from an upright cylinder, see `gap`."""
    for n in range(len(points)):
        aside = math.hypot(points[n, 0] - foot[0], points[n, 2] - foot[2]) - radius
        along = abs(points[n, 1] - foot[1] - 0.5 * height) - 0.5 * height
        out[n] = math.hypot(max(aside, 0.0), max(along, 0.0)) + min(max(aside, along), 0.0)


@kernel
def box_kernel(points, centre, size, heading, slope, out):
    """Write how far points (N, 3) are from a box, see `gap`."""
    c, s = math.cos(heading), math.sin(heading)
    for n in range(len(points)):
        dx, dy, dz = points[n, 0] - centre[0], points[n, 1] - centre[1], points[n, 2] - centre[2]
        x, z = c * dx - s * dz, s * dx + c * dz
        x, y, z = abs(x) - 0.5 * size[0], abs(dy - slope * z) - 0.5 * size[1], abs(z) - 0.5 * size[2]
        outside = math.sqrt(max(x, 0.0) ** 2 + max(y, 0.0) ** 2 + max(z, 0.0) ** 2)
        out[n] = outside + min(max(x, y, z), 0.0)


def floor_at(x: float, z: float, around: Sequence[Any], below: float = np.inf) -> float:
    """The height [m] of the highest box or the floor at a place, no higher than `below`."""
    return _ground_at(x, z, around, below)[0]


def slope_at(x: float, z: float, around: Sequence[Any], below: float = np.inf) -> np.ndarray:
    """How (2,) the highest box or the floor at a place rises along x and z [m/m], if it is no higher there than `below` [m]."""
    thing = _ground_at(x, z, around, below)[1]
    return np.zeros(2) if thing is None else slope(thing) * np.array([np.sin(thing.heading), np.cos(thing.heading)])


def _ground_at(x: float, z: float, around: Sequence[Any], below: float) -> tuple[float, Any]:
    """The height [m] of the highest box or the floor at a place, no higher than `below`, and which box that is, if it is one."""
    height, highest = 0.0, None
    for thing in around:
        if is_box(thing):
            c, s = np.cos(thing.heading), np.sin(thing.heading)
            dx, dz = x - thing.centre[0], z - thing.centre[2]
            along = s * dx + c * dz
            top = thing.centre[1] + 0.5 * thing.size[1] + slope(thing) * along
            if (abs(c * dx - s * dz) <= 0.5 * thing.size[0] and abs(along) <= 0.5 * thing.size[2]
                    and height < top <= below):
                height, highest = top, thing
    return height, highest


def slide(place: ArrayLike, velocity: ArrayLike, floor: float, around: Sequence[Any], agile: float = 1.0) -> np.ndarray:
    """The velocity (2,) along x and z [m/s] nearest to the wished one that runs into nothing and over no edge.

    place: (2,) x, z [m]. velocity: (2,) wished. floor: how high the walker stands [m]. A walker that
    finds no way stops, who is `agile` times as agile as people so much sooner; one that came too near to something, as its own speed carried it, may only leave.
    """
    place, velocity = np.asarray(place, float), np.asarray(velocity, float)
    speed = float(np.hypot(*velocity))
    if speed < 1e-6 or not len(around):
        return velocity
    left = room(place, floor, around, velocity)
    # as far as it takes to stop, looked at step by step, lest a thin wall be missed
    ahead = np.arange(1, 2 + int(max(LOOK * speed / agile, 0.25) / PACE)) * PACE / speed
    for turn in DEVIATIONS:
        c, s = np.cos(turn), np.sin(turn)
        tried = c * np.array([c * velocity[0] + s * velocity[1], -s * velocity[0] + c * velocity[1]])
        if _free(place, tried, ahead, floor, around) if left > 0.0 else room(place + tried * ahead[0], floor, around, tried) > left:
            return tried
    return np.zeros(2)


def _free(place: np.ndarray, velocity: np.ndarray, ahead: np.ndarray, floor: float, around: Sequence[Any]) -> bool:
    """Whether there is room wherever one comes in the times ahead [s], going up and down steps and ramps as they come."""
    for later in ahead:
        there = place + velocity * later
        if room(there, floor, around, velocity) <= 0.0:
            return False
        below = floor_at(there[0], there[1], around, floor + STEP)
        floor = below if floor - below <= STEP else floor  # over a crevice
    return True


def room(place: np.ndarray, floor: float, around: Sequence[Any], way: np.ndarray | None = None) -> float:
    """How much room a walker has left at a place (2,) x, z [m] on a floor so high [m]: [m], negative where a wall is too near, or the floor does not go on.

    way: (2,) where he goes, who steps over crevices.
    """
    here = floor_at(place[0], place[1], around, floor + STEP)
    if abs(here - floor) > STEP:
        if way is None or not over_crevice(place, way, floor, around):
            return -SHOULDER
        here = floor
    body = np.array([[place[0], here + height, place[1]] for height in (STEP + SHOULDER + KNEE, 1.0, HEAD - SHOULDER)])
    return min(gap(body, thing).min() for thing in around) - SHOULDER


def over_crevice(place: np.ndarray, way: np.ndarray, floor: float, around: Sequence[Any]) -> bool:
    """Whether what lies lower than the floor [m] at a place (2,) is so narrow, along the way (2,), that one steps over it."""
    ahead = way / max(float(np.hypot(*way)), 1e-9)
    wide = 0.0
    for along in (ahead, -ahead):
        places = place + EDGES[:, None] * along
        stands = (far for far, (x, z) in zip(EDGES, places) if abs(floor_at(x, z, around, floor + STEP) - floor) <= STEP)
        wide += next(stands, np.inf)
    return wide <= ASKEW
