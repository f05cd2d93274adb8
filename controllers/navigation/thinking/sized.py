"""Goals of bodies of other sizes: how somebody is led through a world in which his body is of the standard size.

How high one steps, and how much room a head and shoulders take, is told of the standard body. Who is k times as large is led in a world 1/k times as
large, as he walks in it (`gambol.controllers.scaled`), and what comes of that is told in his own. What he is asked meanwhile, as for leaps, he is asked as he is.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...body import Pose, Skeleton
from ...contract import CharacterState, Controller, Goal, Intent, Leap, Status, but
from ..levels import Crossing
from ..obstacles import STEP, checked, highest_step, is_box, is_pillar, slope
from .going import Going

if TYPE_CHECKING:  # who never goes to a goal loads no planner
    from ..planning import Plan

Leading = Callable[[CharacterState, Intent, Controller, bool, float], tuple[Going | None, Intent]]
"""How somebody is led to a goal, see `gambol.controllers.navigation.going`."""


class SmallBox:
    """A box as a body sees it that is taken for another's size."""

    def __init__(self, box: Any, factor: float):
        self.centre, self.size = (np.asarray(one, float) / factor for one in (box.centre, box.size))
        self.heading, self.slope = box.heading, slope(box)


class SmallPillar:
    """A pillar likewise."""

    def __init__(self, pillar: Any, factor: float):
        self.foot = np.asarray(pillar.foot, float) / factor
        self.radius, self.height = pillar.radius / factor, pillar.height / factor


class SmallThings(tuple[Any, ...]):
    """What stands about in a smaller world. own: the same in one's own; step: the highest that its body takes there [m]."""

    own: Sequence[Any] = ()
    step: float = STEP


def shrunk(around: Sequence[Any], factor: float) -> SmallThings:
    """Boxes and pillars in a world that is 1/factor times as large, without what stops nobody. ValueError for what is neither, and lacks something."""
    try:
        small = SmallThings(SmallBox(thing, factor) if is_box(thing) else SmallPillar(thing, factor) for thing in around if is_box(thing) or is_pillar(thing))
    except (AttributeError, TypeError, ValueError):
        checked(around)
        raise
    small.own, small.step = around, highest_step(factor)
    return small


def speeds(factor: float) -> np.ndarray:
    """What v_f, ω and v_l (3,) of a body are times those of one of the standard size."""
    return np.array([factor**0.5, factor**-0.5, factor**0.5])


def places(factor: float) -> np.ndarray:
    """What x, z and heading (3,) are times those in the smaller world."""
    return np.array([factor, factor, 1.0])


@dataclass(frozen=True, eq=False)
class Small(CharacterState):
    """A state as it is in a smaller world; its pose is of no account there. own: the same in one's own."""

    own: Any = None

    @staticmethod
    def of(state: CharacterState, factor: float, going: Going | None = None) -> Small:
        """A state in a world 1/factor times as large. going: how far it is on its way there."""
        made: Small = object.__new__(Small)
        vars(made).update(vars(state), ground=state.ground / places(factor), velocity=state.velocity / speeds(factor), floor=float(state.floor) / factor, going=going, own=state)
        return made


@dataclass(frozen=True)
class Sized(Controller):
    """A body that is `factor` times as large as the standard one as whoever leads it has it, in a smaller world. dt: how long the step is that it makes [s]."""

    walker: Controller
    factor: float
    dt: float = field(compare=False)  # what was measured of a body is known in each of its steps

    @property
    def size(self) -> float:
        """By how much larger all is in words."""
        return self.factor

    @property
    def skeleton(self) -> Skeleton:
        """What it moves."""
        return self.walker.skeleton

    @property
    def step_there(self) -> float:
        """How long its step is in the smaller world [s]."""
        return self.dt / self.factor**0.5

    def limits(self, share: float = 1.0) -> np.ndarray | None:
        """The half-spaces (H, 4) of the velocities that it walks with."""
        planes = self.walker.limits(share)
        return None if planes is None else planes * np.array([*speeds(self.factor), 1.0])

    def readiness(self, state: CharacterState) -> Any:
        """How fast it takes a wish up, as a share of how fast it does as it walks."""
        return self.walker.readiness(_own(state))

    def start(self, ground=(0.0, 0.0, 0.0), floor: float = 0.0) -> CharacterState:
        """Standing at x, z [m], heading [rad], on a floor so high [m]."""
        return Small.of(self.walker.start(np.asarray(ground, float) * places(self.factor), floor * self.factor), self.factor)

    def step(self, state: CharacterState, intent: Intent, dt: float) -> tuple[CharacterState, Pose]:
        """One step of dt seconds; the pose is its own."""
        own = self.dt if dt == self.step_there else dt * self.factor**0.5  # to the bit, as it will step
        after, pose = self.walker.step(_own(state), self.asked(intent), own)
        return Small.of(after, self.factor), pose

    def precondition(self, state: CharacterState, intent: Intent) -> float:
        """How well it could start from here for this intent."""
        return self.walker.precondition(_own(state), self.asked(intent))

    def enter(self, state: CharacterState, intent: Intent) -> CharacterState:
        """The state with its own memory."""
        return Small.of(self.walker.enter(_own(state), self.asked(intent)), self.factor)

    def status(self, state: CharacterState) -> Status:
        """Whether it goes on."""
        return self.walker.status(_own(state))

    def refusal(self, state: CharacterState, intent: Intent) -> str | None:
        """Why it could not leap from a state, "" if it could; None where it never leaps."""
        return self.walker.refusal(_own(state), self.asked(intent))

    def pondered(self, state: CharacterState, intent: Intent, ask: Callable[[], None]) -> str | None:
        """The same. ask: is called once more for each part of it that takes as long as most answers do."""
        return self.walker.pondered(_own(state), self.asked(intent), ask)

    def asked(self, intent: Intent) -> Intent:
        """An intent of the smaller world in its own."""
        around = intent.around.own if isinstance(intent.around, SmallThings) else intent.around
        return but(intent, velocity=intent.velocity * speeds(self.factor), leap=self.leapt(intent.leap), around=around, goal=None, aside=None)

    def leapt(self, leap: Leap | None) -> Leap | None:
        """A leap of the smaller world in its own."""
        return None if leap is None or leap.place is None else but(leap, place=leap.place * self.factor)


def _own(state: CharacterState) -> CharacterState:
    return state.own if isinstance(state, Small) else state


@dataclass(frozen=True, eq=False)
class Large(Going):
    """How somebody of another size walks to a goal, in his own world. small: the same in the smaller one, in which he is led; factor: his size."""

    small: Any = None
    factor: float = 1.0

    @staticmethod
    def of(small: Going, intent: Intent, asked: Intent, factor: float, before: Large | None) -> Large:
        """A way in one's own world. intent, asked: what is asked for there, and in the smaller one. before: how it was a step ago."""
        root, known = factor**0.5, before
        goal = intent.goal if known is None or small.goal == asked.goal else known.goal
        made: Large = object.__new__(Large)
        vars(made).update(
            vars(small), goal=goal, planned=goal if small.planned == small.goal else None if small.planned is None else _grown_goal(small.planned, factor),
            plan=known.plan if known is not None and known.small.plan is small.plan else _grown_plan(small.plan, factor),
            around=small.around.own if isinstance(small.around, SmallThings) else small.around,
            crossings=known.crossings if known is not None and known.small.crossings is small.crossings else tuple(_grown_leap(leap, factor) for leap in small.crossings),
            left=small.left * factor, nearest=small.nearest * factor, pace=small.pace * root, small=small, factor=factor,
            **{name: getattr(small, name) * root for name in ("time", "spent", "stood", "waits", "asked")})
        return made

    @property
    def there(self) -> bool:
        """Whether he has arrived, and stands."""
        return self.small.there

    @property
    def status(self) -> Status:
        """Running; done at the goal; failed, with the plan's reason."""
        return self.small.status

    @property
    def costed(self) -> Plan:
        """The plan as it costs: that of somebody of the standard size."""
        return self.small.plan

    def wished(self, ground: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """The velocity (3,) that he wishes for at a ground frame (3,), as he moves (3,)."""
        return self.small.wished(ground / places(self.factor), velocity / speeds(self.factor)) * speeds(self.factor)

    def floors(self, way: np.ndarray, floor: float) -> np.ndarray:
        """How high (P,) [m] he stands at one place (P, 2) of his way after the other, from a floor so high [m]."""
        return self.small.floors(np.asarray(way, float) / self.factor, floor / self.factor) * self.factor


def in_size(lead: Leading, state: CharacterState, intent: Intent, walker: Controller, walks: bool, dt: float) -> tuple[Going | None, Intent]:
    """What `lead` gives of somebody of the standard size, of one of another."""
    factor, goal = walker.size, intent.goal
    assert goal is not None  # or nobody would be led
    body, before = Sized(walker, factor, dt), state.going if isinstance(state.going, Large) and state.going.factor == walker.size else None
    asked = but(intent, goal=but(goal, place=tuple(value / factor for value in goal.place), within=None if goal.within is None else goal.within / factor**0.5),
                velocity=intent.velocity / speeds(factor), around=shrunk(intent.around, factor), aside=None if intent.aside is None else intent.aside / speeds(factor))
    way, led = lead(Small.of(state, factor, None if before is None else before.small), asked, body, walks, body.step_there)
    return (None if way is None else Large.of(way, intent, asked, factor, before),
            but(intent, velocity=led.velocity * speeds(factor), leap=intent.leap if led.leap is intent.leap else body.leapt(led.leap), halt=None if led.halt is None else led.halt * places(factor)))


def _grown_goal(goal: Goal, factor: float) -> Goal:
    return but(goal, place=tuple(value * factor for value in goal.place), within=None if goal.within is None else goal.within * factor**0.5)


def _grown_plan(plan: Plan, factor: float) -> Plan:
    return but(plan, coefficients=plan.coefficients * places(factor), seconds=plan.seconds * factor**0.5, goal=plan.goal * places(factor))


def _grown_leap(leap: Crossing, factor: float) -> Crossing:
    return Crossing(leap.ground * places(factor), leap.place * factor, leap.height * factor)
