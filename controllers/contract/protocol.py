"""What every controller answers, and what it may be asked with."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping
from types import MappingProxyType
from typing import Any, Protocol

import numpy as np

from ..body import Pose, Skeleton
from .states import CharacterState, OfSize, Status
from .wishes import HIGHEST, Intent, Leap, Strike


class Unable(ValueError):
    """A controller can't do what is asked from here; the message says why. onward: with what `Controller.seek` goes on finding that out in the
    next step, the message being what is known so far, "" for nothing; None where all is known."""

    onward: Any = None


LONGEST = 0.1
"""A step is this long at most [s]."""


def seconds(dt: Any) -> float:
    """The length of a step as a plain number, for kernels are compiled anew for every other kind of number.

    ValueError unless 0 < dt ≤ 0.1; of single precision, too.
    """
    try:
        plain = float(dt)
    except (TypeError, ValueError):
        raise ValueError(f"dt is one number of seconds, for a whole batch, too; got {dt!r}") from None
    if not 0.0 < plain < LONGEST * (1.0 + 1e-6):
        raise ValueError(f"dt must be in (0, {LONGEST:g}] s, got {dt}")
    return plain


def given(state: Any, intent: Any) -> None:
    """Nothing, if a step is given a state and an intent. ValueError for anything else, or the other way round, and for a state of a body of another size."""
    if not isinstance(state, CharacterState) or not isinstance(intent, Intent):
        raise ValueError(f"a step takes a CharacterState, an Intent and seconds; got a {type(state).__name__} and a {type(intent).__name__}")
    if isinstance(state.memory, OfSize):
        raise ValueError("this state is of a body of another size: step it with the controller that it is of")


def known(state: Any, *wished: Any) -> None:
    """Nothing, if what is asked about is a state, and what is wished there an intent. ValueError for anything else."""
    if not isinstance(state, CharacterState):
        raise ValueError(f"a CharacterState is asked about, as start and step give it; got a {type(state).__name__}")
    for intent in wished:
        if not isinstance(intent, Intent):
            raise ValueError(f"what somebody is asked for is an Intent; got a {type(intent).__name__}")


def level(floor: Any, most: float = HIGHEST) -> Any:
    """How high floors (...) lie [m], as they are. ValueError unless they are finite and within ±`most` m."""
    try:
        sound = abs(floor) <= most if isinstance(floor, float) else np.all(np.abs(np.asarray(floor, float)) <= most)
    except (TypeError, ValueError):
        sound = False
    if not sound:
        raise ValueError(f"a floor must be a finite height within ±{most:g} m, got {floor!r}")
    return floor


def grounded(ground: Any, most: float = HIGHEST) -> np.ndarray:
    """Grounds (..., 3) x, z [m], heading [rad] as numbers. ValueError unless they are so many, and within ±`most`."""
    try:
        found = np.asarray(ground, float)
    except (TypeError, ValueError):
        found = np.empty(0)
    if found.shape[-1:] != (3,) or not (np.abs(found) <= most).all():
        raise ValueError(f"a ground must be (..., 3) x, z, heading within ±{most:g}; got {ground!r}")
    return found


class Controller(Protocol):
    """What the world asks of a controller. Whoever inherits from it has the null answers below, and gives what follows them.

    skeleton: what its poses are of. size: how long its legs are, over those of the standard body. library: its gaits, a `gambol.controllers.locomotion.Library`. settings: what may be
    tuned. body: what it is drawn in, a `gambol.game.render.Body`. None of each where it has none. parts: the controllers
    that it is made of, by name. What raises NotImplementedError has no null answer: whoever inherits gives it.
    """

    skeleton: Skeleton
    size: float = 1.0
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
        """How well it could start from here for this intent: 0 not at all … 1 perfectly; walking says 0.5, who answers a strike 3. Of one that
        is active already: how firmly it holds on; jumps do with 1.5."""
        raise NotImplementedError(f"{type(self).__name__} is a controller without precondition: write it")

    def enter(self, state: CharacterState, intent: Intent) -> CharacterState:
        """The state with this controller's own memory, ready to step: it takes over pose and motion as
        they are, so that nothing jumps. Unable, with the reason, if it can't after all."""
        raise NotImplementedError(f"{type(self).__name__} is a controller without enter: write it")

    def seek(self, state: CharacterState, intent: Intent, onward: Any = None) -> CharacterState:
        """What `enter` gives, of which no more is worked out than a step has time for: Unable, with its `onward`, until it is known whether it can.
        onward: of the step before, if the same was asked."""
        return self.enter(state, intent)

    def refusal(self, state: CharacterState, intent: Intent) -> str | None:
        """Why it could not leap from a state as intent.leap says, "" if it could; None of one that never leaps."""
        return None

    def pondered(self, state: CharacterState, intent: Intent, ask: Callable[[], None]) -> str | None:
        """What `refusal` gives. ask: is called once more for each part of it that takes as long as most answers do."""
        return self.refusal(state, intent)

    def looks(self, state: CharacterState, intent: Intent) -> Generator[int, Any, Any]:
        """The plan of the leap that intent.leap says from a state, or why there is none, in pieces: it yields what each costs before that is worked out. None of one that never leaps."""
        return None
        yield

    def found(self, state: CharacterState, intent: Intent, ask: Callable[[], None] = lambda: None) -> Leap | None:
        """The leap that intent.leap says, with how it could be made from a state or one nearly like it; None if it could not. ask: see `pondered`."""
        return None

    def gain(self, strike: Strike) -> np.ndarray | None:
        """By how much (2,) x, z [m/s] a strike changes the velocity of its body; None of one that answers no strikes."""
        return None

    def pushed(self, state: CharacterState, change: np.ndarray) -> CharacterState | None:
        """The state with a velocity that a push has changed by (2,) x, z [m/s] in the world, from which it goes on as it does; None where it can't."""
        return None

    def step(self, state: CharacterState, intent: Intent, dt: float) -> tuple[CharacterState, Pose]:
        """One step of `dt` seconds. ValueError unless 0 < dt ≤ 0.1, see `seconds`."""
        raise NotImplementedError(f"{type(self).__name__} is a controller without step: write it")

    def status(self, state: CharacterState) -> Status:
        """Whether it goes on."""
        raise NotImplementedError(f"{type(self).__name__} is a controller without status: write it")
