"""What somebody wants of a character: velocities, places, jumps, looks; and what strikes it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from ..body import brief

HARDEST = 1000.0
"""Nobody is struck harder [N·s]: as a car at walking pace would."""
HIGHEST = 1e5
"""No floor is higher or deeper than this [m]: beyond it single precision loses millimetres, and numbers their sense."""
DRIFTS = 0.3
"""A leap to a place that moves is found out about on and on, until the place is so far [m] from where it was at first. Found out about anew whenever it moved,
it never would be."""
LEVER = 1.0
"""A heading to land in that turns counts as a place that moves by so much for each radian [m]."""


def _numbers(name: str, value: Any) -> np.ndarray:
    try:
        return np.asarray(value, float)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: needs numbers, got {value!r}") from None


def _told(value: Any, count: int) -> bool:
    """Whether a value is (..., count) real numbers, which may be NaN."""
    try:
        array = np.asarray(value)
    except (TypeError, ValueError):  # rows of several lengths
        return False
    return array.dtype.kind in "fiu" and array.shape[-1:] == (count,)


def _number(name: str, value: Any) -> float:
    """One number. ValueError for what is none, or several."""
    if _numbers(name, value).shape or value is None:
        raise ValueError(f"{name} is one number, got {value!r}")
    return float(value)


@dataclass(frozen=True, eq=False)
class Leap:
    """A jump that somebody wants. place: (3,) [m] in the world where the middle of the feet should land, or
    None for where it is now: straight up.

    ValueError for what is no number; a place, time or foot that nobody can leap to is for the controller to refuse.
    airtime: [s], or None for the least effort. slack: who can't reach the place may land so far from it [m]: a runner
    who comes too near for it farther on.
    heading: [rad] to land in, turning there the shorter way round and looking where one goes; None to face on as one does.
    on: "left", "right" or "both": lands on that foot, or on both, to hop on from there; None to stand there, or to walk or run on.
    stays: whether who walks lands on both feet, to come to rest; else he walks on, on one. A runner runs on.
    along: whether who walks, however slowly, and aside or backward, too, leaps the way he goes, about as far as that carries him, off one foot onto the other, and
    goes on; there is no place then. Who stands leaps straight up. waited: for so long [s] he has wanted to: the longer, the less well a foot need carry him on.
    how: along which arc it was found that it can be made, see `Controller.found`, which is tried first; None where that was not.
    """

    place: np.ndarray | None
    airtime: float | None = None
    slack: float = 0.0
    heading: float | None = None
    on: Literal["left", "right", "both"] | None = None
    how: Any = None
    stays: bool = False
    along: bool = False
    waited: float = 0.0

    def __post_init__(self):
        if self.place is not None:
            object.__setattr__(self, "place", _numbers("a leap's place", self.place))
        for name in ("airtime", "slack", "heading", "waited"):
            if getattr(self, name) is not None or name in ("slack", "waited"):
                _number(f"a leap's {name}", getattr(self, name))
        if not 0.0 <= self.slack < math.inf:
            raise ValueError(f"a leap's slack must be 0 m or more, got {self.slack!r}")
        if self.along and self.place is not None:
            raise ValueError(f"a leap along the way that one goes has no place, got {self.place!r}")

    def same(self, other: Leap | None) -> bool:
        """Whether another wish is this one."""
        return self._off(other) == 0.0

    def near(self, other: Leap | None, within: float = DRIFTS) -> bool:
        """Whether another wish is this one, to a place that may have moved by less than so much [m] meanwhile, or in a heading that turned."""
        return self._off(other) < within

    def _off(self, other: Leap | None) -> float:
        """How far [m] another wish's place is from this one's, and how far its heading turned; infinite where the wishes differ in anything else, or one is to no place."""
        if other is None or (self.airtime, self.slack, self.on, self.stays, self.along) != (other.airtime, other.slack, other.on, other.stays, other.along):
            return math.inf
        turned = 0.0 if self.heading == other.heading else math.inf
        if turned and self.heading is not None and other.heading is not None and math.isfinite(self.heading - other.heading):
            turned = LEVER * abs(math.remainder(self.heading - other.heading, math.tau))
        if self.place is None or other.place is None:
            return turned if self.place is other.place else math.inf
        if np.array_equal(self.place, other.place):
            return turned
        off = float(np.linalg.norm(self.place - other.place)) if self.place.shape == other.place.shape == (3,) else math.inf
        return off + turned if math.isfinite(off) else math.inf


@dataclass(frozen=True)
class Goal:
    """A place to walk to, and how to stand there.

    place: x, z or x, y, z [m] in the world; a height says only where it is drawn. heading: [rad], or None to look there the way one
    comes. within: so many seconds after it was asked for the way is to end, or None for the pace that people choose.
    ValueError for what is no place, heading or time.
    """

    place: tuple[float, ...]
    heading: float | None = None
    within: float | None = None

    def __post_init__(self):
        place = tuple(_numbers("a goal's place", self.place).ravel().tolist())
        if len(place) not in (2, 3) or not all(abs(value) <= HIGHEST for value in place):
            raise ValueError(f"a goal is x, z or x, y, z within ±{HIGHEST:g} m, got {self.place!r}")
        if self.heading is not None and not math.isfinite(_number("a goal's heading", self.heading)):
            raise ValueError(f"a goal's heading must be finite [rad], or None; got {self.heading!r}")
        if self.within is not None and not _number("a goal's time", self.within) > 0.0:
            raise ValueError(f"a goal is to be reached within more than 0 s, or None; got {self.within!r}")
        object.__setattr__(self, "place", place)  # whatever it was given as, it can be compared

    @property
    def floor(self) -> np.ndarray:
        """The place (2,) x, z [m]."""
        return np.array([self.place[0], self.place[-1]])


@dataclass(frozen=True)
class Strike:
    """A blow or a push, short enough that nobody moves meanwhile. impulse: x, z [N·s] in the world, along the floor; height: [m] over the floor
    where it strikes, None for the chest. ValueError for what is no impulse, more than HARDEST, or nowhere on a body."""

    impulse: tuple[float, float]
    height: float | None = None

    def __post_init__(self):
        impulse = tuple(_numbers("a strike's impulse", self.impulse).ravel().tolist())
        if len(impulse) != 2 or not math.hypot(*impulse) <= HARDEST:
            raise ValueError(f"an impulse is x, z of at most {HARDEST:g} N·s together, got {self.impulse!r}")
        if self.height is not None and not 0.0 <= _number("a strike's height", self.height) <= 3.0:
            raise ValueError(f"a strike's height must be within 0 … 3 m, or None; got {self.height!r}")
        object.__setattr__(self, "impulse", impulse)


@dataclass(frozen=True, eq=False)
class Sighting:
    """What cameras see of somebody in one frame.

    pictures: of each camera a mask (H, W) bool, or int8 with −1 where others are, a picture (H, W, 3) or (H, W) uint8, or None of one whose frame is missing.
    place: (3,) [m] how far all of them are from where they were calibrated, as they may go along.
    """

    pictures: Sequence[np.ndarray | None]
    place: np.ndarray = field(default_factory=lambda: np.zeros(3))


@dataclass(frozen=True, eq=False)
class Intent:
    """What somebody wants of a character, in the character's own ground frame.

    velocity: (..., 3) forward speed v_f [m/s], angular speed ω [rad/s, counter-clockwise from
    above] and lateral speed v_l [m/s, positive to the left]. leap: a jump, as long as it is wanted.
    around: what stands about, anything with a box's centre, size and heading or a pillar's foot,
    radius and height (`gambol.game.scene.scene` has both). points: (n, 3) [m] in the world, where the points on
    the body should be that a reconstruction follows, NaN where one is not seen; None for no such wish. turns: (n, 3, 3) how the joints
    at those points should be turned in the world, NaN where that is not known; None where none is.
    look: (..., 3) [m] a place in the world to look at while walking or standing; None to look where one goes.
    halt: (..., 3) x, z [m], heading [rad] in the world where to come to rest, going there with that velocity; NaN for a heading: as one comes, for a
    place: none; None for none. A walker lets go of the velocity in time for it.
    towards: (..., 2) the heading in the world [rad] and the speed [m/s] that the velocity leads to in the end: who stands turns there in as few
    steps as people do; NaN for one who is not told, None for no such wish.
    goal: where to walk to, instead of a velocity; a `gambol.controllers.supervisor.Supervisor` plans the way. aside: (3,) what is added to
    the velocity by which that plan is followed, to keep out of others' way: the plan waits meanwhile, and is made anew where it leads him off.
    held: no leap of the way goes off now, as somebody is where it leads.
    sighting: a frame of the cameras that watch whoever is to be tracked; None between two frames, and for no such wish.
    aim: a jump that is about to be wanted: who stands crouches for it and waits; with neither it nor a leap he stands up again. Who runs up to it, or wants
    it already, is not held up by what he may leap onto.
    strike: what hits the body as this step begins, whatever is wanted; None for nothing. One in the air is struck once it stands again.
    ValueError for a field of another kind.
    """

    __repr__ = brief

    velocity: np.ndarray = field(default_factory=lambda: np.zeros(3))
    leap: Leap | None = None
    around: Sequence[Any] = ()
    points: np.ndarray | None = None
    look: np.ndarray | None = None
    goal: Goal | None = None
    aside: np.ndarray | None = None
    held: bool = False
    sighting: Sighting | None = None
    aim: Leap | None = None
    turns: np.ndarray | None = None
    halt: np.ndarray | None = None
    towards: np.ndarray | None = None
    strike: Strike | None = None

    def __post_init__(self):
        if not _told(self.velocity, 3):
            raise ValueError(f"a velocity is (..., 3) forward [m/s], turning [rad/s], left [m/s]; got {self.velocity!r}")
        for name, count, words in _PLACES:
            if (value := getattr(self, name)) is not None and not _told(value, count):
                raise ValueError(f"an intent's {name} is {words}, or None; got {value!r}")
        for name, kind in _KINDS:
            if not isinstance(value := getattr(self, name), kind | None):
                raise ValueError(f"an intent's {name} is a {kind.__name__}, or None; got {value!r}")
        if not hasattr(self.around, "__getitem__") or isinstance(self.around, dict):
            raise ValueError(f"around is a sequence of what stands about, empty for nothing; got {self.around!r}")
        for one in self.around[:1]:  # as the first, so the others
            if not any(hasattr(one, name) for name in ("centre", "foot", "place")):  # a goal has a place, and stops nobody
                raise ValueError(f"what stands about has a box's centre, size and heading, or a pillar's foot, radius and height; got {one!r}")

    @staticmethod
    def tangential(v_t, omega, v_l) -> Intent:
        """The intent in Truong's terms: tangential (total) speed v_t, ω and v_l, each (...).

        v_f² = v_t² − v_l², with the sign of v_t: a negative v_t walks backward.
        ValueError if |v_l| > |v_t|, which no motion has.
        """
        v_t, omega, v_l = np.broadcast_arrays(*(np.asarray(v, float) for v in (v_t, omega, v_l)))
        if np.any(np.abs(v_l) > np.abs(v_t) + 1e-9):
            raise ValueError("the lateral speed can't exceed the tangential (total) speed")
        v_f = np.copysign(np.sqrt(np.maximum(v_t**2 - v_l**2, 0.0)), v_t)
        return Intent(np.stack([v_f, omega, v_l], -1))


_PLACES = (("look", 3, "(..., 3) x, y, z [m]"), ("halt", 3, "(..., 3) x, z [m], heading [rad]"), ("towards", 2, "(..., 2) heading [rad], speed [m/s]"),
           ("aside", 3, "(3,) forward [m/s], turning [rad/s], left [m/s]"))
_KINDS = (("leap", Leap), ("goal", Goal), ("sighting", Sighting), ("aim", Leap), ("strike", Strike))
