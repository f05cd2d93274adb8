"""Queues: who comes to a door waits until those before him are through, and until nobody comes out of it.

Avoidance alone knows nothing of doors: crowds press into them and jam. Here a door is a gap between two things that is about as deep as a wall
is thick. Whoever heads for one slows down so that no more wait near it than have room there, and who comes from the side that nobody is passing from
leaves the way out free.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ..routes import separation, shapes_of

NARROW, WIDE = 0.5, 2.4
"""Doors are so wide, at least and at most [m] ..."""
DEEP = 1.0
"""... and so deep at most [m]."""
FAR = 12.0
"""Nobody farther from a door minds it [m]."""
THROUGH = 0.5
"""Whose way leads past a door no farther than this [m] goes through it."""
DENSE = 1.2
"""So many people stand on a square metre before a door, and no more."""
EASE = 0.6
"""Over so long a way [m] people slow down behind those who wait."""
SLIPS, FREE = 0.62, 1.6
"""One goes on for each such width of a door [m], however many are there; the others stay so far from it [m], lest they press into it from all sides."""
ABREAST, BEHIND = 0.9, 0.3
"""People go through a door abreast if it has such a width [m] for each; who goes on behind another keeps at least so far farther from it [m]."""
KEPT = 1.5
"""Those who let others out stay so far from the door [m] ..."""
LANE = 0.5
"""... and so far beside its opening [m], ..."""
LONG = 5.0
"""... as far as so long a way before it [m]."""
ASIDE = 0.6
"""How fast they step aside [m/s]."""
OUT = 1.2
"""Who is no farther than this beyond a door [m] still comes out of it."""
WITHIN = 0.7
"""Who is so near to a door [m] when it is the others' turn goes through it all the same."""
FOLLOWS = 2.0
"""Whoever is no farther from the door [m] follows those before him."""
CLEARS = 5.0
"""For so long [s], at most, those whose turn begins wait until the others are out."""
WAITS, PATIENCE = 4.0, 14.0
"""Who is so near to a door [m] waits for his turn, for so long [s]; then the others let him."""


class Door(NamedTuple):
    """A gap in a wall. middle: (2,) [m]. along: (2,) from post to post. half: of its width [m]."""

    middle: np.ndarray
    along: np.ndarray
    half: float

    def seen(self, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Places (..., 2) as a door has them: along it, and before (below 0) or beyond it [m]."""
        off = np.asarray(places, float) - self.middle
        return off @ self.along, off @ np.array([-self.along[1], self.along[0]])


def doors_of(around: Sequence[Any]) -> tuple[Door, ...]:
    """The doors among things."""
    return _doors(shapes_of(around).tobytes())


@lru_cache(maxsize=8)
def _doors(table: bytes) -> tuple[Door, ...]:
    shapes, found = np.frombuffer(table).reshape(-1, 6), []
    corners = [_corners(shape) for shape in shapes]
    for i in range(len(shapes)):
        for j in range(i):
            if shapes[i, 5] > 0.0 and shapes[j, 5] > 0.0:
                continue  # between two pillars is no wall
            one, other = _nearest(corners[i], shapes[j]), _nearest(corners[j], shapes[i])
            (a, b), depth = (one[:2], one[2]) if one[2] <= other[2] else (other[:2][::-1], other[2])
            width = depth - shapes[i, 5] - shapes[j, 5]
            if not NARROW <= width <= WIDE:
                continue
            along = (b - a) / depth
            across = np.array([-along[1], along[0]])
            spans = [np.sort(corners[k] @ across)[[0, -1]] + shapes[k, 5] * np.array([-1.0, 1.0]) for k in (i, j)]
            low, high = max(span[0] for span in spans), min(span[1] for span in spans)
            if high - low > DEEP:
                continue
            middle = 0.5 * (a + shapes[i, 5] * along + b - shapes[j, 5] * along)
            if high > low:
                middle = middle + (0.5 * (low + high) - middle @ across) * across
            ends = middle - 0.5 * width * along, middle + 0.5 * width * along
            if all(separation(*ends[0], *ends[1], shape) > 0.0 for k, shape in enumerate(shapes) if k not in (i, j)):
                found.append(Door(middle, along, 0.5 * width))
    return tuple(found)


class Turns(NamedTuple):
    """Whose turn it is at each door of D. sides: (D,) -1 for those before it, 1 for those beyond, as `Door.seen` has it; 0 for nobody's yet. waited: (D,)
    for how long those of the other side have waited meanwhile [s], below 0 while the door is left for them to go on."""

    sides: np.ndarray
    waited: np.ndarray


class _Met(NamedTuple):
    """Walkers as a door has them: along it, beyond it [m], on which side, how far off [m] and aside of the opening; who heads for it, who comes out,
    and who would, though others are in his way."""

    along: np.ndarray
    beyond: np.ndarray
    side: np.ndarray
    far: np.ndarray
    aside: np.ndarray
    comes: np.ndarray
    leaving: np.ndarray
    would: np.ndarray

    def first(self, side: float) -> float:
        """How far the next of one side is from the door [m], 0 while some of it come out; inf if nobody comes."""
        return min(np.min(self.far[self.comes & (self.side == side)], initial=np.inf), 0.0 if np.any(self.leaving & (self.side == -side)) else np.inf)

    def within(self, turn: float) -> np.ndarray:
        """Who (N,) is in the door though it is the turn of those on the other side."""
        return self.comes & (self.far < WITHIN) & (self.side != turn)

    def blocked(self, turn: float) -> bool:
        """Whether those whose turn it is wait until it is empty."""
        return bool(np.any(self.within(turn)) or np.any(self.would & (self.side == turn)))

    def nearer(self) -> float:
        """The side that is nearer to it."""
        return -1.0 if self.first(-1.0) <= self.first(1.0) else 1.0


def _met(door: Door, places: np.ndarray, wishes: np.ndarray, aims: np.ndarray, moving: np.ndarray) -> _Met:
    along, beyond = door.seen(places)
    w_along, w_beyond = door.seen(door.middle + wishes)
    a_along, a_beyond = door.seen(aims)
    side = np.where(beyond >= 0.0, 1.0, -1.0)
    towards = side * w_beyond < -1e-6
    at = along - beyond * w_along / np.where(towards, w_beyond, 1.0)
    near = np.hypot(np.maximum(np.abs(a_along) - door.half, 0.0), a_beyond) < THROUGH + 0.2
    aside = np.maximum(np.abs(along) - door.half + 0.3, 0.0)
    far = np.hypot(aside, beyond)
    comes = (far < FAR) & (near | towards & (np.abs(at) < door.half + 0.1) & (side * a_beyond < THROUGH))
    leaving = (np.abs(along) < door.half + LANE) & (np.abs(beyond) < OUT) & ~comes & (side * door.seen(door.middle + moving)[1] > 0.1)
    would = (np.abs(along) < door.half + 0.2) & (np.abs(beyond) < WITHIN) & ~comes & (side * w_beyond > 0.1)
    return _Met(along, beyond, side, far, aside, comes, leaving, would)


def taking_turns(places, wishes, aims, doors: Sequence[Door], going, turns: Turns | None, dt: float) -> Turns:
    """Whose turn it is after a step of dt [s]; arguments as of `queued`, turns: as they were, None at first.

    A side goes on as long as its people follow each other closely, but for no longer than those of the other side are patient, from when it can.
    """
    places, wishes, aims, going = (np.asarray(a, float) for a in (places, wishes, aims, going))
    turns = Turns(np.zeros(len(doors)), np.zeros(len(doors))) if turns is None or len(turns.sides) != len(doors) else turns
    sides, waited = turns.sides.copy(), turns.waited.copy()
    for d, door in enumerate(doors):
        met = _met(door, places, wishes, aims, going)
        follows = met.first(sides[d]) < FOLLOWS if sides[d] else False
        waits = bool(sides[d]) and bool(np.any(met.comes & (met.side == -sides[d]) & (met.far < WAITS)))
        if waited[d] < 0.0:
            waited[d] = min(waited[d] + dt, 0.0) if met.blocked(sides[d]) else 0.0
        else:
            waited[d] = waited[d] + dt if waits else 0.0
        if not follows or waited[d] > PATIENCE:
            sides[d], waited[d] = -sides[d] if follows else met.nearer() if np.any(met.comes) else 0.0, -CLEARS
    return Turns(sides, waited)


def queued(places, wishes, aims, doors: Sequence[Door], going=None, turns: Turns | None = None) -> np.ndarray:
    """Wishes (N, 2) [m/s] of walkers at places (N, 2), slowed down and led aside where they come to doors.

    aims: (N, 2) where each turns to first on his way. going: (N, 2) how they move [m/s], by which those who come out of a door are known; as
    they wish by default. turns: whose turn it is, from `taking_turns`; by default that of the side whose people come out, or are nearer.
    """
    places, found, aims = np.asarray(places, float), np.array(wishes, float), np.asarray(aims, float)
    moving = found if going is None else np.asarray(going, float)
    for d, door in enumerate(doors):
        met = _met(door, places, found, aims, moving)
        first = [met.first(-1.0), met.first(1.0)]
        turn = met.nearer() if turns is None or turns.sides[d] == 0.0 else float(turns.sides[d])
        within, blocked = met.within(turn) & (turns is not None), turns is not None and turns.waited[d] < 0.0 and met.blocked(turn)
        mine = np.flatnonzero(met.comes & (met.side == turn))
        order = np.argsort(met.far[mine] + met.aside[mine], kind="stable")
        rank, abreast = np.argsort(order, kind="stable"), max(int(2.0 * door.half / ABREAST), 1)
        slips = max(round(2.0 * door.half / SLIPS), 1)
        before = np.where(rank < abreast, -np.inf, met.far[mine[order[np.maximum(rank - abreast, 0)]]]) if len(mine) else rank
        room = np.sqrt(FREE**2 + 2.0 * np.maximum(rank - slips, 0) / (np.pi * DENSE))
        if not blocked:
            found[mine] *= np.clip((met.far[mine] - np.where(rank < slips, before + BEHIND, room)) / EASE, 0.0, 1.0)[:, None]
        if not np.isfinite(min(first)):
            continue
        keeps = (met.side != turn) | blocked
        lets = met.comes & keeps & ~within
        if np.any(lets):
            found[lets] *= np.clip((met.far[lets] - KEPT) / EASE, 0.0, 1.0)[:, None]
            lane = (np.abs(met.along) < door.half + LANE) & (np.abs(met.beyond) < LONG) & keeps & ~within & (met.comes | (np.hypot(*found.T) < 0.1))
            if np.isfinite(first[0]) and np.isfinite(first[1]):
                away = np.where(met.along >= 0.0, 1.0, -1.0)[:, None] * door.along
                found[lane] = ASIDE * away[lane]
    return found


def _corners(shape: np.ndarray) -> np.ndarray:
    """The corners (4, 2) of a shape without its rounding."""
    c, s = np.cos(shape[4]), np.sin(shape[4])
    local = np.array([[1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]]) * shape[2:4]
    return local @ np.array([[c, -s], [s, c]]) + shape[:2]


def _nearest(corners: np.ndarray, shape: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Of corners (4, 2) the one nearest to the rectangle of a shape, the place there, and how far it is."""
    c, s = np.cos(shape[4]), np.sin(shape[4])
    off = corners - shape[:2]
    local = np.stack([c * off[:, 0] - s * off[:, 1], s * off[:, 0] + c * off[:, 1]], 1)
    on = np.clip(local, -shape[2:4], shape[2:4])
    far = np.hypot(*(local - on).T)
    k = int(far.argmin())
    return corners[k], on[k] @ np.array([[c, -s], [s, c]]) + shape[:2], float(far[k])
