"""Who walks as he is told comes to a stop before what is solid, or goes along it: neither scripts nor hands see what stands about."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from gambol.controllers.contract import CharacterState, Intent, but
from gambol.controllers.navigation import in_frame, in_world
from gambol.controllers.navigation.passing import NEAR, slow_kernel, walls_of, way_kernel

SPARE = 0.02
"""He stops so much before the nearest that he may come to a wall [m]."""
LAG, BRAKE = 0.45, 2.5
"""Nobody wishes to go towards a wall faster than he could stop whose legs follow so much later [s] and brake so hard [m/s²] …"""
LATER, HARDER = 0.2, 3.5
"""… nor, who is told where to stop before it and lets go in time by himself, than by these."""
HEAD_ON = 0.94
"""Who goes at a wall at less than the angle to its normal with this cosine stops before it; others go along it."""
SEEN = 0.5, 0.7, 3.0
"""A wall is seen so far ahead [m], and so much farther for each m/s [s], and as braking by the third [m/s²], twice, takes."""
CURVES, STRAIGHT = 0.35, 0.95
"""Who turns by more than this [rad] on the way there stops for no wall ahead, nor who is to come to rest at an angle of less than this cosine."""
RESTS = 0.12, 0.05
"""Who stands, or goes slower than the second [m/s], so near to where he would stop [m] stays."""
TURNS, MOST, ALONG = 0.5, 1.5, 0.4
"""Who goes along a wall, and was not told to turn, turns that way in so much time [s], no faster than this [rad/s], if that leaves him so much of his speed."""


def stopped(state: CharacterState, intent: Intent, around: Sequence[Any]) -> Intent:
    """The same intent, its walk no faster towards walls than legs stop, and to end before the one that it leads at; as it is of who leaps or is about to, or goes
    to a goal round everything."""
    velocity = in_world(state.ground, intent.velocity)
    speed = float(np.hypot(*velocity))
    if not len(around) or speed < 1e-6 or intent.goal is not None or intent.leap is not None or intent.aim is not None or state.active == "jump":
        return intent
    walls, floor = walls_of(around), float(state.floor)
    x, z, heading = (float(value) for value in state.ground)
    lag, brake, halt = LAG, BRAKE, intent.halt
    far = _ahead(walls, state, intent, velocity / speed, speed)
    if far is not None:
        if far < RESTS[0] and math.hypot(state.velocity[0], state.velocity[2]) < RESTS[1]:
            return _told(intent, heading, np.zeros(2), halt)
        lag, brake, halt = LATER, HARDER, np.array([x + far * velocity[0] / speed, z + far * velocity[1] / speed, math.nan])
    slowed = velocity.copy()
    if slow_kernel(walls, x, z, floor, heading, slowed, NEAR + SPARE, lag, brake, 0.0):
        return _told(intent, heading, slowed, halt) if far is not None else _aside(_told(intent, heading, slowed, halt), velocity, slowed)
    return intent if halt is intent.halt else but(intent, halt=halt)


def _ahead(walls: np.ndarray, state: CharacterState, intent: Intent, ahead: np.ndarray, speed: float) -> float | None:
    """How far [m] somebody gets in a direction (2,) until he has to stop before a wall that he goes straight at; None where there is none, or he comes to rest before it."""
    out, seen = np.empty(3), SEEN[0] + SEEN[1] * speed + speed * speed / SEEN[2]
    far = way_kernel(walls, float(state.ground[0]), float(state.ground[1]), float(state.floor), ahead, NEAR + SPARE, seen, out)
    if far >= seen or -float(ahead @ out[:2]) < HEAD_ON or abs(float(intent.velocity[1])) * far > CURVES * speed:
        return None
    if intent.halt is not None:
        left = np.asarray(intent.halt, float)[:2] - state.ground[:2]
        if float(left @ ahead) < max(far, STRAIGHT * float(np.hypot(*left))):
            return None
    return far


def _told(intent: Intent, heading: float, velocity: np.ndarray, halt: np.ndarray | None) -> Intent:
    """The intent with another velocity (2,) in the world and another place to come to rest."""
    towards = intent.towards if intent.towards is None else np.array([intent.towards[0], min(float(intent.towards[1]), float(np.hypot(*velocity)))])
    return but(intent, velocity=in_frame((0.0, 0.0, heading), velocity, intent.velocity[1]), halt=halt, towards=towards)


def _aside(intent: Intent, wished: np.ndarray, velocity: np.ndarray) -> Intent:
    """The intent of somebody whom a wall leads aside, to (2,) from what he wished, turning to where he goes as who walks ahead does."""
    v_f, turn, v_l = (float(value) for value in intent.velocity)
    if intent.towards is not None or turn or v_f < abs(v_l) or np.hypot(*velocity) < ALONG * np.hypot(*wished):
        return intent
    error = math.remainder(math.atan2(*velocity) - math.atan2(*wished), math.tau)
    return but(intent, velocity=np.array([v_f, min(max(error / TURNS, -MOST), MOST), v_l]))
