"""Which recorded cycles become primitives: the paper's protocol, then the gaps that it leaves.

Truong 2010, section II.A: curvature radii 0, 1, 2, 3, ∞ to both sides at three speeds, lateral and
diagonal directions at three speeds, backward, runs, rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .control_space import SCALE
from .cycles import Cycle

CLOSURE = np.radians(9.0)
"""Cycles that close worse than this (RMS joint angle) are not used in walking …"""
RUN_CLOSURE = np.radians(15.0)
"""… nor worse than this in running, where captures are short and subjects still accelerate."""
REACH = 0.6
"""A protocol target counts as met by a cycle nearer than this in scaled velocity."""
SPACING = 0.45
"""Gap filling adds cycles until every usable one is this near to a primitive."""
RIDGE = 0.1
"""Regularisation of the local regression, in squared kernel widths: sparse corners stay plain means."""


@dataclass(frozen=True)
class Choice:
    """One chosen cycle: its label, its number, and whether left and right are exchanged."""

    label: str
    cycle: int
    mirrored: bool = False


def protocol() -> list[tuple[str, np.ndarray]]:
    """The walking targets, each a label and (v_f, ω, v_l) in SI."""
    targets: list[tuple[str, tuple[float, float, float]]] = [
        (f"forward {v:.2f} m/s", (v, 0, 0)) for v in (0.40, 0.65, 0.95, 1.30, 1.45, 1.65)]
    for speed, v in (("slow", 0.53), ("normal", 0.83), ("fast", 1.15)):
        targets.append((f"radius inf {speed}", (v, 0, 0)))
        for radius in (3, 2, 1, 0.4):
            for side, sign in (("left", 1), ("right", -1)):
                targets.append((f"radius {radius} {side} {speed}", (v * min(1, radius**0.3), sign * v / radius, 0)))
    for omega in (0.8, 1.4, 2.0, 2.6):
        for side, sign in (("left", 1), ("right", -1)):
            targets.append((f"radius 0 {side} {omega:.1f} rad/s", (0, sign * omega, 0)))
    for angle, speeds in ((45, (0.65, 0.85, 1.2)), (70, (0.4, 0.6, 0.7)), (90, (0.3, 0.45, 0.6)), (135, (0.5, 0.7))):
        for v in speeds:
            for side, sign in (("left", 1), ("right", -1)):
                a = np.radians(angle)
                targets.append((f"direction {angle} {side} {v:.2f} m/s", (v * np.cos(a), 0, sign * v * np.sin(a))))
    for side, sign in (("left", 1), ("right", -1)):
        targets.append((f"side-step {side} turning in", (0, sign * 1.05, sign * 0.4)))
        targets.append((f"side-step {side} turning out", (0, -sign * 1.05, sign * 0.4)))
    for v in (-0.4, -0.6, -0.85):
        targets.append((f"backward {-v:.2f} m/s", (v, 0, 0)))
        for side, sign in (("left", 1), ("right", -1)):
            targets.append((f"backward {-v:.2f} m/s turning {side}", (v, sign * 0.8, 0)))
    return [(label, np.array(v, float)) for label, v in targets]


def select(cycles: list[Cycle], rank: np.ndarray, family: str) -> tuple[list[Choice], list[str]]:
    """Primitives of one family, and the labels of the protocol that nothing recorded meets.

    rank: (C,) how far to put a cycle's source behind the others, in scaled velocity. Natural
    cycles come first; mirrored ones only fill what then is missing.
    """
    limit = CLOSURE if family == "walk" else RUN_CLOSURE
    usable = np.array([c.family == family and c.closure < limit for c in cycles], bool)
    if not usable.any():
        return [], [label for label, _ in protocol()] if family == "walk" else []
    velocity = np.array([c.velocity for c in cycles]) / SCALE
    cost = np.asarray(rank, float) ** 2 + 0.05 * (np.array([c.closure for c in cycles]) / limit) ** 2
    flip = np.array([1.0, -1.0, -1.0])
    chosen: list[Choice] = []
    places: list[np.ndarray] = []
    missing = []

    def take(label, i, mirrored=False):
        chosen.append(Choice(label, int(i), mirrored))
        places.append(velocity[i] * (flip if mirrored else 1.0))

    def spare(i, mirrored, least):
        at = velocity[i] * (flip if mirrored else 1.0)
        return not places or np.linalg.norm(np.array(places) - at, axis=-1).min() > least

    for label, target in protocol() if family == "walk" else []:
        for mirrored in (False, True):
            distance = np.linalg.norm(velocity * (flip if mirrored else 1.0) - target / SCALE, axis=-1)
            score = np.where(usable & (distance < REACH), distance**2 + cost, np.inf)
            best = int(np.argmin(score))
            if np.isfinite(score[best]):
                if spare(best, mirrored, 0.25 * SPACING):
                    take(label, best, mirrored)
                break
        else:
            missing.append(label)
    for mirrored in (False, True):
        while True:  # the usable cycle farthest from all primitives, until none is far
            at = velocity * (flip if mirrored else 1.0)
            gap = np.full(len(cycles), 10.0) if not places else \
                np.linalg.norm(at[:, None] - np.array(places), axis=-1).min(1)
            # a cycle counts as far only beyond its rank's handicap; mirrored ones need twice the gap
            score = np.where(usable & (gap > SPACING * (2 if mirrored else 1) + rank), gap - np.sqrt(cost), -np.inf)
            best = int(np.argmax(score))
            if not np.isfinite(score[best]):
                break
            take("gap", best, mirrored)
    return chosen, missing


def neighbours(cycles: list[Cycle], group: np.ndarray, seed: int, family: str, width: float = 0.3
               ) -> tuple[np.ndarray, np.ndarray]:
    """Cycles near a chosen one, by the same actor, and their weights: what it is averaged with.

    A single cycle carries one step's accidents; its neighbours in velocity average them out. The
    weights are those of a local linear regression evaluated at the chosen cycle's velocity: they
    sum to one, and unlike a plain mean they do not pull the outermost cycles inwards. group: (C,)
    actor of each cycle. width: of the kernel, scaled velocity.
    """
    limit = CLOSURE if family == "walk" else RUN_CLOSURE
    near = np.array([i for i, c in enumerate(cycles)
                     if c.family == family and group[i] == group[seed] and (c.closure < limit or i == seed)])
    away = np.array([cycles[i].velocity - cycles[seed].velocity for i in near]) / SCALE
    kernel = np.exp(-0.5 * np.sum(away**2, -1) / width**2)
    near, away, kernel = near[kernel > 0.05], away[kernel > 0.05], kernel[kernel > 0.05]
    kernel /= kernel.sum()
    centre = kernel @ away
    spread = (away - centre).T @ (kernel[:, None] * (away - centre)) + RIDGE * width**2 * np.eye(3)
    return near, kernel * (1 - (away - centre) @ np.linalg.solve(spread, centre))
