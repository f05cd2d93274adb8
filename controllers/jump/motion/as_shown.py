"""A motion that begins as what was shown: legs over planted feet are made anew from where their balls are and point, which says nothing of how soles roll, toes bend and shanks are
twisted about themselves. What of that was shown fades (inertialisation), and so does how far the pelvis is off for it; balls stay on their way."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...body import settle
from ..body import FOOT_FADE, Physique, Start, turns, vectors

LASTS = 0.6
"""After so long nothing is left [s]."""
SAME = 2e-4
"""What differs by less than this [rad, m] does not."""
GROWS = 0.5
"""It grows no faster, at first, than by this share of what makes a damped spring turn back at once: nothing swings far past where it is going."""


@dataclass(frozen=True, eq=False)
class Shown:
    """What a body was shown to differ by from a motion as it began. off: (8, 3) [rad] by how much its legs' joints were turned in the world, about their own axes, and rate: (8,) [1/s] how
    fast that changed, as a share of it. root: (3,) [m] how far its pelvis was off, balls: (2, 3) [m] those of its feet, seen from its hips."""

    off: np.ndarray
    rate: np.ndarray
    root: np.ndarray
    balls: np.ndarray

    @staticmethod
    def of(physique: Physique, start: Start, step: float, roots: np.ndarray, local: np.ndarray) -> Shown | None:
        """What a start differs by from a motion whose first roots (N, 3) and joints' rotations (N, J, 3, 3) are `step` [s] apart; None where it begins so by itself."""
        legs, bones = _legs(physique)
        now, shown = _world(local[:2], legs), _world(start.rotations[None], legs)[0]
        off, root = vectors(np.swapaxes(now[0], -1, -2) @ shown), start.root - roots[0]
        size = np.linalg.norm(off, axis=-1)
        if size.max() < SAME and np.abs(root).max() < SAME:
            return None
        own = vectors(np.swapaxes(now[0], -1, -2) @ now[1])  # before it began it would have turned as it does then
        ago = _world((turns(-step * start.rates) @ start.rotations)[None], legs)[0]
        was = vectors(np.swapaxes(now[0] @ turns(-own), -1, -2) @ ago)
        quick = 2.0 * np.log(2.0) / FOOT_FADE
        rate = np.clip(((off - was) * off).sum(-1) / np.maximum(size, SAME) ** 2 / step, -quick, GROWS * quick)
        return Shown(off, rate, root, _balls(shown, bones) - _balls(now[0], bones))

    def over(self, physique: Physique, times: np.ndarray, roots: np.ndarray, local: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Roots (N, 3) and joints' rotations (N, J, 3, 3) at times (N,) [s] since the motion began, going over from what was shown."""
        some, (legs, bones) = int(np.searchsorted(times, LASTS)), _legs(physique)
        part, made = times[:some, None], _world(local[:some], legs)
        ends = 1.0 - part / LASTS
        left = ends * settle(np.ones(len(legs)), self.rate, FOOT_FADE, part)[0]
        rest = ends * settle(np.ones(1), np.zeros(1), FOOT_FADE, part)[0]
        world = made @ turns(left[..., None] * self.off)
        onto = _onto(_balls(world, bones), _balls(made, bones) + rest[..., None] * self.balls)
        for side in (0, 4):  # leg and foot turn about the hip by what the ball would be off
            world[:, side:side + 3] = onto[:, side // 4, None] @ world[:, side:side + 3]
        roots, local = roots.copy(), local.copy()
        roots[:some] += rest * self.root
        above = np.concatenate([local[:some, :1], world[:, :3], local[:some, :1], world[:, 4:7]], 1)
        local[:some, legs] = np.swapaxes(above, -1, -2) @ world
        return roots, local


def as_shown(physique: Physique, start: Start, times: np.ndarray, roots: np.ndarray, local: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The roots (N, 3) and joints' rotations (N, J, 3, 3) of a motion at times (N,) [s], going over from how it was shown to start."""
    shown = Shown.of(physique, start, float(times[1] - times[0]), roots, local)
    return (roots, local) if shown is None else shown.over(physique, times - times[0], roots, local)


def _legs(physique: Physique) -> tuple[np.ndarray, np.ndarray]:
    """The joints (8,) of both legs, and where (8, 3) each is from the last [m]."""
    legs = (physique.tables.hip[:, None] + np.arange(4)).ravel()
    return legs, physique.skeleton.offsets[legs]


def _world(local: np.ndarray, legs: np.ndarray) -> np.ndarray:
    """How the joints (8,) of both legs are turned in the world (N, 8, 3, 3), of whole bodies' rotations (N, J, 3, 3)."""
    out = local[:, legs].copy()
    for side in (0, 4):
        above = local[:, 0]
        for k in range(side, side + 4):
            out[:, k] = above = above @ out[:, k]
    return out


def _balls(world: np.ndarray, bones: np.ndarray) -> np.ndarray:
    """Where (..., 2, 3) the balls of the feet are from their hips [m], of joints turned so in the world (..., 8, 3, 3). bones: (8, 3) from each to the last [m]."""
    ways = world[..., [0, 1, 2, 4, 5, 6], :, :] @ bones[[1, 2, 3, 5, 6, 7], :, None]
    return ways.reshape(*world.shape[:-3], 2, 3, 3).sum(-2)


def _onto(ways: np.ndarray, others: np.ndarray) -> np.ndarray:
    """The smallest turns (..., 3, 3) of ways (..., 3) onto nearby others (..., 3)."""
    ways, others = (part / np.linalg.norm(part, axis=-1, keepdims=True) for part in (ways, others))
    return turns(np.cross(ways, others))
