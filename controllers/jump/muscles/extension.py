"""The thesis's thrust: muscles straighten the joints of a crouched body until it leaves the floor.

Ooi 2015, 3.1.3, mended as docs/glossary.md says. Printed are τ = m a_θ and explicit Euler. But torques turn
inertias: τ_net = I α, where τ_net is the muscle's torque less gravity's and I the inertia, about
the joint, of everything the joint moves; over a planted foot that is the body above it. Joints
that move each other share more than that, the whole mass matrix, of which those I are the
diagonal: only with it does the work of the muscles become motion and height, nothing more.

The body is a chain in its sagittal plane (see `chain`). Muscles pass from holding to pushing one
after the other, from the centre of mass outward. When each does decides how upright the body
leaves: all at once it falls back, too late it falls forward. So `shoot` finds two numbers: how
active the muscles are, for the speed, and how late the lower ones are, for the direction.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ..body import GRAVITY, Physique, place_kernel
from .chain import CHAIN, COLUMNS, EXPLICIT, MOVED, PRINTED, RUNGE_KUTTA, SEMI_IMPLICIT, Links, links_kernel, thrust_kernel
from .strength import DELAYS, STEP, upward
from .windup import Crouch

LONGEST_STEP = 1.0 / 240.0
"""No longer steps are taken [s]."""
LATEST, LAZIEST = 1.6, 0.2
"""`shoot` delays muscles by at most so many times DELAYS, and leaves them at least so active."""
ROUNDS, MOST = 12, 360
"""At most so many thrusts are tried, of so many steps."""
Inertia = Literal["chain", "moved", "printed"]
Integration = Literal["semi-implicit", "explicit", "runge-kutta"]
_INERTIAS = {"chain": CHAIN, "moved": MOVED, "printed": PRINTED}
_INTEGRATIONS = {"semi-implicit": SEMI_IMPLICIT, "explicit": EXPLICIT, "runge-kutta": RUNGE_KUTTA}


@dataclass(frozen=True, eq=False)
class Extension:
    """A thrust of N steps, in the sagittal plane: forward, up.

    times: (N,) [s]. bends: (N, 3) [rad] of hip, knee and ankle, as in `muscles`. turns: (N, 4) [rad]
    of foot, shank, thigh and trunk forward since the crouch; the foot's is how far the heel has
    risen. centre, velocity: (N, 2) [m, m/s] of the centre of mass. force: (N, 2) [N] of the ground.
    work: [J] the muscles did. energy: [J] of motion and height that the body gained. activation,
    delays: how active the muscles were, and by when (3,) [s]. extended: whether it left the floor
    with its legs extended, rather than because nothing pressed it down any more or time was over.
    """

    times: np.ndarray
    bends: np.ndarray
    turns: np.ndarray
    centre: np.ndarray
    velocity: np.ndarray
    force: np.ndarray
    work: float
    energy: float
    activation: float
    delays: np.ndarray
    extended: bool

    @property
    def duration(self) -> float:
        """From the lowest point to take-off [s]."""
        return float(self.times[-1])


def links(physique: Physique, crouch: Crouch) -> Links:
    """A crouched body as a chain."""
    body, count = physique.tables, len(crouch.rotations)
    positions, turned = np.empty((count, 3)), np.empty((count, 3, 3))
    place_kernel(body, crouch.pelvis, crouch.rotations, positions, turned)
    return links_kernel(body, crouch.feet, positions, turned, crouch.bends.reshape(2, 3))


def extend(physique: Physique, crouch: Crouch, gravity=GRAVITY, *, activation: float = 1.0, delays=DELAYS,
           dt: float = 1.0 / 3840.0, inertia: Inertia = "chain", integration: Integration = "semi-implicit",
           longest: float = 1.5) -> Extension:
    """Straighten a crouched body by its muscles until it leaves the floor.

    gravity: (3,) or downward [m/s²]. activation: of the muscles, 0 … 1. delays: (3,) [s] by when
    hip, knee and ankle are as active as that; at first they hold against gravity. dt: step [s], at
    most 1/240. integration: `explicit` as printed, `semi-implicit`, of first order as well,
    or `runge-kutta`, which needs no shorter step. inertia: `chain`, the whole mass matrix; `moved`,
    each joint by itself turning what is above it, over flat feet; `printed`, τ = m a_θ. longest: [s]
    after which a body that still stands is given up. ValueError for anything else.
    """
    if not 0.0 < dt <= LONGEST_STEP + 1e-12:
        raise ValueError(f"dt must be above 0 and at most 1/240 s, got {dt!r}")
    delays = np.array(delays, float)
    if not 0.0 <= activation <= 1.0 or delays.shape != (3,) or not (delays >= 0.0).all():
        raise ValueError(f"activation must be within 0 … 1 and delays three times [s], got {activation!r}, {delays}")
    if inertia not in _INERTIAS or integration not in _INTEGRATIONS:
        raise ValueError(f"inertia must be of {', '.join(_INERTIAS)}, integration of {', '.join(_INTEGRATIONS)}, "
                         f"got {inertia!r}, {integration!r}")
    most = int(longest / dt)
    rows = np.empty((most + 1, COLUMNS))
    used, extended = thrust_kernel(links(physique, crouch), crouch.spring, -float(upward(gravity, -1.0)[1]), float(activation),
                                   delays, _INERTIAS[inertia], _INTEGRATIONS[integration], dt, most, rows)
    rows = rows[:used].copy()
    return Extension(rows[:, 0], rows[:, 1:4], rows[:, 4:8], rows[:, 8:10], rows[:, 10:12], rows[:, 12:14], float(rows[-1, 14]),
                     float(rows[-1, 15] - rows[0, 15]), float(activation), delays, bool(extended))


def shoot(physique: Physique, crouch: Crouch, velocity, gravity=GRAVITY) -> Extension:
    """The thrust that takes a crouched body off with `velocity` [m/s], (3,) or upward, if one does.

    The upward part comes first: it is met to 0.2 % of the speed wherever the muscles have it. Forward, as
    the feet point, a body over its feet goes with a few decimetres a second at most, and as near to
    the wish as that. Secants (Broyden's method) on activation and lateness, Runge-Kutta at 1/240 s.
    ValueError for a velocity that is not finite.
    """
    velocity, g = upward(velocity, 1.0), -float(upward(gravity, -1.0)[1])
    if velocity.shape != (3,) or not np.isfinite(velocity).all():
        raise ValueError(f"velocity must be a number or (3,) and finite, got {velocity}")
    yaw = 0.5 * (crouch.feet[0, 3] + crouch.feet[1, 3])
    wanted = np.array([velocity[0] * math.sin(yaw) + velocity[2] * math.cos(yaw), velocity[1]])
    chain, row, close = links(physique, crouch), np.empty((1, COLUMNS)), 2e-3 * np.linalg.norm(wanted)

    def reached(activation, lateness):
        thrust_kernel(chain, crouch.spring, g, activation, lateness * DELAYS, CHAIN, RUNGE_KUTTA, STEP, MOST, row)
        return row[0, 10:12].copy()
    activation, lateness = 0.95, 0.9
    got = reached(activation, lateness)
    slope = np.column_stack([(reached(activation - 0.04, lateness) - got) / -0.04,
                             (reached(activation, lateness + 0.1) - got) / 0.1])
    best = (math.inf, activation, lateness)
    for _ in range(ROUNDS):
        miss = wanted - got
        best = min(best, (float(np.hypot(0.2 * miss[0], miss[1])), activation, lateness))
        bound = lateness in (0.0, LATEST) and abs(miss[1]) < close
        if np.abs(miss).max() < close or bound:
            break
        later = np.linalg.solve(slope, miss)[1] if abs(np.linalg.det(slope)) > 1e-6 else 0.0
        late = float(np.clip(lateness + np.clip(later, -0.5, 0.5), 0.0, LATEST))
        change = np.array([(miss[1] - slope[1, 1] * (late - lateness)) / slope[1, 0], late - lateness])
        change[0] = np.clip(activation + np.clip(change[0], -0.25, 0.25), LAZIEST, 1.0) - activation
        if not change.any():
            break
        activation, lateness, before = activation + change[0], late, got
        got = reached(activation, lateness)
        slope += np.outer(got - before - slope @ change, change) / (change @ change)
    _, activation, lateness = best
    return extend(physique, crouch, gravity, activation=activation, delays=lateness * DELAYS, dt=STEP,
                  integration="runge-kutta")
