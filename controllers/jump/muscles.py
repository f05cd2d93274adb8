"""Muscles as linear springs across hip, knee and ankle, and the ground force they give.

Ooi 2015, 3.1.2.1: a joint's bend θ opens a gap between two bones of width r that a spring of
stiffness k must stretch across. Two readings (READINGS A2):

- `wedge` (default): the gap is the chord, F = 2 k r sin(θ/2): nothing when straight.
- `printed`: θ = acos(2k²r²/F² − 1), which is the inverse of F = k r / cos(θ/2): never below k r,
  without bound towards a folded joint. They agree at 90°.

A spring's torque is its moment arm times F. Drawn straight from bone to bone the arm would be
r cos(θ/2), and deep crouches the weak ones; over a kneecap, or the round end of a bone, the arm
stays r, and that is the default. The ground force is the f that fits Jᵀ f = τ best: muscles hold
it without moving.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Literal, NamedTuple

import numpy as np

from ..body.human import STATURE
from ..compiled import kernel
from .dynamics import BodyTables, Physique

Reading = Literal["wedge", "printed"]
WIDTH = 0.05
"""r: how far a muscle runs from the axis of the joint it crosses [m], at standard height."""
STIFFNESS = 30.6e3
"""k: of one leg's muscles across one joint [N/m] in an adult of 73 kg, standard height and strength 1.

So that the crouch of a jump 0.35 m high lowers the centre of mass by 0.33 m.
"""
POINTED, CALF = 0.70, 0.5
"""The calf pulls until the foot points down this far [rad], so an ankle's bend counts from there, and it is
softer than the others by this factor: a level sole then carries what hip and knee push."""
BURST = 1.45
"""How much more than these springs a muscle gives for a moment: the peak of a push over its mean."""
MUSCLES = ("left hip", "left knee", "left ankle", "right hip", "right knee", "right ankle")
"""The order of everything that has an entry per muscle."""


class Muscle(NamedTuple):
    """A spring across a joint. stiffness: k [N/m]. width: r [m]."""

    stiffness: float
    width: float


@lru_cache(maxsize=64)
def muscle(physique: Physique) -> Muscle:
    """The springs of a body, one and the same across hip, knee and ankle.

    r grows with height, k with mass and strength and against height, so that bodies of one build
    push with the same share of their weight at the same bend.
    """
    size = physique.height / STATURE
    return Muscle(STIFFNESS * physique.strength * physique.mass / 73.0 / size, WIDTH * size)


def spring_force(bend, spring: Muscle, reading: Reading = "wedge") -> np.ndarray:
    """The force (...) [N] of a spring across a joint bent by `bend` (...) [rad], 0 straight, at most π.

    A joint bent the other way stretches nothing: it counts as straight. The printed reading grows
    without bound towards π; there it is held at a bend of 179°.
    """
    bend = np.clip(bend, 0.0, math.pi)
    if reading == "wedge":
        return 2.0 * spring.stiffness * spring.width * np.sin(0.5 * bend)
    return spring.stiffness * spring.width / np.cos(0.5 * np.minimum(bend, math.radians(179.0)))


def spring_bend(force, spring: Muscle, reading: Reading = "wedge") -> np.ndarray:
    """The bend (...) [rad] at which a spring pulls with `force` (...) [N]: the inverse of `spring_force`.

    Clamped to the reading's domain: wedge 0 ≤ F ≤ 2 k r, θ = acos(1 − F²/(2k²r²));
    printed F ≥ k r, θ = acos(2k²r²/F² − 1).
    """
    share = np.maximum(np.asarray(force, float), 0.0) / (spring.stiffness * spring.width)
    if reading == "wedge":  # acos(1 − s²/2), kept exact near 0
        return 2.0 * np.arcsin(np.minimum(0.5 * share, 1.0))
    return np.arccos(2.0 / np.maximum(share, 1.0) ** 2 - 1.0)


def moment_arm(attachment, joint, direction) -> np.ndarray:
    """The moment arm (...) [m] of a muscle that pulls along `direction` (..., 3) where it leaves
    `attachment` (..., 3) [m], about `joint` (..., 3) [m]: ‖(p_attach − p_joint) × d̂‖."""
    direction = np.asarray(direction, float)
    unit = direction / np.linalg.norm(direction, axis=-1, keepdims=True)
    return np.linalg.norm(np.cross(np.asarray(attachment, float) - joint, unit), axis=-1)


def spring_torque(bend, spring: Muscle, reading: Reading = "wedge") -> np.ndarray:
    """The torque (...) [N m], τ = ‖r‖ F, with which a spring straightens a joint bent by `bend` (...) [rad]."""
    return spring.width * spring_force(bend, spring, reading)


def spring_work(bend, spring: Muscle, reading: Reading = "wedge") -> np.ndarray:
    """The work (...) [J] that a spring does as its joint straightens from `bend` (...) [rad]: ∫ τ dθ."""
    half = 0.5 * np.clip(bend, 0.0, math.radians(179.0) if reading == "printed" else math.pi)
    if reading == "wedge":
        return 4.0 * spring.stiffness * spring.width**2 * (1.0 - np.cos(half))
    return 2.0 * spring.stiffness * spring.width**2 * np.arctanh(np.sin(half))


@kernel
def torque_kernel(bend, stiffness, width, printed):
    """`spring_torque` of one joint, compiled."""
    half = 0.5 * min(max(bend, 0.0), math.pi)
    if printed:
        return stiffness * width * width / math.cos(min(half, 0.5 * math.radians(179.0)))
    return 2.0 * stiffness * width * width * math.sin(half)


@kernel
def bend_kernel(parent, child):
    """How far [rad] a joint is turned about its parent's x axis, from the orientations (3, 3) of both."""
    sine, cosine = 0.0, 0.0
    for i in range(3):
        sine += child[i, 1] * parent[i, 2]
        cosine += child[i, 1] * parent[i, 1]
    return math.atan2(sine, cosine)


@kernel
def leg_force_kernel(body: BodyTables, side, foot, centre, stiffness, width, printed, positions, orientations,
                     bends, torques, out):
    """Write what one leg's muscles do in a placed body: bends (3,) [rad] and torques (3,) [N m] of hip,
    knee and ankle, and the ground force (3,) [N].

    foot: (6,) as in `posture`. centre: (3,) the centre of mass: the ground pushes below it, as far as
    the part of the sole that stands goes. f = pinv(Jᵀ) τ in the plane of the leg: hinges about
    one axis hold nothing across it.
    """
    hip = body.hip[side]
    bends[0] = -bend_kernel(orientations[0], orientations[hip])
    bends[1] = bend_kernel(orientations[hip], orientations[hip + 1])
    bends[2] = POINTED - bend_kernel(orientations[hip + 1], orientations[hip + 2])
    sine, cosine = math.sin(foot[3]), math.cos(foot[3])
    rear = body.heel[2] - body.toe[2] if foot[4] < 0.02 else 0.0
    along = (centre[0] - foot[0]) * sine + (centre[2] - foot[2]) * cosine
    along = min(max(along, rear), body.tip[2])
    # forward and up in the leg's plane; rows of Jᵀ: the torque about the hinge of a unit force
    low = foot[1] - body.sole
    a, b, c, p, q = 1e-9, 0.0, 1e-9, 0.0, 0.0
    for k in range(3):
        torques[k] = (CALF if k == 2 else 1.0) * torque_kernel(bends[k], stiffness, width, printed)
        j = hip + k
        ahead = along - (positions[j, 0] - foot[0]) * sine - (positions[j, 2] - foot[2]) * cosine
        below = positions[j, 1] - low
        # straightening hip and ankle turns the leg below about +x, the knee about −x; the ground answers
        sign = -1.0 if k == 1 else 1.0
        forward, up = sign * below, sign * ahead
        a += forward * forward
        b += forward * up
        c += up * up
        p += forward * torques[k]
        q += up * torques[k]
    determinant = a * c - b * b
    ahead_force = (c * p - b * q) / determinant
    out[1] = (a * q - b * p) / determinant
    out[0], out[2] = ahead_force * sine, ahead_force * cosine
