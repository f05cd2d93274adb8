"""Steering: a wished velocity in the world becomes an intent in the character's own frame.

Everything is a pure function over any batch. Nothing jumps as the wish changes, with one
exception that no steering can avoid: straight behind, left and right are equally near. There
the way the character already turns decides, so that it never dithers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..body import advance, stacked, wrap
from ..contract import Intent


@dataclass(frozen=True)
class Reach:
    """How fast a body can go in each direction [m/s]; between them, ellipses."""

    forward: float = 3.4
    backward: float = 0.7
    lateral: float = 0.6


@dataclass(frozen=True)
class Steering:
    """How a character turns.

    gain: rad/s of turning per rad of heading error. turn: the fastest turn [rad/s].
    fade: below this wished speed [m/s] the direction of a wish counts less and less, as its
    direction means nothing at rest. commit: how far beyond straight behind [rad] a turn that is
    under way is still carried on the same way round.
    """

    gain: float = 4.0
    turn: float = 2.0
    fade: float = 0.15
    commit: float = 0.5
    reach: Reach = Reach()


def turn_towards(heading: ArrayLike, wanted: ArrayLike, turning: ArrayLike = 0.0, settings: Steering = Steering()) -> tuple[np.ndarray, np.ndarray]:
    """Angular speed ω [rad/s] and heading error [rad], both (...), that bring `heading` to `wanted`.

    heading, wanted: (...) [rad]. turning: (...) the present ω [rad/s]. The error lies within
    (-π, π], moved by up to `commit` to the side that the character turns to already.
    """
    lean = settings.commit * np.tanh(4.0 * np.asarray(turning, float) / settings.turn)
    error = wrap(np.asarray(wanted) - np.asarray(heading) - lean) + lean
    return settings.turn * np.tanh(settings.gain * error / settings.turn), error


def steer(ground, velocity, facing=None, turning=0.0, settings: Steering = Steering()) -> Intent:
    """The intent of a character that wishes to move with `velocity` in the world.

    ground: (..., 3) x, z [m] and heading [rad]. velocity: (..., 2) wished world velocity along
    x and z [m/s]. facing: None, or (...) the heading to hold [rad] whatever the movement
    (strafing); NaN where none is held. turning: (...) the present angular speed [rad/s].

    With nothing to face, the character turns to where it goes and walks only as far as it
    already looks there: a wish to the side makes an arc, one straight back turns on the spot.
    ValueError for what has another shape.
    """
    heading, velocity = _numbers("ground is (..., 3) x, z [m], heading [rad]", ground, 3)[..., 2], _numbers("velocity is (..., 2) along x and z [m/s]", velocity, 2)
    speed = np.hypot(velocity[..., 0], velocity[..., 1])
    towards = np.arctan2(velocity[..., 0], velocity[..., 1])

    trust = speed**2 / (speed**2 + settings.fade**2)
    omega, error = turn_towards(heading, towards, turning, settings)
    free = np.stack(np.broadcast_arrays(speed * (0.5 + 0.5 * np.cos(error)), trust * omega, 0.0), -1)
    if facing is None:
        return Intent(within(free, settings.reach), towards=stacked(np.where(speed > settings.fade, towards, np.nan), speed))

    facing = np.asarray(facing, float)
    held = np.isfinite(facing)
    omega, _ = turn_towards(heading, np.where(held, facing, heading), turning, settings)
    cosine, sine = np.cos(heading), np.sin(heading)
    strafe = np.stack(np.broadcast_arrays(
        velocity[..., 0] * sine + velocity[..., 1] * cosine, omega,
        velocity[..., 0] * cosine - velocity[..., 1] * sine), -1)
    ends = np.where(held, np.where(speed < settings.fade, facing, np.nan), np.where(speed > settings.fade, towards, np.nan))
    return Intent(within(np.where(held[..., None], strafe, free), settings.reach), towards=stacked(ends, np.where(held, 0.0, speed)))


def _numbers(what: str, value: ArrayLike, count: int) -> np.ndarray:
    """(..., count) numbers, which may be NaN."""
    try:
        numbers = np.asarray(value, float)
    except (TypeError, ValueError):
        numbers = np.zeros(0)
    if numbers.shape[-1:] != (count,):
        raise ValueError(f"a {what}; got {value!r}")
    return numbers


def within(velocity, reach: Reach) -> np.ndarray:
    """Velocities (..., 3) v_f, ω, v_l shortened to what the body reaches, direction and ω kept."""
    velocity = np.asarray(velocity, float)
    v_f, v_l = velocity[..., 0], velocity[..., 2]
    along = np.where(v_f >= 0.0, reach.forward, reach.backward)
    excess = np.maximum(np.hypot(v_f / along, v_l / reach.lateral), 1.0)
    return stacked(v_f / excess, velocity[..., 1], v_l / excess)


def in_world(ground, velocity) -> np.ndarray:
    """World velocities (..., 2) along x and z [m/s] of ground frames (..., 3) moving with (..., 3) v_f, ω, v_l."""
    heading, velocity = np.asarray(ground, float)[..., 2], np.asarray(velocity, float)
    cosine, sine = np.cos(heading), np.sin(heading)
    v_f, v_l = velocity[..., 0], velocity[..., 2]
    return stacked(v_f * sine + v_l * cosine, v_f * cosine - v_l * sine)


def in_frame(ground, velocity, turn=0.0) -> np.ndarray:
    """The (..., 3) v_f, ω, v_l with which ground frames (..., 3) move that have world velocities (..., 2) along x and z [m/s] and turn so fast [rad/s]: what `in_world` undoes."""
    heading, velocity = np.asarray(ground, float)[..., 2], np.asarray(velocity, float)
    cosine, sine = np.cos(heading), np.sin(heading)
    x, z = velocity[..., 0], velocity[..., 1]
    return np.stack([x * sine + z * cosine, np.broadcast_to(turn, x.shape), x * cosine - z * sine], -1)


def drift(ground, velocity, seconds) -> np.ndarray:
    """Ground frames (..., T, 3) that constant velocities lead to: arcs of circles.

    ground: (..., 3) x, z [m], heading [rad]. velocity: (..., 3) v_f, ω, v_l in the moving
    frame. seconds: (T,) times from now.
    """
    ground, velocity = np.asarray(ground, float)[..., None, :], np.asarray(velocity, float)[..., None, :]
    return advance(ground, velocity, np.asarray(seconds, float))
