"""Where hands aim a jump, and what they ask by that: the ring, the leap that leads there, where a body turns meanwhile, and whether it goes on as it does."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from gambol.controllers.contract import CharacterState, Leap
from gambol.controllers.jump import SLOWLY
from gambol.controllers.navigation import floor_at, in_world, slope_at

from .on_top import on_top
from .straight_ahead import UP
from .within_reach import LOWER, Reaches, anywhere, stopped_at

MOVING = 0.9
"""Faster than this [m/s] the jump goes on the way one goes."""
GOES, CREEPS = (0.35, 0.14), 0.45
"""And faster than the first of these [m/s], aside and backward, too, of who is held to go by a stick, and has even floor before him: a small leap, off one foot onto the other. Or
than the other, whose stick is tilted by no more than the third: he goes about as fast as it asks, and does not set off."""
ARC, BENDS, BENT = 0.1, 0.26, 0.05
"""Faster than the first [rad/s] somebody goes along an arc. He leans into it, so that his foot sends him so long [s] farther round it: there the ring lies, and stays ahead of
who turns by more than the third [rad] as he waits for his footfall."""
SLOPED = 2.0
"""Who is on the move lands farther from the ring by so much for each metre a metre that ground rises there [m]: uphill a foot sends nobody as far, nor as near, as on level ground."""
NEAR = 0.12
"""A ring nearer than this [m] means straight up."""
SLACK, ROUND = (0.5, 0.3), 0.5
"""Who can't reach the ring lands at most so far from it [m], from a stand and on the move; and along an arc, of which one foot sends him farther round than the other."""
AIRTIME, CHARGE, LONGEST = 0.42, 0.20, 0.60
"""A jump straight up: its airtime after a tap [s], what each second of holding adds [s/s], at most [s]."""
SINKS = 0.35
"""A body goes down so long [s] behind the aim: it crouches for the jump that will be aimed at then."""
PATIENCE = 0.9
"""So long a jump that was asked waits for the feet to be ready [s]; standing it is refused at once."""
LONGER = 0.6
"""That passes at this pace while somebody who goes slowly, aside or backward comes to a foot that carries him on: not every one does, and his steps take half a second."""
ASKEW = 0.35
"""A standing body that faces the ring to within this [rad] jumps as it stands; else it turns in the air."""
TURNS_ROUND = 0.2
"""Who holds the button for longer [s] turns to the ring on his feet meanwhile, and to one on something goes on with that when it is let go: one leaps farther ahead than aside."""
LOOKED = 0.2
"""Who holds the button for longer [s] looks where to jump."""
TAPS, COMES = 0.2, 0.5
"""Who holds the button for less than the first [s] leaps as he goes; a foot that sends him comes within the second [s], for which he neither brakes nor turns back."""
ASIDE, BACK, ROUND_IN = 0.44, -0.26, 0.24
"""Who goes, and holds his stick farther aside of that than the first [rad], but not back, by a cosine less than the second, turns there first; he may wait by so much of his patience for that [s]."""
ELSEWHERE, TILTED = math.radians(60.0), 0.5
"""Who let go, waits for his feet, and tilts the stick anew so far that it counts, by more than the first [rad] off the way to the ring and off where he held it, wants to go there: the ring
is given up."""


def speed_of(state: CharacterState) -> float:
    """How fast somebody goes [m/s]."""
    return float(np.hypot(state.velocity[0], state.velocity[2]))


@dataclass(frozen=True)
class Aimed:
    """Where somebody aims.

    offset: x, z [m] of the ring from the feet, in the world. held: how long the button has been held [s].
    aiming: whether it is. waiting: [s] for which a jump that was asked is still wanted. moving: it goes ahead. place: x, z
    [m] in the world where somebody who moved let go of the ring, or where it stays of who goes back from it. heading: [rad] in which to land, None where nobody said so.
    rests: whether the stick that moved him was let go, so that he is to come to rest where he lands; tilt: how far it is tilted.
    course: which way [rad] the ring was set of who moves, and in which he lands where he goes along an arc. even: who goes slowly has even floor before him.
    skips: he went slowly enough for that as he let go. stick: where (2,) in the world it was held as the button was let go, nowhere since it came to rest.
    steers: where (2,) in the world it is held now. led: for so long [s] the stick, which led him to what holds him up, pushes a ring that lies ahead already no farther. backs: he found that he would hit what he stands before, and goes back from it.
    follows: the button was pressed as he was about to leave the floor, for the leap that is to follow.
    """

    offset: tuple[float, float] = (0.0, 0.0)
    held: float = 0.0
    aiming: bool = False
    waiting: float = 0.0
    moving: bool = False
    place: tuple[float, float] | None = None
    heading: float | None = None
    spent: bool = False
    rests: bool = False
    tilt: float = 0.0
    course: float = 0.0
    even: bool = False
    skips: bool = False
    stick: tuple[float, float] = (0.0, 0.0)
    steers: tuple[float, float] = (0.0, 0.0)
    led: float = 0.0
    backs: bool = False
    follows: bool = False

    def _goes(self, state: CharacterState) -> bool:
        """Whether somebody goes on by a small leap, slowly, aside or backward."""
        # who brakes from a run leaps to where he let go of the ring as long as he can
        return self.moving and self.even and speed_of(state) < (SLOWLY[1] if self.aiming or self.skips or state.refused else MOVING)

    def _turns(self, state: CharacterState) -> bool:
        """Whether somebody on the move has let go, and turns first to where his stick is held."""
        if not self.moving or self.aiming or self.waiting <= PATIENCE - ROUND_IN or self.rests or state.active == "jump" or math.hypot(*self.steers) < TILTED or speed_of(state) < GOES[0]:
            return False
        x, z = in_world(state.ground, state.velocity)
        ahead = (x * self.steers[0] + z * self.steers[1]) / (math.hypot(x, z) * math.hypot(*self.steers))
        return BACK < ahead < math.cos(ASIDE)

    def _there(self, state: CharacterState) -> tuple[float, float]:
        """Where x, z [m] the ring is in the world."""
        return self.place or (float(state.ground[0]) + self.offset[0], float(state.ground[1]) + self.offset[1])

    def facing(self, state: CharacterState, around: Sequence[Any], back: bool = False) -> float | None:
        """The heading [rad] that a body about to jump from a stand turns to on its feet, if any. back: it goes back from what it would leap onto or over, and keeps facing that."""
        x, z = self._there(state)
        turns = self.aiming or self.waiting > 0.0 and floor_at(x, z, around, float(state.floor) + UP) > float(state.floor) + LOWER
        return self._ahead if back or turns and self.held >= TURNS_ROUND else None

    @property
    def _ahead(self) -> float | None:
        """The heading [rad] of the ring from a standing body, where nobody said in which to land."""
        return None if self.moving or self.heading is not None or math.hypot(*self.offset) < NEAR else math.atan2(*self.offset)

    @property
    def looked(self) -> float | None:
        """The heading [rad] in which somebody looks for a place to land; None where nobody does."""
        if not self.aiming or self.held < LOOKED or math.hypot(*self.offset) < NEAR:
            return None
        return math.atan2(*self.offset)

    @property
    def stands(self) -> bool:
        """Whether the sticks move the ring and not the body."""
        return self.wants and not self.moving

    @property
    def wants(self) -> bool:
        """Whether a jump is aimed at, or waited for."""
        return self.aiming or self.waiting > 0.0

    @property
    def takes_off(self) -> bool:
        """Whether somebody on the move is about to leap, as he goes: he tapped the button, or let go of it not long ago."""
        return self.moving and (self.held < TAPS if self.aiming else self.waiting > PATIENCE - COMES)

    def target(self, state: CharacterState, around: Sequence[Any], gravity: float, longest: float = math.inf, ahead: float = 0.0,
               reaches: Reaches = anywhere) -> Leap | None:
        """The jump that would be made now; None where nobody aims. gravity: [m/s²], downwards positive. longest: [s] that the body can be in
        the air straight up; ahead: as it would be made so many seconds later."""
        if not self.wants:
            return None
        floor = float(state.floor)
        if not self.moving and math.hypot(*self.offset) < NEAR:
            airtime = min(AIRTIME + CHARGE * (self.held + ahead), LONGEST) * math.sqrt(9.81 / gravity)
            return Leap(None, min(airtime, longest), heading=self.heading)
        if self._goes(state) and not (self.rests and state.active == "jump"):
            turns = self.course if abs(float(state.velocity[1])) > ARC and speed_of(state) > MOVING else None
            return Leap(None, heading=turns, stays=self.rests, along=True, waited=0.0 if self.aiming else (PATIENCE - self.waiting) / LONGER)
        x, z = self._there(state)
        x, z = on_top((x, z) if self.moving else stopped_at((x, z), self.heading, state, around, reaches), floor, around)
        place = np.array([x, floor_at(x, z, around, floor + UP), z])
        steep = SLOPED * float(np.hypot(*slope_at(x, z, around, place[1] + LOWER))) if self.moving and len(around) else 0.0
        if self.moving and abs(float(state.velocity[1])) > ARC:  # he turns there as he flies, and goes on round it
            return Leap(place, slack=ROUND + steep, heading=self.course, stays=self.rests)
        return Leap(place, slack=SLACK[self.moving] + steep, heading=self._ahead if self._askew(state) else self.heading, stays=self.moving and self.rests)

    def readied(self, state: CharacterState, around: Sequence[Any], gravity: float, longest: float = math.inf,
                reaches: Reaches = anywhere) -> Leap | None:
        """The jump for which a standing body crouches meanwhile; None where nobody aims from a stand, or it may still turn to it."""
        return None if self.moving or not self.aiming or self._askew(state) else self.target(state, around, gravity, longest, SINKS, reaches)

    def asked(self, state: CharacterState, around: Sequence[Any], gravity: float, longest: float = math.inf,
              reaches: Reaches = anywhere) -> Leap | None:
        """The jump that is wanted now that the button was let go; None while the body still turns to it."""
        return None if self.aiming or self.waiting <= 0.0 or self._turns(state) or self._askew(state) and self.facing(state, around) is not None else self.target(state, around, gravity, longest, 0.0, reaches)

    def _askew(self, state: CharacterState) -> bool:
        """Whether a standing body does not face the ring."""
        return self._ahead is not None and abs(math.remainder(self._ahead - float(state.ground[2]), math.tau)) > ASKEW
