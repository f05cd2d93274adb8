"""How fast a blend really walks: the achieved velocity of primitives and of half-and-half blends.

The root follows the standing foot, so the velocity of a blend is a property of its pose series and
not the mean of its primitives' velocities. Measured once, it becomes the primitives' coordinates
in the control space and the `bend` of the space's edges.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal, overload

import numpy as np

from ..body import screw
from ..compiled import kernel
from .control_space import ControlSpace, thin
from .kernel import COLUMNS, DURATION_AT, SCRATCH, body_tables, pose_kernel, series_table
from .library import Library, LibraryError
from .memory import Settings, legs_of, memory_dtype
from .root_motion import follow_feet
from .step import advance_phase, blend_series

CYCLES = 3
"""Whole cycles over which a velocity is measured, after one to settle."""


def steady_velocities(library: Library, weights: np.ndarray) -> np.ndarray:
    """Achieved (v_f, ω, v_l) (M, 3) of blends with constant weights (M, P)."""
    weights = np.asarray(weights, np.float32)
    memory = np.zeros(len(weights), memory_dtype(len(library.primitives)))
    memory["weights"][:, :weights.shape[1]] = weights
    memory["row"][:, DURATION_AT] = memory["stretch"] = memory["pace"] = memory["quick"] = 1.0
    frames = np.zeros((len(weights), 2, 3))
    time = np.zeros(len(weights))
    _walk_cycles(memory, frames, time, 1 / 240, Settings(), body_tables(library), legs_of(library),
                 series_table(library), library.velocities.astype(np.float32))
    return screw(frames[:, 0], frames[:, 1], time[:, None])


@kernel
def _walk_cycles(memory, frames, time, dt, settings, body, legs, table, velocities):
    joints = body.parents.shape[0]
    local, orientations = np.empty((joints, 3, 3), np.float32), np.empty((joints, 3, 3), np.float32)
    positions, scratch = np.empty((joints, 3), np.float32), np.empty(SCRATCH, np.float32)
    fresh = np.empty(COLUMNS, np.float32)
    for n in range(memory.shape[0]):
        m = memory[n]
        wraps, turned = 0, 0.0
        for _ in range(int((CYCLES + 2) * 4.0 / dt)):
            before, heading = m.phase, m.ground[2]
            advance_phase(m, table, 1.0, legs.rest, dt, -1.0)
            blend_series(m, settings, table, fresh, legs, dt)
            pose_kernel(body, fresh, local, positions, orientations, scratch)
            follow_feet(m, body, legs, positions, orientations, velocities, dt)
            if wraps >= 1:
                time[n] += dt
                turned += (m.ground[2] - heading + np.pi) % (2 * np.pi) - np.pi
            if m.phase < before:
                if wraps == 0:
                    for i in range(3):
                        frames[n, 0, i] = m.ground[i]
                wraps += 1
                if wraps > CYCLES:
                    break
        frames[n, 1, 0], frames[n, 1, 1] = m.ground[0], m.ground[1]
        frames[n, 1, 2] = frames[n, 0, 2] + turned


def settle(library: Library, progress=None) -> Library:
    """The library with achieved velocities for its primitives, and its spaces' bends measured."""
    count = len(library.primitives)
    moving = np.arange(count) != library.rest
    velocities = library.velocities.copy()
    if progress:
        progress("measuring velocities", 0, 2)
    velocities[moving] = steady_velocities(library, np.eye(count))[moving]
    library = _without_slivers(replace(library, velocities=velocities))
    if progress:
        progress("measuring velocities", 1, 2)
    bends = {}
    for family in ("walk", "run"):
        space = space_of(library, family)
        if space is not None:
            bends[family] = measure_bend(library, library.family(family), space)
    if progress:
        progress("measuring velocities", 2, 2)
    return replace(library, bends=bends)


def _without_slivers(library: Library) -> Library:
    """The library without the primitives that make its control spaces' simplices thin.

    Rest stays, and so does straight walking, which people do most, and whatever goes farthest to any side.
    """
    kept = np.array([p.family == "rest" or p.label.startswith("forward") for p in library.primitives])
    for members in (library.family("walk"), library.family("run")):
        if len(members):
            kept[members[library.velocities[members].argmax(0)]] = kept[members[library.velocities[members].argmin(0)]] = True
    left = np.sort(np.concatenate([
        members[thin(library.velocities[members], kept[members])]
        for members in (library.family("walk"), library.family("run")) if len(members)]))
    return replace(library, primitives=tuple(library.primitives[i] for i in left),
                   velocities=library.velocities[left], coefficients=library.coefficients[left])


def measure_bend(library: Library, members: np.ndarray, space: ControlSpace) -> np.ndarray:
    """What half-and-half blends along the space's edges (E,) have beyond the mean of their ends (E, 5):
    the two points and (v_f, ω, v_l), as `ControlSpace.with_bend` takes it."""
    pairs, _ = space.edges()
    weights = np.zeros((len(pairs), len(library.primitives)))
    for k in range(2):
        weights[np.arange(len(pairs)), members[pairs[:, k]]] = 0.5
    bend = steady_velocities(library, weights) - 0.5 * space.points[pairs].sum(1)
    return np.concatenate([pairs, bend], -1)


@overload
def space_of(library: Library, family: Literal["walk"]) -> ControlSpace: ...
@overload
def space_of(library: Library, family: str) -> ControlSpace | None: ...
def space_of(library: Library, family: str) -> ControlSpace | None:
    """The control space of one family: a walk too wild is walked slower, down to rest; a run too
    wild goes straighter at the same speed.

    None for runs too few or too alike to span one: walking then serves at any speed. LibraryError
    if that is so of walking.
    """
    members = library.family(family)
    try:
        space = ControlSpace.build(library.velocities[members], np.zeros(3) if family == "walk" else None,
                                   keep_speed=family == "run")
    except ValueError as error:
        if family == "run":
            return None
        raise LibraryError(f"this library can't be walked: {error}; it takes steady walking forward, turning to "
                           "both sides and sideways") from None
    bend = library.bends.get(family)
    return space if bend is None else space.with_bend(bend)
