"""The floor on which a jump starts: how the ground rises there, and how high it is under each foot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...contract import CharacterState, level
from ...navigation import floor_at, slope_at
from ..body import Physique, Start, raised

UNDER = 0.15
"""What lies higher or lower than this over the floor of who walks is no more of it [m]."""
UP = 0.06
"""A foot higher than this over the floor is in the air [m]."""
UNEVEN = 0.02
"""Ground is no slope where the floor under a foot lies by more than this beside it [m]."""


def on_ground(start: Start, state: CharacterState, around: Sequence[Any]) -> Start:
    """The same start on ground as it rises under somebody; as it is on level ground, and where a foot stands beside the slope."""
    x, z, _ = np.asarray(state.ground, float)
    floor = float(state.floor)
    slope = slope_at(x, z, around, floor + UP)
    if not slope.any():
        return start
    sloping = start.on(slope, np.array([x, z]) + (floor - floor_at(x, z, around, floor + UP)) / (slope @ slope) * slope)
    heights = floor + sloping.rise(start.feet[:, :3])
    even = all(abs(floor_at(ball[0], ball[2], around, high + UNEVEN) - high) < UNEVEN for ball, high in zip(start.feet, heights))
    return sloping if even else start


def astride(physique: Physique, start: Start, state: CharacterState) -> tuple[Start, float]:
    """The same start of one whose feet stand on floors of their own, as astride an edge, and how high the lower of these is [m]; who pushes off one foot has but one."""
    floor = float(level(state.floor))
    if start.single is not None:
        return start, floor
    over = start.feet[:, 1] - (floor + raised(physique.tables, start.slope) + start.rise(start.feet[:, :3]))
    over = np.where(np.asarray(state.contacts).reshape(2, 2)[:, 1] & (np.abs(over) > UNEVEN), over, 0.0)
    return (replace(start, levels=over - over.min()) if over.any() else start), floor + float(over.min())


def on_its_floor(physique: Physique, start: Start, floor: float, around: Sequence[Any]) -> bool:
    """Whether feet that push come to stand on that floor [m], heel or ball: who goes over an edge has one of them beyond it."""
    body, feet = physique.tables, start.planted(floor, physique.tables)
    for side in (0, 1) if start.single is None else (start.single,):
        ball, ahead = feet[side, :3], np.array([np.sin(feet[side, 3]), 0.0, np.cos(feet[side, 3])])
        places = ball, ball + (body.heel[2] - body.toe[2]) * ahead
        if all(floor_at(x, z, around, high + UP) < high - UP for (x, _, z), high in zip(places, floor + start.rise(np.array(places)))):
            return False
    return True


def ground(state: CharacterState, around: Sequence[Any]) -> tuple[float, np.ndarray]:
    """How high [m] the ground is under somebody, and how (2,) it rises along x and z [m/m]."""
    x, z, _ = np.asarray(state.ground, float)
    floor = float(state.floor)
    slope = slope_at(x, z, around, floor + UNDER) if len(around) else np.zeros(2)
    return floor_at(x, z, around, floor + UNDER) if slope.any() else floor, slope
