"""Traction: nobody speeds up, slows down or goes round a curve harder than the ground pushes at the moment.

Legs push as hard as they bear by the blend's hips (`command`). But the mass centre also goes by itself: it sways, limbs swing, and feet that are held where they stand
lead their legs otherwise than the blend's; just before a strike a walker bears half of his weight. So it is told of the pose as it is shown what friction leaves
for the ground frame's own acceleration; by what that is over, the body comes less far in this very step, and feet stay where they are. It makes up for that within a step
or two, so that ways end where they were to.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..body import Skeleton, anatomy, relative_kernel, spring_kernel
from ..compiled import kernel
from .legs import leg_kernel
from .mass_centre import FRICTION, GRAVITY

SPARE = 0.1
"""Whoever bears his weight may push by this share harder than his legs do on average."""
FELT = 0.024
"""How the mass centre goes by itself is felt so late [s], however long steps are: it is told from the difference of two differences."""
MAKES_UP = 0.15
"""Half-life with which a body makes up for where it lags behind its command [s]."""
KNOWN = 2
"""So many steps it takes until it can be."""


class Masses(NamedTuple):
    """A body's mass by joints: shares (J,), and the shares' centres times them (J, 3) [m] in the joints' frames."""

    shares: np.ndarray
    moments: np.ndarray


def masses_of(skeleton: Skeleton) -> Masses:
    """What a step must know of a body's masses."""
    body, shares, moments = anatomy(skeleton), np.zeros(len(skeleton)), np.zeros((len(skeleton), 3))
    np.add.at(shares, body.joints, body.shares)
    np.add.at(moments, body.joints, body.shares[:, None] * body.centres)
    return Masses(shares, moments)


@kernel
def make_up(m, dt):
    """Lead the ground frame on for dt back to where its command leads, as far as it lagged behind that."""
    for i in range(2):
        before = m.lag[i]
        m.lag[i], m.lag_rate[i] = (0.0, 0.0) if m.settled else spring_kernel(before, m.lag_rate[i], 0.0, MAKES_UP, dt)
        if not m.settled:
            m.ground[i] += m.lag[i] - before


@kernel
def keep_traction(m, masses, legs, settings, came, floor, positions, orientations, local, dt, work):
    """Take from a step what friction does not give it. came: (2,) where the ground frame was before it, x, z in the world [m]; floor: how high the floor lies [m]."""
    place, target = np.empty(3), np.empty(3)
    _mass_centre(m, masses, legs, floor, positions, orientations, place)
    gain = min(dt / FELT, 1.0)
    for i in range(3):
        rate = (place[i] - m.mass[i]) / dt
        m.pull[i] += gain * ((rate - m.mass_rate[i]) / dt - m.pull[i]) if m.felt >= KNOWN else -m.pull[i]
        m.mass[i], m.mass_rate[i] = place[i], rate
    goes_x, goes_z = (m.ground[0] - came[0]) / dt, (m.ground[1] - came[1]) / dt
    x, z = (goes_x - m.went[0]) / dt, (goes_z - m.went[1]) / dt
    m.went[0], m.went[1] = goes_x, goes_z
    size = math.hypot(x, z)
    if m.felt < KNOWN:
        m.felt += 1
        return
    if m.settled or m.waits or m.turn != 0.0 and m.spot or m.walled or m.brink > 0.0 or size < 1e-6:
        return
    x, z = x / size, z / size
    most = max(FRICTION, (1.0 + SPARE) * settings.acceleration * settings.agility / GRAVITY)
    over = size - max(most * (GRAVITY + m.pull[1]) - x * m.pull[0] - z * m.pull[2], 0.0)
    if over <= 0.0:
        return
    x, z = -over * dt * x, -over * dt * z
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    left, ahead = c * x - s * z, s * x + c * z
    m.went[0], m.went[1] = m.went[0] + x, m.went[1] + z
    m.ground[0], m.ground[1] = m.ground[0] + x * dt, m.ground[1] + z * dt
    m.lag[0], m.lag[1] = m.lag[0] + x * dt, m.lag[1] + z * dt
    m.lag_rate[0], m.lag_rate[1] = m.lag_rate[0] + x, m.lag_rate[1] + z
    for foot in range(2):
        m.offset[foot, 0], m.offset[foot, 1] = m.offset[foot, 0] - x * dt, m.offset[foot, 1] - z * dt
        hip = legs.hip[foot]
        for i in range(3):
            target[i] = positions[hip + 2, i]
        target[0], target[2] = target[0] - left * dt, target[2] - ahead * dt
        leg_kernel(positions, orientations, hip, target, work)
        relative_kernel(orientations[0], orientations[hip], local[hip])
        relative_kernel(orientations[hip], orientations[hip + 1], local[hip + 1])
        relative_kernel(orientations[hip + 1], orientations[hip + 2], local[hip + 2])


@kernel
def _mass_centre(m, masses, legs, floor, positions, orientations, out):
    """Where the mass centre (3,) of the pose as it is shown is from the ground frame's origin, along the world's axes [m]."""
    x = z = 0.0
    y = floor + m.level - m.pelvis
    for j in range(masses.shares.shape[0]):
        x += masses.shares[j] * positions[j, 0]
        y += masses.shares[j] * positions[j, 1]
        z += masses.shares[j] * positions[j, 2]
        for k in range(3):
            x += orientations[j, 0, k] * masses.moments[j, k]
            y += orientations[j, 1, k] * masses.moments[j, k]
            z += orientations[j, 2, k] * masses.moments[j, k]
    for foot in range(2):  # whose legs were lowered with the pelvis
        for j in range(legs.hip[foot], legs.hip[foot] + 4):
            y += masses.shares[j] * m.pelvis
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    out[0], out[1], out[2] = c * x + s * z, y, c * z - s * x
