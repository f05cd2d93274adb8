"""What whoever has a motion file knows of it, and its reader would else have to judge: which way is up, and how long its unit is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from ..body import Clip
from .acclaim_motion import skeleton_of
from .parsing import fail
from .units_and_axes import LENGTHS, METRIC, UP, Detected, MotionFileError, detect, read, standardise

_IN = "metres", "decimetres", "centimetres", "millimetres", "feet", "inches"


@dataclass(frozen=True)
class Reading:
    """How motion files are to be read.

    up: the axis that points up, "x" … "-z". unit: metres in one of the file's own units; of an AMC file in one of its skeleton's. What is None, each file is judged by
    (`detect`). ValueError for another axis, and for what is no length.
    """

    up: str | None = None
    unit: float | None = None

    def __post_init__(self):
        if self.up is not None and self.up not in UP:
            raise ValueError(f"up is one of {', '.join(UP)}, not {self.up!r}")
        if self.unit is not None and not (isinstance(self.unit, float | int) and 0.0 < self.unit < math.inf):
            raise ValueError(f"a unit is a number of metres above zero, not {self.unit!r}")

    @staticmethod
    def of(up: str | None = None, unit: str | None = None) -> Reading:
        """The same, of words: a unit by its name, or as a number of metres. ValueError where there is none of that name."""
        if unit is None:
            return Reading(None if up is None else up.strip().lower().lstrip("+"))
        try:
            metres = LENGTHS[unit.strip().lower()] if unit.strip().lower() in LENGTHS else float(unit)
            if not 0.0 < metres < math.inf:
                raise ValueError
        except ValueError:
            raise ValueError(f"a unit is {', '.join(LENGTHS)} or a number of metres above zero, not {unit!r}") from None
        return Reading(None if up is None else up.strip().lower().lstrip("+"), metres)

    def read(self, path: str | Path) -> tuple[Clip, Detected]:
        """A raw clip, and how it is to be read. MotionFileError for a file that can't be read or judged."""
        raw, scale = read(path), self.unit
        if scale is not None and Path(path).suffix.lower() == ".amc":  # which is read in metres, by what its skeleton says
            scale /= skeleton_of(path).metre
        try:
            return raw, detect(raw, up=self.up, scale=scale)
        except MotionFileError as error:
            fail(path, None, str(error))

    def load(self, path: str | Path) -> Clip:
        """A motion file as a clip in metres, Y up, without calibration frames, as of `mocap.load`."""
        return standardise(*self.read(path))

    def doubt(self, path: str | Path) -> str:
        """How a file is read that is read as few are, "" of one that is read as most are, or where all of that is told. MotionFileError as of `read`."""
        if self.up is not None and self.unit is not None:
            return ""
        found = self.read(path)[1]
        if (self.up is not None or found.up == "y") and (self.unit is not None or found.scale in METRIC):
            return ""
        unit = next((words for words, metres in zip(_IN, LENGTHS.values()) if metres == found.scale), f"units of {found.scale:.4g} m")
        return f"{path}: read as with {found.up.upper()} up and in {unit}, as of somebody {found.stature:.2f} m tall"


JUDGED = Reading()
"""Nothing is known: all is judged."""
