"""Muscles as linear springs across hip, knee and ankle, and the ground force they give.

Ooi 2015, 3.1.2.1: a joint's bend θ opens a gap between two bones of width r that a spring of
stiffness k must stretch across. Two readings of its force:

- `wedge` (default): the gap is the chord, F = 2 k r sin(θ/2): nothing when straight.
- `printed`: θ = acos(2k²r²/F² − 1), which is the inverse of F = k r / cos(θ/2): never below k r,
  without bound towards a folded joint. They agree at 90°.

A spring's torque is its moment arm times F, τ = ‖r‖ F. Two readings of the arm:

- `constant` (default): over a kneecap, or the round end of a bone, it stays r.
- `attached`: the spring is drawn straight from bone to bone, between two points r off the joint, and
  ‖r‖ = ‖(p_attach − p_joint) × d̂‖ = r cos(θ/2): deep crouches are then the weak ones.

The ground force is the f that fits Jᵀ f = τ best: muscles hold it without moving.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Literal, NamedTuple

import numpy as np

from ...compiled import kernel
from ..body import MASS, BodyTables, Physique, bend_kernel

Reading = Literal["wedge", "printed"]
Arm = Literal["constant", "attached"]
WIDTH = 0.05
"""r: how far a muscle runs from the axis of the joint it crosses [m], at standard height."""
STIFFNESS = 29.7e3
"""k: of one leg's muscles across one joint [N/m] in an adult of 73 kg, standard height and strength 1.

Found by the thrust (`extension`): with r as 5 cm, the k with which an adult's counter-movement
is as deep as measured ones, 0.28 … 0.38 m for jumps of 0.3 … 0.4 m, when a crouch is just deep enough for
fully active springs to reach the take-off speed. Only k r² counts for torques, so one number was free.
"""
POINTED = 0.70
"""The calf pulls until the foot points down this far [rad]: an ankle's bend counts from there."""
MUSCLES = ("left hip", "left knee", "left ankle", "right hip", "right knee", "right ankle")
"""The order of everything that has an entry per muscle."""


class Muscle(NamedTuple):
    """A spring across a joint. stiffness: k [N/m]. width: r [m]. printed, attached: the readings of its
    force and of its arm."""

    stiffness: float
    width: float
    printed: bool = False
    attached: bool = False


@lru_cache(maxsize=64)
def muscle(physique: Physique, reading: Reading = "wedge", arm: Arm = "constant") -> Muscle:
    """The springs of a body, one and the same across hip, knee and ankle.

    r grows with height, k with mass and strength and against height, so that bodies of one build
    push with the same share of their weight at the same bend. ValueError for an unknown reading.
    """
    if reading not in ("wedge", "printed"):
        raise ValueError(f"reading must be wedge or printed, got {reading!r}")
    if arm not in ("constant", "attached"):
        raise ValueError(f"arm must be constant or attached, got {arm!r}")
    size = physique.size
    return Muscle(STIFFNESS * physique.strength * physique.mass / MASS / size, WIDTH * size, reading == "printed",
                  arm == "attached")


def spring_force(bend, spring: Muscle) -> np.ndarray:
    """The force (...) [N] of a spring across a joint bent by `bend` (...) [rad], 0 straight, at most π.

    A joint bent the other way stretches nothing: it counts as straight. The printed reading grows
    without bound towards π; there it is held at a bend of 179°.
    """
    bend = np.clip(bend, 0.0, math.pi)
    if spring.printed:
        return spring.stiffness * spring.width / np.cos(0.5 * np.minimum(bend, math.radians(179.0)))
    return 2.0 * spring.stiffness * spring.width * np.sin(0.5 * bend)


def spring_bend(force, spring: Muscle) -> np.ndarray:
    """The bend (...) [rad] at which a spring pulls with `force` (...) [N]: the inverse of `spring_force`.

    Clamped to the reading's domain: wedge 0 ≤ F ≤ 2 k r, θ = acos(1 − F²/(2k²r²));
    printed F ≥ k r, θ = acos(2k²r²/F² − 1).
    """
    share = np.maximum(np.asarray(force, float), 0.0) / (spring.stiffness * spring.width)
    if spring.printed:
        return np.arccos(2.0 / np.maximum(share, 1.0) ** 2 - 1.0)
    return 2.0 * np.arcsin(np.minimum(0.5 * share, 1.0))  # acos(1 − s²/2), kept exact near 0


def moment_arm(bend, spring: Muscle) -> np.ndarray:
    """The moment arm ‖r‖ (...) [m] of a spring across a joint bent by `bend` (...) [rad]."""
    bend = np.clip(bend, 0.0, math.pi)
    return spring.width * (np.cos(0.5 * bend) if spring.attached else np.ones_like(bend))


def spring_torque(bend, spring: Muscle) -> np.ndarray:
    """The torque (...) [N m], τ = ‖r‖ F, with which a spring straightens a joint bent by `bend` (...) [rad]."""
    return moment_arm(bend, spring) * spring_force(bend, spring)


def spring_work(bend, spring: Muscle) -> np.ndarray:
    """The work (...) [J] that a spring does as its joint straightens from `bend` (...) [rad]: ∫ τ dθ."""
    bend = np.asarray(bend, float)
    out = np.empty(bend.shape)
    for i, value in np.ndenumerate(bend):
        out[i] = work_kernel(value, spring)
    return out[()]


@kernel
def torque_kernel(bend, spring):
    """`spring_torque` of one joint, compiled."""
    half = 0.5 * min(max(bend, 0.0), math.pi)
    scale = spring.stiffness * spring.width**2
    if spring.printed:
        # k r² / cos(θ/2), and the attached arm takes the cosine away again
        return scale if spring.attached else scale / math.cos(min(half, math.radians(89.5)))
    return 2.0 * scale * math.sin(half) * (math.cos(half) if spring.attached else 1.0)


@kernel
def work_kernel(bend, spring):
    """`spring_work` of one joint, compiled."""
    half = 0.5 * min(max(bend, 0.0), math.radians(179.0) if spring.printed else math.pi)
    scale = spring.stiffness * spring.width**2
    if spring.printed:
        return 2.0 * scale * (half if spring.attached else math.atanh(math.sin(half)))
    return 2.0 * scale * math.sin(half) ** 2 if spring.attached else 4.0 * scale * (1.0 - math.cos(half))


@kernel
def force_kernel(body: BodyTables, spring: Muscle, feet, centre, positions, orientations, bends, torques, forces):
    """Write what the muscles do in a placed body over feet (2, 6): bends (2, 3) [rad] and torques (2, 3)
    [N m] of hips, knees and ankles, and both ground forces (2, 3) [N]. Returns the size of their sum.

    centre: (3,) the centre of mass.
    """
    for side in range(2):
        leg_force_kernel(body, spring, side, feet[side], centre, positions, orientations, bends[side], torques[side],
                         forces[side])
    total = 0.0
    for i in range(3):
        total += (forces[0, i] + forces[1, i]) ** 2
    return math.sqrt(total)


@kernel
def leg_force_kernel(body: BodyTables, spring: Muscle, side, foot, centre, positions, orientations, bends, torques, out):
    """One leg's part of `force_kernel`.

    The ground pushes below the centre of mass, as far as the part of the sole that stands goes.
    f = pinv(Jᵀ) τ in the plane of the leg: hinges about one axis hold nothing across it.
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
        torques[k] = torque_kernel(bends[k], spring)
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
