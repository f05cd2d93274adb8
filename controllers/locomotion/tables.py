"""A library as a step of the kernels needs it, made once."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from .control_space import ControlSpace
from .gait_change import Changes, changes
from .idle import Idling, idling
from .kernel import Body, Space, body_tables, series_table, space_tables
from .library import Library
from .memory import Legs, legs_of
from .first_stride import Starting, starting
from .traction import Masses, masses_of
from .turning_step import Turning, turning


class Tables(NamedTuple):
    """What a step is told of body and library, in the order in which it takes them."""

    body: Body
    legs: Legs
    walk: Space
    run: Space
    series: np.ndarray
    changes: Changes
    idle: Idling
    start: Starting
    turns: Turning
    masses: Masses


@lru_cache(maxsize=4)  # a tenth of a second, for everybody who walks by the same library
def tables_of(library: Library, walk: ControlSpace, run: ControlSpace | None) -> Tables:
    """The tables of a library with these control spaces; without runs walking serves at any speed."""
    walking = space_tables(walk, library.family("walk"))
    running = space_tables(run, library.family("run")) if run else walking
    return Tables(body_tables(library), legs_of(library), walking, running, series_table(library),
                  changes(library, walk, run), idling(library), starting(library), turning(library), masses_of(library.skeleton))
