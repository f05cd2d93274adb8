"""The motion library: gait primitives as Fourier coefficients, with where each one came from."""

from __future__ import annotations

import json
import tokenize
import zipfile
import zlib
from dataclasses import asdict, dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..body import Skeleton, brief, human, rotations as rot
from ..files import ordinary, reason, whole
from .cycles import Cycle

# what the columns of a coefficient array are, for J joints
HIPS, LABELS, DURATION = -8, -5, -1
"""Columns counted from the end: hips x, y, z; four contact labels; duration dt/dφ [s]."""


class LibraryError(ValueError):
    """A library file that can't be used, with the reason."""


@dataclass(frozen=True)
class Primitive:
    """Where one primitive of the library comes from and how good it is.

    label: its place in the protocol. clip, start [s], period [s]: the recorded cycle. family:
    "walk", "run" or "rest". closure [rad]: RMS joint angle between its two ends. events: fractions
    of the period. mirrored: left and right exchanged. averaged: cycles averaged into it.
    """

    label: str
    clip: str
    start: float
    period: float
    family: str
    closure: float
    events: tuple[float, ...]
    mirrored: bool = False
    averaged: int = 1


class Idle(NamedTuple):
    """Somebody standing about. coefficients: (K, 3 J + 3) of uniform cubic B-splines of joints and hips, less the
    rest primitive's, all stretches one after another. ends: (S,) where each stretch ends among them."""

    coefficients: np.ndarray
    ends: np.ndarray


class Turn(NamedTuple):
    """How somebody turns from rest in two steps. coefficients: (2, 2, 3, K, 3 J + 11): into a walk and on the spot; the left or the right foot
    first, to its side; over 1, how far, and its square; uniform cubic B-splines of joints, hips, labels, duration, and of how the
    ground frame goes: v_f [m/s], turned [rad], v_l [m/s]."""

    coefficients: np.ndarray


class Start(NamedTuple):
    """What the first strides from rest have beyond the blend. coefficients: (2, 2, K, 3 J + 3) with the left or the right
    foot first, of a start straight on and for each rad/s that it turns to that side: uniform cubic B-splines."""

    coefficients: np.ndarray


@dataclass(frozen=True, eq=False)
class Library:
    """P primitives on a skeleton of J joints.

    velocities: (P, 3) (v_f, ω, v_l). coefficients: (P, 2N + 1, D) with D = 3 J + 8 columns: the
    rotation vectors of all joints relative to `reference` (the root's in the ground frame), the
    hips in the ground frame [m], the labels of left heel, left ball, right heel, right ball, and
    the duration dt/dφ [s]. reference: (J, 3, 3) mean local rotations over the library.
    bends: by family, (E, 5) what its control space knows of blends along its edges.
    accelerations: by family, (J,) [m/s²] the 99th percentile in the recordings, where known.
    """

    __repr__ = brief

    skeleton: Skeleton
    primitives: tuple[Primitive, ...]
    velocities: np.ndarray
    coefficients: np.ndarray
    reference: np.ndarray
    provenance: str = ""
    bends: dict[str, np.ndarray] = field(default_factory=dict)
    accelerations: dict[str, np.ndarray] = field(default_factory=dict)
    idle: Idle | None = None
    start: Start | None = None
    turn: Turn | None = None

    def family(self, name: str) -> np.ndarray:
        """The numbers of the primitives of one family; "walk" has rest among them."""
        wanted = {"walk", "rest"} if name == "walk" else {name}
        return np.array([i for i, p in enumerate(self.primitives) if p.family in wanted], np.int64)

    @property
    def rest(self) -> int:
        """The number of the rest primitive."""
        return next(i for i, p in enumerate(self.primitives) if p.family == "rest")

    def save(self, path: str | Path) -> None:
        """Write a compressed .npz under exactly that name; reading it back gives the same library.

        It appears whole or not at all: what stood there before stays until the new one is complete.
        """
        about = {"format": 1, "height": float(self.skeleton.offsets[0, 1]),
                 "primitives": [asdict(p) for p in self.primitives], "provenance": self.provenance}
        with whole(path) as part, open(part, "wb") as file:
            self._write(file, about)

    def _write(self, file, about: dict) -> None:
        families: dict[str, Any] = {f"bend_{family}": bend for family, bend in self.bends.items()}
        families |= {f"acceleration_{family}": a for family, a in self.accelerations.items()}
        if self.idle is not None:
            families |= {"idle": self.idle.coefficients.astype(np.float16), "idle_ends": self.idle.ends}
        if self.start is not None:
            families |= {"start": self.start.coefficients.astype(np.float16)}
        if self.turn is not None:
            families |= {"turn": self.turn.coefficients.astype(np.float16)}
        np.savez_compressed(file, velocities=self.velocities, reference=self.reference,
                            coefficients=self.coefficients.astype(np.float32), **families,
                            about=np.frombuffer(json.dumps(about).encode(), np.uint8))

    @staticmethod
    def load(path: str | PathLike[str]) -> Library:
        """Read a library. LibraryError names the file if it is missing or not one."""
        try:
            with np.load(ordinary(path), allow_pickle=False) as file:
                about = json.loads(bytes(file["about"]).decode())
                standard = human()
                skeleton = human() if abs(about["height"] - standard.offsets[0, 1]) < 1e-9 else \
                    standard.scaled(about["height"] / standard.offsets[0, 1])
                primitives = tuple(Primitive(**{**p, "events": tuple(p["events"])}) for p in about["primitives"])
                library = Library(skeleton, primitives, file["velocities"],
                                  file["coefficients"].astype(float), file["reference"], about["provenance"],
                                  _named(file, "bend_"), _named(file, "acceleration_"),
                                  Idle(file["idle"].astype(np.float32), file["idle_ends"]) if "idle" in file.files else None,
                                  Start(file["start"].astype(np.float32)) if "start" in file.files else None,
                                  Turn(file["turn"].astype(np.float32)) if "turn" in file.files else None)
        except FileNotFoundError:
            raise LibraryError(f"{path}: no such library; build one with `gambol library build DIR -o {path}`") from None
        except (OSError, ValueError, LookupError, TypeError, AttributeError, ArithmeticError, EOFError, MemoryError,
                RuntimeError, tokenize.TokenError, zipfile.BadZipFile, zlib.error) as error:  # all a damaged zip has in store
            # numpy takes a file of any other kind for its own and speaks of that
            why = reason(error) if isinstance(error, OSError) or zipfile.is_zipfile(path) else "no .npz file at all"
            raise LibraryError(f"{path}: not a gait library ({why})") from None
        library._check(path)
        return library

    def _check(self, path: str | PathLike[str]) -> None:
        """LibraryError, naming the file, unless the arrays fit each other."""
        count, joints = len(self.primitives), len(self.skeleton)
        rows = self.coefficients.shape[1] if self.coefficients.ndim == 3 and self.coefficients.shape[1] % 2 else -1
        wanted = {"coefficients": (count, rows, 3 * joints - HIPS), "velocities": (count, 3), "reference": (joints, 3, 3)}
        for name, shape in wanted.items():
            array = getattr(self, name)
            if array.shape != shape or array.dtype.kind != "f" or not np.isfinite(array).all():
                raise LibraryError(f"{path}: {name} of shape {array.shape} do not fit {count} primitives "
                                   f"on {joints} joints, or are not finite numbers")
        for name, bend in self.bends.items():
            if bend.ndim != 2 or bend.shape[1] != 5 or not np.isfinite(bend).all():
                raise LibraryError(f"{path}: bend_{name} must be finite (E, 5), not {bend.shape}")
        if self.idle is not None:
            rows, ends = self.idle
            if rows.ndim != 2 or rows.shape[1] != 3 * joints + 3 or not np.isfinite(rows).all() or ends.ndim != 1 \
                    or ends.dtype.kind != "i" or np.any(np.diff(ends, prepend=0) < 1) or ends[-1:].sum() != len(rows):
                raise LibraryError(f"{path}: idle must be finite (K, {3 * joints + 3}) with stretches that end within it")
        if self.start is not None:
            given = self.start.coefficients
            if given.ndim != 4 or given.shape != (2, 2, given.shape[2], 3 * joints + 3) or given.shape[2] < 4 \
                    or not np.isfinite(given).all():
                raise LibraryError(f"{path}: start must be finite (2, 2, K, {3 * joints + 3}) with K of 4 at least")
        if self.turn is not None:
            given = self.turn.coefficients
            if given.ndim != 5 or given.shape != (2, 2, 3, given.shape[3], 3 * joints + 11) or given.shape[3] < 4 \
                    or not np.isfinite(given).all():
                raise LibraryError(f"{path}: turn must be finite (2, 2, 3, K, {3 * joints + 11}) with K of 4 at least")
        if sum(p.family == "rest" for p in self.primitives) != 1:
            raise LibraryError(f"{path}: a library needs one primitive of rest")


def _named(file: Any, start: str) -> dict[str, np.ndarray]:
    """The arrays of a file whose names begin so, by what follows."""
    return {name.removeprefix(start): file[name] for name in file.files if name.startswith(start)}


def reference_rotations(cycles: list[Cycle]) -> np.ndarray:
    """The mean local rotation (J, 3, 3) of every joint over all samples of some cycles."""
    return rot.mean(np.concatenate([c.rotations for c in cycles]))


def channels(cycle: Cycle, reference: np.ndarray) -> np.ndarray:
    """One cycle's samples (S, 3 J + 8) in the library's columns."""
    chart = rot.log(np.swapaxes(reference, -1, -2) @ cycle.rotations)
    chart = rot.continuous(chart).reshape(len(chart), -1)
    return np.concatenate([chart, cycle.hips, cycle.labels, cycle.duration[:, None]], -1)
