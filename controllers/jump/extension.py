"""The thesis's thrust: muscles straighten the joints of a crouched body until it leaves the floor.

Ooi 2015, 3.1.3, read as in READINGS A2. Printed are τ = m a_θ and explicit Euler. But torques turn
inertias: τ_net = I α, where τ_net is the muscle's torque less gravity's and I the inertia, about
the joint, of everything the joint moves; over a planted foot that is the body above it. Joints
that move each other share more than that, the whole mass matrix, of which those I are the
diagonal: only with it does the work of the muscles become motion and height, nothing more.

The body is a chain in its sagittal plane, both legs as one: foot, shank, thigh and, as one piece,
all above the hips. The foot turns about its ball once its heel no longer presses on the floor.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from .dynamics import GRAVITY, Physique, place_kernel
from .muscles import BURST, CALF, muscle, spring_torque
from .poise import capacity_kernel, frame
from .windup import Crouch

LONGEST_STEP = 1.0 / 240.0
"""No longer steps are taken [s]."""
EXTENDED = 0.975
"""A leg of this share of its length is extended: the push is over."""
DELAYS = (0.0, 0.04, 0.08)
"""When hip, knee and ankle start to push [s]: from the centre of mass outward."""
Inertia = Literal["chain", "moved", "printed"]


@dataclass(frozen=True, eq=False)
class Extension:
    """A thrust of N steps, in the sagittal plane: forward, up.

    times: (N,) [s]. bends: (N, 3) [rad] of hip, knee and ankle, as in `muscles`. heel: (N,) [rad]
    how far it has risen. centre, velocity: (N, 2) [m, m/s] of the centre of mass. force: (N, 2)
    [N] of the ground. work: [J] the muscles did. energy: [J] of motion and height that the body
    gained. extended: whether it left the floor with its legs extended, rather than because
    nothing pressed it down any more or time was over.
    """

    times: np.ndarray
    bends: np.ndarray
    heel: np.ndarray
    centre: np.ndarray
    velocity: np.ndarray
    force: np.ndarray
    work: float
    energy: float
    extended: bool

    @property
    def duration(self) -> float:
        """From the lowest point to take-off [s]."""
        return float(self.times[-1])


class Chain:
    """A crouched body as four links: foot, shank, thigh, the rest, in the plane of (forward, up).

    mass: (4,) [kg]. inertia: (4,) [kg m²] about the links' centres. link, centre: (4, 2) [m] from
    each link's lower joint to the next and to its centre, as it crouches. ball: (2,) [m].
    """

    def __init__(self, physique: Physique, crouch: Crouch):
        body = physique.tables
        positions, turned = np.empty((len(crouch.rotations), 3)), np.empty((len(crouch.rotations), 3, 3))
        place_kernel(body, crouch.pelvis, crouch.rotations, positions, turned)
        yaw = 0.5 * (crouch.feet[0, 3] + crouch.feet[1, 3])
        plane = np.array([[math.sin(yaw), 0.0, math.cos(yaw)], [0.0, 1.0, 0.0]])
        side = np.array([math.cos(yaw), 0.0, -math.sin(yaw)])
        hips = body.hip[:, None]
        joints = [(positions[hips + k] @ plane.T).mean((0, 1)) for k in (3, 2, 1, 0)]
        group = np.full(len(positions), 3)
        for k, number in ((2, 0), (1, 1), (0, 2)):
            group[body.hip + number] = k
        group[body.hip + 3] = 0
        places = positions[body.joint] + np.einsum("sij,sj->si", turned[body.joint], body.centre)
        around = np.einsum("i,sij,sjk,slk,l->s", side, turned[body.joint], body.inertia, turned[body.joint], side)
        self.mass, self.inertia = np.empty(4), np.empty(4)
        self.link, self.centre = np.zeros((4, 2)), np.empty((4, 2))
        for k in range(4):
            mine = group[body.joint] == k
            mass, flat = body.mass[mine], places[mine] @ plane.T
            middle = mass @ flat / mass.sum()
            self.mass[k] = mass.sum()
            self.inertia[k] = around[mine].sum() + mass @ np.sum((flat - middle) ** 2, -1)
            self.centre[k] = middle - joints[k]
            if k < 3:
                self.link[k] = joints[k + 1] - joints[k]
        self.ball = joints[0]
        self.leg = body.thigh + body.shank

    def at(self, angles: np.ndarray, speeds: np.ndarray):
        """How links turned forward by `angles` (4,) [rad], at `speeds` (4,) [rad/s], lie and move.

        Returns their centres (4, 2), the centres' Jacobian (4, 2, 4) and what of their acceleration
        (4, 2) comes from turning alone; and the distance from ankle to hip [m].
        """
        c, s = np.cos(angles)[:, None], np.sin(angles)[:, None]

        def turn(v):
            return np.concatenate([c * v[:, :1] + s * v[:, 1:], c * v[:, 1:] - s * v[:, :1]], 1)
        link, own = turn(self.link), turn(self.centre)
        base = np.cumsum(np.concatenate([self.ball[None], link[:3]]), 0)
        jacobian, bias = np.zeros((4, 2, 4)), np.zeros((4, 2))
        for k in range(4):
            arms = np.concatenate([link[:k], own[k:k + 1]])
            jacobian[k, :, :k + 1] = np.stack([arms[:, 1], -arms[:, 0]])
            bias[k] = -(speeds[:k + 1, None] ** 2 * arms).sum(0)
        return base + own, jacobian, bias, float(np.linalg.norm(base[3] - base[1]))


# how the bends of hip, knee and ankle follow from the links' turns: foot, shank, thigh, trunk
_BENDS = np.array([[0.0, 0.0, -1.0, 1.0], [0.0, 1.0, -1.0, 0.0], [-1.0, 1.0, 0.0, 0.0]])


def extend(physique: Physique, crouch: Crouch, gravity=GRAVITY, *, dt: float = 1.0 / 1920.0,
           inertia: Inertia = "chain", integration: Literal["semi-implicit", "explicit"] = "semi-implicit",
           delays=DELAYS, longest: float = 1.5) -> Extension:
    """Straighten a crouched body by its muscles, fully active, until it leaves the floor.

    gravity: (3,) [m/s²], straight down. dt: step [s], at most 1/240: steps of first order lose a
    tenth of the energy there, a hundredth at 1/3840 s. delays: (3,) [s] of hip, knee and ankle;
    until then muscles hold against gravity. inertia: `chain`, the whole mass matrix; `moved`, each
    joint by itself turning what is above it, over flat feet; `printed`, τ = m a_θ. longest: [s]
    after which a body that still stands is given up.
    ValueError for a dt above 1/240 s or not above 0.
    """
    if not 0.0 < dt <= LONGEST_STEP + 1e-12:
        raise ValueError(f"dt must be above 0 and at most 1/240 s, got {dt!r}")
    chain, spring = Chain(physique, crouch), muscle(physique)
    g = -float(np.asarray(gravity, float)[1])
    start = 0.5 * (crouch.bends[:3] + crouch.bends[3:])
    softness = np.array([1.0, 1.0, CALF])
    angles, speeds, onset = np.zeros(4), np.zeros(4), np.asarray(delays, float)
    weight = chain.mass / chain.mass.sum()
    flat, work, height, rows, extended = True, 0.0, None, [], False
    for n in range(int(longest / dt)):
        places, jacobian, bias, length = chain.at(angles, speeds)
        bends = start + _BENDS @ angles
        pull = g * np.einsum("k,kj->j", chain.mass, jacobian[:, 1])  # of gravity on each link, resisted
        matrix = np.einsum("k,kij,kil->jl", chain.mass, jacobian, jacobian) + np.diag(chain.inertia)
        turning = np.einsum("k,kij,ki->j", chain.mass, jacobian, bias)
        holding = np.array([-pull[3], pull[2] + pull[3], -pull[1] - pull[2] - pull[3]])
        full = 2.0 * softness * spring_torque(bends, spring)
        torques = np.where(n * dt >= onset, full, np.clip(holding, 0.0, full))
        if inertia == "chain":
            given = -_BENDS.T @ torques - pull - turning
            change = np.zeros(4)
            if flat:
                change[1:] = np.linalg.solve(matrix[1:, 1:], given[1:])
                flat = matrix[0] @ change - given[0] >= 0.0  # while the floor has to hold the heel up
            if not flat:
                change = np.linalg.solve(matrix, given)
        else:
            change = _apart(chain, matrix, torques - holding, inertia)
        moving = weight @ (jacobian @ speeds)
        centre = weight @ places
        force = chain.mass.sum() * (weight @ (jacobian @ change + bias) + [0.0, g])
        rows.append((n * dt, *bends, angles[0], *centre, *moving, *force))
        energy = 0.5 * speeds @ matrix @ speeds + chain.mass.sum() * g * centre[1]
        height = energy if height is None else height
        extended = length >= EXTENDED * chain.leg
        if extended or (n > 0 and force[1] <= 0.0):
            break
        before = speeds
        speeds = speeds + change * dt
        angles = angles + (before if integration == "explicit" else speeds) * dt
        work -= dt * torques @ _BENDS @ (0.5 * (before + speeds))
        if not flat and angles[0] <= 0.0 and speeds[0] < 0.0:  # the heel is down again
            angles[0], speeds[0], flat = 0.0, 0.0, True
    rows = np.array(rows)
    return Extension(rows[:, 0], rows[:, 1:4], rows[:, 4], rows[:, 5:7], rows[:, 7:9], rows[:, 9:11], float(work),
                     float(energy - height), extended)


def _apart(chain: Chain, matrix, net, inertia):
    """The links' angular accelerations (4,) if each joint turned by itself what lies above it."""
    bends = np.empty(3)
    for k, first in enumerate((3, 2, 1)):
        turned = matrix[first:, first:].sum() if inertia == "moved" else chain.mass[first:].sum()
        bends[k] = -net[k] / turned
    shank = bends[2]
    thigh = shank - bends[1]
    return np.array([0.0, shank, thigh, thigh + bends[0]])


def capacity(physique: Physique, roots: np.ndarray, local: np.ndarray, feet: np.ndarray) -> np.ndarray:
    """The greatest ground force (N,) [N] that the muscles can give in poses over planted feet.

    roots: (N, 3) [m], local: (N, J, 3, 3) poses. feet: (N, 2, 6) as in `posture`. For a moment:
    BURST times what they hold.
    """
    roots, local, feet = (np.ascontiguousarray(a, float) for a in (roots, local, feet))
    out = np.empty(len(roots))
    capacity_kernel(frame(physique), roots, local, feet, out)
    return BURST * out
