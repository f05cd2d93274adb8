"""How somebody stands whom a plan has brought down, and from where he leaps again."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...contract import CharacterState
from ..body import Physique, Start, soles
from ..motion import Plan

BEHIND = 0.055
"""The ground frame of who stands is so far behind the middle of his soles [m], at standard height."""


def rebounding(start: Start, made: Plan, time: float) -> Start:
    """The start of one who is `time` [s] into a plan and comes down: its landing is the crouch of the jump that follows."""
    n = int(np.clip(np.searchsorted(made.times, time), 1, len(made.times) - 1))
    gains = (made.velocities[n] - made.velocities[n - 1]) / (made.times[n] - made.times[n - 1])
    low = min(float(start.centre[1]), float(made.centres[n:, 1].min()))
    return replace(start, heading=made.path.heading + made.path.turn, velocity=made.moving(time)[1], acceleration=gains, ready=True, low=low,
                   single=made.path.lands, springs=made.path.hops)


def standing(physique: Physique, made: Plan) -> np.ndarray:
    """Where (2,) x, z [m] the ground frame is of one who stands on both feet as a plan lands."""
    heading = made.path.heading + made.path.turn
    return soles(made.feet, physique.tables).mean(0)[[0, 2]] - BEHIND * physique.size * np.array([np.sin(heading), np.cos(heading)])


def landed(physique: Physique, state: CharacterState, made: Plan) -> CharacterState:
    """The state of one who plays a plan that lands on both feet as it will stand there, at rest."""
    middle = made.centres[-1] if made.rolls else soles(made.feet, physique.tables).mean(0)
    pose = made.at(made.duration if np.isinf(made.through) else made.lowest)
    return replace(state, ground=np.array([middle[0], middle[2], made.path.heading + made.path.turn]), velocity=np.zeros(3), pose=pose, contacts=np.ones(4, bool),
                   memory=None, floor=float(made.feet[:, 1].mean() - physique.tables.sole), previous=None, elapsed=0.0)
