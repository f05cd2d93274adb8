"""The locomotion controller: ``state', pose = locomotion.step(state, intent, dt)``."""

from __future__ import annotations

import zlib
from copy import copy
from dataclasses import replace
from functools import cache, cached_property
from math import ceil
from os import PathLike

import numpy as np
from numpy.typing import ArrayLike

from gambol import assets

from ..body import Pose, Skeleton
from ..contract import HIGHEST, CharacterState, Controller, Intent, Status, given, grounded, level, seconds
from ..navigation.passing import walls_of
from .control_space import ControlSpace
from .entry import entered
from .first_stride import readiness
from .held_up import held_up, led_out
from .idle import ENDS
from .kernel import DURATION_AT
from .library import Library
from .memory import ABOUT, ASKS, Settings, memory_dtype, plain, put
from .pushed import pushed
from .step import step_kernel
from .tables import Tables, tables_of
from .tops import FLAT, tops
from .velocity_correction import space_of

DEFAULT_LIBRARY = assets.path("library", "default.npz")
FINEST = 1 / 60
"""A longer step is made in parts no longer than this [s], as feet come down and gaits change at its moments."""
ROUNDING = 1e-9
"""Who stands no farther from where he was left than this [m, rad] was not put elsewhere: a body of another size rounds."""
ELSEWHERE = 0.1
"""A place to come to rest at that moves by more than this [m] is another, for which nobody stops yet."""


@cache
def _shipped() -> Locomotion:
    return Locomotion(Library.load(DEFAULT_LIBRARY))


class Locomotion(Controller):
    """Walks, turns, strafes, runs and stops by blending a library's primitives.

    Holds only what it was built from; every character's state is passed in and out, with any
    number of leading batch axes, so one call steps a crowd.
    """

    def __init__(self, library: Library, settings: Settings = Settings()):
        self.library = library
        self.settings = plain(settings)
        self.walk = space_of(library, "walk")
        self.run = space_of(library, "run")
        if self.run is None:  # no runs recorded: walking serves at any speed
            self.settings = self.settings._replace(run_above=np.inf)
        self._dtype = memory_dtype(len(library.primitives))

    @cached_property
    def tables(self) -> Tables:
        """What its kernels read, told once somebody walks: telling it runs kernels, which a first picture does not wait for."""
        return tables_of(self.library, self.walk, self.run)

    @cached_property
    def _library(self) -> int:
        """What tells its memories from those over other libraries."""
        return zlib.crc32(self.tables.series.tobytes())

    @staticmethod
    def load(path: str | PathLike[str] | None = None, settings: Settings = Settings()) -> Locomotion:
        """The controller over a library file; the shipped one by default, which is read once for all. LibraryError if unusable."""
        return Locomotion(Library.load(path), settings) if path else _shipped().tuned(settings)

    def tuned(self, settings: Settings) -> Locomotion:
        """The same controller under other settings; all that was built from the library is shared."""
        other = copy(self)
        other.settings = plain(settings if self.run else settings._replace(run_above=np.inf))
        return other

    def space(self, family: str) -> ControlSpace | None:
        """The control space of "walk" or "run"; None where the library has no such gaits."""
        return {"walk": self.walk, "run": self.run}[family]

    @property
    def skeleton(self) -> Skeleton:
        """The standard human that the poses are of."""
        return self.library.skeleton

    def limits(self, share: float = 1.0) -> np.ndarray | None:
        """The half-spaces (H, 4) of the velocities that it walks with, none of a library without walks."""
        return None if self.walk is None else self.walk.half_spaces(share)

    def readiness(self, state: CharacterState) -> np.ndarray:
        """How fast (...) wishes are taken up, as a share of how fast a walker does: less while weight goes over for a first stride."""
        return readiness(state.memory)

    def start(self, ground: ArrayLike = (0.0, 0.0, 0.0), floor: np.ndarray | float = 0.0) -> CharacterState:
        """A character at rest at ground (..., 3) x, z [m], heading [rad], on a floor (...) [m] high.
        ValueError unless finite."""
        level(floor)
        ground = grounded(ground)
        memory = np.zeros(ground.shape[:-1], self._dtype)
        memory["ground"] = ground
        memory["weights"][..., self.library.rest] = memory["led"][..., self.library.rest] = 1.0
        memory["settled"] = 1
        memory["phase"] = 0.25
        memory["row"][..., DURATION_AT] = memory["stretch"] = memory["pace"] = memory["quick"] = 1.0
        memory["library"] = self._library
        memory["luck"] = _luck(ground)
        if len(self.tables.idle.must) > ENDS:
            memory["moment"] = memory["luck"] % np.flatnonzero(~self.tables.idle.must)[-1]
        state = CharacterState(ground, np.zeros(ground.shape), Pose(np.zeros(ground.shape), np.zeros(3)),
                               np.zeros(ground.shape[:-1] + (4,), bool), memory, floor)
        state, _ = self.step(state, Intent(np.zeros(3)), 1 / 60)  # finds the pose
        memory = state.memory.copy()
        memory["grip"], memory["bears"], memory["taut"], memory["offset"], memory["offset_rate"] = 1.0, 1.0, 1.0, 0.0, 0.0
        memory["raised"] = self.tables.legs.height - memory["points"][..., 1]
        for name in ("raised_rate", "bears_rate", "lent", "lent_rate", "rise", "rise_rate"):
            memory[name] = 0.0
        state, _ = self.step(replace(state, memory=memory), Intent(np.zeros(3)), 1 / 60)  # and how feet stand in it
        memory = state.memory.copy()
        for name, value in (("breath", 0.0), ("row_rate", 0.0)):
            memory[name] = value
        return replace(state, ground=memory["ground"], velocity=np.zeros(ground.shape), memory=memory)

    def step(self, state: CharacterState, intent: Intent, dt: float) -> tuple[CharacterState, Pose]:
        """One step of dt seconds (0 < dt ≤ 0.1; ValueError otherwise).

        A state whose `ground` was replaced goes on from there, feet and all: ValueError unless it is
        finite, and for a state that did not come from a controller over this library (`enter` it).
        intent.velocity and intent.halt broadcast against the state's batch axes. A wish that is not finite counts
        as no wish. One beyond what the library holds is walked slower on the same arc (so a hard
        turn just below `Settings.run_above` is walked, not run); a runner keeps the speed and
        turns or side-steps less. Nobody's middle comes nearer to a wall of intent.around than `NEAR`, in the library's size.
        """
        given(state, intent)
        dt = seconds(dt)
        level(state.floor)
        memory = self._memory(state).reshape(-1)
        shape = state.memory.shape
        wish = _spread(intent.velocity, (*shape, 3)).reshape(-1, 3)
        if not np.isfinite(wish).all():
            wish[~np.isfinite(wish).all(-1)] = 0.0
        np.minimum(np.maximum(wish, -20.0, out=wish), 20.0, out=wish)
        leaps = 0 if intent.halt is not None else ASKS if intent.leap is not None else ABOUT if intent.aim is not None else 0  # who is to halt before it leaps onto nothing
        memory["alert"] = leaps
        memory["looks"] = 0
        _towards(memory, intent.towards, shape)
        if intent.look is not None:
            self._look(memory, intent.look, shape, state.floor)
        _halt(memory, intent.halt, wish, shape)
        ground = tops(intent.around) if len(intent.around) else FLAT
        walls = walls_of(intent.around)
        joints = len(self.skeleton)
        root = np.empty((len(memory), 3), np.float32)
        local = np.empty((len(memory), joints, 3, 3), np.float32)
        here = _spread(state.floor, shape).reshape(-1)
        parts = max(1, ceil(dt / FINEST - 1e-6))  # what is left of a frame may be as short as rounding
        for _ in range(parts):
            floor, before = here.copy(), memory["ground"][:, :2].copy()
            held_up(memory, wish, floor, walls, dt / parts)
            step_kernel(memory, wish, dt / parts, self.settings, *self.tables, ground, here, root, local)
            led_out(memory, before, floor, walls, root)
        root[:, 1] += floor
        pose = Pose(root.reshape(shape + (3,)), local.reshape(shape + (joints, 3, 3)))
        memory = memory.reshape(shape)
        return CharacterState(memory["ground"], memory["velocity"], pose, (memory["standing"] == 1) & (memory["off"] == 0), memory,
                              here.reshape(shape) if len(ground) else state.floor), pose

    @staticmethod
    def _look(memory: np.ndarray, look: ArrayLike, shape: tuple[int, ...], floor: np.ndarray | float) -> None:
        """Note the places (..., 3) that characters (N,) are told to look at, over their own floors; none that is not finite."""
        place = _spread(look, shape + (3,))
        place[..., 1] -= floor
        place = place.reshape(-1, 3)
        sound = np.asarray(np.isfinite(place).all(-1))
        memory["looks"] = sound
        memory["look"] = np.where(sound[:, None], np.clip(place, -1e6, 1e6), 0.0)

    def _knows(self, memory) -> bool:
        return (isinstance(memory, np.ndarray) and memory.dtype == self._dtype
                and bool((memory["library"].reshape(-1) == self._library).all()))

    def _memory(self, state: CharacterState) -> np.ndarray:
        """A copy of the state's memory, its feet carried along if the state's ground was replaced."""
        if not self._knows(state.memory):
            raise ValueError("this state's memory is not of a controller over this library: enter it first")
        memory, ground = _copied(state.memory), np.asarray(state.ground, float)
        if ground.shape != memory["ground"].shape or not (np.abs(ground - memory["ground"]) <= ROUNDING).all():
            if ground.shape != memory["ground"].shape or not np.isfinite(ground).all():
                raise ValueError(f"ground must be finite {memory['ground'].shape} x, z, heading; got {ground!r}")
            put(memory, ground)
        return memory

    def precondition(self, state: CharacterState, intent: Intent) -> float:
        """Walking can start from any pose: always possible, never urgent."""
        return 0.5

    def enter(self, state: CharacterState, intent: Intent) -> CharacterState:
        """The state as seen by this controller: as it is if it walked before, over this very library; else
        standing or walking on from its pose, its motion and its feet. A whole batch begins anew."""
        if self._knows(state.memory):
            return state
        return entered(self, state, float(np.asarray(intent.velocity, float)[..., 0].max())) if np.ndim(state.ground) == 1 else self.start(state.ground, state.floor)

    def pushed(self, state: CharacterState, change: np.ndarray) -> CharacterState | None:
        """One who walks or runs, pushed no harder than its next steps take in; else None."""
        return pushed(state, change) if self._knows(state.memory) else None

    def status(self, state: CharacterState) -> Status:
        """Locomotion never ends by itself."""
        return Status("running")


def _towards(memory: np.ndarray, towards: ArrayLike | None, shape: tuple[int, ...]) -> None:
    """Note which heading and speed (..., 2) characters (N,) are to have in the end; none that is not finite."""
    memory["heads"] = 0
    if towards is not None:
        told = _spread(towards, shape + (2,)).reshape(-1, 2)
        memory["heads"] = np.isfinite(told).all(-1)
        memory["towards"] = np.where(memory["heads"][:, None], told, 0.0)


def _halt(memory: np.ndarray, halt: ArrayLike | None, wish: np.ndarray, shape: tuple[int, ...]) -> None:
    """Note where (..., 3) characters (N,) are to come to rest; none that is not finite. Who stops for a place goes on with that until
    he wishes (N, 3) for something else."""
    if halt is None:
        memory["halts"] *= ~wish.any(-1)
        return
    place = _spread(halt, shape + (3,)).reshape(-1, 3)
    sound = (np.abs(place[:, :2]) <= HIGHEST).all(-1)
    goes, stops = np.asarray(sound & wish.any(-1)), (memory["halts"] > 0) & ~wish.any(-1)
    same = goes & (memory["halts"] > 0) & (np.hypot(*(place - memory["halt"])[:, :2].T) < ELSEWHERE)
    memory["halts"] = np.where(same | stops, memory["halts"], goes)
    memory["halt"] = np.where(goes[:, None], place, memory["halt"])


def _spread(value: ArrayLike, shape: tuple[int, ...]) -> np.ndarray:
    """An array of its own of a shape that values broadcast to, as numpy's own makes it in five times the time."""
    out = np.empty(shape)
    try:
        out[...] = value
    except ValueError:
        raise ValueError(f"a wish of shape {np.shape(value)} for bodies that take {shape}, or what broadcasts to it") from None
    return out


def _copied(memory: np.ndarray) -> np.ndarray:
    """A copy of records (...), byte by byte: numpy's own goes from field to field, ten times as long."""
    return np.ndarray(memory.shape, memory.dtype, bytearray(memory.tobytes()))


def _luck(ground: np.ndarray) -> np.ndarray:
    """A number (...) of its own for every place (..., 3), never 0: who begins elsewhere idles otherwise."""
    mixed = np.ascontiguousarray(ground).view(np.uint64)
    with np.errstate(over="ignore"):
        mixed = (mixed ^ (mixed >> np.uint64(29))) * np.uint64(0x9E3779B97F4A7C15)
        mixed = (mixed[..., 0] * np.uint64(3) + mixed[..., 1] * np.uint64(5) + mixed[..., 2] * np.uint64(7)) >> np.uint64(32)
    return (mixed | np.uint64(1)).astype(np.uint32)
