"""The jump controller: ``state', pose = jump.step(state, intent, dt)``, one planned jump at a time."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ..body import Pose, Skeleton
from ..contract import CharacterState, Controller, Intent, Leap, Status, given, known, level, seconds
from .asking import Searches
from .body import GRAVITY, Physique
from .crouching import Crouching, begun, crouched
from .motion import Plan, as_shown, fall
from .playing import DRAWN, RISEN, arms_in, played
from .prior import Prior
from .reach import SETS_FEET, Onward, Refused
from .starting import Jumping, along_of, start_of, stayed

READY, HOLDS, OVER = 1.0, 1.5, 0.3
"""How well it bids when a jump is asked and possible; how firmly it holds on to one; once it is landed
and somebody wants to walk."""
PULLS = 0.1, 100.0
"""How hard a world may pull [m/s²]: on a little moon of ten metres' jumps, and on one where nobody gets up."""
SOONEST, ON = 0.3, 0.12
"""Who struck nothing may walk on sooner than he has risen, but no sooner than the first after touch-down [s], as soon as so long [s] after the lowest point of his landing."""
RISES = 0.1
"""Who crouches, but still comes up faster than this [m/s], at standard height, goes down first: his legs can't pull."""


class Jump(Searches, Controller):
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
        elif intent.leap is None or state.memory.time > state.memory.plan.take_off:  # let go of is a leap also before it leaves the floor
            state = self._followed(state, intent)
        if isinstance(state.memory, Crouching):
            after = crouched(self, state, intent.leap or intent.aim, dt, intent.around)
            pose = arms_in(self.skeleton, after.pose, after.ground, intent.around, after.memory.time / DRAWN[0])
            return replace(after, pose=pose), pose
        return played(self, state, intent.around, dt)

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
