"""Scripts: a list of moves, one after the other, that gives an intent for every step."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from controllers.contract import CharacterState, Intent
from controllers.navigation import Path, Steering, follow, steer

STEERING = Steering()
ARRIVED = 0.12
"""A path is walked when no more than this is left of it [m]."""


@dataclass(frozen=True)
class Move:
    """One thing to do.

    seconds: how long; infinite for a path that takes as long as it takes.
    velocity, until: v_f [m/s], ω [rad/s], v_l [m/s] at the beginning and the end, linear between.
    points: x, z [m] to walk along from wherever the character is, instead of `velocity`.
    speed: [m/s] along them. facing: a heading to hold [rad], or None.
    """

    seconds: float
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    until: tuple[float, float, float] | None = None
    points: tuple[tuple[float, float], ...] = ()
    speed: float = 1.2
    facing: float | None = None


@dataclass(frozen=True, eq=False)
class Script:
    """Where somebody is in a list of moves. steps: made of the current move. path, progress: along it."""

    moves: tuple[Move, ...]
    index: int = 0
    steps: int = 0
    path: Path | None = None
    progress: float = 0.0

    @property
    def done(self) -> bool:
        """Whether every move is over."""
        return self.index >= len(self.moves)

    def step(self, state: CharacterState, dt: float) -> tuple[Script, Intent]:
        """The script `dt` seconds later, and what it asks of a character in `state` meanwhile."""
        script = self
        while not script.done and script._over(state, dt):
            script = replace(script, index=script.index + 1, steps=0, path=None, progress=0.0)
        if script.done:
            return script, Intent()
        move = script.moves[script.index]
        if move.points and script.steps == 0:
            script = replace(script, path=_from_here(state.ground, move.points))
        script, intent = script._ask(move, state, dt)
        return replace(script, steps=script.steps + 1), intent

    def _over(self, state: CharacterState, dt: float) -> bool:
        move = self.moves[self.index]
        if math.isinf(move.seconds):
            return self.steps > 0 and (self.path is None or self.progress >= self.path.length - ARRIVED)
        return self.steps * dt >= move.seconds - 0.5 * dt

    def _ask(self, move: Move, state: CharacterState, dt: float) -> tuple[Script, Intent]:
        if not move.points:
            if move.facing is not None:
                return self, steer(state.ground, np.zeros(2), move.facing, state.velocity[1], STEERING)
            velocity = np.array(move.velocity)
            if move.until is not None:
                velocity = velocity + (np.array(move.until) - velocity) * min(self.steps * dt / move.seconds, 1.0)
            return self, Intent(velocity)
        wish, progress = np.zeros(2), self.progress
        if self.path is not None:
            wish, progress = follow(self.path, state.ground, np.float64(progress), move.speed)
        intent = steer(state.ground, wish, move.facing, state.velocity[1], STEERING)
        return replace(self, progress=float(progress)), intent


def _from_here(ground: np.ndarray, points) -> Path | None:
    """The path from where a character stands through points; None if it stands on the only one."""
    way = [tuple(ground[:2])]
    for point in points:
        if math.dist(point, way[-1]) > 1e-3:
            way.append(point)
    return Path(np.array(way)) if len(way) > 1 else None
