"""Plans of who moves already, and of who has to be there by some time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from .goal_planner import plan
from .walk_plan import Plan
from .weights import HUMAN

QUICKER = 4
"""So often a quicker plan is sought for who has to be there within some time."""


def plan_in_time(ground: np.ndarray, goal: np.ndarray, velocity: np.ndarray, planes: np.ndarray, around: Sequence[Any], floor: float,
                 within: float | None = None, strictly: bool = False, leaving: np.ndarray | None = None, size: float = 1.0) -> Plan:
    """The plan from where and how a walker moves, within the time [s], or, unless strictly, the quickest; the arguments as of `plan`."""
    across = planes[:, :3] @ velocity
    share = np.min(-planes[:, 3] / np.maximum(across, 1e-9), initial=1.0, where=across > 1e-9)  # who runs has to slow down first
    moving = max(min(float(share), 1.0), 0.0) * np.asarray(velocity, float)
    onward = np.zeros(3) if leaving is None else leaving
    weights = HUMAN
    made = plan(ground, goal, moving, weights, planes, around, floor=floor, leaving=onward, size=size)
    if made.reason and np.abs(moving).max() > 1e-3:  # he has to stand first
        moving = np.zeros(3)
        made = plan(ground, goal, moving, weights, planes, around, floor=floor, leaving=onward, size=size)
    for _ in range(QUICKER):
        if made.reason or within is None or made.seconds <= within:
            return made
        faster = (0.95 * within / made.seconds) ** 4
        weights = weights._replace(forward=faster * weights.forward, turning=faster * weights.turning, lateral=faster * weights.lateral)
        quicker = plan(ground, goal, moving, weights, planes, around, floor=floor, leaving=onward, size=size)
        made = made if quicker.reason or quicker.seconds > made.seconds else quicker
    if within is not None and made.seconds > within and strictly:
        return Plan.none(ground, goal, f"it takes {made.seconds * size**0.5:.1f} s, {within * size**0.5:.1f} s are given")
    return made
