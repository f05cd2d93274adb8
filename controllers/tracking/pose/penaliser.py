"""The penalty on jitter, section 4: where the last two poses would lead, and the rows that draw the solution there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..twists import Chain, Configuration, inverse, local_turns, retract_kernel, rigid, turn_log_kernel, twist_log_kernel
from ...body import exp
from ...body import log as vector

JOINT_ACCELERATION = 250.0
"""As fast as joints' angles change their pace [rad/s²]; σ = a/f² of the penalty, 0.07 rad at 60 frames a second."""
ACCELERATION = 25.0
"""The hips' [m/s²], 7 mm at 60 frames a second: a person's 10, and what skin and pelvis differ."""
TURNING = 110.0
"""The hips' [rad/s²], 0.03 rad at 60 frames a second."""

STILL = ("Arm.x", "ForeArm.x", "Hand.y", "Hand.z")
"""What an arm seldom does: turn about itself, and bend at the wrist."""


@dataclass(frozen=True, eq=False)
class Penalty:
    """Where to draw a solution, and how firmly. target: the prediction. weights: (6 + D,) 1/σ² of translation [1/m²],
    rotation and angles [1/rad²]."""

    target: Configuration
    weights: np.ndarray


def predicted(chain: Chain, now: Configuration, before: Configuration) -> Configuration:
    """Where two poses lead, eq. (16) and (17): each of them as far on as from the one before to it.

    The root's is M_t M_{t−1}⁻¹ M_t; a ball goes on likewise, R_t R_{t−1}ᵀ R_t, as its rotation vectors don't add up.
    """
    step = np.empty(len(chain))
    turn_log_kernel(chain.first, chain.count, before.angles, now.angles, step)
    angles = now.angles + step
    balls = np.flatnonzero(chain.count == 3)
    then, earlier = (local_turns(chain, one).rotations for one in (now, before))
    for j in balls:
        at = chain.first[j]
        angles[at:at + 3] = vector(then[j] @ earlier[j].T @ then[j])
    return Configuration(rigid(now.root @ inverse(before.root) @ now.root), np.clip(angles, chain.lower, chain.upper))


def calmed(chain: Chain, now: Configuration, target: Configuration, pace: float) -> Configuration:
    """A prediction whose joints go only so far on: 1 as predicted, 0 as they are now. The root goes all the way.

    Where no picture shows a limb, or its turn about itself, a pace that is kept turns it on and on.
    """
    step = np.zeros(6 + len(chain))
    turn_log_kernel(chain.first, chain.count, now.angles, target.angles, step[6:])
    angles = now.angles.copy()
    retract_kernel(chain.first, chain.count, pace * step, np.eye(4), angles, chain.lower, chain.upper)
    return Configuration(target.root, angles)


def part_way(chain: Chain, now: Configuration, target: Configuration, share: float) -> Configuration:
    """A pose `share` of the way, 0 … 1, from one to another: the hips straight on, everything turned by so much."""
    root = np.eye(4)
    root[:3, :3] = exp(share * vector(target.root[:3, :3] @ now.root[:3, :3].T)) @ now.root[:3, :3]
    root[:3, 3] = now.root[:3, 3] + share * (target.root[:3, 3] - now.root[:3, 3])
    return Configuration(root, calmed(chain, now, target, share).angles)


def penalty_of(chain: Chain, target: Configuration, rate: float, firmness: float = 1.0) -> Penalty:
    """The penalty at `rate` frames a second, from bounds on acceleration: σ = a/f². firmness: times so much.

    Beyond a rate of 60 it gets no firmer: jitter comes from pictures, not from the rate.
    """
    return Penalty(target, firmness / bounds(chain, rate) ** 2)


def bounds(chain: Chain, rate: float) -> np.ndarray:
    """How much the hips' pace [m], their turning [rad] and the joints' [rad] change at most from frame to frame (6 + D,)."""
    interval = 1.0 / min(rate, 60.0) ** 2
    return interval * np.concatenate([np.full(3, ACCELERATION), np.full(3, TURNING), np.full(len(chain), JOINT_ACCELERATION)])


def carried(chain: Chain, penalty: Penalty, firmness: float) -> Penalty:
    """A penalty that draws arms to how people carry them, too: neither turned about themselves nor bent at the wrist.

    firmness: 1/σ² of that [1/rad²]. Silhouettes hardly show it, and noise turns an arm until its elbow bends backwards.
    """
    pulled = np.array([name.removeprefix("Left").removeprefix("Right") in STILL for name in chain.names])
    weights, angles = penalty.weights.copy(), penalty.target.angles.copy()
    own = weights[6:][pulled]
    angles[pulled] *= own / (own + firmness)
    weights[6:][pulled] = own + firmness
    return Penalty(Configuration(penalty.target.root, angles), weights)


def penalty_rows(chain: Chain, penalty: Penalty, where: Configuration, centre: np.ndarray) -> np.ndarray:
    """What eq. (26) wants of a step (6 + D,): (log(M̲ M⁻¹), Θ̲ − Θ), the root's about `centre` (3,) [m].

    About the world's origin a turn of the root would count as a shift, and the more the farther off it is.
    """
    out, motion = np.empty(6 + len(chain)), penalty.target.root @ inverse(where.root)
    motion[:3, 3] += motion[:3, :3] @ centre - centre
    twist_log_kernel(motion, out[:6])
    turn_log_kernel(chain.first, chain.count, where.angles, penalty.target.angles, out[6:])
    return out
