"""How a body's centre of mass is borne: its acceleration, calmed, and whose body it is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from gambol.controllers.body import Pose, centre_in_pose, settle
from gambol.controllers.jump import Jump, Physique

HALFLIFE = 0.06
"""Of what follows the centre of mass [s]: corrections of feet are shorter, steps are longer."""

ADULT = Physique()
"""Whose body moves where nothing is said of it."""


@dataclass(frozen=True, eq=False)
class CentreOfMass:
    """A critically damped follower of a centre of mass: place, velocity, acceleration, (3,) each [m, s].

    Its acceleration is the centre's without what trembles.
    """

    place: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray

    @staticmethod
    def begun(centre: np.ndarray, velocity: np.ndarray) -> CentreOfMass:
        """At a centre (3,) [m] that moves with a velocity (3,) [m/s]."""
        return CentreOfMass(centre, velocity, np.zeros(3))

    def step(self, centre: np.ndarray, dt: float) -> CentreOfMass:
        """`dt` seconds later, the centre at a new place (3,) [m]."""
        offset, velocity = settle(self.place - centre, self.velocity, HALFLIFE, dt)
        return CentreOfMass(centre + offset, velocity, (velocity - self.velocity) / dt)


def jump_of(controller: Any) -> Jump | None:
    """The jumps of a controller; None for one that can't jump."""
    jump = controller.parts.get("jump")
    return jump if isinstance(jump, Jump) else None


def physique_of(controller: Any) -> Physique:
    """Whose body a controller moves; an adult's where it says nothing."""
    jump = jump_of(controller)
    return ADULT if jump is None else jump.physique


def centre_of(controller: Any, pose: Pose) -> np.ndarray:
    """The centre of mass (3,) [m] of a controller's body in a pose."""
    return centre_in_pose(physique_of(controller).anatomy, controller.skeleton, pose)
