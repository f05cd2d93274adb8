"""Whether a jump can start at this moment: feet stand that can push, and legs would not go through each other in a crouch."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...body import contact_points, forward_kinematics, wrap, yaw
from ...contract import CharacterState
from ..body import FLAT, Physique
from .floors import UP, on_ground
from .from_state import RUNNING, start_of

FRESH = -0.06
"""A foot has just struck while the body is no further than this past it [m]: still behind it."""
STEEP = 0.9
"""Downhill that is seen from as high over it as mass centres are [m], at standard height: a foot strikes farther behind there, square to the ground."""
HIGH, SINKS = 0.012, 0.2
"""But not while it is higher over the floor than the first [m] and comes down faster than the second [m/s], at standard height: nobody pushes off a foot that is still in
the air, whatever its contacts say."""
KNEES, APART = 0.31, 0.06
"""Knees of a crouch are so far ahead of their ankles, as the feet point. Ankles and knees that are nearer than the second to each other, across the way that
the body faces, are too near [m], at standard height."""
TURNED = np.radians(40.0)
"""A foot that is turned farther from there [rad] is not crouched over."""
STANDS = 0.01
"""Who is slower than this [m/s, rad/s], and stands on both feet, has set them."""


def ready(physique: Physique, state: CharacterState, around: Sequence[Any] = ()) -> bool:
    """Whether a jump can start at this moment: standing feet, or a foot that has just struck, among boxes and pillars around."""
    start = start_of(physique, state)
    speed = float(np.hypot(start.velocity[0], start.velocity[2]))
    if start.single is None:
        low = start.feet[:, 1] - float(state.floor) < physique.tables.sole + UP * physique.size
        return speed < RUNNING and bool(low.any())
    towards = start.velocity * FLAT / max(speed, 1e-9)
    falls = -float(on_ground(start, state, around).slope @ towards[[0, 2]]) if len(around) else 0.0
    past = float((start.centre - start.feet[start.single, :3]) @ towards) - STEEP * physique.size * max(falls, 0.0)
    return past < FRESH and not _comes_down(physique, state)[start.single]


def sets_feet(physique: Physique, state: CharacterState) -> bool:
    """Whether somebody on the move still has to set his feet: as they come to stand now, his legs would go through each other in a crouch. Where he moves, his
    gait sets them within a step or two; a runner pushes off one foot, and does not crouch."""
    if np.all(state.contacts) and np.abs(state.velocity).max() < STANDS:
        return False
    body, start = physique.tables, start_of(physique, state)
    if start.single is not None:
        return False
    feet = start.planted(float(state.floor), body)
    turned = wrap(feet[:, 3] - start.heading)
    ankles = feet[:, :3] @ yaw(start.heading)[:, 0] - body.toe[2] * np.sin(turned)  # to the left
    knees = ankles + KNEES * body.size * np.sin(turned)
    return bool(np.abs(turned).max() > TURNED or min(ankles[0] - ankles[1], knees[0] - knees[1]) < APART * body.size)


def _comes_down(physique: Physique, state: CharacterState) -> np.ndarray:
    """Whether each foot (2,), heel and toes, is still in the air and comes down."""
    if state.previous is None or not state.elapsed > 0.0:
        return np.zeros(2, bool)
    before, now = (contact_points(physique.skeleton, *forward_kinematics(physique.skeleton, np.asarray(pose.root, float), np.asarray(pose.rotations, float)))[:, 1]
                   .reshape(2, 2).min(1) for pose in (state.previous, state.pose))
    return (now - float(state.floor) > physique.tables.sole + HIGH * physique.size) & (before - now > SINKS * math.sqrt(physique.size) * state.elapsed)
