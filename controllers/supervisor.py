"""Which controller acts now (Faloutsos 2001): each says how well it could, and the best one does.

The supervisor is a controller itself. It asks, picks, and passes pose and motion on; taking them
over without a jump is each controller's own `enter`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Mapping
from copy import copy
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .body import Pose, Skeleton
from .contract import HARDEST, CharacterState, Controller, Duty, Intent, Leap, Status, Strike, Unable, but, given, known, seconds
from .navigation import changed, checked, going, matters
from .navigation.passing import drawn_on


MOVED, PASSED, TURNED, ALONG = 0.05, 0.2, 0.1, 0.03
"""A leap that was refused is tried again from elsewhere: so far away [m], farther by so much for each m/s, turned by so much [rad], on other feet, or
once he stands who was standing up. One along the way that somebody goes after the last [m]: it is asked of each moment anew, and the next may do."""

HARDLY = 0.02
"""And to a place that has moved by so much [m]."""


ALONE = "characters come singly; a crowd that only walks is stepped by the locomotion itself"


ELSE = "this state is not of several controllers: enter it first"


GLIDES = 0.05
"""And once he rests who still went faster than this [m/s]."""


RISES, RESTS = 0.2, 0.1
"""Whose hips come up faster than the first [m/s], as he goes no faster than the second [m/s], still stands up, as from a landing."""


TAKEN = "its next steps take in what pushed it"
"""Why who walks or runs goes on, pushed."""

STRAYS, ASIDE = 0.1, 1.5
"""What stands about is the same as long as nothing has moved by more than the first [m] that is nearer than the second [m] to the leap. What is
found so is planned once more, past what stands there then."""


@dataclass(frozen=True, eq=False)
class Asked:
    """What a controller refused. name: whose. intent: what was asked at first. state: from where. onward: with what it goes on finding out about it; None where
    all is known."""

    name: str
    intent: Intent
    state: CharacterState
    onward: Any = None

    def drifts(self, intent: Intent) -> bool:
        """Whether it is to the same place, which moves."""
        was, leap = self.intent.leap, intent.leap
        return was is not None and leap is not None and was.near(leap) and not was.same(leap)

    def still(self, state: CharacterState, intent: Intent) -> bool:
        """Whether the same is asked from the same place: of the same stance, where somebody moves. What was refused is asked anew of a place that moved by more than hardly."""
        was, leap, before = self.intent.leap, intent.leap, self.state
        if was is None or leap is None or not (was.near(leap, HARDLY) if self.onward is None else was.near(leap)):
            return False
        if intent.around is not self.intent.around:
            here, place = state.ground[:2], leap.place
            there = here if place is None or place.shape != (3,) else place[[0, 2]]  # what is no place is refused wherever things are
            if matters(changed(self.intent.around, intent.around, STRAYS), here, there, math.dist(here, there) + 2.0 * ASIDE):
                return False
        far = state.ground - before.ground
        pace = float(np.hypot(before.velocity[0], before.velocity[2]))
        if pace > GLIDES > float(np.hypot(state.velocity[0], state.velocity[2])):
            return False
        return bool(np.array_equal(state.contacts, before.contacts) and np.hypot(far[0], far[1]) < (ALONG if leap.along else MOVED + PASSED * pace)
                    and abs(far[2]) < TURNED and state.floor == before.floor and not (_rises(before) and not _rises(state)))


class Supervisor(Controller):
    """Several controllers as one. The first is where every character starts and what always can go on.

    controllers: by name, all for the same skeleton; ValueError for what is none. Characters come singly: for a crowd that only
    walks, step the locomotion itself. Who walks closely by something draws his arms in. Where an intent has a goal, the way is planned by what the first can walk, beside the
    steps: what is planned is used some steps later.
    """

    def __init__(self, controllers: Mapping[str, Controller]):
        if not isinstance(controllers, Mapping) or not controllers:
            raise ValueError(f"a supervisor takes controllers by name, the first one that can always go on first; got {controllers!r}")
        self.parts: Mapping[str, Controller] = dict(controllers)
        self.first = next(iter(self.parts))
        for name, part in self.parts.items():
            if isinstance(part, type):
                raise ValueError(f"the controller {name!r} is a class, {part.__name__}: make one of it")
            lacks = [answer for answer in ("precondition", "enter", "step", "status") if not hasattr(part, answer)]
            if lacks:
                raise ValueError(f"the controller {name!r} has no {', '.join(lacks)}: inherit from gambol.controllers.contract.Controller; got {part!r}")

    @property
    def skeleton(self) -> Skeleton:
        """The skeleton that the poses are of."""
        return self.parts[self.first].skeleton

    @property
    def kind(self) -> str:
        """What tells its motion from that of other controllers, beside the library."""
        return " + ".join(one.kind for one in self.parts.values())

    @property
    def size(self) -> float:
        """How long its legs are, over those of the standard body."""
        return self.parts[self.first].size

    @property
    def library(self) -> Any:
        """The first controller's gaits."""
        return self.parts[self.first].library

    @property
    def settings(self) -> Any:
        """The first controller's settings."""
        return self.parts[self.first].settings

    def tuned(self, settings: Any) -> Supervisor:
        """The same under other settings of the first controller."""
        other = copy(self)
        other.parts = {**self.parts, self.first: self.parts[self.first].tuned(settings)}
        return other

    def limits(self, share: float = 1.0) -> np.ndarray | None:
        """The half-spaces (H, 4) of the velocities that the first walks with."""
        return self.parts[self.first].limits(share)

    def readiness(self, state: CharacterState) -> Any:
        """How fast whoever is on duty takes a wish up, as a share of how fast it does as it walks."""
        name, own = self.active(state)
        return self.parts[name].readiness(own)

    def start(self, ground=(0.0, 0.0, 0.0), floor: float = 0.0) -> CharacterState:
        """A character at rest at ground x, z [m], heading [rad], on a floor `floor` [m] high. ValueError for more than one."""
        if np.ndim(ground) > 1:
            raise ValueError(f"{ALONE}; got a ground of shape {np.shape(ground)}")
        state = self.parts[self.first].start(ground, floor)
        return replace(state, memory=Duty(self.first, state.memory, "it starts here"))

    def step(self, state: CharacterState, intent: Intent, dt: float) -> tuple[CharacterState, Pose]:
        """One step of dt seconds (0 < dt ≤ 0.1; ValueError otherwise) by whoever is best for it now. ValueError for a state of another controller."""
        given(state, intent)
        try:
            return self._stepped(state, intent, seconds(dt))
        except (AttributeError, IndexError, TypeError):
            checked(intent.around)
            raise

    def _stepped(self, state: CharacterState, intent: Intent, dt: float) -> tuple[CharacterState, Pose]:
        duty = state.memory
        if not isinstance(duty, Duty):
            raise ValueError(ELSE)
        way = None
        if intent.goal is not None:
            way, intent = going(state, intent, self, duty.active == self.first, dt)
        own = but(state, memory=duty.memory)
        kept = None
        if intent.strike is not None or duty.strike is not None:
            duty, own, intent, kept = self._struck(duty, own, intent)
        else:
            duty, own = self._choose(duty, own, intent)
        before = state.pose
        after, pose = self.parts[duty.active].step(own, intent, dt)
        if duty.active != self.first and not (np.isfinite(pose.rotations).all() and np.isfinite(pose.root).all()):
            raise ValueError(f"the controller {duty.active!r} gave a pose that is not finite")
        arms = None  # who else acts begins with them as they are
        if duty.active == self.first and (len(intent.around) or duty.arms is not None):
            pose, arms = drawn_on(self.skeleton, pose, after.ground, intent.around, duty.arms, float(np.hypot(after.velocity[0], after.velocity[2])), dt)
        duty = but(duty, memory=after.memory, strike=kept, arms=arms)
        return but(after, pose=pose, memory=duty, previous=before, elapsed=dt, going=way), pose

    def _struck(self, duty: Duty, own: CharacterState, intent: Intent) -> tuple[Duty, CharacterState, Intent, Strike | None]:
        """Who acts in a step in which something strikes, or has struck in the air; the state it starts from, what is asked of it, and the strike that is still to be answered.

        The first goes on from what it can take in; what is harder is for who answers strikes, once a foot stands of one whom another moves.
        """
        strike = both(duty.strike, intent.strike)
        taker, change = next(((name, gain) for name, part in self.parts.items() if (gain := part.gain(strike)) is not None), ("", None))
        calm = but(intent, strike=None)
        if change is None:
            return *self._choose(duty, own, calm), calm, None
        if duty.active == self.first:
            taken = self.parts[self.first].pushed(own, change)
            if taken is not None:
                return *self._choose(but(duty, why=TAKEN), taken, calm), calm, None
        elif duty.active != taker and not np.any(own.contacts):
            return *self._choose(duty, own, calm), calm, strike
        hit = but(intent, strike=strike)
        duty, own = self._choose(duty, own, hit)
        return duty, own, hit, None if duty.active == taker else strike

    def _choose(self, duty: Duty, own: CharacterState, intent: Intent) -> tuple[Duty, CharacterState]:
        """Who acts in this step, and the state it starts from."""
        active = self.parts[duty.active]
        status = active.status(own)
        # one that ended holds on to nothing
        hold = active.precondition(own, intent) if status.kind == "running" else 0.0
        gone_wrong = "" if status.kind == "done" else status.reason
        refused = "" if intent.leap is None else duty.refused
        asked = None if intent.leap is None else duty.asked
        again = asked is not None and asked.still(own, intent)
        # who has refused for good, as long as the same is asked from the same place, need not say how well it could
        bids = {name: other.precondition(own, intent) for name, other in self.parts.items()
                if name != duty.active and not (again and asked is not None and asked.onward is None and asked.name == name)}
        for name, bid in bids.items():
            if not isinstance(bid, float | int | np.floating) or not bid >= 0.0:
                raise ValueError(f"the precondition of the controller {name!r} must be a number, 0 or more; got {bid!r}")
        for name in sorted(bids, key=bids.__getitem__, reverse=True):
            if bids[name] <= hold:
                break
            before = asked if again and asked is not None and asked.name == name else None
            try:
                entered = self.parts[name].seek(own, intent, None if before is None else before.onward)
            except Unable as reason:
                refused = str(reason) or (refused if asked is not None and asked.name == name and asked.drifts(intent) else "")
                first = (intent, own) if before is None else (before.intent, before.state)
                asked = None if intent.leap is None else Asked(name, *first, reason.onward)
                continue
            because = status.reason or {"done": f"{duty.active} is done"}.get(status.kind, "")
            why = because or f"it suits best: {bids[name]:.1f} over {hold:.1f}"
            return Duty(name, entered.memory, why, gone_wrong), entered
        return but(duty, refused=gone_wrong or refused, asked=asked), own

    def refusal(self, state: CharacterState, intent: Intent) -> str | None:
        """Why none of them could leap as intent.leap says, "" if one could; None where none ever leaps."""
        return self.pondered(state, intent, lambda: None)

    def pondered(self, state: CharacterState, intent: Intent, ask: Callable[[], None]) -> str | None:
        """The same. ask: is called once more for each part of it that takes as long as most answers do."""
        known(state, intent)
        found = [why for why in (part.pondered(self.active(state)[1], intent, ask) for part in self.parts.values()) if why is not None]
        return None if not found else "" if "" in found else found[0]

    def looks(self, state: CharacterState, intent: Intent) -> Generator[int, Any, Any]:
        """The plan of the leap that intent.leap says, by one of them, or why there is none, in pieces: it yields what each costs before that is worked out. None where none ever leaps."""
        known(state, intent)
        told = None
        for part in self.parts.values():
            found = yield from part.looks(self.active(state)[1], intent)
            if found is not None and not isinstance(found, str):
                return found
            told = told or found
        return told

    def found(self, state: CharacterState, intent: Intent, ask: Callable[[], None] = lambda: None) -> Leap | None:
        """The leap that intent.leap says, with how one of them could make it; None where none could. ask: see `pondered`."""
        known(state, intent)
        found = (part.found(self.active(state)[1], intent, ask) for part in self.parts.values())
        return next((leap for leap in found if leap is not None), None)

    def active(self, state: CharacterState) -> tuple[str, CharacterState]:
        """Who is on duty, and the state as that controller sees it. ValueError for a state that is none of several controllers."""
        known(state)
        if not isinstance(state.memory, Duty):
            raise ValueError(ELSE)
        return state.memory.active, but(state, memory=state.memory.memory)

    def precondition(self, state: CharacterState, intent: Intent) -> float:
        """As good as its best."""
        own = self.active(state)[1]
        return max(controller.precondition(own, intent) for controller in self.parts.values())

    def enter(self, state: CharacterState, intent: Intent) -> CharacterState:
        """The state under this supervisor, its first controller on duty unless one is already."""
        known(state)
        if isinstance(state.memory, Duty) and state.memory.active in self.parts:
            return state
        entered = self.parts[self.first].enter(state, intent)
        return replace(entered, memory=Duty(self.first, entered.memory, "it takes over"))

    def status(self, state: CharacterState) -> Status:
        """It never ends by itself; a walk to a goal is done, or fails with a reason. ValueError for what is no state."""
        known(state)
        return Status("running") if state.going is None else state.going.status


def _rises(state: CharacterState) -> bool:
    """Whether somebody still stands up."""
    if state.previous is None or state.elapsed <= 0.0 or float(np.hypot(state.velocity[0], state.velocity[2])) > RESTS:
        return False
    return float(state.pose.root[1] - state.previous.root[1]) > RISES * state.elapsed


def both(one: Strike | None, other: Strike | None) -> Strike:
    """Two strikes as one, no harder than anybody is struck, where the later one hits; of one alone, that one. ValueError for none."""
    if one is None or other is None:
        found = other if one is None else one
        if found is None:
            raise ValueError("nothing strikes: give at least one strike")
        return found
    both = np.add(one.impulse, other.impulse)
    return Strike(tuple(both * min(1.0, (1.0 - 1e-9) * HARDEST / max(float(np.hypot(*both)), 1e-9))), other.height)
