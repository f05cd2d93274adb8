"""The world: characters and their controllers, stepped at a fixed rate.

A world is a value. Stepping it gives the next one and leaves the old as it was, so pausing,
rewinding, replaying and drawing in between need nothing more than keeping worlds.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from gambol.controllers.body import Pose, forward_kinematics, wrap
from gambol.controllers.contract import CharacterState, Intent, but
from gambol.controllers.navigation import drift
from gambol.controllers.navigation.crowd import Turns

from ..scene import TINT, Figure, Prop
from .centre_of_mass import CentreOfMass, centre_of
from .collisions import falls_beside, in_the_way, kept_apart, run_into
from .followers import KEPT, Follows, carried, errors, joint_errors
from .watched import Watches

RATE = 60
"""Simulation steps a second, whatever the display does."""
DT = 1.0 / RATE
TRAIL_EVERY = 6
TRAIL_LENGTH = 150
FLOOR_LIFT = 0.01
"""How high trails and paths are drawn above the floor [m]."""

RISE, CROUCH = 0.08, 0.45
"""A pelvis no further than this above or below where it stands [m] lifts and lowers no camera."""


@dataclass(frozen=True, eq=False)
class Character:
    """Somebody in the world.

    controller: keeps `gambol.controllers.contract.Controller` and has the `skeleton` that it moves; one with a
    `body` (`gambol.game.render.mesh.Body`) is drawn in it.
    intent: what was last asked of the character. trail: (N, 3) [m] where it was, oldest first.
    follows: whose points it follows, watches: which cameras see whom it is to be like; None of both for somebody with a will.
    told: (N, 4) its `followers.errors`, oldest first.
    opacity: 1 for a body, less for a ghost. centre_of_mass: how its centre of mass is borne; None before its first step.
    enters, leaves: when it is there [s]; before and afterwards it stays as it is, and nobody sees it.
    """

    name: str
    controller: Any
    state: CharacterState
    tint: tuple[float, float, float] = TINT
    intent: Intent = field(default_factory=Intent)
    trail: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    follows: Follows | None = None
    told: np.ndarray = field(default_factory=lambda: np.zeros((0, 4)))
    opacity: float = 1.0
    centre_of_mass: CentreOfMass | None = None
    enters: float = 0.0
    leaves: float = math.inf
    watches: Watches | None = None

    def there(self, number: int) -> bool:
        """Whether it is there after so many steps of the world."""
        return round(RATE * self.enters) <= number < RATE * self.leaves - 0.5

    @property
    def joints(self) -> tuple[np.ndarray, np.ndarray]:
        """World positions (J, 3) [m] and orientations (J, 3, 3) of its body."""
        pose = self.state.pose
        return forward_kinematics(self.controller.skeleton, pose.root, np.asarray(pose.rotations, float))

    @property
    def level(self) -> float:
        """How high the floor seems to lie [m] that carries it, for whoever looks: in the air it goes along."""
        floor, root = float(self.state.floor), float(self.state.pose.root[1])
        over = root - floor - float(self.controller.skeleton.offsets[0, 1])
        return floor + max(over - RISE, 0.0) + min(over + CROUCH, 0.0)

    def step(self, intent: Intent, number: int) -> Character:
        """One step on; `number` is that of the step that ends."""
        state, _ = self.controller.step(self.state, intent, DT)
        trail = self.trail
        if number % TRAIL_EVERY == 0:
            here = np.array([[state.ground[0], float(state.floor) + FLOOR_LIFT, state.ground[1]]])
            trail = np.concatenate([trail[-(TRAIL_LENGTH - 1):], here])
        made = but(self, state=state, intent=intent, trail=trail)
        centre = centre_of(made.controller, state.pose)
        centre_of_mass = self.centre_of_mass or CentreOfMass.begun(before := centre_of(self.controller, self.state.pose), (centre - before) / DT)
        return but(made, centre_of_mass=centre_of_mass.step(centre, DT))

    def tracked(self, performers: Mapping[str, Character], number: int) -> Character:
        """One step on of somebody whom cameras make out of a performer. performers: who has made that step, by name."""
        watches = self.watches
        assert watches is not None  # all others have made their step
        performer, sighting = performers.get(watches.performer), None
        if performer is None:
            return self.step(Intent(), number)
        there = performer.joints
        if watches.due(number):
            sighting = watches.sighting(*there, number)
        made = self.step(Intent(sighting=sighting), number)
        told = joint_errors(made.joints[0], there[0] + watches.beside)
        return but(made, intent=Intent(), told=np.concatenate([self.told[-(KEPT - 1):], told[None]]))

    def after(self, performers: Mapping[str, Character], intent: Intent, number: int) -> Character:
        """One step on of a follower. performers: who has made that step, by name."""
        from gambol.controllers.reconstruction import towards  # a game without a study starts without

        old, seen, turns, truth, follows = self, intent.points, intent.turns, None, self.follows
        assert follows is not None  # all others have made their step
        performer = performers.get(follows.performer)
        if performer is not None:
            there = performer.joints
            seen, turns, truth = follows.seen(*there, number / RATE), follows.turns(there[1], number / RATE), there[0]
            old = but(self, state=carried(follows, self.state, truth, intent.around))
        if seen is None:
            return self.step(intent, number)
        made = old.step(replace(intent, velocity=towards(self.state, seen), points=seen, turns=turns), number)
        told = errors(follows, made.joints, truth, seen)
        return but(made, told=np.concatenate([self.told[-(KEPT - 1):], told[None]]))


@dataclass(frozen=True, eq=False)
class World:
    """All that is simulated at one moment. number: steps made since the start. turns: whose turn it is at doors, where people mind that."""

    characters: tuple[Character, ...] = ()
    props: tuple[Prop, ...] = ()
    number: int = 0
    turns: Turns | None = None

    @property
    def time(self) -> float:
        """Seconds of simulation since the start: exact, as it is counted, not summed."""
        return self.number / RATE

    def step(self, intents: Sequence[Intent]) -> World:
        """The world one sixtieth of a second later; one intent for each character, in order.

        Who runs into another is struck, as the other is; who walks is held before who stands or lies. Who is tracked comes after whom cameras see, and followers last: they see where their performer is now.
        """
        if len(intents) != len(self.characters):
            raise ValueError(f"{len(self.characters)} characters need as many intents, got {len(intents)}")
        number = self.number + 1
        intents = [but(intent, around=falls_beside(self.characters, self.number, self.props, i) if intent.strike is not None
                       else self.about(i) if intent.goal is not None or intent.leap is not None else self.props)
                   for i, intent in enumerate(kept_apart(self.characters, run_into(self.characters, intents, self.number), self.number))]
        made = [one if not one.there(self.number) else None if one.follows or one.watches else one.step(intent, number)
                for one, intent in zip(self.characters, intents)]
        performers = {one.name: one for one in made if one is not None}
        made = [old.tracked(performers, number) if new is None and old.watches else new for new, old in zip(made, self.characters)]
        performers = {one.name: one for one in made if one is not None}
        return but(self, number=number, characters=tuple(
            new or old.after(performers, intent, number)
            for new, old, intent in zip(made, self.characters, intents)))

    def about(self, who: int) -> tuple[Prop, ...]:
        """What stands about for a character, by its number, who plans a way or a leap: the props, and others who lie on the floor."""
        return in_the_way(self.characters, self.number, self.props, who)

    def index(self, name: str) -> int:
        """The number of a character. KeyError, naming it, if there is none."""
        for i, character in enumerate(self.characters):
            if character.name == name:
                return i
        raise KeyError(name)


@dataclass(frozen=True)
class FixedStep:
    """Turns the display's uneven frames into whole steps.

    cap: the most steps that one frame may ask for; what a late frame owes beyond is dropped,
    so that a slow machine runs slower instead of falling ever further behind.
    owed: seconds not yet simulated, less than one step. dropped: seconds given up so far. Steps,
    owed and dropped time are together exactly the time that has passed.
    """

    cap: int = 12
    owed: float = 0.0
    dropped: float = 0.0

    def add(self, seconds: float) -> tuple[int, FixedStep]:
        """How many steps to make now that `seconds` have passed, and what is owed afterwards.

        Negative, infinite and undefined times count as none.
        """
        owed = self.owed + (seconds if 0.0 <= seconds < np.inf else 0.0)
        # a hair of slack, so that frames of exactly one step never skip a beat by rounding
        steps = int(owed / DT + 1e-6)
        if steps > self.cap:
            return self.cap, but(self, owed=0.0, dropped=self.dropped + owed - self.cap * DT)
        return steps, but(self, owed=owed - steps * DT)

    @property
    def alpha(self) -> float:
        """How far the moment to draw lies between the last step but one and the last, 0 … 1."""
        return min(max(self.owed / DT, 0.0), 1.0)


def ground_between(before: CharacterState, after: CharacterState, alpha: float) -> np.ndarray:
    """The ground frame (..., 3) between two states, the heading by the shorter way round."""
    change = after.ground - before.ground
    change = np.concatenate([change[..., :2], wrap(change[..., 2:])], -1)
    return before.ground + alpha * change


def pose_between(before: Pose, after: Pose, alpha: float) -> Pose:
    """The pose between two: the root on a line, each joint by the shortest rotation."""
    if alpha <= 0.0:
        return before
    if alpha >= 1.0:
        return after
    turn = Rotation.from_matrix(np.swapaxes(before.rotations, -1, -2) @ after.rotations).as_rotvec()
    return Pose(before.root + alpha * (after.root - before.root),
                before.rotations @ Rotation.from_rotvec(alpha * turn).as_matrix())


def figures(before: World, after: World, alpha: float, predict: float = 1.5) -> tuple[Figure, ...]:
    """What to draw of the characters between two worlds.

    predict: seconds of the path ahead, if each character keeps the velocity it was asked for; who goes to a goal has all of the plan ahead.
    """
    drawn = []
    for old, new in zip(before.characters, after.characters):
        pose = pose_between(old.state.pose, new.state.pose, alpha)
        positions, orientations = forward_kinematics(new.controller.skeleton, pose.root, pose.rotations)
        ground = ground_between(old.state, new.state, alpha)
        way = new.state.going
        ahead = drift(ground, new.intent.velocity, np.linspace(0.0, predict, 16)) if way is None else \
            np.vstack([ground, way.plan.at(np.linspace(min(way.time, way.plan.seconds), way.plan.seconds, 48))[0]])
        lift = float(new.state.floor) + FLOOR_LIFT
        along = np.full(len(ahead), lift) if way is None else way.floors(ahead[:, :2], float(new.state.floor)) + FLOOR_LIFT
        here = np.array([[ground[0], lift, ground[1]]])
        contacts = (old if alpha < 0.5 else new).state.contacts
        drawn.append(Figure(positions, orientations, new.tint, contacts,
                            np.concatenate([old.trail, here]),
                            np.stack([ahead[:, 0], along, ahead[:, 1]], -1),
                            new.controller.body, opacity=new.opacity if new.there(before.number) else 0.0))
    return tuple(drawn)
