"""What is known of a character from one step to the next, and who is on duty."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, TypeVar

import numpy as np

from ..body import Pose
from .wishes import Strike

T = TypeVar("T")


def but(value: T, **changes: Any) -> T:
    """The same value with other fields, as `dataclasses.replace` gives it, in a tenth of its time: what every step of everybody asks for. Fields are
    not looked at again."""
    made = object.__new__(type(value))
    vars(made).update(vars(value), **changes)
    return made


@dataclass(frozen=True, eq=False)
class CharacterState:
    """All that is known of a character at one moment, whoever drives it.

    ground: (..., 3) x, z [m] of the mid-shoulder point dropped to the floor, and heading θ [rad].
    velocity: (..., 3) achieved (v_f, ω, v_l) in the ground frame [m/s, rad/s, m/s].
    pose: the pose of the last step. contacts: (..., 4) bool, which of left heel, left ball,
    right heel, right ball stand on the floor.
    memory: what the active controller keeps for itself, a value of its own that nobody else changes.
    floor: (...) how high the floor lies that the character stands on [m].
    previous, elapsed: the pose a step before and that step's length [s]: how the body moves, for
    whoever takes over. None where nobody knows.
    going: how far it is on the way to its goal, a `gambol.controllers.navigation.Going`; None where it has none.
    """

    ground: np.ndarray
    velocity: np.ndarray
    pose: Pose
    contacts: np.ndarray
    memory: Any = None
    floor: np.ndarray | float = 0.0
    previous: Pose | None = None
    elapsed: float = 0.0
    going: Any = None

    @property
    def active(self) -> str:
        """Which of several controllers is on duty, by name; "" where one alone moves it."""
        return self.memory.active if isinstance(self.memory, Duty) else ""

    @property
    def refused(self) -> str:
        """Why what was asked last can't be done, or goes wrong; "" if it can."""
        return self.memory.refused if isinstance(self.memory, Duty) else ""


@dataclass(frozen=True, eq=False)
class Duty:
    """The memory of a supervisor: who is on duty. active: a controller's name. memory: its own. why: why it was
    chosen, in words.

    refused: why what was asked last can't be done, or goes wrong; empty if it can. asked: what was refused and from where, so that it
    is not tried again until something changes. strike: what struck it in the air, where nobody answers that, until it stands again.
    """

    active: str
    memory: Any
    why: str
    refused: str = ""
    asked: Any = None
    strike: Strike | None = None


@dataclass(frozen=True)
class Status:
    """How a controller stands: running, done, or failed with a reason."""

    kind: Literal["running", "done", "failed"] = "running"
    reason: str = ""
