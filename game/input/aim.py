"""Aiming a jump: a button is held, a ring on the floor is moved, and letting go jumps there.

Standing, the stick pushes the ring away from the feet, and the body crouches as it will have to; walking or running, the ring lies ahead at the
distance that the speed gives, and stays where it is let go. Without a push the jump goes straight up, the higher the
longer it was held. Who stands and turns meanwhile, or keeps facing, says in which heading to land: the body then goes off as it stands.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gambol.controllers.contract import CharacterState, Leap
from gambol.controllers.jump import PACE, SETS_FEET, SLOWLY, TOO_NEAR
from gambol.controllers.navigation import floor_at, in_world, slope_at

from .on_top import on_top
from .run_up import AHEAD
from .straight_ahead import UP
from .wish import Wish, in_view
from .within_reach import LOWER, Reaches, anywhere, stopped_at

MOVING = 0.9
"""Faster than this [m/s] the jump goes on the way one goes."""
GOES, CREEPS = (0.35, 0.14), 0.45
"""And faster than the first of these [m/s], aside and backward, too, of who is held to go by a stick, and has even floor before him: a small leap, off one foot onto the other. Or
than the other, whose stick is tilted by no more than the third: he goes about as fast as it asks, and does not set off."""
ARC, BENDS, BENT = 0.1, 0.26, 0.05
"""Faster than the first [rad/s] somebody goes along an arc. He leans into it, so that his foot sends him so long [s] farther round it: there the ring lies, and stays ahead of
who turns by more than the third [rad] as he waits for his footfall."""
STANDS = 0.2
"""Who still walks faster than this [m/s] as he lets go of a ring at which he aimed from a stand comes to rest before it: it stays where it is."""
SLOWED = 0.6
"""Who let go of a ring on the move and has become slower than this [m/s], as before a box, leaps as one who stands, once he can."""
HITS = "would hit"
"""Why somebody can't leap from where he stands, but may from farther off."""
RESTED = 0.03
"""And who is faster than this [m/s] is not refused yet: once he rests he may leap after all."""
PUSH = 1.5
"""How fast a stick pushes the ring [m/s]."""
SWINGS = 3.0
"""How fast the heading turns in which to land [rad/s]."""
FARTHEST = 1.4
"""How far from a standing body the ring may be, over how far it leaps over level ground: so far it may leap down."""
SLOPED = 2.0
"""On the move, by so much for each metre a metre that ground rises there [m]: uphill a foot sends nobody as far, nor as near, as on level ground."""
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
TURNS = 0.3
"""That passes at this pace while a standing body still turns to the ring, sets its feet, or finds out how to leap: half a turn takes 2.2 s."""
LONGER = 0.6
"""And at this while somebody who goes slowly, aside or backward comes to a foot that carries him on: not every one does, and his steps take half a second."""
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
RESTS, FALLING = 0.12, 0.1
"""A stick that is tilted less than the first, or by so much less than a step before, was let go: thumbs take some steps for it."""
ELSEWHERE, TILTED = math.radians(60.0), 0.5
"""Who let go, waits for his feet, and tilts the stick anew so far that it counts, by more than the first [rad] off the way to the ring and off where he held it, wants to go there: the ring
is given up."""

def _pace(state: CharacterState) -> float:
    """How fast somebody goes [m/s]."""
    return float(np.hypot(state.velocity[0], state.velocity[2]))


def _between(one: tuple[float, float], other: tuple[float, float]) -> float:
    """The angle [rad] between two ways; half a turn where the other is none."""
    return math.pi if not any(other) else abs(math.remainder(math.atan2(*one) - math.atan2(*other), math.tau))


def course_of(state: CharacterState) -> float:
    """Which way [rad] a leap goes of somebody on the move: the way he goes, and farther round an arc."""
    x, z = in_world(state.ground, state.velocity)
    return math.atan2(x, z) + BENDS * float(state.velocity[1])


def _ring(state: CharacterState) -> tuple[float, float]:
    """Where x, z [m] the ring lies from somebody on the move."""
    far, course = AHEAD[0] + AHEAD[1] * _pace(state), course_of(state)
    return far * math.sin(course), far * math.cos(course)


@dataclass(frozen=True)
class Aim:
    """Where somebody aims.

    offset: x, z [m] of the ring from the feet, in the world. held: how long the button has been held [s].
    aiming: whether it is. waiting: [s] for which a jump that was asked is still wanted. moving: it goes ahead. place: x, z
    [m] in the world where somebody who moved let go of the ring, or where it stays of who goes back from it. heading: [rad] in which to land, None where nobody said so.
    rests: whether the stick that moved him was let go, so that he is to come to rest where he lands; tilt: how far it is tilted.
    course: which way [rad] the ring was set of who moves, and in which he lands where he goes along an arc. even: who goes slowly has even floor before him.
    skips: he went slowly enough for that as he let go. stick: where (2,) in the world it was held as the button was let go, nowhere since it came to rest.
    steers: where (2,) in the world it is held now. led: for so long [s] the stick, which led him to what holds him up, pushes a ring that lies ahead already no farther. backs: he found that he would hit what he stands before, and goes back from it.
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

    def step(self, wish: Wish, camera_yaw: float, state: CharacterState, leaving: bool, dt: float, aloft: bool = False, cramped: bool = False,
             farthest: float = math.inf, even: bool = False, now: CharacterState | None = None, ahead: tuple[float, float] | None = None) -> Aim:
        """The aim `dt` seconds later. leaving: the body is about to leave the floor. aloft: it flies, and what is asked waits until it lands;
        the state is then that in which it will stand there. cramped: it is too near to what it would leap onto, and goes back first.
        farthest: how far from a standing body the ring may be [m]. even: the floor before it is even and free. now: how it goes until then, where that is another state.
        ahead: where x, z [m] from his feet the ring lies at first of one whom something holds up, see `straight_ahead.onto`."""
        if leaving or wish.jump and self.spent:
            return Aim(spent=wish.jump and (self.aiming or self.spent))
        stopped = not wish.jump and self.waiting > dt and self._stopped(state, even)
        x, z = self._there(state)
        tilt = math.hypot(*wish.move)
        if stopped and np.all(state.contacts):
            return replace(self, waiting=self.waiting - TURNS * dt, moving=False, offset=(x - float(state.ground[0]), z - float(state.ground[1])), tilt=tilt)
        stays = not self.moving and (cramped or self.place is not None)
        offset = (x - float(state.ground[0]), z - float(state.ground[1])) if stays else self.offset
        rests = tilt < RESTS or tilt < self.tilt - FALLING or self.rests and tilt < self.tilt
        stick = in_view(wish.move, camera_yaw)
        led = self.led if self.aiming else 0.0 if ahead is None else math.hypot(*ahead) / PUSH
        told = replace(self, offset=offset if ahead is None or self.aiming else ahead, led=led, rests=rests, tilt=tilt, even=even, steers=stick,
                       stick=stick if self.aiming else self.stick if tilt >= RESTS else (0.0, 0.0))
        if wish.jump:
            return told._aimed(wish, camera_yaw, state, stays, farthest, dt)
        if self.aiming:
            return told._let_go((x, z), self.offset, state)
        if not self.moving and not aloft and tilt >= TILTED and min(_between(stick, told.offset), _between(stick, told.stick)) > ELSEWHERE and math.hypot(*offset) >= NEAR:
            return Aim(tilt=tilt)
        return self._waits(told, state, state if now is None else now, aloft, cramped, stopped, stays, dt)

    def _let_go(self, there: tuple[float, float], offset: tuple[float, float], state: CharacterState) -> Aim:
        """The button is let go: the ring of who moves stays where it is in the world, x, z [m], and that of who comes to rest before it. offset: where it was of him."""
        fixed = self.moving or _pace(state) > STANDS and state.active != "jump" and math.hypot(*offset) >= NEAR
        return replace(self, aiming=False, waiting=PATIENCE, offset=offset, place=there if fixed else self.place, course=course_of(state),
                       skips=self.moving and _pace(state) < SLOWLY[1])

    def _waits(self, told: Aim, state: CharacterState, now: CharacterState, aloft: bool, cramped: bool, stopped: bool, stays: bool, dt: float) -> Aim:
        """The same of one who let go and has not leapt yet: he waits for his footfall, turns to the ring, rests first, or gives up. told: with what the step brought."""
        sets = state.refused == SETS_FEET
        if aloft and self.moving and self.waiting > 0.0:  # it stays ahead of who comes down first
            offset = _ring(state)
            return replace(self, offset=offset, place=(float(state.ground[0]) + offset[0], float(state.ground[1]) + offset[1]), course=course_of(state))
        if told._turns(now):  # the ring stays ahead of who turns to where he is led
            offset = _ring(now)
            return replace(told, waiting=self.waiting - TURNS * dt, offset=offset, place=(float(now.ground[0]) + offset[0], float(now.ground[1]) + offset[1]), course=course_of(now))
        goes = _pace(now)
        hits = not self.moving and HITS in state.refused
        slows = not self.moving and goes > RESTED and (hits or state.refused.startswith(PACE))  # once he rests he is asked again
        if hits and not slows and not self.backs and math.hypot(*told.offset) >= NEAR:
            return replace(self, backs=True, waiting=PATIENCE)
        if slows and goes > MOVING and state.refused.startswith(TOO_NEAR) and told.even and not stays and math.hypot(*told.offset) < NEAR:
            return self._led_on(now, dt)
        if self.waiting <= dt and not aloft or not self.moving and not (sets or slows or cramped) and state.refused:
            return Aim()
        pace = 0.0 if aloft else LONGER if self._goes(state) else TURNS if sets or not self.moving and state.seeks or stopped or cramped or self._askew(state) else 1.0
        gone = self._gone_round(state)
        return replace(gone, waiting=self.waiting - pace * dt, offset=told.offset, place=self._there(state) if stays else gone.place, rests=told.rests, tilt=told.tilt, even=told.even, stick=told.stick, steers=told.steers)

    def _aimed(self, wish: Wish, camera_yaw: float, state: CharacterState, stays: bool, farthest: float, dt: float) -> Aim:
        """The button is held: the ring goes ahead of who moves, and with the stick of who stands."""
        least = math.inf if self.led else self._least(state, self.tilt) if self.even and not stays else MOVING  # who goes back from it, or is right before it, stands soon
        moving, heading, place, offset = _pace(state) > least, None, None, self.offset
        if moving:
            offset = _ring(state)
        else:
            pushed = in_view(wish.move, camera_yaw)
            still = self.held < self.led and pushed[0] * offset[0] + pushed[1] * offset[1] > 0.0  # it lies where the stick would have pushed it to
            x, z = offset if still else (offset[k] + PUSH * dt * pushed[k] for k in (0, 1))
            shrink = min(1.0, farthest / max(math.hypot(x, z), 1e-9))
            offset = (x * shrink, z * shrink)
            place = (float(state.ground[0]) + offset[0], float(state.ground[1]) + offset[1]) if stays else None
            heading = self._turned(wish, offset, camera_yaw, float(state.ground[2]), dt)
        return Aim(offset, self.held + dt if self.aiming else 0.0, True, 0.0, moving, place, heading, rests=self.rests, tilt=self.tilt, steers=self.steers, course=course_of(state), even=self.even, led=self.led)

    def _least(self, state: CharacterState, tilt: float) -> float:
        """Faster than this [m/s] a leap goes on the way of one before whom the floor is even, whose stick is tilted so far. Who aims from a stand moves the ring with it, as he
        turns, too."""
        if tilt < RESTS:
            return MOVING
        return GOES[tilt <= CREEPS and state.active != "jump" and (self.moving or not self.aiming)]

    def _led_on(self, state: CharacterState, dt: float) -> Aim:
        """The same of one who wants to leap straight up, but comes down too fast for that: the ring lies ahead of him, as of everybody who goes so fast."""
        x, z = _ring(state)
        return replace(self, waiting=self.waiting - dt, moving=True, offset=(x, z), place=(float(state.ground[0]) + x, float(state.ground[1]) + z), course=course_of(state))

    def _gone_round(self, state: CharacterState) -> Aim:
        """The same of one who goes along an arc as he waits, and has turned: his ring stays ahead of him, as far away as it is."""
        course = course_of(state)
        if not self.moving or self.place is None or abs(math.remainder(course - self.course, math.tau)) < BENT or _pace(state) < MOVING:
            return self
        here = float(state.ground[0]), float(state.ground[1])
        far = math.dist(here, self.place)
        return replace(self, place=(here[0] + far * math.sin(course), here[1] + far * math.cos(course)), course=course)

    def _stopped(self, state: CharacterState, even: bool) -> bool:
        """Whether somebody let go of the ring on his way and has come to rest before it, as before a box: from there he leaps as one who stands."""
        if not self.moving or self.aiming or even or _pace(state) > SLOWED or state.active == "jump":
            return False
        x, z = self._there(state)
        ahead = (x - float(state.ground[0])) * math.sin(self.course) + (z - float(state.ground[1])) * math.cos(self.course)
        return ahead > NEAR

    def _goes(self, state: CharacterState) -> bool:
        """Whether somebody goes on by a small leap, slowly, aside or backward."""
        # who brakes from a run leaps to where he let go of the ring as long as he can
        return self.moving and self.even and _pace(state) < (SLOWLY[1] if self.aiming or self.skips or state.refused else MOVING)

    def _turns(self, state: CharacterState) -> bool:
        """Whether somebody on the move has let go, and turns first to where his stick is held."""
        if not self.moving or self.aiming or self.waiting <= PATIENCE - ROUND_IN or self.rests or state.active == "jump" or math.hypot(*self.steers) < TILTED or _pace(state) < GOES[0]:
            return False
        x, z = in_world(state.ground, state.velocity)
        ahead = (x * self.steers[0] + z * self.steers[1]) / (math.hypot(x, z) * math.hypot(*self.steers))
        return BACK < ahead < math.cos(ASIDE)

    def _there(self, state: CharacterState) -> tuple[float, float]:
        """Where x, z [m] the ring is in the world."""
        return self.place or (float(state.ground[0]) + self.offset[0], float(state.ground[1]) + self.offset[1])

    def _turned(self, wish: Wish, offset: tuple[float, float], camera_yaw: float, faces: float, dt: float) -> float | None:
        """The heading [rad] in which to land `dt` seconds later; a body that faces so keeps facing, or begins to turn from there or from the ring."""
        if math.hypot(*wish.look) > 0.0:
            return math.atan2(*in_view(wish.look, camera_yaw))
        heading = self.heading
        if heading is None and wish.strafe:
            heading = faces
        if heading is None and wish.turn:
            heading = faces if math.hypot(*offset) < NEAR else math.atan2(*offset)
        return None if heading is None else math.remainder(heading + SWINGS * dt * wish.turn, math.tau)

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
            turns = self.course if abs(float(state.velocity[1])) > ARC and _pace(state) > MOVING else None
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
