"""Aiming a jump: a button is held, a ring on the floor is moved, and letting go jumps there.

Standing, the stick pushes the ring away from the feet, and the body crouches as it will have to; walking or running, the ring lies ahead at the
distance that the speed gives, and stays where it is let go. Without a push the jump goes straight up, the higher the
longer it was held. Who stands and turns meanwhile, or keeps facing, says in which heading to land: the body then goes off as it stands.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from gambol.controllers.contract import CharacterState
from gambol.controllers.jump import PACE, SETS_FEET, SLOWLY, TOO_NEAR
from gambol.controllers.navigation import in_world

from .aimed import BENDS, BENT, CREEPS, ELSEWHERE, GOES, LONGER, MOVING, NEAR, PATIENCE, TILTED, Aimed, speed_of
from .run_up import AHEAD
from .wish import Wish, in_view

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
TURNS = 0.3
"""The patience of who let go passes at this pace while a standing body still turns to the ring, sets its feet, or finds out how to leap: half a turn takes 2.2 s."""
RESTS, FALLING = 0.12, 0.1
"""A stick that is tilted less than the first, or by so much less than a step before, was let go: thumbs take some steps for it."""


def _between(one: tuple[float, float], other: tuple[float, float]) -> float:
    """The angle [rad] between two ways; half a turn where the other is none."""
    return math.pi if not any(other) else abs(math.remainder(math.atan2(*one) - math.atan2(*other), math.tau))


def course_of(state: CharacterState) -> float:
    """Which way [rad] a leap goes of somebody on the move: the way he goes, and farther round an arc."""
    x, z = in_world(state.ground, state.velocity)
    return math.atan2(x, z) + BENDS * float(state.velocity[1])


def _ring(state: CharacterState) -> tuple[float, float]:
    """Where x, z [m] the ring lies from somebody on the move."""
    far, course = AHEAD[0] + AHEAD[1] * speed_of(state), course_of(state)
    return far * math.sin(course), far * math.cos(course)


@dataclass(frozen=True)
class Aim(Aimed):
    """Where somebody aims, and how that goes on."""

    def step(self, wish: Wish, camera_yaw: float, state: CharacterState, leaving: bool, dt: float, aloft: bool = False, cramped: bool = False,
             farthest: float = math.inf, even: bool = False, now: CharacterState | None = None, ahead: tuple[float, float] | None = None) -> Aim:
        """The aim `dt` seconds later. leaving: the body is about to leave the floor. aloft: it flies. What is asked anew meanwhile waits until it lands;
        the state is then that in which it will stand there. cramped: it is too near to what it would leap onto, and goes back first.
        farthest: how far from a standing body the ring may be [m]. even: the floor before it is even and free. now: how it goes until then, where that is another state.
        ahead: where x, z [m] from his feet the ring lies at first of one whom something holds up, see `straight_ahead.onto`."""
        if wish.jump and self.spent or leaving and not self.follows and (self.aiming or not wish.jump):
            return Aim(spent=wish.jump)
        aloft = aloft or leaving
        if self.follows != leaving:
            self = Aim(follows=True) if leaving else replace(self, follows=False)
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
        fixed = self.moving or speed_of(state) > STANDS and state.active != "jump" and math.hypot(*offset) >= NEAR
        return replace(self, aiming=False, waiting=PATIENCE, offset=offset, place=there if fixed else self.place, course=course_of(state),
                       skips=self.moving and speed_of(state) < SLOWLY[1])

    def _waits(self, told: Aim, state: CharacterState, now: CharacterState, aloft: bool, cramped: bool, stopped: bool, stays: bool, dt: float) -> Aim:
        """The same of one who let go and has not leapt yet: he waits for his footfall, turns to the ring, rests first, or gives up. told: with what the step brought."""
        sets = state.refused == SETS_FEET
        if aloft and self.moving and self.waiting > 0.0:  # it stays ahead of who comes down first
            offset = _ring(state)
            return replace(self, offset=offset, place=(float(state.ground[0]) + offset[0], float(state.ground[1]) + offset[1]), course=course_of(state))
        if told._turns(now):  # the ring stays ahead of who turns to where he is led
            offset = _ring(now)
            return replace(told, waiting=self.waiting - TURNS * dt, offset=offset, place=(float(now.ground[0]) + offset[0], float(now.ground[1]) + offset[1]), course=course_of(now))
        goes = speed_of(now)
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
        moving, heading, place, offset = speed_of(state) > least, None, None, self.offset
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
        return Aim(offset, self.held + dt if self.aiming else 0.0, True, 0.0, moving, place, heading, rests=self.rests, tilt=self.tilt, steers=self.steers, course=course_of(state), even=self.even, led=self.led, follows=self.follows)

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
        if not self.moving or self.place is None or abs(math.remainder(course - self.course, math.tau)) < BENT or speed_of(state) < MOVING:
            return self
        here = float(state.ground[0]), float(state.ground[1])
        far = math.dist(here, self.place)
        return replace(self, place=(here[0] + far * math.sin(course), here[1] + far * math.cos(course)), course=course)

    def _stopped(self, state: CharacterState, even: bool) -> bool:
        """Whether somebody let go of the ring on his way and has come to rest before it, as before a box: from there he leaps as one who stands."""
        if not self.moving or self.aiming or even or speed_of(state) > SLOWED or state.active == "jump":
            return False
        x, z = self._there(state)
        ahead = (x - float(state.ground[0])) * math.sin(self.course) + (z - float(state.ground[1])) * math.cos(self.course)
        return ahead > NEAR

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
