"""What can be stood on, and how far feet get on it.

The floor and the tops of boxes are surfaces. Two are one region where one steps from the one onto the other: over kerbs and crevices, up stairs,
onto ramps. Where the ground falls off by more than a step, a region ends, and a rail says so to whoever plans a walk.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np

from ..obstacles import ASKEW, CREVICE, HEAD, STEP, is_box, is_pillar, ramp, slope, span, step_among
from ..routes import THIN

OUTLINE = 0.1
"""How far apart the places are at which a box's sides are looked at [m]."""
BESIDE = 0.03
"""So far within and without a side the ground is looked at [m]."""
DOORSTEP = 4
"""At so many such places two surfaces meet, at least, where one steps over."""
TALL = 1e3
"""A rail is so high [m]: it counts whatever floor it is seen from."""


class Rail(NamedTuple):
    """What stops a walker, as a box: the end of the ground, or a box that is too high to step onto."""

    centre: tuple[float, float, float]
    size: tuple[float, float, float]
    heading: float


class Post(NamedTuple):
    """What stops a walker, as a pillar."""

    foot: tuple[float, float, float]
    radius: float
    height: float


class Outline(NamedTuple):
    """Places (S, 2) along the sides of a box, the sides' outward normals (S, 2), the side that each is on, and how far apart they are (S,) [m]."""

    places: np.ndarray
    normals: np.ndarray
    sides: np.ndarray
    apart: np.ndarray


class Levels:
    """The surfaces among things: those of B boxes by their number, and the floor, by B.

    table: (B, 8) of boxes: centre, size [m], heading [rad], slope. pillars: (P, 5): foot, radius, height [m]. step: the highest that is taken [m].
    """

    def __init__(self, table: np.ndarray, pillars: np.ndarray, step: float = STEP):
        self.pillars, self.step = pillars, step
        self.centres, self.halves, self.headings, self.slopes = table[:, :3], 0.5 * table[:, 3:6], table[:, 6], table[:, 7]
        self.floor = len(table)

    def local(self, places: np.ndarray) -> np.ndarray:
        """Places (P, 2) as each box has them (P, B, 2): along its width and its length."""
        c, s = np.cos(self.headings), np.sin(self.headings)
        dx, dz = (places[:, None, k] - self.centres[None, :, 2 * k] for k in (0, 1))
        return np.stack([c * dx - s * dz, s * dx + c * dz], -1)

    def tops(self, places: np.ndarray) -> np.ndarray:
        """How high the tops of all boxes lie at places (P, 2), and the floor: (P, B + 1) [m], -inf beside a box."""
        local = self.local(places)
        over = np.all(np.abs(local) <= self.halves[:, [0, 2]] + 1e-9, -1)
        high = self.centres[:, 1] + self.halves[:, 1] + self.slopes * local[..., 1]
        return np.column_stack([np.where(over, high, -np.inf), np.zeros(len(places))])

    def ground(self, places: np.ndarray, below: np.ndarray | float = np.inf) -> tuple[np.ndarray, np.ndarray]:
        """What is highest at places (P, 2), no higher than `below` (P,) [m]: which surfaces (P,), and how high (P,)."""
        tops = self.tops(places)
        tops = np.where(tops <= np.broadcast_to(below, len(places))[:, None] + 1e-9, tops, -np.inf)
        tops[:, -1] = 0.0
        which = self.floor - tops[:, ::-1].argmax(1)  # the floor where a box is no higher
        return which, tops[np.arange(len(places)), which]

    def floors(self, places: np.ndarray, floor: float) -> np.ndarray:
        """How high (P,) [m] somebody stands at one place (P, 2) after the other, who begins on a floor so high [m] and takes no higher step."""
        places, heights, brink = np.asarray(places, float), [], 0
        for k, row in enumerate(self.tops(places)):
            before, floor = floor, float(row[row <= floor + self.step].max(initial=0.0))
            if floor < before - self.step:
                brink = k  # where he comes down to something, or to a crevice
            elif brink and math.dist(places[k], places[brink - 1]) < ASKEW:
                beyond = float(row[row <= heights[brink - 1] + self.step].max(initial=0.0))
                if beyond >= heights[brink - 1] - self.step:
                    floor, heights[brink:], brink = beyond, [heights[brink - 1]] * (k - brink), 0
            heights.append(floor)
        return np.array(heights)

    def shut(self, places: np.ndarray, heights: np.ndarray, room: float = 0.0) -> np.ndarray:
        """Whether something stands or hangs over places (P, 2) on ground of heights (P,), or so near to them [m], that lets nobody stand there."""
        local, half = self.local(places), self.halves[:, [0, 2]]
        over = np.clip(local, -half, half)
        tops = self.centres[:, 1] + self.halves[:, 1] + self.slopes * over[..., 1]
        near = np.linalg.norm(local - over, axis=-1) <= room + 1e-9
        shut = np.any(near & (tops > heights[:, None] + self.step) & (tops - 2.0 * self.halves[:, 1] < heights[:, None] + HEAD), 1)
        for one in self.pillars:
            near = np.hypot(places[:, 0] - one[0], places[:, 1] - one[2]) <= one[3] + room
            shut |= near & (one[1] < heights + HEAD) & (one[1] + one[4] > heights + self.step)
        return shut

    def outline(self, box: int, inset: float = 0.0, apart: float = OUTLINE) -> Outline:
        """The sides of a box, moved in by an inset [m], at places no farther apart than this [m]; two at least on each side."""
        c, s = np.cos(self.headings[box]), np.sin(self.headings[box])
        turned = np.array([[c, -s], [s, c]])
        half = np.maximum(self.halves[box, [0, 2]] - inset, 0.0)
        parts: list[list[np.ndarray]] = [[], [], [], []]
        for side, (axis, sign) in enumerate(((0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0))):
            long = 2.0 * half[1 - axis]
            count = max(int(np.ceil(long / apart)), 2)
            local = np.zeros((count, 2))
            local[:, axis], local[:, 1 - axis] = sign * half[axis], ((np.arange(count) + 0.5) / count - 0.5) * long
            normal = np.zeros(2)
            normal[axis] = sign
            for part, value in zip(parts, (local @ turned + self.centres[box, [0, 2]], np.tile(normal @ turned, (count, 1)),
                                           np.full(count, side), np.full(count, long / count))):
                part.append(value)
        return Outline(*(np.concatenate(part) for part in parts))

    @cached_property
    def _sides(self) -> list[tuple[Outline, np.ndarray, np.ndarray]]:
        """For each box its outline, the surface (S,) that one steps onto over it, -1 for none, and whether (S,) the ground ends there."""
        found = []
        for box in range(self.floor):
            out = self.outline(box)
            within, without = out.places - BESIDE * out.normals, out.places + BESIDE * out.normals
            here = self.tops(within)[:, box]
            own = (self.ground(within, here + self.step)[0] == box) & ~self.shut(within, here)
            onto, there = self.ground(without, here + self.step)
            open_ = own & ~self.shut(without, np.maximum(there, here))
            step = open_ & (here - there <= self.step)
            widths = np.arange(2.0 * BESIDE, CREVICE + BESIDE, BESIDE)
            over = (without + widths[:, None, None] * out.normals).reshape(-1, 2)
            beyond, high = self.ground(over, np.tile(here + self.step, len(widths)))
            lands = (abs(np.tile(here, len(widths)) - high) <= self.step) & ~self.shut(over, np.maximum(np.tile(here, len(widths)), high))
            for there, could in zip(beyond.reshape(len(widths), -1), lands.reshape(len(widths), -1)):  # nearest first
                across = open_ & ~step & could
                onto, step = np.where(across, there, onto), step | across
            found.append((out, np.where(step, onto, -1), open_ & ~step))
        return found

    @cached_property
    def regions(self) -> np.ndarray:
        """The region (B + 1,) of every surface, by the number of one of them."""
        region = np.arange(self.floor + 1)
        for box, (_, onto, _) in enumerate(self._sides):
            for other, count in zip(*np.unique(onto[onto >= 0], return_counts=True)):
                if count >= DOORSTEP and region[box] != region[other]:
                    region[region == region[box]] = region[other]
        return region

    def under(self, place: np.ndarray, floor: float) -> int:
        """The surface under somebody at a place (2,), who stands so high [m]."""
        return int(self.ground(np.asarray(place, float)[None], floor + self.step)[0][0])

    def meant(self, place: np.ndarray, region: int) -> int:
        """The surface that a goal (2,) lies on: one of this region, if it has one there that can be stood on; else what is highest there."""
        place = np.asarray(place, float)[None]
        tops = self.tops(place)[0]
        for which in np.argsort(-tops):
            if tops[which] > -np.inf and self.regions[which] == region and not self.shut(place, tops[None, which])[0]:
                return int(which)
        return int(self.ground(place)[0][0])

    def stops(self, region: int) -> tuple[Rail | Post, ...]:
        """What stops somebody who walks in a region: the rails where it ends, and what stands or hangs in it."""
        mine = self.regions == region
        found: list[Rail | Post] = []
        brinks: list[np.ndarray] = []
        for box in range(self.floor):
            if not mine[box]:
                low, high = self.centres[box, 1] + self.halves[box, 1] * np.array([-1.0, 1.0])
                if self._counts(self.centres[box, [0, 2]], low, high, mine):
                    found.append(_rail(self.centres[box, [0, 2]], 2.0 * self.halves[box, [0, 2]], self.headings[box]))
                continue
            out, _, ends = self._sides[box]
            for side in range(4):
                for stretch in _runs(np.flatnonzero(ends & (out.sides == side))):
                    middle, normal = out.places[stretch].mean(0), out.normals[stretch[0]]
                    half = 0.5 * len(stretch) * out.apart[stretch[0]] * np.array([normal[1], -normal[0]])
                    brinks.append(np.array([middle - half, middle + half]))
        for stretch in _joined(brinks):
            along = stretch[1] - stretch[0]
            found.append(_rail(stretch.mean(0), np.array([THIN, np.hypot(*along)]), np.arctan2(*along)))
        for x, y, z, radius, height in self.pillars.tolist():
            if self._counts(np.array([x, z]), y, y + height, mine):
                found.append(Post((x, -TALL, z), radius, 2.0 * TALL))
        return tuple(found)

    def _counts(self, place: np.ndarray, low: float, high: float, mine: np.ndarray) -> bool:
        """Whether what reaches from low to high [m] at a place (2,) is in the way of somebody on these surfaces (B + 1,)."""
        tops = np.where(mine, self.tops(place[None])[0], -np.inf)
        floors = tops[(tops > -np.inf) & (tops <= low + self.step)]
        if not len(floors):  # it stands beside them
            aside = np.maximum(np.abs(self.local(place[None])[0]) - self.halves[:, [0, 2]], 0.0)
            near = np.where(mine[:-1], np.hypot(aside[:, 0], aside[:, 1]), np.inf)
            which = int(near.argmin()) if len(near) else 0
            floors = np.zeros(1) if mine[-1] or not len(near) else (self.centres + self.halves)[which:which + 1, 1]
        return bool(high > floors.max() + self.step and low < floors.max() + HEAD)


def levels_of(around: Sequence[Any]) -> Levels:
    """The levels among boxes and pillars, the same for the same ones."""
    table = [(*box.centre, box.size[0], span(box)[1] - span(box)[0], box.size[2], box.heading, slope(box) if ramp(box) else 0.0) for box in around if is_box(box)]
    return _levels(np.array(table, float).tobytes(), np.array([(*one.foot, one.radius, one.height) for one in around if is_pillar(one)], float).tobytes(), step_among(around))


@lru_cache(maxsize=8)
def _levels(table: bytes, pillars: bytes, step: float) -> Levels:
    return Levels(np.frombuffer(table).reshape(-1, 8), np.frombuffer(pillars).reshape(-1, 5), step)


def _rail(place: np.ndarray, size: np.ndarray, heading: float) -> Rail:
    return Rail((float(place[0]), 0.0, float(place[1])), (float(size[0]), 2.0 * TALL, float(size[1])), float(heading))


def _joined(stretches: list[np.ndarray]) -> list[np.ndarray]:
    """Stretches, each from one place to another (2, 2), those that go on in each other as one: the sides of a flight of stairs."""
    whole: list[np.ndarray] = []
    for stretch in stretches:
        while (k := next((k for k, other in enumerate(whole) if _goes_on(stretch, other) or _goes_on(other, stretch)), None)) is not None:
            other = whole.pop(k)
            stretch = np.array([stretch[0], other[1]] if _goes_on(stretch, other) else [other[0], stretch[1]])
        whole.append(stretch)
    return whole


def _goes_on(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether a stretch (2, 2) goes on straight in another."""
    along, further = one[1] - one[0], other[1] - other[0]
    return bool(np.hypot(*(other[0] - one[1])) < BESIDE and along @ further > 0.999999 * np.hypot(*along) * np.hypot(*further))


def _runs(numbers: np.ndarray) -> list[np.ndarray]:
    """Numbers that follow each other, together."""
    return [run for run in np.split(numbers, np.flatnonzero(np.diff(numbers) > 1) + 1) if len(run)]
