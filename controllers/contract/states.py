"""What is known of a character from one step to the next, and who is on duty."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, TypeVar

import numpy as np

from ..body import Pose, brief, yaw
from .wishes import HIGHEST, Strike

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

    __repr__ = brief

    ground: np.ndarray
    velocity: np.ndarray
    pose: Pose
    contacts: np.ndarray
    memory: Any = None
    floor: np.ndarray | float = 0.0
    previous: Pose | None = None
    elapsed: float = 0.0
    going: Any = None

    def __getitem__(self, some: Any) -> CharacterState:
        """Those of a batch that an index, a slice or a mask picks, as numpy does: `crowd[3]`, `crowd[late]`. ValueError for one alone."""
        batch = _batch(self)

        def of(value: Any) -> Any:
            return np.array(value[some] if np.ndim(value) else np.broadcast_to(value, batch)[some])

        def pose(one: Pose | None) -> Pose | None:
            return None if one is None else Pose(of(one.root), of(one.rotations))
        return but(self, ground=of(self.ground), velocity=of(self.velocity), pose=pose(self.pose), contacts=of(self.contacts),
                   memory=None if self.memory is None else of(self.memory), floor=of(self.floor), previous=pose(self.previous))

    def put(self, some: Any, others: CharacterState) -> CharacterState:
        """The same batch with others in place of those that an index, a slice or a mask picks: `crowd.put(done, walker.start(places))`.
        ValueError for one alone, for others of another kind of controller, and where their number does not fit."""
        batch = _batch(self)
        if type(others.memory) is not type(self.memory) or getattr(others.memory, "dtype", None) != getattr(self.memory, "dtype", None):
            raise ValueError("those put into a batch must come of the controller that steps it")

        def of(value: Any, other: Any) -> np.ndarray:
            value = np.array(np.broadcast_to(value, batch)) if not np.ndim(value) else np.array(value)
            try:
                value[some] = other
            except ValueError:
                raise ValueError(f"{np.shape(others.ground)[:-1]} do not fit where {np.shape(self.ground[some])[:-1]} of the batch are picked") from None
            return value

        def pose(one: Pose, other: Pose) -> Pose:
            return Pose(of(one.root, other.root), of(one.rotations, other.rotations))
        return but(self, ground=of(self.ground, others.ground), velocity=of(self.velocity, others.velocity), pose=pose(self.pose, others.pose),
                   contacts=of(self.contacts, others.contacts), memory=None if self.memory is None else of(self.memory, others.memory),
                   floor=of(self.floor, others.floor), previous=None if self.previous is None else pose(self.previous, others.previous or others.pose))

    def at(self, ground: Any, floor: Any = None) -> CharacterState:
        """The same elsewhere: at ground (..., 3) x, z [m], heading [rad], on a floor (...) so high [m], by default as high as it is; with its pose and how
        that moves. ValueError unless that is finite, as many as they are. Of who jumps, falls or stumbles the next step refuses it."""
        here, there = np.asarray(self.ground, float), np.asarray(ground, float)
        up = 0.0 if floor is None else np.asarray(floor, float) - self.floor
        if there.shape != here.shape or not (np.abs(there[..., :2]) <= HIGHEST).all() or not np.isfinite(there).all() or not np.isfinite(up).all():
            raise ValueError(f"elsewhere is a finite {here.shape} x, z, heading, and a finite floor; got {ground!r} and {floor!r}")
        turn = yaw(there[..., 2] - here[..., 2])

        def carried(one: Pose) -> Pose:
            root, rotations = np.asarray(one.root, float) - np.stack([here[..., 0], np.zeros(here.shape[:-1]), here[..., 1]], -1), np.array(one.rotations)
            root = np.einsum("...ij,...j->...i", turn, root) + np.stack([there[..., 0], np.broadcast_to(up, here.shape[:-1]), there[..., 1]], -1)
            rotations[..., 0, :, :] = turn @ rotations[..., 0, :, :]
            return Pose(root.astype(np.asarray(one.root).dtype), rotations)
        return but(self, ground=there.copy(), pose=carried(self.pose), previous=None if self.previous is None else carried(self.previous),
                   floor=self.floor if floor is None else floor)

    @property
    def active(self) -> str:
        """Which of several controllers is on duty, by name; "" where one alone moves it."""
        return self.memory.active if isinstance(self.memory, Duty) else ""

    @property
    def refused(self) -> str:
        """Why what was asked last can't be done, or goes wrong; "" if it can."""
        return self.memory.refused if isinstance(self.memory, Duty) else ""

    @property
    def seeks(self) -> bool:
        """Whether it is still found out how what was asked last can be done."""
        if not isinstance(self.memory, Duty):
            return False
        return any(getattr(asked, "onward", None) is not None for asked in (self.memory.asked, self.memory.memory))


def _batch(state: CharacterState) -> tuple[int, ...]:
    """The batch axes of a state. ValueError where it has none."""
    batch = np.shape(state.ground)[:-1]
    if not batch:
        raise ValueError("this is the state of one character, not of a batch: there is nothing to pick from")
    return batch


@dataclass(frozen=True, eq=False)
class Duty:
    """The memory of a supervisor: who is on duty. active: a controller's name. memory: its own. why: why it was
    chosen, in words.

    refused: why what was asked last can't be done, or goes wrong; empty if it can. asked: what was refused and from where, so that it
    is not tried again until something changes. strike: what struck it in the air, where nobody answers that, until it stands again. arms: how
    far they are drawn in, a `gambol.controllers.navigation.passing.Arms`; None where they are free.
    """

    __repr__ = brief

    active: str
    memory: Any
    why: str
    refused: str = ""
    asked: Any = None
    strike: Strike | None = None
    arms: Any = None


@dataclass(frozen=True, eq=False)
class OfSize:
    """The memory of a body in another size than its controller is made for. memory: that one's. factor: the legs' length
    over that of the skeleton it is made for."""

    __repr__ = brief

    memory: Any
    factor: float


@dataclass(frozen=True)
class Status:
    """How a controller stands: running, done, or failed with a reason."""

    kind: Literal["running", "done", "failed"] = "running"
    reason: str = ""
