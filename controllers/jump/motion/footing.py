"""Which soles stand at each moment of a wind-up and a push: from where the ground can press."""

from __future__ import annotations

import math

import numpy as np

from ...body import HALF_SOLE, forward_kinematics, hull_kernel, settle, wrap, yaw
from ...compiled import kernel
from ..body import FOOT_FADE, BodyTables, Physique, Start, nearest_kernel, swivelled_kernel, turns

FADE = 0.14
"""Half-life with which the start's pose gives way to the jump's [s]."""
MOMENT = 1e-4
"""How fast angles turn joints is told from poses so far apart [s]."""
STANDS = 0.02
"""What is higher over the floor than this [m], at standard height, does not stand."""
HIPS = 0.09
"""How far below the centre of mass hips are that push [m], at standard height."""
STRAIGHT, RAISED = 0.992, 0.05
"""A heel rises where the leg is longer than this share of its length, or where the ankle would bend by so much more than it can [rad]."""
HEELS_RISE, RISES_FOR = (0.30, 0.90), 0.15
"""When in the push a heel starts to rise, at the earliest and at the latest, and so long [s] before take-off if there is the time: no ankle is infinitely fast."""
SHORT_PUSH, NEARER, LEAST_UP = 0.13, 0.8, 0.2
"""It rises less in pushes that are shorter than the first [s]; and by no more than the second of what brings the ankle nearest to the hip, but by the third [rad] at
least."""
DOWN_BY = 0.4
"""Half-life with which a runner's foot comes down, as a share of the time until its heel rises."""
RUNNERS_HEEL, RUNS_FOR = (0.2, 1.15), 0.12
"""When in the push a runner's heel starts to rise, and how far [rad]: the leg ends behind the body; less far where there is less time for it [s]."""


def settling(start: Start, planted: np.ndarray, body: BodyTables, times: np.ndarray, off: float, pushes: float) -> np.ndarray:
    """The feet (N, 2, 5) at times (N,) [s], on their way from the start to where they are planted (2, 5): balls x, y, z [m], yaw, pitch [rad]. A push of so long [s]
    begins at `off` [s]; a runner's foot is down by when its heel rises in that."""
    lasts = min(FOOT_FADE, DOWN_BY * (off + RUNNERS_HEEL[0] * pushes)) if start.runs else FOOT_FADE
    feet = planted + faded(start.feet - planted, start.feet_rates, lasts, times)
    heels = np.sin(np.maximum(-feet[..., 4], 0.0)) * (body.toe[2] - body.heel[2])  # lower than balls by this
    feet[..., 1] = np.maximum(feet[..., 1], planted[:, 1] + heels)
    return feet


def swivels(physique: Physique, start: Start, times: np.ndarray) -> np.ndarray:
    """What is left (N, 2) [rad] at times (N,) [s] of how far the knees were turned about their legs from where they point of themselves."""
    was = []
    for ago in (0.0, MOMENT):
        local = turns(-ago * start.rates) @ start.rotations
        placed = forward_kinematics(physique.skeleton, np.zeros(3), local)
        was.append([swivelled_kernel(physique.tables, side, start.feet[side, 3] - ago * start.feet_rates[side, 3], *placed) for side in range(2)])
    now, before = np.array(was)
    return faded(now, wrap(now - before) / MOMENT, FADE, times)


def heels_rise(start: Start, planted: np.ndarray, centres: np.ndarray, share: np.ndarray, lasts: float) -> float:
    """When in the push (0 … 1), which lasts so long [s], the heels rise: if it can be not before a standing jumper, its mass at centres (N, 3) when so much
    (N,) of the push is over, is over the balls of the feet."""
    if start.runs:
        return RUNNERS_HEEL[0]
    past = (centres[:, None] - start.pushing(planted)[:, :3]) @ yaw(start.heading)[:, 2]
    over = (past > 0.0).all(-1) & (share > 0.0)
    earliest, latest = HEELS_RISE
    latest = latest if start.haste > 1 else max(min(latest, 1.0 - RISES_FOR / lasts), earliest)
    return float(np.clip(share[int(np.argmax(over))], earliest, latest)) if over.any() else earliest


def heels_up(start: Start, planted: np.ndarray, leave: np.ndarray, pushes: float, body: BodyTables) -> float:
    """How far feet (2, 5) point down [rad] as they leave the floor under a mass at leave (3,) [m], after a push of so long [s]: no farther than brings ankles
    nearer to the hips, as it would backward, nor than a runner's comes to."""
    if start.runs:
        return RUNNERS_HEEL[1] * (1.0 if start.haste > 1 else min((1.0 - RUNNERS_HEEL[0]) * pushes / RUNS_FOR, 1.0))
    return standing_heels_kernel(body, start.pushing(planted).mean(0), leave, pushes, start.haste, start.heel_up)


@kernel
def standing_heels_kernel(body, foot, leave, pushes, haste, heel_up):
    """See `heels_up`, of who is no runner; foot: (5,) in the middle of those that push."""
    if haste > 1:
        return heel_up
    hips = leave.copy()
    hips[1] -= HIPS * body.size
    return min(heel_up * min(pushes / SHORT_PUSH, 1.0), max(NEARER * nearest_kernel(body, hips, foot), LEAST_UP))


def heels_down(centres: np.ndarray, feet: np.ndarray, body: BodyTables, flex: np.ndarray | float) -> np.ndarray:
    """Whether heels (N, 2) of feet (N, 2, 5) can be on the floor under a mass at centres (N, 3): neither is the leg too short nor does the ankle
    bend by more than `flex` (2,) [rad]."""
    down = np.empty(feet.shape[:2], bool)
    _heels_down(np.ascontiguousarray(centres), np.ascontiguousarray(feet), body, np.broadcast_to(flex, 2).copy(), down)
    return down


@kernel
def _heels_down(centres, feet, body, flex, down):
    """Write `heels_down` (N, 2)."""
    for n in range(len(feet)):
        for side in range(2):
            s, c = math.sin(feet[n, side, 3]), math.cos(feet[n, side, 3])
            x = centres[n, 0] - feet[n, side, 0] + body.toe[2] * s
            y = centres[n, 1] - HIPS * body.size - feet[n, side, 1] + body.toe[1]
            z = centres[n, 2] - feet[n, side, 2] + body.toe[2] * c
            long = math.sqrt(x * x + y * y + z * z)
            bent = min(max((body.shank**2 + long**2 - body.thigh**2) / (2.0 * body.shank * long), -1.0), 1.0)
            shank = math.atan2(x * s + z * c, y) + math.acos(bent)
            down[n, side] = long < STRAIGHT * (body.thigh + body.shank) and shank < flex[side] + RAISED


def standing_soles(feet: np.ndarray, low: float, flat: np.ndarray, single: int | None, body: BodyTables) -> tuple[np.ndarray, np.ndarray]:
    """The corners (N, 13, 2) x, z [m] of what of feet (N, 2, 5) stands on a floor on which balls are `low` [m], counter-clockwise, and how many (N,)
    they are. flat: (N, 2) whether heels may stand; single: the only foot that counts, if one does."""
    hulls, counts = np.empty((len(feet), 13, 2)), np.empty(len(feet), np.int64)
    soles_kernel(feet, low + STANDS * body.size, flat, -1 if single is None else single, body, hulls, counts)
    return hulls, counts


@kernel
def soles_kernel(feet, low, flat, single, body, hulls, counts):
    """Write the hulls (N, 13, 2) of what of the soles of feet (N, 2, 5) is no higher than `low` [m], and their counts (N,). flat: (N, 2) as in
    `standing_soles`; single: the only foot that stands, or −1."""
    points, half = np.empty((12, 2)), HALF_SOLE * body.size
    back, ahead = body.heel[2] - body.toe[2], body.tip[2]
    for n in range(len(feet)):
        count = 0
        for side in range(2):
            if single >= 0 and side != single:
                continue
            foot = feet[n, side]
            s, c, rise = math.sin(foot[3]), math.cos(foot[3]), math.sin(foot[4])
            for k in range(3):
                along = back if k == 0 else 0.0 if k == 1 else ahead
                high = foot[1] - rise * back if k == 0 else foot[1] if k == 1 else foot[1] - min(rise, 0.0) * ahead
                if high > low or (k == 0 and not flat[n, side]):
                    continue
                for aside in (half, -half):
                    points[count, 0] = foot[0] + aside * c + along * s
                    points[count, 1] = foot[2] - aside * s + along * c
                    count += 1
        counts[n] = hull_kernel(points, count, hulls[n])


def faded(offset: np.ndarray, rate: np.ndarray, halflife: float, times: np.ndarray) -> np.ndarray:
    """Offsets (N, ...) at times (N,) [s] of one (...) that settles from its rate."""
    kept, carried = settle(np.array([1.0, 0.0]), np.array([0.0, 1.0]), halflife, times[:, None])[0].T  # of offset, of rate
    return np.multiply.outer(kept, offset) + np.multiply.outer(carried, rate)
