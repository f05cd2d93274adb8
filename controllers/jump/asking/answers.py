"""What leap somebody can make from a state: from where it goes off, to which place, whether at this moment, and why not."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from ...contract import CharacterState, Intent, Leap, known, level
from ...navigation import STEP, floor_at
from ..body import Start, airtime_up, measures
from ..crouching import Crouching
from ..motion import STANDS, Carried, Plan, carried, hangs, over_nothing, steps_over
from ..muscles import strongest
from ..reach import DEAR, SETS_FEET, Pieces, Reach, Refused, counted, goes_on, meant
from ..starting import FEET, Jumping, along_of, astride, cramped, goes, landed, off_one, off_under, on_ground, on_its_floor, ready, rebounding, sets_feet, start_of, turning

STILL = 0.25
"""Who is slower than this [m/s, rad/s] stands, and may crouch."""
SPARES = 0.97
"""Straight up a body is asked for this share of how high its muscles would take it at most."""
ABOUT, SHARES = (0.43, 2.9, 0.75), (0.95, 0.05, 0.15)
"""How far bodies leap from a stand, over their size, by how high they rise over it; and what share of that behind, more ahead and less aside: within 0.2 m of
what is found for bodies of 0.7 to 2.1 m, weak and strong."""


class Answers(Reach):
    """What leaps a body can make from the states in which it may be."""

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

    def found(self, state: CharacterState, intent: Intent, ask: Callable[[], None] = lambda: None) -> Leap | None:
        """The leap that can be made from a state, with how; None where it can't. ask: see `pondered`."""
        leap = intent.leap
        if leap is None:
            return None
        try:
            start, place, floor, _ = self._meant(state, leap, intent.around)
        except Refused:
            return None
        found, _ = counted(self.seen(start, place, floor, leap.airtime, intent.around, False), DEAR, ask)
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
        if stands and deep >= (STANDS - 0.02) * size and hangs(self.physique.skeleton, state.pose, intent.around, size):
            return True
        return deep >= 0.2 * size and (over_nothing(self.physique.skeleton, state.pose, state.contacts, intent.around, float(state.floor), size)
                                       or steps_over(self.physique, self.start_of(state), state.pose, intent.around, float(state.floor), self.gravity))

    def _waits(self, state: CharacterState, leap: Leap, around: Sequence[Any]) -> bool:
        """Whether it may as well leap in a moment: it rests, or hardly moves and pushes off both feet."""
        return self._rests(state) or not isinstance(state.memory, Jumping) and not goes_on(self.placed(state, leap, around)[0])

    def _rests(self, state: CharacterState) -> bool:
        """Whether it crouches or stands."""
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
