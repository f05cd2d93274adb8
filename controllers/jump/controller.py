"""The jump controller: ``state', pose = jump.step(state, intent, dt)``, one planned jump at a time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..body import Pose, Skeleton, centre_of_mass, forward_kinematics, wrap
from ..contract import CharacterState, Controller, Intent, Status, level, seconds
from ..navigation import floor_at, gap
from .body import FLAT, GRAVITY, Physique, Start, along, landing_feet, soles, vectors
from .feasibility import Refused, fault, wrong
from .motion import Path, Plan, fall, over_nothing, path, struck
from .planner import plan
from .prior import Prior
from .sweep import touches

READY, HOLDS, OVER = 1.0, 1.5, 0.3
"""How well it bids when a jump is asked and possible; how firmly it holds on to one; once it is landed
and somebody wants to walk."""
RUNNING = 1.2
"""Faster than this [m/s] one foot pushes and the jump waits for it to strike."""
FRESH = -0.06
"""A foot has just struck while the body is no further than this past it [m]: still behind it."""
UP = 0.06
"""A foot higher than this over the floor is in the air [m]."""
HEIGHTS = 1.0, 1.12, 1.26, 1.42, 1.6
"""What the airtime is multiplied by until the arc clears what stands in its way."""
WAYS = (False, False), (False, True), (True, True)
"""With which arms, down or not, and legs, drawn up or not, a body tries to pass what is in its way."""
BACK = 1.0, 0.85, 0.6
"""A place that is offered instead of another is planned, too: if something would be touched there, less far on the way."""
TRIES = 3
"""With so many plans at most: who was refused shall not wait for the reason."""
CARRIED = (0.75,), (0.6,), (0.95,), (1.2,)
"""For so long [s] a run would carry a body that leaps without effort, on Earth, at standard height: the usual first."""
FLUSH = 0.03
"""A target lies on the floor if it is no farther from it than this [m]; only told where something stands about."""
PULLS = 0.1, 100.0
"""How hard a world may pull [m/s²]: on a little moon of ten metres' jumps, and on one where nobody gets up."""
RISEN = 0.45
"""So long after touch-down [s] a jumper can walk on."""
KEPT = 32
"""So many plans are known for a while: who asks whether a leap can be made makes it soon."""
MOST_HITS = 3
"""A body that still touches something after so many hits slips by."""


@dataclass(frozen=True, eq=False)
class Jumping:
    """What a jumper remembers. time: [s] since the plan began. fault: what was struck in mid-air, from where the
    plan is a fall. hits: how often."""

    plan: Plan
    time: float = 0.0
    fault: str = ""
    hits: int = 0

    @property
    def landed(self) -> bool:
        """Whether the feet have come down."""
        return self.time >= self.plan.touch_down


class Jump(Controller):
    """Jumps to where `intent.leap` says, from rest, a walk or a run.

    physique: whose body. gravity: (3,) [m/s²], see PULLS. ValueError for another. prior: how people carry themselves, the shipped
    one by default.
    Pre-condition: both feet stand, or one of a runner has just struck; the target is within reach
    (path, strength, room). Post-condition: it stands on both feet over the target, or still moves
    forward over them with the velocity that the state says. Expected performance: nothing comes in
    its way in the air.
    """

    def __init__(self, physique: Physique = Physique(), gravity=GRAVITY, prior: Prior | None = None):
        self.physique, self.prior = physique, prior or Prior.load()
        self._lately: tuple[tuple[Any, Sequence[Any], tuple[Plan | None, str]], ...] = ()
        self.gravity = np.asarray(gravity, float)
        if self.gravity.shape != (3,) or not np.isfinite(self.gravity).all() or not PULLS[0] <= -self.gravity[1] <= PULLS[1] \
                or np.hypot(self.gravity[0], self.gravity[2]) > 1e-9:
            raise ValueError(f"gravity must pull straight down by {PULLS[0]:g} … {PULLS[1]:g} m/s², got {gravity!r}")

    @property
    def skeleton(self) -> Skeleton:
        """The skeleton that the poses are of."""
        return self.physique.skeleton

    @property
    def kind(self) -> str:
        """What tells its motion from that of other jumpers."""
        return f"Jump {self.physique} {self.gravity.tolist()}"

    def precondition(self, state: CharacterState, intent: Intent) -> float:
        """READY if the jump that is asked can start now; while one goes on, how firmly it holds on."""
        if isinstance(state.memory, Jumping):
            walks = bool(np.abs(intent.velocity).max() > 0.05) or intent.leap is not None
            landed = state.memory.time > state.memory.plan.touch_down + RISEN
            return OVER if walks and landed else HOLDS
        if intent.around and self._lost_floor(state, intent):
            return HOLDS
        if intent.leap is None:
            return 0.0
        return READY if self._moment(state) else 0.0

    def enter(self, state: CharacterState, intent: Intent) -> CharacterState:
        """The state at the beginning of a planned jump, or of a fall if it stepped over an edge. Refused, with the reason, if
        the jump can't be made."""
        if intent.around and self._lost_floor(state, intent):
            fallen = fall(self.physique, self.start_of(state), None, intent.around, self.gravity)
            return replace(state, memory=Jumping(fallen, 0.0, "there was nothing to step on"))
        return replace(state, memory=Jumping(self.plan(state, intent)))

    def plan(self, state: CharacterState, intent: Intent) -> Plan:
        """The jump that `intent.leap` asks for, from the state as it is. Refused, with the reason."""
        leap = intent.leap
        if leap is None:
            raise Refused("nobody asked for a jump")
        start, floor = self.start_of(state), float(level(state.floor))
        here = self.middle(start, floor)
        place = here if leap.place is None else np.asarray(leap.place, float)
        if place.shape != (3,) or not np.isfinite(place).all():
            raise Refused(f"the target must be three finite numbers, got {leap.place!r}")
        if leap.airtime is not None and not 0.05 <= leap.airtime <= 10.0:
            raise Refused(f"the airtime must be within 0.05 … 10 s, got {leap.airtime!r}")
        made, reason = self._made(start, place, floor, leap.airtime, intent.around)
        if made is not None:
            return made
        if leap.airtime is not None:
            other = self._made(start, place, floor, None, intent.around)[0]
            if other is not None and abs(other.path.airtime - leap.airtime) > 0.01:
                raise Refused(f"{leap.airtime:g} s in the air is too {'long' if leap.airtime > other.path.airtime else 'short'} for this "
                              f"body there; the jump takes {other.path.airtime:.2f} s")
        raise Refused(reason, self.nearest(start, place, floor, leap.airtime, intent.around), here)

    def _made(self, start: Start, place: np.ndarray, floor: float, airtime: float | None,
              around: Sequence[Any], tries: int | None = None) -> tuple[Plan | None, str]:
        """A plan that touches nothing, or None and why there is none. Where something is in the way of its limbs, they are drawn up, or
        it jumps higher. tries: so many plans at most. What was asked just now is not planned again."""
        asked = (*(part if part is None or isinstance(part, float | int) else part.tobytes() for part in vars(start).values()),
                 place.tobytes(), floor, airtime, tries)
        for known, things, made in self._lately:
            if known == asked and (things is around or list(things) == list(around)):
                return made
        made = self._planned(start, place, floor, airtime, around, tries)
        self._lately = (*self._lately[1 - KEPT:], (asked, around, made))
        return made

    def _planned(self, start: Start, place: np.ndarray, floor: float, airtime: float | None,
                 around: Sequence[Any], tries: int | None) -> tuple[Plan | None, str]:
        """What `_made` gives, planned."""
        why = self.footing(start, place, floor, around)
        if why:
            return None, why
        told, count = "", 0
        for way, why in self.arcs(start, place, floor, airtime, around):
            if not why:
                made, count = plan(self.physique, start, way, place, floor), count + 1
                why = wrong(self.physique, made) or str(touches(self.physique, made, around) or "")
                if not why:
                    return made, ""
            told = told or why
            if count == tries:
                break
        return None, told

    def refusal(self, state: CharacterState, intent: Intent) -> str:
        """Why the jump that `intent.leap` asks for can't be made from a state; "" if it can: it is planned, and swept, too."""
        start, floor = self.start_of(state), float(level(state.floor))
        if intent.leap is None:
            return "nobody asked for a jump"
        place = self.middle(start, floor) if intent.leap.place is None else np.asarray(intent.leap.place, float)
        return self._made(start, place, floor, intent.leap.airtime, intent.around)[1]

    def survey(self, start: Start, place: np.ndarray, floor: float, airtime: float | None = None,
               around: Sequence[Any] = ()) -> tuple[Path, str]:
        """The path to a place (3,) off a floor [m], and why it can't be gone, if so: a look at the place, then `arcs`; nothing is planned."""
        why = self.footing(start, place, floor, around)
        if why:
            return self.path(start, place, floor, airtime), why
        first = None
        for way, why in self.arcs(start, place, floor, airtime, around):
            first = first or (way, why)
            if not why:
                return way, ""
        assert first is not None  # there is always one
        return first

    def footing(self, start: Start, place: np.ndarray, floor: float, around: Sequence[Any]) -> str:
        """Why nobody can stand at a place (3,), if so."""
        around = [thing for thing in around if not hasattr(thing, "place")]
        if any(gap(place[None] + [0.0, 0.05, 0.0], thing)[0] < 0.0 for thing in around):
            return "that place is inside something solid"
        below = floor_at(place[0], place[2], around, place[1] + FLUSH)
        if around and below < place[1] - FLUSH:
            return f"there is nothing to land on at {place[1]:.2f} m; the floor there lies at {below:.2f} m"
        body = self.physique.tables
        corners = soles(landing_feet(place, start.heading, body), body)
        if around and min(floor_at(x, z, around, place[1] + FLUSH) for x, _, z in corners) < place[1] - FLUSH:
            return "too near an edge: only part of its feet would find floor"
        return ""

    def arcs(self, start: Start, place: np.ndarray, floor: float, airtime: float | None = None,
             around: Sequence[Any] = ()) -> Iterator[tuple[Path, str]]:
        """The paths to a place, and why each can't be gone, if so: the usual one first; where something stands about then with the legs
        drawn up and the arms down and, without an airtime, higher."""
        first = None
        for higher in HEIGHTS:
            flight = airtime if first is None else first.airtime * higher
            for low, tucked in WAYS if len(around) else WAYS[:1]:
                if first is not None and higher > 1.0 and not tucked:
                    continue
                way = self.path(start, place, floor, flight, low, tucked)
                first = first or way
                yield way, fault(self.physique, way, around, floor)
                if not way.strong:
                    return
            if airtime is not None or not len(around):
                return

    def nearest(self, start: Start, place: np.ndarray, floor: float, airtime: float | None = None,
                around: Sequence[Any] = ()) -> np.ndarray | None:
        """The place (3,) [m] that can be reached nearest to a refused one, by bisection on the way there from one that takes
        no effort: where it stands, or where a run would carry the body. None if that can't be reached either."""
        here = self.middle(start, floor)

        def reached(there: np.ndarray) -> bool:
            if len(around):
                there[1] = floor_at(there[0], there[2], around, max(place[1], floor) + 1e-6)
            return not self.survey(start, there, floor, airtime, around)[1]
        run = start.velocity * FLAT * np.sqrt(9.81 * self.physique.size / -self.gravity[1])
        easy = here + np.array([[0.0]] if start.single is None else CARRIED) * run
        found = next((there for there in easy if reached(there)), None)
        if found is None:
            return None
        low, high, begun = 0.0, 1.0, found.copy()
        for _ in range(7):
            middle = 0.5 * (low + high)
            there = begun + middle * (place - begun)
            if reached(there):
                low, found = middle, there
            else:
                high = middle
        for share in BACK:
            there = begun + share * (found - begun)
            there[1] = found[1] if not len(around) else floor_at(there[0], there[2], around, max(place[1], floor) + 1e-6)
            if self._made(start, there, floor, airtime, around, TRIES)[0] is not None:
                return there
        return None

    def middle(self, start: Start, floor: float) -> np.ndarray:
        """The middle (3,) of both soles as they come to stand on a floor [m]: where a jump straight up lands."""
        body = self.physique.tables
        return soles(start.planted(floor, body), body).mean(0) * FLAT + [0.0, floor, 0.0]

    def path(self, start: Start, place: np.ndarray, floor: float, airtime: float | None = None, low_arms: bool = False,
             tucked: bool = False) -> Path:
        """The path estimate alone: the arc to draw while aiming."""
        body = self.physique.tables
        feet = start.planted(floor, body)
        pushing = feet if start.single is None else feet[start.single:start.single + 1]
        return path(self.physique, start, pushing, landing_feet(place, start.heading, body), floor,
                    self.gravity, airtime, low_arms, self.prior, tucked)

    def start_of(self, state: CharacterState) -> Start:
        """What a jump needs to know of a state."""
        skeleton, masses = self.skeleton, self.physique.anatomy
        pose = Pose(np.asarray(state.pose.root, float), np.asarray(state.pose.rotations, float))
        positions, turned = forward_kinematics(skeleton, pose.root, pose.rotations)
        centre = centre_of_mass(masses, positions, turned)
        velocity, rates, feet_rates = np.zeros(3), np.zeros((len(skeleton), 3)), np.zeros((2, 5))
        feet = self._feet(positions, turned)
        if state.previous is not None and state.elapsed > 0.0:
            before = forward_kinematics(skeleton, np.asarray(state.previous.root, float),
                                        np.asarray(state.previous.rotations, float))
            velocity = (centre - centre_of_mass(masses, *before)) / state.elapsed
            moved = feet - self._feet(*before)
            moved[:, 3:] = wrap(moved[:, 3:])
            standing = np.any(np.asarray(state.contacts).reshape(2, 2), axis=1)
            feet_rates = np.where(standing[:, None], 0.0, moved / state.elapsed)
            rates = vectors(pose.rotations @ np.swapaxes(np.asarray(state.previous.rotations, float), -1, -2)) / state.elapsed
        return Start(pose.root, pose.rotations, rates, centre, velocity, feet, float(state.ground[2]),
                     feet_rates, self._single(state, feet))

    def _feet(self, positions: np.ndarray, turned: np.ndarray) -> np.ndarray:
        """The feet (2, 5) of a placed body: balls, yaw, pitch."""
        feet = np.zeros((2, 5))
        for side, name in enumerate(("Left", "Right")):
            foot = turned[self.skeleton.index(name + "Foot")]
            feet[side, :3] = positions[self.skeleton.index(name + "Toe")]
            feet[side, 3] = np.arctan2(foot[0, 2], foot[2, 2])
            feet[side, 4] = np.arcsin(np.clip(-foot[1, 2], -1.0, 1.0))
        return feet

    def step(self, state: CharacterState, intent: Intent, dt: float) -> tuple[CharacterState, Pose]:
        """One step of dt seconds along the planned jump. ValueError unless 0 < dt ≤ 0.1."""
        dt = seconds(dt)
        level(state.floor)
        jumping: Jumping = state.memory
        made, time = jumping.plan, min(jumping.time + dt, jumping.plan.duration)
        pose = made.at(time)
        n = int(np.clip(np.searchsorted(made.times, time) , 0, len(made.times) - 1))
        landed = time >= made.touch_down
        floor = float(made.feet[0, 1] - self.physique.tables.sole) if landed else float(state.floor)
        heading = float(state.ground[2])
        ground = np.array([made.centres[n, 0], made.centres[n, 2], heading])
        c, s = np.cos(heading), np.sin(heading)
        vx, _, vz = made.velocities[n]
        velocity = np.array([s * vx + c * vz, 0.0, c * vx - s * vz])
        after = replace(state, ground=ground, velocity=velocity, pose=pose, contacts=made.contacts[n].copy(),
                        memory=replace(jumping, time=time), floor=floor)
        if made.take_off < time < made.touch_down and intent.around and jumping.hits < MOST_HITS:
            after = self._hit(after, intent.around, dt)
        return after, pose

    def _hit(self, state: CharacterState, around: Sequence[Any], dt: float) -> CharacterState:
        """The state as it is if it strikes nothing in the air, else at the beginning of a fall."""
        jumping: Jumping = state.memory
        made, time = jumping.plan, jumping.time
        flown, way = time - made.take_off, made.path
        velocity = way.velocity + flown * self.gravity
        hit = struck(self.skeleton, state.pose, along(way.leave, way.velocity, flown, self.gravity), velocity, around)
        if hit is None:
            return state
        before = max(time - dt, 0.0)
        start = self.start_of(replace(state, previous=made.at(before), elapsed=time - before))
        fallen = fall(self.physique, replace(start, velocity=velocity), hit, around, self.gravity)
        return replace(state, memory=Jumping(fallen, 0.0, hit.reason, jumping.hits + 1))

    def status(self, state: CharacterState) -> Status:
        """Running until it stands; one that struck something says so at once, and fails once it stands."""
        jumping: Jumping = state.memory
        if jumping.time < min(jumping.plan.through, jumping.plan.duration):
            return Status("running", jumping.fault)
        if jumping.fault:
            return Status("failed", jumping.fault)
        return Status("done", "it has landed and can't stop here" if jumping.time >= jumping.plan.through else "")

    def _lost_floor(self, state: CharacterState, intent: Intent) -> bool:
        """Whether it stands on nothing: looked at only where the floor ahead lies lower."""
        x, z, heading = state.ground
        ahead, left = np.asarray(state.velocity, float)[[0, 2]] * 0.2
        c, s = np.cos(heading), np.sin(heading)
        x, z = x + s * ahead + c * left, z + c * ahead - s * left
        if np.ndim(state.ground) != 1 or floor_at(x, z, intent.around) > float(state.floor) - 0.2 * self.physique.size:
            return False
        return over_nothing(self.skeleton, state.pose, state.contacts, intent.around, self.physique.size)

    def _moment(self, state: CharacterState) -> bool:
        """Whether a jump can start at this moment: standing feet, or a foot that has just struck."""
        start = self.start_of(state)
        low = start.feet[:, 1] - float(state.floor) < self.physique.tables.sole + UP * self.physique.size
        if np.hypot(start.velocity[0], start.velocity[2]) < RUNNING:
            return bool(low.any())
        if start.single is None:
            return False
        towards = start.velocity * FLAT / np.hypot(start.velocity[0], start.velocity[2])
        return bool((start.centre - start.feet[start.single, :3]) @ towards < FRESH)

    def _single(self, state: CharacterState, feet: np.ndarray) -> int | None:
        """The foot that pushes a runner off: the one that stands, if the other is in the air."""
        if np.hypot(state.velocity[0], state.velocity[2]) < RUNNING:
            return None
        standing = np.asarray(state.contacts).reshape(2, 2).any(1)
        return int(np.argmax(standing)) if standing.sum() == 1 else None
