"""Recorded jumps: where clips fly, where the events of a jump are, and how the body is carried between them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from ...body import Anatomy, Clip, Skeleton, centre_of_mass, contact_points, heading_of, yaw
from ..body import carriage
from .coefficients import ROWS

ALOFT, AROUND = 0.035, 0.6
"""Higher [m] over its lowest place within so many seconds is a foot in the air."""
LASTS, FALLS = (0.2, 0.75), (7.5, 13.5)
"""How long flights of jumps last [s], and how fast their mass centres fall [m/s²]; strides are shorter, climbing does not fall."""
STANDS = 0.1
"""Both feet stand so long [s] before or after a flight off two feet, or onto two."""
STRIKES = 0.25
"""A runner's foot stands so long before take-off at most [s]."""
CROUCHES, BEFORE, RISES, AFTER = 0.6, 0.9, 0.5, 1.0
"""The lowest point is so long before take-off at most, the start before that; as long after touch-down and after that [s]."""


class Recorded(NamedTuple):
    """One recorded jump. single: the foot that it leaves, 0 left, 1 right, None for both. airtime [s]; far: [m] ahead; pace:
    [m/s] at the start. depth: how far its mass centre goes down [m]. events: (6,) frames: start, lowest, take-off, touch-down,
    lowest, upright. keys: (ROWS, COLUMNS) [rad]."""

    clip: str
    time: float
    single: int | None
    airtime: float
    far: float
    pace: float
    depth: float
    events: np.ndarray
    keys: np.ndarray


def bend(turned: np.ndarray) -> np.ndarray:
    """How far rotations (..., 3, 3) turn about x [rad]."""
    return np.arctan2(turned[..., 2, 1], turned[..., 1, 1])


def carried(skeleton: Skeleton, local: np.ndarray, turned: np.ndarray) -> np.ndarray:
    """How poses (T, J, 3, 3), placed (T, J, 3, 3), carry trunk, head, arms and legs: (T, COLUMNS) [rad]."""
    at = skeleton.index
    facing = np.stack([yaw(h) for h in heading_of(turned[:, 0, :, 2])])
    out = [bend(np.swapaxes(facing, -1, -2) @ turned[:, 0]), bend(local[:, at("Spine")] @ local[:, at("Spine1")] @ local[:, at("Spine2")]),
           bend(local[:, at("Neck")] @ local[:, at("Head")])]
    for side, name in ((1.0, "Left"), (-1.0, "Right")):
        upper, along = local[:, at(name + "Shoulder")] @ local[:, at(name + "Arm")], local[:, at(name + "ForeArm"), :, 0]
        # turned about its own bone until the elbow is the hinge that `carriage` has
        twist = np.arctan2(-side * along[:, 1], side * along[:, 2])[:, None] * [1.0, 0.0, 0.0]
        arm = Rotation.from_matrix(upper @ Rotation.from_rotvec(twist).as_matrix() @ carriage.hanging(side).T).as_rotvec()
        out += [*continued(arm).T, np.arccos(np.clip(along[:, 0], -1.0, 1.0))]
    out += [bend(local[:, at(name + part)]) for name in ("Left", "Right") for part in ("UpLeg", "Leg", "Foot")]
    return np.stack(out, -1)


def continued(vectors: np.ndarray) -> np.ndarray:
    """Rotation vectors (T, 3) without jumps by a whole turn."""
    out = vectors.copy()
    for n in range(1, len(out)):
        angle = float(np.linalg.norm(out[n]))
        if angle > 1e-6:
            other = out[n] * (1.0 - 2.0 * np.pi / angle)
            if np.linalg.norm(other - out[n - 1]) < np.linalg.norm(out[n] - out[n - 1]):
                out[n] = other
    return out


def flights(skeleton: Skeleton, anatomy: Anatomy, clip: Clip, lasts: tuple[float, float] = LASTS) -> Iterator[tuple[int, int]]:
    """First and last frame in the air of every jump of a clip that flies for so long [s]."""
    positions, turned = clip.kinematics()
    low = contact_points(skeleton, positions, turned)[..., 1].min(-1)
    reach = max(round(AROUND / clip.frame_time), 1)
    floor = np.array([low[max(n - reach, 0):n + reach + 1].min() for n in range(len(low))])
    height = centre_of_mass(anatomy, positions, turned)[:, 1]
    for first, last in np.flatnonzero(np.diff(np.pad((low - floor > ALOFT).astype(int), 1))).reshape(-1, 2):
        count, time = last - first, np.arange(len(low)) * clip.frame_time
        if not lasts[0] < count * clip.frame_time < lasts[1] or first < 3 or last > len(low) - 4:
            continue
        inner = slice(first + max(count // 6, 1), last - max(count // 6, 1))
        if inner.stop - inner.start < 3:
            continue
        if FALLS[0] < -2.0 * np.polyfit(time[inner] - time[first], height[inner], 2)[0] < FALLS[1]:
            yield int(first), int(last)


def jumps(skeleton: Skeleton, anatomy: Anatomy, clip: Clip) -> Iterator[Recorded]:
    """Every jump of a clip, aligned at its events. Hops on one foot are left out, and what begins or ends with the clip."""
    positions, turned = clip.kinematics()
    centre, step = centre_of_mass(anatomy, positions, turned), clip.frame_time
    height, flow = centre[:, 1], np.gradient(centre, step, axis=0)
    feet = contact_points(skeleton, positions, turned)[..., 1].reshape(-1, 2, 2).min(-1)
    columns = carried(skeleton, clip.rotations, turned)

    def frames(seconds: float) -> int:
        return max(round(seconds / step), 2)
    for first, last in flights(skeleton, anatomy, clip):
        floor = feet[max(first - frames(AROUND), 0):last + frames(AROUND)].min()
        before = feet[max(first - frames(STANDS), 0)] - floor < 0.06
        single = None if before.all() else int(before[1])
        lands = feet[min(last + frames(STANDS), len(feet) - 1)] - floor < 0.06
        pace = float(np.hypot(*flow[max(first - frames(0.3), 0), [0, 2]]))
        if single is None and not lands.all() or single is not None and (pace < 1.5 or not before.any()):
            continue
        if single is None:
            lowest = max(first - frames(CROUCHES), 0) + int(height[max(first - frames(CROUCHES), 0):first].argmin())
            begins = max(lowest - frames(BEFORE), 0)
            flew = np.flatnonzero(feet[begins:lowest].min(-1) - floor > ALOFT)
            begins += int(flew[-1]) + 1 if len(flew) else 0
            begins += int(height[begins:lowest + 1].argmax())
        else:  # from its last foot-strike on
            begins = first - 1
            while begins > 0 and feet[begins - 1, single] - floor < 0.06 and begins > first - frames(STRIKES):
                begins -= 1
            lowest = begins + int(height[begins:first].argmin())
            lowest = min(max(lowest, begins + (first - begins) // 4), first - 2)
        landed = last + int(height[last:last + frames(RISES)].argmin())
        upright = landed + int(height[landed:landed + frames(AFTER)].argmax())
        events = np.array([begins, lowest, first, last, landed, upright])
        if (np.diff(events) < 2).any():
            continue
        ahead = yaw(float(heading_of(turned[first, 0][:, 2])))[:, 2]
        yield Recorded(clip.name, first * step, single, (last - first) * step, float((centre[last] - centre[first]) @ ahead),
                       float(flow[begins] @ ahead), float(height[begins] - height[lowest]), events, aligned(columns, events))


def aligned(columns: np.ndarray, events: np.ndarray) -> np.ndarray:
    """The keys (ROWS, COLUMNS) through which straight lines come nearest to columns (T, COLUMNS) between events (6,)."""
    rows = np.interp(np.linspace(0.0, 5.0, ROWS), np.arange(6), events)
    frames = np.linspace(events[0], events[-1], 12 * ROWS)
    hats = np.stack([np.interp(frames, rows, row) for row in np.eye(ROWS)], -1)
    shown = np.stack([np.interp(frames, np.arange(len(columns)), column) for column in columns.T], -1)
    return np.linalg.lstsq(hats, shown, rcond=None)[0]
