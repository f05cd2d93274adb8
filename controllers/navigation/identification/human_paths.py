"""Recorded walks to goals, read from a file."""

from __future__ import annotations

import io
import tokenize
import zipfile
import zlib
from dataclasses import dataclass
from os import PathLike

import numpy as np

from ...files import contents, reason

LARGEST = 1 << 28
"""A file is so large at most [bytes]."""
FEWEST = 8
"""A path has so many places at least."""
APART = 0.3
"""A path begins and ends within this of its start and goal [m]."""
SHAPES = {"name": "(N,)", "start": "(N, 3) x, y [m], heading [rad]", "goal": "(N, 3) x, y [m], heading [rad]", "xy": "(N, T, 2) [m]"}


class PathsError(ValueError):
    """A file of human paths can't be used; the message names it and what is wrong."""


@dataclass(frozen=True, eq=False)
class HumanPaths:
    """N walks from rest to rest.

    names: (N,). starts, goals: (N, 3) x, z [m], heading [rad]. places: (N, T, 2) x, z [m] at even times. headings: (N, T) [rad],
    NaN where nobody recorded one.
    """

    names: np.ndarray
    starts: np.ndarray
    goals: np.ndarray
    places: np.ndarray
    headings: np.ndarray

    def __len__(self) -> int:
        return len(self.names)

    def of(self, which) -> HumanPaths:
        """Some of them, by number or by a mask."""
        return HumanPaths(self.names[which], self.starts[which], self.goals[which], self.places[which], self.headings[which])


def read_paths(path: str | PathLike[str]) -> HumanPaths:
    """The walks in an .npz file. PathsError, naming the file and the array, for one that has none.

    Its arrays: name (N,), start and goal (N, 3) x, y [m] and heading [rad], xy (N, T, 2) [m] at even times, and where there are
    recorded headings, heading (N, T) [rad]. Headings are counter-clockwise from x as seen from above; walks begin and end at rest.
    """
    try:
        with np.load(io.BytesIO(contents(path, LARGEST)), allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
    except (OSError, ValueError, LookupError, TypeError, AttributeError, EOFError, MemoryError, RuntimeError, tokenize.TokenError,
            zipfile.BadZipFile, zlib.error) as error:  # all a damaged zip has in store
        why = reason(error) if isinstance(error, OSError) else "no .npz file, or a damaged one"
        raise PathsError(f"{path}: not a file of human paths ({why})") from None
    for name, shape in SHAPES.items():
        if name not in arrays:
            raise PathsError(f"{path}: has no array {name!r}; needs {name} {shape}")
    return _checked(path, arrays)


def _checked(path, arrays) -> HumanPaths:
    count = len(arrays["name"]) if arrays["name"].ndim == 1 else 0
    if not count or arrays["name"].dtype.kind not in "US":
        raise PathsError(f"{path}: name must be (N,) words for at least one walk, got {arrays['name'].dtype} {arrays['name'].shape}")
    long = arrays["xy"].shape[1] if arrays["xy"].ndim == 3 else 0
    wanted = {"start": (count, 3), "goal": (count, 3), "xy": (count, max(long, FEWEST), 2)}
    if "heading" in arrays:
        wanted["heading"] = (count, long)
    for name, shape in wanted.items():
        array = arrays[name]
        if array.shape != shape or array.dtype.kind not in "fiu":
            raise PathsError(f"{path}: {name} must be numbers of shape {shape}, got {array.dtype} {array.shape}")
        if name != "heading" and not np.isfinite(array).all():
            raise PathsError(f"{path}: {name} of walk {arrays['name'][np.argwhere(~np.isfinite(array))[0, 0]]} is not finite")
    for end, at in (("start", 0), ("goal", -1)):
        off = np.linalg.norm(arrays["xy"][:, at] - arrays[end][:, :2], axis=1)
        if off.max() > APART:
            worst = off.argmax()
            raise PathsError(f"{path}: walk {arrays['name'][worst]} is {off[worst]:.2f} m from its {end} at its {'first' if at == 0 else 'last'} "
                             f"place, more than {APART} m")
    headings = np.asarray(arrays.get("heading", np.full((count, long), np.nan)), float)
    return HumanPaths(arrays["name"].astype(str), _ours(arrays["start"]), _ours(arrays["goal"]), arrays["xy"][..., ::-1].astype(float), headings)


def _ours(poses: np.ndarray) -> np.ndarray:
    """Poses (N, 3) with x ahead and y to the left as ours, which have z ahead and x to the left."""
    return poses[:, [1, 0, 2]].astype(float)
