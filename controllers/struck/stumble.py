"""Swaying and stumbling: a body over the feet that catch it, its mass centre on the pendulum's way, trunk and arms as recorded people answer a push."""

from __future__ import annotations

import numpy as np

from ..body import yaw
from ..jump.body import FLEX, FOOT_FADE, Physique, Start, carriage, hermite, measures, monotone, turns, vectors
from ..jump.motion import FADE, faded, ground_kernel, swivels
from .capture import DROPS, Way
from .passing import out_of_way, past_kernel
from .swaying import RATE
from .recorded_pushes import SPACED
from .recovery import Recovery

STRAIGHT = 0.975
"""A leg that stands under a stumbling body is no longer than this share of its length, as long as its heel is down."""
BENT = 1.15
"""Hips are off a foot by so many times as much as the mass centre, as a trunk that bends sends them the other way."""
HEELS = 0.14
"""A heel that rises lends a leg that is behind so much [m], at standard height."""
LOWERS = 0.09
"""Who is thrown goes down by this [m], at standard height, for each m/s (recorded: 0.06 … 0.13)."""
LIFTS = 0.045, 0.05
"""A foot swings so high [m] and higher by this share of how far it goes."""
SOFTLY = 8.0
"""In the midst of its swing a leg straightens so many times as softly as one that pushes a jump off (`planted_pose.SOFT`): a knee that is stretched as fast as such
a foot goes would be thrown as it comes to its end."""
CLEARS = 0.6
"""… and by this share of how far it steps up or down: past the edge of the tread."""
CROSSED, CROSSING, BEFOREHAND = 0.8, 0.12, 0.08
"""Who crosses over turns pelvis and trunk by this towards where he goes [rad], in so long [s], and is turned so long before his feet cross and after [s]: thighs would go through each other."""
PEELS = 0.35
"""How far a foot that leaves points down at most [rad]."""
MOST = 1.4
"""Trunk and arms answer no more than to so fast a push [m/s]: that was recorded."""
ROLLS, SPREADS = 0.16, 0.30
"""A push from the side bends the trunk aside by this and spreads the arms by that [rad], for each m/s; built, nobody was recorded."""
COURSE = (0.0, 0.15, 0.4, 0.8, 1.5), (0.0, -0.5, 1.0, 0.5, 0.0)
"""How it goes in time [s]: against the push at first, the trunk being left behind, then with it."""
CHEST = 1.25
"""Where a push strikes that is told nowhere [m], at standard height; pushes at the hips bend the trunk as much the other way."""


RESTED, STILL = 0.25, 0.05
"""So long before its end it is at rest but for trunk and arms [s], if it is slower then than this [m/s]."""
SAID = "pushed, it sways", "pushed, it takes a step", "pushed, it stumbles"
FALLS_OFF = "pushed over an edge"


def stumble(physique: Physique, start: Start, way: Way, free: np.ndarray, response: np.ndarray, floor: float, height: float) -> Recovery:
    """The motion of a body along a way. free: (2,) which feet are in the air. response: (2, ROWS, 11) as fitted. floor: [m] on which it stood. height: [m] over it where it was
    struck."""
    body, size = physique.tables, physique.size
    times = np.arange(len(way.centre)) / RATE
    feet, standing, levels = _feet(start, way, free, body, times)
    centres, velocities = _centres(physique, start, way, feet, standing, levels, times)
    feet = np.concatenate([feet, np.zeros((len(times), 2, 3))], -1)  # the ground is level where one was struck
    feet[..., 8] = swivels(physique, start, times)
    angles, aside = _carriage(start, way, response, times, (height / size - 1.0) / (CHEST - 1.0))
    offsets, turned = _left_over(physique, start, angles[0], times)
    joints = carriage.joints_of(physique.skeleton)
    offsets[:, joints[:3], 2] += aside[:, None] / 3.0
    facing = yaw(start.heading + _turned(feet, start.heading, times)) @ turns(angles[:, :1] * [1.0, 0.0, 0.0])
    roots, local = np.empty((len(times), 3)), np.tile(np.eye(3), (len(times), len(physique.skeleton), 1, 1))
    root, begins = np.array(start.root, float), [0, *(int(round(step[1] * RATE)) for step in way.steps if step[1] > 0.0), len(times)]
    turned = np.ascontiguousarray(turned @ facing)
    for first, last in zip(begins[:-1], begins[1:]):
        if first and first < len(times):
            _leaves(feet, standing, first, times)
        part = slice(first, last)
        made = feet[part].copy()
        ground_kernel(body, FLEX * physique.flexibility, angles[part], joints, offsets[part], turned[part], centres[part], made, root, roots[part], local[part])
        feet[part] = made
        root = roots[last - 1].copy()
    contacts = np.zeros((len(times), 4), bool)
    contacts[:, 1::2] = standing
    contacts[:, ::2] = standing & (feet[..., 4] < 0.03)
    return Recovery(times, roots, local, centres, velocities, contacts, np.full(len(times), start.heading), way.fate, way.caught,
                    way.steps[:, [0, 2]].copy(), float(times[-1]) - RESTED if np.abs(way.velocity[-1]).max() < STILL else np.inf,
                    FALLS_OFF if way.fate == DROPS else SAID[min(way.caught, 2)], _floors(way, floor, times), goes=way.goes)


def _floors(way: Way, floor: float, times: np.ndarray) -> np.ndarray:
    """How high it stands (N,) [m]: as the foot does that came down last on something."""
    floors = np.full(len(times), floor)
    for step in way.steps if way.fate != DROPS else way.steps[:-1]:
        floors[times >= step[2]] = step[6]
    return floors


def _feet(start: Start, way: Way, free: np.ndarray, body, times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The feet (N, 2, 6): balls, yaw, pitch, 1; whether they stand (N, 2); and how high the ground lies (N, 2) [m] where they stand, or will."""
    planted = start.planted(0.0, body)
    under = np.where(free, np.minimum(way.levels, start.feet[:, 1] - body.sole), way.levels)  # a foot in the air may be on its way down, as to a tread
    planted[:, 1] += under
    feet, levels = np.ones((len(times), 2, 6)), np.tile(under, (len(times), 1))
    feet[..., :5] = planted + faded(start.feet - planted, start.feet_rates, FOOT_FADE, times)
    feet[..., 1] = np.maximum(feet[..., 1], planted[:, 1])
    standing = np.tile(~np.asarray(free, bool), (len(times), 1))
    for step in way.steps:
        side, lift, land = int(step[0]), step[1], step[2]
        first, last = int(round(lift * RATE)), int(round(land * RATE))  # who walks on may be gone before it lands
        flight = np.arange(first, min(last + 1, len(times)))
        share = (times[flight] - lift) / (land - lift)
        begin, rate = feet[first, side, :5].copy(), np.zeros(5)
        if lift == 0.0:
            begin, rate = start.feet[side].copy(), start.feet_rates[side].copy()
        low, end = min(float(levels[first, side]), step[6]), np.array([step[3], step[6] + body.sole, step[4], begin[3] + np.remainder(step[5] - begin[3] + np.pi, 2.0 * np.pi) - np.pi, 0.0])
        gone = quintic(begin, rate * (land - lift), end, share)
        far = float(np.hypot(*(end - begin)[[0, 2]]))
        up = 16.0 * share**2 * (1.0 - share) ** 2
        gone[:, 1] = np.maximum(gone[:, 1] + (LIFTS[0] * body.size + LIFTS[1] * far + CLEARS * abs(step[6] - float(levels[first, side]))) * up
                                * (lift > 0.0 or begin[1] - low < 0.1 * body.size), low + body.sole)
        aside = np.empty(2)
        most = past_kernel(begin[[0, 2]], end[[0, 2]], feet[first, 1 - side, [0, 2]], 1.0 - 2.0 * side, start.heading, body.size, aside)
        gone[:, [0, 2]] += np.outer(out_of_way(np.clip(share**3 * (10.0 - 15.0 * share + 6.0 * share**2), 0.0, 1.0), most), aside)
        gone[:, 4] += PEELS * min(far / 0.3, 1.0) * 27.0 / 4.0 * share * (1.0 - share) ** 2 * (lift > 0.0)
        lower = np.sin(np.maximum(-gone[:, 4], 0.0)) * (body.toe[2] - body.heel[2])
        gone[:, 1] = np.maximum(gone[:, 1], low + body.sole + lower)
        levels[first:, side] = step[6]
        feet[flight, side, :5] = gone
        feet[flight, side, 5] += SOFTLY * up
        standing[first:last, side] = False
        feet[last:, side, :5], standing[last:, side] = end, True
    return feet, standing, levels


def _turned(feet: np.ndarray, heading: float, times: np.ndarray) -> np.ndarray:
    """How far (N,) [rad] pelvis and trunk are turned to the left because a foot crosses the other, or stands across it: at first not at all, nor any faster than before."""
    from scipy.ndimage import gaussian_filter1d, maximum_filter1d, minimum_filter1d  # no game waits for it at its start

    apart = (feet[:, 0, [0, 2]] - feet[:, 1, [0, 2]]) @ [np.cos(heading), -np.sin(heading)]
    before = (feet[:, 0, [0, 2]] - feet[:, 1, [0, 2]]) @ [np.sin(heading), np.cos(heading)]
    across = np.where(apart < 0.0, CROSSED * -np.sign(before), 0.0)
    wide, across = 2 * round(BEFOREHAND * RATE) + 1, np.concatenate([np.zeros(len(across)), across])
    across = maximum_filter1d(across, wide, mode="nearest") + minimum_filter1d(across, wide, mode="nearest")
    turned = gaussian_filter1d(across, CROSSING * RATE, mode="nearest")[len(across) - len(apart):]
    return turned - faded(turned[:1], (turned[1:2] - turned[:1]) * RATE, CROSSING, times)[:, 0]


def quintic(begin, rate, end, share):
    """The smoothest way (K, ...) from `begin`, which it leaves with `rate` for the whole way, to rest at `end`: minimum jerk (Flash and Hogan 1985)."""
    s = share[:, None]
    return begin + rate * s * (1.0 - s) ** 3 * (1.0 + 3.0 * s) + (end - begin) * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)


def _leaves(feet: np.ndarray, standing: np.ndarray, first: int, times: np.ndarray) -> None:
    """A foot that leaves goes on from the pitch with which it stood."""
    for side in range(2):
        if standing[first - 1, side] and not standing[first, side]:
            lands = first + int(np.argmax(np.append(standing[first:, side], True)))
            flight = np.arange(first, min(lands, len(times)))
            share = (flight - first) / max(lands - first, 1)
            was = feet[first - 1, side, 4]
            feet[flight, side, 4] += was * (1.0 - share) ** 3 * (1.0 + 3.0 * share)


def _centres(physique: Physique, start: Start, way: Way, feet: np.ndarray, standing: np.ndarray, levels: np.ndarray, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The mass centre (N, 3): along the floor as the pendulum has it, and as low as legs and the push ask. levels: (N, 2) how high the ground lies under the feet [m]."""
    body, size, stand = physique.tables, physique.size, measures(physique).stand
    hips = stand - (physique.skeleton.offsets[0, 1] + physique.skeleton.offsets[body.hip[0], 1])  # the mass centre over the hips
    leg, ankle = STRAIGHT * (body.thigh + body.shank), body.sole - body.toe[1]
    carried = stand + levels.mean(1)
    most = carried.copy()
    for side in range(2):
        facing = np.stack([np.sin(feet[:, side, 3]), np.cos(feet[:, side, 3])], -1)
        foot = feet[:, side, [0, 2]] - body.toe[2] * facing
        off = BENT * np.linalg.norm(way.centre - foot, axis=-1) - abs(physique.skeleton.offsets[body.hip[0], 0]) * 0.5
        behind = ((way.centre - foot) * facing).sum(-1) > 0.0
        reach = leg + np.where(behind, HEELS * size, 0.0)
        high = ankle + np.sqrt(np.maximum(reach**2 - off**2, (0.45 * leg) ** 2)) + hips + levels[:, side]
        most = np.where(standing[:, side], np.minimum(most, high), most)
    pace = np.maximum.accumulate(np.linalg.norm(way.velocity, axis=-1)[::-1])[::-1]
    most = np.minimum(most, carried - LOWERS * size * np.minimum(np.maximum(pace - 0.15, 0.0), MOST) * np.clip(times / 0.3, 0.0, 1.0))
    from scipy.ndimage import gaussian_filter1d, minimum_filter1d  # no game waits for it at its start

    wide = int(0.15 * RATE)
    low = gaussian_filter1d(minimum_filter1d(most, 2 * wide + 1, mode="nearest"), 0.45 * wide, mode="nearest")
    off, rate = start.centre[1] - low[0], start.velocity[1] - (low[1] - low[0]) * RATE
    height = low + faded(np.array([off]), np.array([rate]), 0.12, times)[:, 0]
    centres = np.stack([way.centre[:, 0], height, way.centre[:, 1]], -1)
    velocities = np.stack([way.velocity[:, 0], np.gradient(height, 1.0 / RATE), way.velocity[:, 1]], -1)
    return centres, velocities


def _carriage(start: Start, way: Way, response: np.ndarray, times: np.ndarray, height: float) -> tuple[np.ndarray, np.ndarray]:
    """How trunk and arms are carried (N, 11) [rad], and how far the trunk bends aside (N,), to the left positive."""
    pace = np.linalg.norm(way.velocity, axis=-1)
    top = int(pace[:int(0.6 * RATE)].argmax())
    c, s = np.cos(start.heading), np.sin(start.heading)
    x, z = way.velocity[top] * min(1.0, MOST / max(pace[top], 1e-6))
    ahead, left = s * x + c * z, c * x - s * z
    rows = response[0 if ahead > 0.0 else 1]
    keys = np.arange(len(rows)) * SPACED
    shown = hermite(keys, rows, monotone(keys, rows), np.minimum(times, keys[-1]))
    angles = carriage.STAND + abs(ahead) * shown
    keys, share = np.array(COURSE)
    course = hermite(keys, share, monotone(keys, share), np.minimum(times, keys[-1]))
    lean = float(np.clip(height, -1.0, 1.5))
    aside = -ROLLS * left * lean * course
    spread = SPREADS * abs(left) * np.abs(course)
    angles[:, 5] += spread
    angles[:, 9] -= spread
    angles[:, 6] += 0.6 * spread
    angles[:, 10] += 0.6 * spread
    angles[:, :2] = carriage.STAND[:2] + (angles[:, :2] - carriage.STAND[:2]) * (0.4 + 0.6 * lean)
    return angles, aside


def _left_over(physique: Physique, start: Start, angles: np.ndarray, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What is left (N, J, 3) [rad] of how the body was carried, legs apart, and of how its pelvis was turned (N, 3, 3)."""
    count = len(physique.skeleton)
    local = np.tile(np.eye(3), (count, 1, 1))
    carriage.carry_kernel(angles, carriage.joints_of(physique.skeleton), local)
    local[0] = yaw(start.heading) @ turns(angles[:1] * [1.0, 0.0, 0.0])
    offset, rate = vectors(start.rotations @ np.swapaxes(local, -1, -2)), start.rates.copy()
    legs = (physique.tables.hip[:, None] + np.arange(4)).ravel()
    left = faded(offset, rate, FADE, times)
    left[:, legs] = 0.0
    turned = turns(left[:, 0])
    left[:, 0] = 0.0
    return left, turned
