"""Files of arrays that a program wrote and another version of it, or anybody, may have changed: numpy's .npz."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from zipfile import BadZipFile

import numpy as np

from .safe_files import ordinary, reason


class ArraysError(ValueError):
    """A file of arrays that can't be used; says which and why."""


def arrays(path: str | PathLike[str], what: str, marks: Mapping[str, object], maker: str) -> dict[str, np.ndarray]:
    """All arrays of an .npz file that is `what`, none of them of Python's objects.

    marks: arrays that say which version it is, by name, as lists and numbers; maker: what makes one of this version. ArraysError, naming the file,
    for one that can't be read, is no such file, or has other marks.
    """
    try:
        with np.load(ordinary(path), allow_pickle=False) as file:
            found = {name: file[name] for name in file.files}
    except OSError as error:
        raise ArraysError(f"{path}: can't be read: {reason(error)}") from None
    except (ValueError, AttributeError, EOFError, KeyError, NotImplementedError, BadZipFile):
        raise ArraysError(f"{path}: is no {what}, or damaged") from None
    if any(name not in found or found[name].tolist() != mark for name, mark in marks.items()):
        raise ArraysError(f"{path}: is of another version of Gambol; {maker} makes one")
    return found
