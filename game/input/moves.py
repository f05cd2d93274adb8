"""What a script is made of: moves, and the jumps that they may end with."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from gambol.controllers.contract import Goal


@dataclass(frozen=True)
class Jump:
    """A jump to `place`, x, y, z [m]; None: straight up. airtime: [s], None for the least effort.

    within: a runner jumps no farther from it than this [m]; None: as its speed suggests. slow: how much longer flights
    take than on Earth, √(9.81 / g). aims: so long [s] a standing body crouches first, aiming. heading: [rad] in which it lands; None: as it went off.
    hop: instead of a place, so far ahead [m] of where its feet stand, on what is highest there of `around`, as far up as somebody hops. on: the feet
    on which it lands to hop on, see `Leap`.
    """

    place: tuple[float, float, float] | None = None
    airtime: float | None = None
    within: float | None = None
    slow: float = 1.0
    aims: float = 0.0
    heading: float | None = None
    hop: float | None = None
    around: tuple[Any, ...] = ()
    on: Literal["left", "right", "both"] | None = None


@dataclass(frozen=True)
class Move:
    """One thing to do.

    seconds: how long; infinite for a path that takes as long as it takes.
    velocity, until: v_f [m/s], ω [rad/s], v_l [m/s] at the beginning and the end, linear between.
    points: x, z [m] to walk along from wherever the character is, instead of `velocity`.
    speed: [m/s] along them. facing: a heading to hold [rad], or None. jump: what it ends with;
    until it can begin, the rest of the move goes on. goal: where to go instead, as it is planned.
    """

    seconds: float
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    until: tuple[float, float, float] | None = None
    points: tuple[tuple[float, float], ...] = ()
    speed: float = 1.2
    facing: float | None = None
    jump: Jump | None = None
    goal: Goal | None = None

    @property
    def runs(self) -> bool:
        """Whether it goes somewhere by foot."""
        return bool(self.points) or any(self.velocity)
