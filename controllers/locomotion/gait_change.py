"""Where one gait may become another: the phases at which their feet are alike, in place and in movement.

A walk and a run have their events in different orders, so that equal phases show legs half a metre apart. For every
phase of the one the nearest phase of the other is looked for, along a straight way at the speeds where the two meet;
and a change is open where that is near, which is soon after a foot has struck.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..body import contact_points, forward_kinematics, rotations as rot
from ..compiled import kernel
from . import fourier
from .control_space import ControlSpace
from .library import DURATION, HIPS, LABELS, Library

PHASES = 64
"""Phases of a cycle that are compared."""
LEAD = 0.1
"""How far ahead movements are compared: a difference of 1 m/s counts as that of this many metres."""
STANDING = 0.15
"""A point that stands in one gait only counts as this far off [m]."""
SLACK = 1.25
"""A change is open where the gaits are at most this much farther apart than where they are nearest."""


class Changes(NamedTuple):
    """From walk (row 0) and from run (row 1): the other gait's phase, and whether one may change. (2, PHASES) both."""

    phase: np.ndarray
    open: np.ndarray


def changes(library: Library, walk: ControlSpace, run: ControlSpace | None) -> Changes:
    """Where the gaits of a library may follow each other; anywhere where there is one only."""
    if run is None:
        phases = np.arange(PHASES, dtype=np.float32) / PHASES
        return Changes(np.stack([phases, phases]), np.ones((2, PHASES), np.int32))
    feet = [np.concatenate([points, LEAD * speeds, STANDING * labels[..., None]], -1)
            for points, speeds, labels in (_feet(library, "walk", walk, walk.straight()[1]), _feet(library, "run", run, run.straight()[0]))]
    apart = np.sqrt(np.square(feet[0][:, None] - feet[1][None]).sum((-1, -2)))
    nearest, distance = (np.stack([f(apart, 1), f(apart, 0)]) for f in (np.argmin, np.min))
    halves = distance.reshape(2, 2, -1)  # each foot in its turn
    opened = halves <= SLACK * halves.min(-1, keepdims=True)
    return Changes((nearest / PHASES).astype(np.float32), opened.reshape(2, PHASES).astype(np.int32))


def _feet(library: Library, family: str, space: ControlSpace, speed: float) -> tuple[np.ndarray, ...]:
    """Heels and balls (PHASES, 4, 3) [m] in the ground frame of a straight gait, how they move [m/s] and how much
    they stand (PHASES, 4)."""
    weights = space.weights(np.array([speed, 0.0, 0.0]))
    series = np.tensordot(weights, library.coefficients[library.family(family)], 1)
    rows = fourier.evaluate(series, np.arange(PHASES) / PHASES)
    local = library.reference @ rot.exp(rows[:, :HIPS].reshape(PHASES, -1, 3))
    points = contact_points(library.skeleton, *forward_kinematics(library.skeleton, rows[:, HIPS:LABELS], local))
    step = (np.roll(points, -1, 0) - np.roll(points, 1, 0)) * (0.5 * PHASES)
    return points, step / rows[:, DURATION, None, None], rows[:, LABELS:DURATION]


@kernel
def change_kernel(changes, family, phase):
    """Whether a gait (0 walk, 1 run) may change at a phase, and the other's phase then."""
    at = phase * changes.phase.shape[1]
    first = int(at) % changes.phase.shape[1]
    other = (first + 1) % changes.phase.shape[1]
    step = (changes.phase[family, other] - changes.phase[family, first] + 0.5) % 1.0 - 0.5
    return changes.open[family, first] == 1, (changes.phase[family, first] + (at - int(at)) * step) % 1.0
