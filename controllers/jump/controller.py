"""The jump controller: ``state', pose = jump.step(state, intent, dt)``, one planned jump at a time."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from ..body import Pose, Skeleton
from ..contract import CharacterState, Controller, Intent, Leap, Status, given, known, level, seconds
from ..navigation import STEP, floor_at
from ..navigation.passing import drawn_in
from .body import GRAVITY, Physique, Start, airtime_up, along, measures
from .crouching import Crouching, begun, crouched
from .motion import STANDS, Carried, Plan, as_shown, between_kernel, carried, fall, hangs, over_nothing, steps_over, struck
from .muscles import strongest
from .prior import Prior
from .reach import SETS_FEET, Found, How, Onward, Pieces, Reach, Refused, Seeking, meant, too_weak, whole
from .starting import FEET, Jumping, along_of, astride, cramped, goes, landed, off_one, off_under, on_ground, on_its_floor, ready, rebounding, sets_feet, standing, start_of, stayed, turning

LEVELS = 0.05
"""Who may land beside a place lands as high or low as it lies, to so much [m]."""
READY, HOLDS, OVER = 1.0, 1.5, 0.3
"""How well it bids when a jump is asked and possible; how firmly it holds on to one; once it is landed
and somebody wants to walk."""
STILL = 0.25
"""Who is slower than this [m/s, rad/s] stands, and may crouch."""
PULLS = 0.1, 100.0
"""How hard a world may pull [m/s²]: on a little moon of ten metres' jumps, and on one where nobody gets up."""
RISEN, SOONEST, ON = 0.45, 0.3, 0.12
"""So long after touch-down [s] a jumper has risen far enough to walk on; and sooner, but not before the second, as soon as so long [s] after the lowest point of his landing,
unless he struck something."""
RISES = 0.1
"""Who crouches, but still comes up faster than this [m/s], at standard height, goes down first: his legs can't pull."""
SPARES = 0.97
"""Straight up a body is asked for this share of how high its muscles would take it at most."""
SHIFTS = 8.0
"""Rate [1/s] with which the ground frame comes under the centre of mass, from where it was."""
DRAWN = 0.58, 0.15
"""Who falls draws his arms in beside what he falls past, in the first time [s]; who has landed before something, in the second."""
ABOUT, SHARES = (0.43, 2.9, 0.75), (0.95, 0.05, 0.15)
"""How far bodies leap from a stand, over their size, by how high they rise over it; and what share of that behind, more ahead and less aside: within 0.2 m of
what is found for bodies of 0.7 to 2.1 m, weak and strong."""
ELSEWHERE = 0.02
"""Whose pelvis is farther than this [m] from where it was as he began to seek, as he still went down into his crouch or came to rest, seeks once more before he is refused."""
MOST_HITS = 3
"""A body that still touches something after so many hits slips by."""


class Jump(Reach, Controller):
    """Jumps to where `intent.leap` says, from rest, a walk or a run.

    physique: whose body. gravity: (3,) [m/s²], see PULLS. ValueError for another. prior: how people carry themselves, the shipped
    one by default.
    Pre-condition: both feet stand, or one of a runner has just struck; the target is within reach
    (path, strength, room). Post-condition: it stands on both feet over the target, or still moves
    forward over them with the velocity that the state says. Expected performance: nothing comes in
    its way in the air.
    """

    def __init__(self, physique: Physique = Physique(), gravity=GRAVITY, prior: Prior | None = None):
        super().__init__(physique, np.asarray(gravity, float), prior or Prior.load())
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
        if isinstance(state.memory, Crouching):
            walks = bool(np.abs(intent.velocity).max() > 0.05)
            return HOLDS if intent.leap is not None or intent.aim is not None or not (walks or state.memory.stands) else OVER
        if isinstance(state.memory, Jumping):
            walks = bool(np.abs(intent.velocity).max() > 0.05) or intent.leap is not None
            made = state.memory.plan
            soon = made.touch_down + RISEN if state.memory.fault else min(made.touch_down + RISEN, max(made.lowest + ON, made.touch_down + SOONEST))
            landed = state.memory.time > max(soon, made.rolls)
            return OVER if walks and landed else HOLDS
        if intent.around and self._lost_floor(state, intent):
            return HOLDS
        if intent.leap is None:
            return READY if intent.aim is not None and self._stands(state) and not self._sets_feet(state) else 0.0
        return READY if self._ready(state, intent.leap, intent.around) and self._on_its_floor(state, intent.around) else 0.0

    def enter(self, state: CharacterState, intent: Intent) -> CharacterState:
        """The state at the beginning of a planned jump, of a crouch, or of a fall if it stepped over an edge. Refused, with the reason,
        if the jump can't be made."""
        return self._began(state, intent) or replace(state, memory=self._begins(self.plan(state, intent), state, intent.leap))

    def seek(self, state: CharacterState, intent: Intent, onward: Onward | None = None) -> CharacterState:
        """The same, of which no more is worked out than a step has time for. Refused for now, too, who still sets his feet."""
        began = self._began(state, intent)
        if began is not None:
            return began
        if self._sets_feet(state) and not along_of(state, intent.leap):
            raise Refused(SETS_FEET, onward=Onward(None))
        return replace(state, memory=self._begins(self.sought(state, intent, onward), state, intent.leap))

    def _begins(self, made: Plan, state: CharacterState, leap: Leap | None) -> Jumping:
        """The memory of one who begins a planned leap, his legs as they were shown."""
        roots, local = as_shown(self.physique, start_of(self.physique, state), made.times, made.roots, made.local)
        return Jumping.begun(replace(made, roots=roots, local=local), state, leap)

    def _began(self, state: CharacterState, intent: Intent) -> CharacterState | None:
        """The state at the beginning of what needs no plan, a crouch or a fall; None where a leap is asked."""
        if intent.around and self._lost_floor(state, intent):
            fallen = fall(self.physique, self.start_of(state), None, intent.around, self.gravity)
            return replace(state, memory=Jumping.begun(fallen, state, intent.leap, "there was nothing to step on"))
        if intent.leap is None and intent.aim is not None:
            start, floor = self.placed(state, around=intent.around)
            return replace(state, memory=begun(self, start, floor), floor=floor)
        return None

    def plan(self, state: CharacterState, intent: Intent) -> Plan:
        """The jump that `intent.leap` asks for, from the state as it is. Refused, with the reason."""
        found = whole(self._looked_for(state, intent))
        if isinstance(found, Found):
            return found.made
        raise Refused(*found)

    def sought(self, state: CharacterState, intent: Intent, onward: Onward | None = None) -> Plan:
        """The same, sought in pieces. onward: of the step before, where the same was asked, or of a place near by. Refused until a plan is found, with why there is none as
        far as that is known. Who stands looks at one plan in each step; who moves is elsewhere by then, and looks at all of them at once."""
        seeking, steps, began, asked, anew = self._seeks(state, intent) if onward is None or onward.seeking is None else onward
        assert seeking is not None
        steps += 1
        found, onward = seeking.after(steps), Onward(seeking, steps, began, asked, anew)
        if isinstance(found, str):
            raise Refused(found, onward=onward)
        leap = intent.leap
        if not isinstance(found, Found):
            if steps > 1 and not anew and float(np.linalg.norm(state.pose.root - began)) > ELSEWHERE:
                raise Refused("", onward=self._seeks(state, intent)._replace(anew=True))
            raise Refused(*found, onward=Onward(None) if self.placed(state, leap, intent.around)[0].bound else None)  # the next moment may do
        assert leap is not None  # or nothing would have been found
        if steps == 1:
            return found.made
        if isinstance(seeking.after(steps - 1), str):  # it was found just now: no step makes two plans
            raise Refused("", onward=onward)
        start, floor = self.placed(state, leap, intent.around)
        place = found.place if leap.place is None else found.place + (leap.place - asked)  # which may have moved meanwhile
        found = self.again(found.arc.how, start, place, floor, leap.airtime, intent.around)
        if found is None:  # he moved meanwhile, or it did
            raise Refused("", onward=self._seeks(state, intent))
        return found.made

    def _seeks(self, state: CharacterState, intent: Intent) -> Onward:
        """The beginning of seeking from a state."""
        place = None if intent.leap is None else intent.leap.place
        return Onward(Seeking(self._looked_for(state, intent, self._waits(state))), 0, np.array(state.pose.root, float), place)

    def _looked_for(self, state: CharacterState, intent: Intent, parted: bool = False) -> Pieces[Found | tuple[str, np.ndarray | None, np.ndarray]]:
        """The jump that `intent.leap` asks for, in pieces; if there is none why, the nearest place (3,) that can be reached, and where (3,) it stands.
        parted: whether plans are pieces of it, too."""
        leap = intent.leap
        if leap is None:
            raise Refused("nobody asked for a jump")
        start, place, floor, here = self._meant(state, leap, intent.around)
        asked = start, place, floor, leap.airtime, intent.around
        known = self.again(leap.how, *asked) if isinstance(leap.how, How) else None
        if known is not None:
            return known
        looked = self.seen(*asked, parted)
        found, reason = (yield from looked) if parted else whole(looked)
        if found is not None:
            return found
        if leap.airtime is not None:
            looked = self.seen(start, place, floor, None, intent.around, parted)
            other, _ = (yield from looked) if parted else whole(looked)
            if other is not None and abs(other.made.path.airtime - leap.airtime) > 0.01:
                if len(intent.around) and whole(self.seen(start, place, floor, leap.airtime, (), False))[0] is not None:  # the body could
                    return f"{reason}; it could be made in {other.made.path.airtime:.2f} s", None, here
                if leap.place is None and leap.airtime > self.longest:
                    return f"too high: this body gets {self.highest:.2f} m up at most, in {self.longest:.2f} s, and {leap.airtime:.2f} s were asked", None, here
                return (f"{leap.airtime:.2f} s in the air is too {'long' if leap.airtime > other.made.path.airtime else 'short'} for this "
                        f"body there; the jump takes {other.made.path.airtime:.2f} s", None, here)
        if start.along:  # nowhere else, but in some other moment
            return reason, None, here
        if start.single is None and not self.path(start, place, floor, leap.airtime).strong:
            usual = self.path(start, here, floor, leap.airtime)
            if not usual.strong and usual.airtime > self.longest:
                return too_weak(self.physique, usual, self.longest), None, here
        ahead = (place - here) / max(float(np.linalg.norm(place - here)), 1e-9)
        if leap.slack > 0.0 and max((self.easy(start, floor) - place) @ ahead) > 0.0:  # else the nearest place is no farther on
            nearest, found = whole(self.nearby(*asked))
            if nearest is not None and found is not None and 0.0 < float((nearest - place) @ ahead) <= leap.slack:
                return found
        else:
            if leap.slack == 0.0:
                yield reason
            nearest, found = yield from self.nearby(*asked)
            if nearest is not None and found is not None and np.linalg.norm(nearest - place) <= leap.slack and abs(nearest[1] - place[1]) <= LEVELS:
                return found
        return reason, nearest, here

    def refusal(self, state: CharacterState, intent: Intent) -> str:
        """Why the jump that `intent.leap` asks for can't be made from a state; "" if it can: it is planned, and swept, too."""
        return self.pondered(state, intent, lambda: None)

    def pondered(self, state: CharacterState, intent: Intent, ask: Callable[[], None]) -> str:
        """The same. ask: is called once more for so much work as most leaps are no more than."""
        known(state, intent)
        if intent.leap is None:
            return "nobody asked for a jump"
        try:
            start, place, floor, _ = self._meant(state, intent.leap, intent.around)
        except Refused as reason:
            return str(reason)
        return self.attempt(start, place, floor, intent.leap.airtime, intent.around, ask=ask)[1] or SETS_FEET * (self._sets_feet(state) and not along_of(state, intent.leap))

    def _meant(self, state: CharacterState, leap: Leap, around: Sequence[Any]) -> tuple[Start, np.ndarray, float, np.ndarray]:
        """From where a leap goes off, to which place (3,), off which floor [m], and where (3,) it stands. Refused where nobody can leap so from anywhere."""
        if leap.heading is not None and not np.isfinite(leap.heading):
            raise Refused(f"the heading must be a finite number of radians, or None, got {leap.heading!r}")
        if leap.on not in (None, *FEET):
            raise Refused(f"a leap lands on 'left', 'right' or 'both' to hop on, or None to stand, got {leap.on!r}")
        start, floor = self.placed(state, leap, around)
        here = self.middle(start, floor)
        place = here if leap.place is None else leap.place
        if leap.along:
            place = self._carried(state, start, floor, leap).place if start.along else self.easy(start, floor)[0]
            place[1] = floor_at(place[0], place[2], around, floor + STEP)
        return start, meant(place, leap.airtime), floor, here

    def _carried(self, state: CharacterState, start: Start, floor: float, leap: Leap) -> Carried:
        """How somebody leaves the foot that stands who goes slowly, aside or backward."""
        return carried(self.physique, start, goes(state), floor, -float(self.gravity[1]), leap.waited)

    def _ready(self, state: CharacterState, leap: Leap, around: Sequence[Any]) -> bool:
        """Whether a leap can start at this moment."""
        if not along_of(state, leap):
            start, waits = off_under(self.physique, start_of(self.physique, state), leap, state, -float(self.gravity[1]), around)
            return start.bound or not waits and ready(self.physique, state, around)
        start, floor = self.placed(state, leap, around)
        return start.along and self._carried(state, start, floor, leap).keeps

    def looks(self, state: CharacterState, intent: Intent) -> Pieces[Plan | str]:
        """The plan of the leap that intent.leap says from a state, or why there is none, in pieces."""
        leap = intent.leap
        if leap is None:
            return "nobody asked for a jump"
        if self._sets_feet(state) and not along_of(state, leap):
            return SETS_FEET
        try:
            start, place, floor, _ = self._meant(state, leap, intent.around)
        except Refused as reason:
            return str(reason)
        found, why = yield from self.seen(start, place, floor, leap.airtime, intent.around, False)
        return why if found is None else found.made

    def found(self, state: CharacterState, intent: Intent) -> Leap | None:
        """The leap that can be made from a state, with how; None where it can't."""
        leap = intent.leap
        if leap is None:
            return None
        try:
            start, place, floor, _ = self._meant(state, leap, intent.around)
        except Refused:
            return None
        found, _ = whole(self.seen(start, place, floor, leap.airtime, intent.around, False))
        return None if found is None else replace(leap, how=found.arc.how)

    @cached_property
    def longest(self) -> float:
        """How long [s] it can be in the air at most as it jumps straight up from a stand."""
        return airtime_up(self.physique, self.highest, self.gravity)

    @cached_property
    def highest(self) -> float:
        """How far [m] it rises at most, having left the floor, as it jumps straight up from a stand."""
        heights = measures(self.physique)
        speed = strongest(self.physique, heights.leave(0.0) - heights.stand, self.gravity)
        return SPARES * 0.5 * speed**2 / -float(self.gravity[1])

    def about(self, aside: float = 0.0) -> float:
        """About how far [m] it leaps from a stand over level ground, so far aside [rad] of the way it faces: what is known at once, without a plan."""
        size, (least, more, power), (even, ahead, less) = self.physique.size, ABOUT, SHARES
        return size * (least + more * (self.highest / size)**power) * (even + ahead * math.cos(aside) - less * math.sin(aside)**2)

    def landing(self, state: CharacterState) -> CharacterState:
        """The state of somebody who jumps as he will stand once he has landed, if it is on both feet; of everybody else as it is."""
        memory = state.memory
        return state if not isinstance(memory, Jumping) or memory.plan.path.lands is not None else landed(self.physique, state, memory.plan)

    def start_of(self, state: CharacterState, leap: Leap | None = None, around: Sequence[Any] = ()) -> Start:
        """What a jump needs to know of a state, of how a leap shall land, and of the ground among boxes and pillars around."""
        return self.placed(state, leap, around)[0]

    def placed(self, state: CharacterState, leap: Leap | None = None, around: Sequence[Any] = ()) -> tuple[Start, float]:
        """The same, and how high the floor is [m] off which it goes: under the lower foot of who stands astride an edge."""
        known(state)
        memory, start = state.memory, start_of(self.physique, state, isinstance(state.memory, Crouching))
        if isinstance(memory, Jumping):
            return on_ground(turning(rebounding(start, memory.plan, memory.time) if memory.rebounds else start, leap), state, around), float(level(state.floor))
        gravity = -float(self.gravity[1])
        start = turning(off_under(self.physique, off_one(self.physique, start, leap, state, gravity), leap, state, gravity, around)[0], leap)
        return astride(self.physique, on_ground(cramped(start, leap, np.asarray(state.ground, float), around), state, around), state)

    def step(self, state: CharacterState, intent: Intent, dt: float) -> tuple[CharacterState, Pose]:
        """One step of dt seconds along the planned jump. ValueError unless 0 < dt ≤ 0.1, and for who was set elsewhere since the last one."""
        given(state, intent)
        dt = seconds(dt)
        level(state.floor)
        if not isinstance(state.memory, Crouching | Jumping):
            raise ValueError("this state is of nobody who jumps: enter it first")
        stayed(state.memory.stood, state)
        if isinstance(state.memory, Crouching):
            state = self._released(state, intent)
        elif state.memory.time > state.memory.plan.take_off:
            state = self._followed(state, intent)
        if isinstance(state.memory, Crouching):
            after = crouched(self, state, intent.leap or intent.aim, dt, intent.around)
            pose = self._drawn_in(after.pose, after.ground, intent.around, after.memory.time / DRAWN[0])
            return replace(after, pose=pose), pose
        jumping: Jumping = state.memory
        made, time = jumping.plan, min(jumping.time + dt, jumping.plan.duration)
        pose = made.at(time)
        n = int(np.clip(np.searchsorted(made.times, time) , 0, len(made.times) - 1))
        landed = time >= made.touch_down
        floor = float(made.feet[:, 1].mean() - self.physique.tables.sole) if landed else float(state.floor)
        centre, (vx, _, vz) = made.moving(time)
        turned = made.path.heading + float(made.path.turned(time))
        ground = np.array([*centre[[0, 2]], turned]) + jumping.shift * (1.0 + SHIFTS * time) * np.exp(-SHIFTS * time)
        under = ground.copy()
        if time > made.take_off and made.path.lands is None and not made.rolls:  # from under the mass centre to where the ground frame of one who stands so is
            share = min((time - made.take_off) / (made.touch_down + RISEN - made.take_off), 1.0)
            ground[:2] += share**2 * (3.0 - 2.0 * share) * (standing(self.physique, made) - centre[[0, 2]])
        heading = float(ground[2])
        c, s = np.cos(heading), np.sin(heading)
        velocity = np.array([s * vx + c * vz, 0.0, c * vx - s * vz])
        after = replace(state, ground=ground, velocity=velocity, pose=pose, contacts=made.contacts[n].copy(),
                        memory=replace(jumping, time=time, stood=np.array([*ground, floor])), floor=floor)
        if made.take_off < time < made.touch_down and intent.around and jumping.hits < MOST_HITS:
            after = self._hit(after, intent.around, dt)
        if jumping.fault or landed:  # a leap's sweep saw to its arms, but who has landed goes on to what he would stop before
            pose = self._drawn_in(pose, under, intent.around, time / DRAWN[0] if jumping.fault else (time - made.touch_down) / DRAWN[1])
            after = replace(after, pose=pose)
        return after, pose

    def _drawn_in(self, pose: Pose, ground: np.ndarray, around: Sequence[Any], share: float) -> Pose:
        """A pose with its arms drawn in beside what stands about, wholly from a share of 1 on."""
        if not around:
            return pose
        near, share = drawn_in(self.skeleton, pose, ground, around), min(share, 1.0)
        root, local = np.empty(3), np.empty_like(pose.rotations)
        between_kernel(pose.root, near.root, pose.rotations, near.rotations, share**2 * (3.0 - 2.0 * share), root, local)
        return Pose(root, local)

    def _released(self, state: CharacterState, intent: Intent) -> CharacterState:
        """The state of who crouches at the beginning of the jump that is asked; as it is where none is, or it can't be made: then it
        says why, and looks again only if something else is asked."""
        memory, leap = state.memory, intent.leap
        if leap is None:
            return state if memory.asked is None else replace(state, memory=replace(memory, refused="", asked=None, onward=None))
        return state if memory.rate[1] > RISES * math.sqrt(self.physique.size) else self._leapt(state, intent, leap)

    def _leapt(self, state: CharacterState, intent: Intent, leap: Leap) -> CharacterState:
        """The state at the beginning of a leap; where it can't be made yet, or at all, as it is, and with why. What was refused is not asked again."""
        memory, same, near = state.memory, leap.same(state.memory.asked), leap.near(state.memory.asked)
        if same and memory.onward is None:
            return state
        try:
            return replace(state, memory=self._begins(self.sought(state, intent, memory.onward if near else None), state, leap))
        except Refused as reason:
            why = str(reason) or (memory.refused if near and not same else "")  # of a place that moves it holds until more is known
            return replace(state, memory=replace(memory, refused=why, asked=leap, onward=reason.onward))

    def _followed(self, state: CharacterState, intent: Intent) -> CharacterState:
        """The state of who comes down at the beginning of the leap that is to follow, or of a crouch if one is aimed at; as it is where there
        is none. What was asked for this jump is no other until it was let go."""
        memory, leap = state.memory, intent.leap
        if leap is None:
            if intent.aim is not None and (memory.rises or memory.rebounds and memory.time >= memory.plan.lowest):
                return replace(state, memory=begun(self, self.start_of(state, around=intent.around), float(memory.plan.feet[:, 1].mean() - self.physique.tables.sole)))
            return state if memory.asked is None else replace(state, memory=replace(memory, asked=None, refused="", onward=None))
        return self._leapt(state, intent, leap) if memory.rebounds else state

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
        return replace(state, memory=Jumping.begun(fallen, state, jumping.asked, hit.reason, jumping.hits + 1))

    def status(self, state: CharacterState) -> Status:
        """Running until it stands; one that struck something says so at once, and fails once it stands."""
        known(state)
        if isinstance(state.memory, Crouching):
            return Status("running", state.memory.refused)
        jumping: Jumping = state.memory
        if jumping.time < min(jumping.plan.through, jumping.plan.duration):
            return Status("running", jumping.fault or jumping.refused)
        if jumping.fault:
            return Status("failed", jumping.fault)
        return Status("done", "it has landed and can't stop here" if jumping.time >= jumping.plan.through else "")

    def _lost_floor(self, state: CharacterState, intent: Intent) -> bool:
        """Whether it stands on nothing: looked at only where the floor ahead lies lower."""
        x, z, heading = state.ground
        ahead, left = np.asarray(state.velocity, float)[[0, 2]] * 0.2
        c, s = np.cos(heading), np.sin(heading)
        x, z = x + s * ahead + c * left, z + c * ahead - s * left
        if np.ndim(state.ground) != 1:
            return False
        size, deep = self.physique.size, float(state.floor) - floor_at(x, z, intent.around)
        stands = np.any(state.contacts) and np.abs(state.velocity).max() < STILL  # who lies across an edge has his soles over nothing, too
        if stands and deep >= (STANDS - 0.02) * size and hangs(self.skeleton, state.pose, intent.around, size):
            return True
        return deep >= 0.2 * size and (over_nothing(self.skeleton, state.pose, state.contacts, intent.around, float(state.floor), size)
                                       or steps_over(self.physique, self.start_of(state), state.pose, intent.around, float(state.floor), self.gravity))

    def _waits(self, state: CharacterState) -> bool:
        """Whether it will be in a moment where it is now."""
        return isinstance(state.memory, Crouching) or not isinstance(state.memory, Jumping) and self._stands(state)

    def _sets_feet(self, state: CharacterState) -> bool:
        """Whether it goes, and still has to set its feet before it crouches."""
        return not isinstance(state.memory, Jumping | Crouching) and sets_feet(self.physique, state)

    def _on_its_floor(self, state: CharacterState, around: Sequence[Any]) -> bool:
        """Whether it stands, or goes with its feet on one floor: nobody pushes off the air beyond an edge."""
        return not around or self._stands(state) or on_its_floor(self.physique, self.start_of(state, around=around), float(level(state.floor)), around)

    def _stands(self, state: CharacterState) -> bool:
        """Whether it stands on both feet, and may crouch."""
        return bool(np.all(state.contacts)) and bool(np.abs(state.velocity).max() < STILL)
