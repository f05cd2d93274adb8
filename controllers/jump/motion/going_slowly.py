"""How somebody moves who goes slowly, aside or backward, and leaps on, off the foot that stands, on the way that he goes, about as far as his speed carries him.

What is recorded are leaps of who runs ahead. A foot presses from within its sole. Told is how fast a body leaves that it pushes off so that he keeps his speed as well as it
can, as an inverted pendulum under the force of a push: a moment at which that is far from how he goes is none to leap off.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...body import HALF_SOLE, yaw
from ...compiled import kernel
from ..body import FLAT, Physique, Start, carriage
from ..prior import EACH, LEGS, ROWS

PUSHES = 0.22
"""So long [s] his foot gives and pushes, on Earth, at standard height."""
FLIES, FASTER = (0.42, 0.25, 0.25, 0.42), (0.1, 0.4, 0.9, 1.6)
"""He flies so long [s] who goes so fast [m/s], at standard height: low in a skip, the higher the nearer he comes to standing still, as one hops on the spot, or to running, as runners leap."""
LIKE = 1.1, 1.75
"""Up to the first of these he skips, from the second on he leaps as runners do, and between them something of both, who goes ahead [m/s]; at standard height."""
LOW = 0.015
"""So much lower he leaves than on a straight leg [m], at standard height: it would have to straighten at once."""
WITHIN = 0.6, 0.11, 0.05
"""The force comes from within so much of the sole's half width, from no farther behind the ball than the second, since heels rise, and from no nearer to the tip than the
third [m], at standard height."""
LEAVES, STRAYS, WALKS = (0.85, 1.4, 1.75), (0.45, 0.33), (0.38, 1.05)
"""He leaves no slower on his way than the first times as he goes, no faster than the second, or the third where that is slower than a walk, nor faster aside of it than so
much, or than the sway [m/s] of who hardly goes; and no slower than one who walks, if he goes as fast, as fast as whom he may be [m/s], at standard height."""
BRISK, BRISKLY = (0.8, 1.2), (0.95, 1.3)
"""Who goes faster than the first of these [m/s] leaves no slower, by and by, and from the second on not than the first times as he goes, and no faster than the second: there is a better moment soon."""
WAITED, EASED = (0.25, 0.3), (0.15, 0.2, 0.08, 0.1)
"""Who has waited for longer than the first, by the second [s], is content with so much less of each of the lower ones, and strays and sways by so much more: the second and the last of these."""
CROSSES = 0.05
"""Who comes farther than this [m] past the foot that pushes, to its outer side, would bring the other leg past it, at standard height."""
TRAILS = 0.16
"""How far ahead of him [m] his foot comes down for each m/s."""
HANGS = np.concatenate([carriage.STAND, np.tile([-0.1, 0.3, 0.0], 2)])
CALM, AHEAD = np.concatenate([[0.6] * 3, np.tile([0.3, 0.3, 0.3, 0.2], 2), np.tile([0.15, 0.35, 0.6], 2)]), np.concatenate([np.zeros(LEGS), np.tile([0.4, 0.32, 0.4], 2)])
"""He carries trunk, arms and legs by the first of these shares as far from how they hang [rad] as runners, and by so much more of it as he goes ahead."""
ARMS, SWINGS = (slice(3, 6), slice(7, 10)), (0.42, 1.1)
"""The columns in which arms turn; who goes ahead swings each by the first [rad] from how it hangs, less where he is slower than the second [m/s], at standard height."""
SWUNG = np.interp(np.arange(ROWS), [0, 14, ROWS - 1], [0.0, 1.0, 2.0])
SWUNG = 1.5 * np.minimum(SWUNG, 1.0)**2 * (3.0 - 2.0 * np.minimum(SWUNG, 1.0)) - np.maximum(SWUNG - 1.0, 0.0)**2 * (5.0 - 2.0 * SWUNG) - 0.5
"""How far that arm is ahead which is beside the foot that pushes, and the other behind, in each row: most of all as he lands, as a walker's whose other foot strikes."""
ASIDE = 1.75
"""His foot comes down so many times as far ahead of him aside as it would ahead."""
BENDS = np.array([-0.45, 0.9, 0.0])
"""By so much [rad] he bends hip and knee of his free leg on its way, if it is straight: else its foot would come into the floor."""
FOLDS = 0.5
"""Where that does not clear the floor, his hip bends by so much of what his knee does: a shank that hangs swings back as its knee bends, and hardly rises."""
GIVES = 0.75
"""He gives to his landing by this share of the usual."""


class Carried(NamedTuple):
    """How somebody leaves the foot that stands: velocity (3,) [m/s], where his other foot comes down (3,) [m], how far that velocity is from how he goes, as a share, and whether he
    can go on so."""

    velocity: np.ndarray
    place: np.ndarray
    strays: float
    keeps: bool


def carried(physique: Physique, start: Start, goes: np.ndarray, floor: float, gravity: float, waited: float = 0.0) -> Carried:
    """How somebody leaves the foot that stands who goes so fast (3,) [m/s], off a floor [m], under gravity [m/s²] downward, and has waited [s] for it."""
    assert start.single is not None
    size = physique.size
    flies = airtime(start.velocity, size) * math.sqrt(size * 9.81 / gravity)
    velocity, leave = sent(physique, start, goes, floor, gravity, flies)
    ball, facing = start.planted(floor, physique.tables)[start.single][:3] * FLAT, yaw(start.heading)
    pace = max(float(np.linalg.norm(goes)), 1e-9)
    eased = min(max((waited - WAITED[0]) / WAITED[1], 0.0), 1.0)
    root = math.sqrt(size)
    slow, fast = min(root * (WALKS[0] - eased * EASED[2]), pace), root * WALKS[1]
    least, most = (float(np.interp(pace / root, BRISK, (usual, brisk))) for usual, brisk in zip(LEAVES, BRISKLY))
    along = goes / pace
    ahead = float(velocity @ along) / pace
    aside = float(np.linalg.norm(velocity - (velocity @ along) * along)) / pace
    past = float((leave - ball) @ facing[:, 0]) * (1 - 2 * start.single)
    lands = TRAILS * beside(start, velocity)
    place = leave + velocity * flies + lands + [0.0, floor, 0.0]
    keeps = (max(least - eased * EASED[0], slow / pace) <= ahead <= max(most, min(LEAVES[2], fast / pace))
             and aside <= max(STRAYS[0] + eased * EASED[1], root * (STRAYS[1] + eased * EASED[3]) / pace) and past <= CROSSES * size)
    return Carried(velocity, place, float(np.linalg.norm(velocity - goes)) / pace, keeps)


def sent(physique: Physique, start: Start, goes: np.ndarray, floor: float, gravity: float, flies: float) -> tuple[np.ndarray, np.ndarray]:
    """How fast (3,) [m/s] somebody leaves the foot that stands, and where (3,) [m], along the floor, who is to leave as near to so fast (3,) as it can, and flies so long [s]."""
    assert start.single is not None
    foot, out = start.planted(floor, physique.tables)[start.single], np.empty(4)
    sent_kernel(physique.size, physique.tables.tip, start.centre, start.velocity, foot, goes, floor, gravity, flies, 1.0, out)
    return np.array([out[0], 0.0, out[1]]), np.array([out[2], 0.0, out[3]])


@kernel
def sent_kernel(size, tip, centre, velocity, foot, goes, floor, gravity, flies, longer, out):
    """Write `sent` (4,): how fast, x and z, and where. tip: (3,) as in `BodyTables`. centre, velocity: (3,) of his mass. foot: (5,) that stands. longer: by what his push takes longer than usual."""
    pushes = longer * PUSHES * math.sqrt(size * 9.81 / gravity)
    rate = math.sqrt(gravity * (1.0 + 0.5 * flies / pushes) / max(centre[1] - floor, 0.3 * size))
    cosh, sinh = math.cosh(rate * pushes), math.sinh(rate * pushes)
    wide, s, c = WITHIN[0] * HALF_SOLE * size, math.sin(foot[3]), math.cos(foot[3])
    x = centre[0] + (velocity[0] * cosh - goes[0]) / (rate * sinh) - foot[0]
    z = centre[2] + (velocity[2] * cosh - goes[2]) / (rate * sinh) - foot[2]
    aside = min(max(x * c - z * s, -wide), wide)
    ahead = min(max(x * s + z * c, -WITHIN[1] * size), tip[2] - WITHIN[2] * size)
    for k, pressed in ((0, foot[0] + aside * c + ahead * s), (1, foot[2] - aside * s + ahead * c)):
        here, speed = centre[2 * k] - pressed, velocity[2 * k]
        out[k], out[2 + k] = here * rate * sinh + speed * cosh, pressed + here * cosh + speed * sinh / rate


def airtime(velocity: np.ndarray, size: float) -> float:
    """How long somebody flies on Earth who goes so fast (3,) [m/s], at standard height [s]. size: over an adult's."""
    return float(np.interp(np.linalg.norm(velocity * FLAT) / math.sqrt(size), FASTER, FLIES))


def calm(keys: np.ndarray, start: Start, rows: np.ndarray | int, size: float) -> np.ndarray:
    """The same keys (..., COLUMNS) of the carriage in rows (...), or nearer to how a body of a size over an adult's hangs of who goes slowly, aside or backward; who goes ahead
    swings his arms by turns, as he walks."""
    skips = skipping(start, size)
    if not skips:
        return keys
    pace = max(float(np.linalg.norm(start.velocity * FLAT)), 1e-9)
    ahead = max(float(start.velocity @ yaw(start.heading)[:, 2]) / pace, 0.0)
    calmed = HANGS + (CALM + ahead * AHEAD) * (keys - HANGS)
    swung = ahead * SWINGS[0] * min(pace / (SWINGS[1] * math.sqrt(size)), 1.0) * SWUNG[rows]
    for side, arm in enumerate(ARMS):
        calmed[..., arm] += ahead * (HANGS[arm] - calmed[..., arm])
        calmed[..., arm.start] += -swung if side == start.single else swung
    return keys + skips * (calmed - keys)


def skipping(start: Start, size: float) -> float:
    """How much a leap of a body of a size over an adult's is a skip: all of one that goes slowly, aside or backward, less the nearer he comes to running, nothing of a runner's."""
    if not start.along:
        return 0.0
    ahead = float(start.velocity @ yaw(start.heading)[:, 2]) / math.sqrt(size)
    return float(np.interp(ahead, LIKE, (1.0, 0.0)))


def beside(start: Start, towards: np.ndarray) -> np.ndarray:
    """How far (3,) ahead of him his foot comes down who goes towards (3,) somewhere off the other: not past his middle."""
    assert start.single is not None  # who goes so pushes off one foot
    left = yaw(start.lands)[:, 0]
    across = float(towards @ left)
    return towards + (-across if across * (2 * start.single - 1) < 0.0 else (ASIDE - 1.0) * across) * left


def straight_through(rows: np.ndarray, start: np.ndarray, due: np.ndarray) -> np.ndarray:
    """How his free leg bends (K, 4, 3) [rad] at times due (K,) [s] from how it is, start (4, 3), to the last of rows (K, 4, 3): runners swing it through from behind, his
    may be anywhere, and goes straight there."""
    share = (due / due[-1])[:, None, None]
    rows = start + share**2 * (3.0 - 2.0 * share) * (rows[-1] - start)
    rows[:, :EACH, 0] += 16.0 * (share[..., 0] * (1.0 - share[..., 0]))**2 * max(1.0 - float(start[1, 0]) / BENDS[1], 0.0) * BENDS
    return rows
