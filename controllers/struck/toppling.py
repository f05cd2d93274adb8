"""Falling over and getting up: a body whose capture point its legs can't reach goes the way of a recorded fall, as fast as a pendulum about its feet does.

The fall that goes most nearly the same way is turned the rest of the way round while it topples. Nothing is below the floor in any moment, and what lies on it stays where it lies.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ..body import centre_of_mass, contact_height, forward_kinematics, yaw
from ..jump.body import Physique, Start, turns, vectors
from ..jump.motion import FEET, TOUCHES, between_kernel, faded, grounded_poses
from .capture import FALLS
from .flesh import flesh, flesh_of
from .held_falls import chosen, held
from .recorded_falls import RATE, Fall, falls
from .recovery import Recovery
from .settled import Settling, footing, settling, stands, uneven
from .stepwise_ground import Ground, ground_about, level_kernel, rest_kernel
from .surroundings import NOTHING

PACES = 0.9, 1.35
"""Falls are played at these shares of their recorded pace, until they strike the floor; from there on in WEARS seconds at their own."""
WEARS = 0.35
FADE, SPENT = 0.13, 0.15
"""Half-life with which the pose as it was struck gives way to the fall's [s]; what the mass centre is faster than the fall is spent on the floor with this time constant [s]."""
SLIDES = 0.3
"""A heel or ball that is faster along the floor [m/s] does not stand on it."""
UP = 0.93
"""Hips this high, as a share of where they are at the end, have got up."""
STOOD = 1.0
"""He is on the floor on which he gets up in the last so many seconds; until then on what is beneath him."""
HALTS = 18
"""Who gets up on stairs comes to rest over the last so many moments, lest he walk on where he stands on two treads."""
WHY = "struck too hard to be caught by a step: it falls, and gets up"


def topple(physique: Physique, start: Start, floor: float, rate: float, things: np.ndarray = NOTHING) -> Recovery:
    """The fall, lying and getting up of a body whose mass centre has start.velocity [m/s] as it begins. floor: [m]. rate: ω [1/s] of the pendulum. things: (K, 9) what stands about, as
    of `about`. On uneven ground it lies as on a level floor until it `settles`."""
    flat = start.velocity[[0, 2]]
    pace = float(np.hypot(*flat))
    ground = ground_about(things, start.centre[[0, 2]], floor) if len(things) else None
    fall, turn = chosen(physique, falls(physique), start.centre, math.atan2(flat[0], flat[1]), start.heading, floor, ground)
    times, shown, toppled = _paced(fall, pace, rate)
    facing = start.heading + turn * _evenly(times / toppled)
    local = fall.turns(shown)
    local[:, 0] = yaw(facing) @ local[:, 0]
    left = faded(vectors(start.rotations @ np.swapaxes(local[0], -1, -2)), start.rates, FADE, times)
    local = turns(left) @ local
    roots, _ = grounded_poses(physique, local, np.asarray(start.root, float), floor)
    centres = centre_of_mass(physique.anatomy, *forward_kinematics(physique.skeleton, roots[:2], local[:2]))
    lacks = start.velocity - (centres[1] - centres[0]) * RATE
    roots = roots + SPENT * (1.0 - np.exp(-times / SPENT))[:, None] * lacks * [1.0, 0.0, 1.0]
    if ground is None:
        return _recovery(physique, times, roots, local, facing, floor, toppled, None)
    positions, turned = forward_kinematics(physique.skeleton, roots, local)
    points, thick = flesh(physique, positions, turned)
    led = held(points, thick, floor, ground)
    roots, points = roots + led, points + led[:, None]
    if not uneven(points, thick, floor, ground):
        return _recovery(physique, times, roots, local, facing, floor, toppled, ground)
    up = max(len(times) - int(np.argmax(roots[::-1, 1] < floor + UP * (roots[-1, 1] - floor))), 2)
    last, aside = footing(points[up - 2:, -FEET:], thick[-FEET:], floor, ground)
    times, roots, local, facing = (rows[:up - 1 + last] for rows in (times, roots, local, facing))
    roots = roots + _evenly(times / toppled)[:, None] * [aside[0], 0.0, aside[1]]
    return _settled(settling(physique, roots, local, facing, floor, toppled, float(start.root[1]), ground))


def settles(made: Recovery, seconds: float) -> Recovery:
    """A fall so long [s] after it began, bent to the ground as well as it is by then: what is shown until then stays."""
    if made.settling is None:
        return made
    now = made.settling.after(seconds)
    return _settled(now) if now.done else replace(made, settling=now)


def _settled(now: Settling) -> Recovery:
    """A fall that comes to rest on uneven ground, bent as well as it is by now."""
    roots, local, facing = _halted(*now.motion(), now.facing)
    made = _recovery(now.physique, np.arange(len(roots)) / RATE, roots, local, facing, now.floor, now.toppled, now.ground, True)
    return made if now.done else replace(made, settling=now)


def _recovery(physique: Physique, times: np.ndarray, roots: np.ndarray, local: np.ndarray, facing: np.ndarray, floor: float, toppled: float, ground: Ground | None,
              rests: bool = False) -> Recovery:
    """A fall and getting up as it is played: roots (N, 3), rotations (N, J, 3, 3) and headings (N,) [rad] at times (N,) [s]. rests: whether it comes to rest on uneven ground."""
    positions, turned = forward_kinematics(physique.skeleton, roots, local)
    centres, soles = centre_of_mass(physique.anatomy, positions, turned), flesh(physique, positions, turned)[0][:, -FEET:]
    floors, carried, lies = np.full(len(times), floor), None, np.full((len(times), FEET), floor + contact_height(physique.skeleton))
    supported = True
    if ground is not None:
        thick = flesh_of(physique).thick[-FEET:]
        beneath = np.empty(len(times))
        level_kernel(ground.corner, ground.levels, centres, beneath)
        supported = not np.isnan(beneath[times > toppled]).any()
        high, carried = stands(soles[-1], thick, ground) if rests else (floor, None)
        floors = np.fmin(np.where(times > toppled, high, floor), beneath)  # who goes down stairs has not lost the floor
        floors[times > times[-1] - STOOD] = high
        rest_kernel(ground.things, ground.corner, ground.caps, soles, thick, False, lies, np.empty((len(times), FEET, 2)))
    feet, over = (rows.reshape(-1, 2, 3, *rows.shape[2:])[:, :, :2].reshape(-1, 4, *rows.shape[2:]) for rows in (soles, soles[..., 1] - lies))
    flows = np.asarray(np.gradient(feet, 1.0 / RATE, axis=0))
    contacts = (np.hypot(flows[..., 0], flows[..., 2]) < SLIDES) & (over < TOUCHES * physique.size)
    if carried is not None:
        contacts[-1] = carried
    return Recovery(times, roots, local, centres, np.gradient(centres, 1.0 / RATE, axis=0), contacts, facing, FALLS, 0, np.zeros((0, 2)), float(times[-1]), WHY, floors, supported)


def _halted(roots: np.ndarray, local: np.ndarray, facing: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Roots (N, 3), rotations (N, J, 3, 3) and headings (N,) [rad] of a body that comes to rest in the last of them: HALTS moments are shown in twice as many, (N + HALTS, ...)."""
    begin = len(roots) - HALTS
    share = np.arange(1, 2 * HALTS + 1) / (2.0 * HALTS)
    shown = begin - 1.0 + HALTS * (1.0 - (1.0 - share) ** 2)
    n = np.minimum(shown.astype(int), len(roots) - 2)
    part = shown - n
    slow, turned = np.empty((2 * HALTS, 3)), np.empty((2 * HALTS, *local.shape[1:]))
    for k in range(2 * HALTS):
        between_kernel(roots[n[k]], roots[n[k] + 1], local[n[k]], local[n[k] + 1], part[k], slow[k], turned[k])
    late = facing[n] + part * (facing[n + 1] - facing[n])
    return np.concatenate([roots[:begin], slow]), np.concatenate([local[:begin], turned]), np.concatenate([facing[:begin], late])


def _evenly(share: np.ndarray) -> np.ndarray:
    """From 0 to 1 as a share of the time (N,) goes from 0 to 1, without a jerk at either."""
    share = np.clip(share, 0.0, 1.0)
    return share**2 * (3.0 - 2.0 * share)


def _paced(fall: Fall, pace: float, rate: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Times (N,) [s], the moments (N,) [s] of a recorded fall that are shown then, and when it strikes the floor: as soon as a pendulum would that goes with a pace [m/s] and falls as far."""
    alone = math.asinh(fall.far * rate / max(pace, 0.05)) / rate  # until x = v/ω sinh ωt is there
    quick = min(max((fall.strikes - fall.begins) / alone, PACES[0]), PACES[1])
    toppled = (fall.strikes - fall.begins) / quick
    wears = min(WEARS, 2.0 * (fall.lasts - fall.strikes) / (quick + 1.0))
    whole = toppled + wears + (fall.lasts - fall.strikes - 0.5 * (quick + 1.0) * wears)
    times = np.arange(int(whole * RATE)) / RATE
    late = np.clip(times - toppled, 0.0, wears)
    shown = fall.begins + quick * np.minimum(times, toppled) + quick * late + 0.5 * (1.0 - quick) * late**2 / wears + np.maximum(times - toppled - wears, 0.0)
    return times, np.minimum(shown, fall.lasts), toppled
