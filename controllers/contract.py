"""The contract every controller keeps: ``state', pose = controller.step(state, intent, dt)``.

State goes in, state comes out; a controller holds only what it was built from. So rewinding,
replaying, testing and crowds need nothing more than keeping states.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Literal, Protocol, TypeVar

import numpy as np

from .body import Pose, Skeleton

T = TypeVar("T")

HARDEST = 1000.0
"""Nobody is struck harder [N·s]: as a car at walking pace would."""
HIGHEST = 1e5
"""No floor is higher or deeper than this [m]: beyond it single precision loses millimetres, and numbers their sense."""


def but(value: T, **changes: Any) -> T:
    """The same value with other fields, as `dataclasses.replace` gives it, in a tenth of its time: what every step of everybody asks for. Fields are
    not looked at again."""
    made = object.__new__(type(value))
    vars(made).update(vars(value), **changes)
    return made


@dataclass(frozen=True, eq=False)
class Leap:
    """A jump that somebody wants. place: (3,) [m] in the world where the middle of the feet should land, or
    None for where it is now: straight up.

    airtime: [s], or None for the least effort. slack: a runner who comes too near for the place may land so much farther on [m].
    heading: [rad] to land in, turning there the shorter way round and looking where one goes; None to face on as one does.
    on: "left", "right" or "both": lands on that foot, or on both, to hop on from there; None to stand there, or run on.
    """

    place: np.ndarray | None
    airtime: float | None = None
    slack: float = 0.0
    heading: float | None = None
    on: Literal["left", "right", "both"] | None = None

    def same(self, other: Leap | None) -> bool:
        """Whether another wish is this one."""
        return (other is not None and (self.airtime, self.slack, self.heading, self.on) == (other.airtime, other.slack, other.heading, other.on)
                and (self.place is None) == (other.place is None) and (self.place is None or other.place is None or np.array_equal(self.place, other.place)))


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
        place = tuple(float(value) for value in self.place)
        if len(place) not in (2, 3) or not all(abs(value) <= HIGHEST for value in place):
            raise ValueError(f"a goal is x, z or x, y, z within ±{HIGHEST:g} m, got {self.place!r}")
        if self.heading is not None and not math.isfinite(self.heading):
            raise ValueError(f"a goal's heading must be finite [rad], or None; got {self.heading!r}")
        if self.within is not None and not self.within > 0.0:
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
        impulse = tuple(float(value) for value in self.impulse)
        if len(impulse) != 2 or not math.hypot(*impulse) <= HARDEST:
            raise ValueError(f"an impulse is x, z of at most {HARDEST:g} N·s together, got {self.impulse!r}")
        if self.height is not None and not 0.0 <= self.height <= 3.0:
            raise ValueError(f"a strike's height must be within 0 … 3 m, or None; got {self.height!r}")
        object.__setattr__(self, "impulse", impulse)


@dataclass(frozen=True, eq=False)
class Sighting:
    """What cameras see of somebody in one frame.

    pictures: of each camera a mask (H, W) bool, a picture (H, W, 3) or (H, W) uint8, or None of one whose frame is missing.
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
    aim: a jump that is about to be wanted: who stands crouches for it and waits; with neither it nor a leap he stands up again.
    strike: what hits the body as this step begins, whatever is wanted; None for nothing. One in the air is struck once it stands again.
    """

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


@dataclass(frozen=True, eq=False)
class CharacterState:
    """All that is known of a character at one moment, whoever drives it.

    ground: (..., 3) x, z [m] of the mid-shoulder point dropped to the floor, and heading θ [rad].
    velocity: (..., 3) achieved (v_f, ω, v_l) in the ground frame [m/s, rad/s, m/s].
    pose: the pose of the last step. contacts: (..., 4) bool, which of left heel, left ball,
    right heel, right ball stand on the floor.
    memory: what the active controller keeps for itself, a frozen dataclass of its own.
    floor: (...) how high the floor lies that the character stands on [m].
    previous, elapsed: the pose a step before and that step's length [s]: how the body moves, for
    whoever takes over. None where nobody knows.
    going: how far it is on the way to its goal, a `gambol.controllers.navigation.Going`; None where it has none.
    """

    ground: np.ndarray
    velocity: np.ndarray
    pose: Pose
    contacts: np.ndarray
    memory: Any = None
    floor: np.ndarray | float = 0.0
    previous: Pose | None = None
    elapsed: float = 0.0
    going: Any = None

    @property
    def active(self) -> str:
        """Which of several controllers is on duty, by name; "" where one alone moves it."""
        return self.memory.active if isinstance(self.memory, Duty) else ""

    @property
    def refused(self) -> str:
        """Why what was asked last can't be done, or goes wrong; "" if it can."""
        return self.memory.refused if isinstance(self.memory, Duty) else ""


@dataclass(frozen=True, eq=False)
class Duty:
    """The memory of a supervisor: who is on duty. active: a controller's name. memory: its own. why: why it was
    chosen, in words.

    refused: why what was asked last can't be done, or goes wrong; empty if it can. asked: what was refused and from where, so that it
    is not tried again until something changes. strike: what struck it in the air, where nobody answers that, until it stands again.
    """

    active: str
    memory: Any
    why: str
    refused: str = ""
    asked: Any = None
    strike: Strike | None = None


@dataclass(frozen=True)
class Status:
    """How a controller stands: running, done, or failed with a reason."""

    kind: Literal["running", "done", "failed"] = "running"
    reason: str = ""


class Unable(ValueError):
    """A controller can't do what is asked from here; the message says why."""


LONGEST = 0.1
"""A step is this long at most [s]."""


def seconds(dt: Any) -> float:
    """The length of a step as a plain number, for kernels are compiled anew for every other kind of number.

    ValueError unless 0 < dt ≤ 0.1; of single precision, too.
    """
    plain = float(dt)
    if not 0.0 < plain < LONGEST * (1.0 + 1e-6):
        raise ValueError(f"dt must be in (0, {LONGEST:g}] s, got {dt}")
    return plain


def level(floor: Any) -> Any:
    """How high floors (...) lie [m], as they are. ValueError unless they are finite and within ±1e5 m."""
    sound = abs(floor) <= HIGHEST if isinstance(floor, float) else np.all(np.abs(np.asarray(floor, float)) <= HIGHEST)
    if not sound:
        raise ValueError(f"a floor must be a finite height within ±{HIGHEST:g} m, got {floor!r}")
    return floor


class Controller(Protocol):
    """What the world asks of a controller. Whoever inherits from it has the null answers below, and gives what follows them.

    skeleton: what its poses are of. library: its gaits, a `gambol.controllers.locomotion.Library`. settings: what may be
    tuned. body: what it is drawn in, a `gambol.game.render.Body`. None of each where it has none. parts: the controllers
    that it is made of, by name. What raises NotImplementedError has no null answer: whoever inherits gives it.
    """

    skeleton: Skeleton
    library: Any = None
    settings: Any = None
    body: Any = None
    parts: Mapping[str, Controller] = MappingProxyType({})

    @property
    def kind(self) -> str:
        """What tells its motion from that of other controllers, beside the library."""
        return type(self).__name__

    def tuned(self, settings: Any) -> Controller:
        """The same controller under other settings; itself where it has none."""
        return self

    def limits(self, share: float = 1.0) -> np.ndarray | None:
        """Half-spaces (H, 4) n·(v_f, ω, v_l) + d ≤ 0 of the velocities that it walks with, and a `share` of them; None of
        one that doesn't walk."""
        return None

    def readiness(self, state: CharacterState) -> Any:
        """How fast (...) it takes a wish up now, as a share of how fast it does as it walks: less while it sets off."""
        return 1.0

    def start(self, ground: Any = (0.0, 0.0, 0.0), floor: float = 0.0) -> CharacterState:
        """A character at rest at ground x, z [m], heading [rad], on a floor `floor` [m] high. Unable, of one that only
        takes over from others."""
        raise Unable(f"{type(self).__name__} starts nobody, it takes over from others: put both under a supervisor")

    def precondition(self, state: CharacterState, intent: Intent) -> float:
        """How well it could start from here for this intent: 0 not at all … 1 perfectly. Of one that
        is active already: how firmly it holds on."""
        raise NotImplementedError

    def enter(self, state: CharacterState, intent: Intent) -> CharacterState:
        """The state with this controller's own memory, ready to step: it takes over pose and motion as
        they are, so that nothing jumps. Unable, with the reason, if it can't after all."""
        raise NotImplementedError

    def refusal(self, state: CharacterState, intent: Intent) -> str | None:
        """Why it could not leap from a state as intent.leap says, "" if it could; None of one that never leaps."""
        return None

    def gain(self, strike: Strike) -> np.ndarray | None:
        """By how much (2,) x, z [m/s] a strike changes the velocity of its body; None of one that answers no strikes."""
        return None

    def pushed(self, state: CharacterState, change: np.ndarray) -> CharacterState | None:
        """The state with a velocity that a push has changed by (2,) x, z [m/s] in the world, from which it goes on as it does; None where it can't."""
        return None

    def step(self, state: CharacterState, intent: Intent, dt: float) -> tuple[CharacterState, Pose]:
        """One step of `dt` seconds. ValueError unless 0 < dt ≤ 0.1, see `seconds`."""
        raise NotImplementedError

    def status(self, state: CharacterState) -> Status:
        """Whether it goes on."""
        raise NotImplementedError
