"""The pilot: wishes seen from the camera become commands in the world, and commands intents."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from gambol.controllers.contract import CharacterState, Intent, but
from gambol.controllers.navigation import Steering, steer

from .wish import Wish, in_view

STEERING = Steering()


@dataclass(frozen=True)
class Pace:
    """How fast the hands ask for: speeds [m/s], turning [rad/s]."""

    slow: float = 0.7
    walk: float = 1.3
    run: float = 3.0
    turn: float = 1.5


@dataclass(frozen=True)
class Command:
    """What the player asks of the character, in the world.

    velocity: x, z [m/s]. facing: the heading to hold [rad], or None to look where it goes.
    turn: turning on the spot [rad/s]. swing: turning the camera, and so the walk, left [rad/s].
    """

    velocity: tuple[float, float] = (0.0, 0.0)
    facing: float | None = None
    turn: float = 0.0
    swing: float = 0.0

    def intent(self, state: CharacterState, settings: Steering = STEERING) -> Intent:
        """The same as an intent of the character in `state`."""
        wanted = steer(state.ground, np.array(self.velocity), self.facing, state.velocity[1], settings)
        return but(wanted, velocity=wanted.velocity + np.array([0.0, self.turn, 0.0]), towards=None if self.turn else wanted.towards)


@dataclass(frozen=True)
class Pilot:
    """What the controls remember. locked: strafing is switched on. facing: the heading held, if any."""

    locked: bool = False
    facing: float | None = None
    pace: Pace = Pace()

    def toggled(self) -> Pilot:
        """Strafing switched on or off."""
        return replace(self, locked=not self.locked)

    def command(self, wish: Wish, camera_yaw: float, heading: float, dt: float) -> tuple[Pilot, Command]:
        """The pilot and the command after `dt` seconds of a wish.

        camera_yaw: where the camera looks, heading: where the character looks [rad].
        """
        pace = self.pace
        throw = math.hypot(*wish.move)
        speed = pace.slow if wish.slow else pace.walk + (pace.run - pace.walk) * wish.run
        x, z = in_view(wish.move, camera_yaw)

        facing = self.facing if self.locked or wish.strafe else None
        if math.hypot(*wish.look) > 0.0:
            facing = math.atan2(*in_view(wish.look, camera_yaw))
        elif (self.locked or wish.strafe) and facing is None:
            facing = heading
        if facing is not None and wish.turn:
            facing += pace.turn * wish.turn * dt

        on_spot = pace.turn * wish.turn if facing is None and throw == 0.0 else 0.0
        # a walker goes where the camera looks, so turning the walk means turning the camera
        swing = pace.turn * wish.turn if facing is None and throw > 0.0 else 0.0
        return replace(self, facing=facing), Command((speed * x, speed * z), facing, on_spot, swing)
