"""How somebody walks to a goal, as a value in his state."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...contract import CharacterState, Goal, Status, but
from ..goal import wish
from ..levels import Crossing, levels_of
from .thought import Thought, steps_of

if TYPE_CHECKING:  # who never goes to a goal loads no planner
    from ..planning import Plan

OFF = 0.3, 1.0
"""Who is so far off his plan [m, rad] plans anew."""
STOOD = 0.2
"""Who has stood at the goal for so long [s] has arrived."""
AWAY = 0.1, 0.2
"""Who had arrived and is now so far from his goal [m, rad] goes there again."""
NEARER = 0.1
"""A new plan is worth something where the walker came so much nearer to the goal since the last [m]."""
LATE = 4.0
"""Who has not arrived so long after his plan's end [s] plans anew."""
OFFSET, ASKEW, SLOW = 0.07, 0.1, 0.3
"""Who is so near to where he is to leap from [m], turned to it so far [rad], and no faster than this [m/s], leaps."""


class Thinking(NamedTuple):
    """thought: what somebody thinks of; it changes fields of his `Going`. steps: since he began, of dt [s]. carries: (3,) the velocity with
    which he goes on at first, and then stops; None for who follows his plan meanwhile."""

    thought: Thought[Mapping[str, Any]]
    dt: float
    steps: int = 0
    carries: np.ndarray | None = None


@dataclass(frozen=True, eq=False)
class Going:
    """How somebody walks to a goal.

    goal: as it was asked for. planned: the goal that the plan was made for, None before the first. plan: the walk there, or to where the first of
    `crossings` is leapt, and `time` how far he is in it [s]. heading: how he
    is to stand at its end [rad]. around: what stood about as it was planned, and stops what of it stops him. spent: since the goal was asked for [s].
    stood: for how long he has stood at the plan's end [s]. left: how far he was from it as it was planned [m]. held: so many plans in a row brought him no nearer. waits: for how
    long others have kept him from coming nearer than he was, `nearest` [m], to the plan's end [s]. plans: how many were made. crossings: the leaps that are left. asked: for how long the first was asked for [s]. leapt: whether somebody else is on duty.
    anew: whether the plan leads on no more. barred: leaps that he could not make. pace: how fast he walks as he leaps on [m/s]; 0 from a stand. off: after how many steps he leaps,
    once that is known. back: whether the plan leads back, to where the run-up begins. poised: whether a leap from a stand was thought of. stands: leaps that he does not make from a walk. thinking: of what he thinks beside.
    """

    goal: Goal
    plan: Plan
    heading: float
    around: Sequence[Any]
    stops: Sequence[Any]
    planned: Goal | None = None
    time: float = 0.0
    spent: float = 0.0
    stood: float = 0.0
    left: float = math.inf
    held: int = 0
    waits: float = 0.0
    nearest: float = math.inf
    plans: int = 0
    crossings: tuple[Crossing, ...] = ()
    asked: float = 0.0
    leapt: bool = False
    anew: bool = False
    barred: tuple[tuple[float, ...], ...] = ()
    pace: float = 0.0
    off: int | None = None
    back: bool = False
    poised: bool = False
    stands: tuple[tuple[float, ...], ...] = ()
    thinking: Thinking | None = None

    def but(self, **changes: Any) -> Going:
        """The same with other fields."""
        return but(self, **changes)

    @property
    def there(self) -> bool:
        """Whether he has arrived, and stands."""
        return self.stood > STOOD and not self.crossings and self.planned == self.goal

    @property
    def status(self) -> Status:
        """Running; done at the goal; failed, with the plan's reason."""
        if self.plan.reason and self.planned == self.goal and self.thinking is None:
            return Status("failed", self.plan.reason)
        return Status("done" if self.there else "running")

    @property
    def costed(self) -> Plan:
        """The plan as it costs."""
        return self.plan

    def floors(self, way: np.ndarray, floor: float) -> np.ndarray:
        """How high (P,) [m] he stands at one place (P, 2) of his way after the other, from a floor so high [m]."""
        return levels_of(self.around).floors(way, floor)

    def wished(self, ground: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """The velocity (3,) that he wishes for at a ground frame (3,), as he moves (3,)."""
        thinks = self.thinking
        return self.wished_while(None, 0, 0.0, ground, velocity) if thinks is None else self.wished_while(thinks.carries, thinks.steps, thinks.dt, ground, velocity)

    def wished_while(self, carries: np.ndarray | None, steps: int, dt: float, ground: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """The same, so many steps of dt [s] after he began to think, carried on as of `Thinking`."""
        if carries is not None:
            return carries if steps < steps_of(0, dt) else np.zeros(3)
        return np.zeros(3) if self.there else wish(self.plan, self.time, ground, velocity)


def within(now: Going, state: CharacterState, near: tuple[float, float]) -> bool:
    """Whether he is so near to the plan's end [m, rad]."""
    off = now.plan.goal - state.ground
    return math.hypot(off[0], off[1]) <= near[0] and abs(math.remainder(off[2], math.tau)) <= near[1]


def astray(now: Going, state: CharacterState) -> bool:
    """Whether the walker is where the plan does not have him, or comes to no end."""
    if now.there:
        return not within(now, state, AWAY)
    off = now.plan.at(now.time)[0] - state.ground
    return math.hypot(off[0], off[1]) > OFF[0] or abs(math.remainder(off[2], math.tau)) > OFF[1] or now.time > now.plan.seconds + LATE


def ready(now: Going, state: CharacterState) -> bool:
    """Whether he stands where the next leap goes off, or nearly stands."""
    return within(now, state, (OFFSET, ASKEW)) and math.hypot(state.velocity[0], state.velocity[2]) < SLOW
