"""Where feet stand and come down, on level ground and on slopes.

A foot is told by the place of its ball [m], its yaw and how far it points down [rad], from the ground that it stands on: on a slope its sole lies in it.
"""

from __future__ import annotations

import numpy as np

from ...body import HALF_SOLE, yaw
from .balance import HALF_STANCE
from .dynamics import BodyTables

LEVEL = np.zeros(2)
"""How ground rises along x and z that does not [m/m]."""
NARROW = 0.015
"""How far to its side a foot comes down on which one runs on [m], at standard height."""


def rise(way: np.ndarray, slope: np.ndarray) -> np.ndarray:
    """How much higher (...) ground that rises by slope (2,) [m/m] is by a way (..., 2) along x and z [m]."""
    return way[..., 0] * slope[0] + way[..., 1] * slope[1]


def raised(body: BodyTables, slope: np.ndarray) -> float:
    """How high a ball is over ground that rises by slope (2,) [m/m], right above it [m]: farther than from its plane."""
    return body.sole * float(np.sqrt(1.0 + slope @ slope))


def uphill(feet: np.ndarray, slope: np.ndarray) -> np.ndarray:
    """How steeply (F,) [rad] feet (F, 5) point up that stand flat on ground that rises by slope (2,) [m/m]."""
    return np.arctan(rise(np.stack([np.sin(feet[:, 3]), np.cos(feet[:, 3])], -1), slope))


def standing(count: int, slope: np.ndarray) -> np.ndarray:
    """Rows (count, 2, 9) of feet for `planted_pose.leg_kernel`, to be filled in: heels free to rise, on ground that rises by slope (2,) [m/m], knees not turned aside."""
    feet = np.ones((count, 2, 9))
    feet[..., 6:8], feet[..., 8] = slope, 0.0
    return feet


def soles(feet: np.ndarray, body: BodyTables, slope: np.ndarray = LEVEL) -> np.ndarray:
    """The corners (4 F, 3) [m] of the soles of feet (F, 5) that stand flat on ground that rises by slope (2,) [m/m]: heels and tips."""
    half = HALF_SOLE * body.size
    corners = np.array([(side * half, 0.0, along) for along in (body.heel[2] - body.toe[2], body.tip[2]) for side in (-1.0, 1.0)])
    found = []
    for foot in feet:
        aside = corners @ yaw(foot[3]).T
        aside[:, 1] = rise(aside[:, [0, 2]], slope) - raised(body, slope)
        found.append(foot[:3] + aside)
    return np.concatenate(found)


def landing_feet(place: np.ndarray, heading: float, body: BodyTables, slope: np.ndarray = LEVEL) -> np.ndarray:
    """Two feet (2, 5) whose soles' middle is at `place` (3,), toes slightly out, on ground that rises by slope (2,) [m/m]."""
    middle = 0.5 * (body.heel[2] - body.toe[2] + body.tip[2])
    feet = np.zeros((2, 5))
    for side, sign in enumerate((1.0, -1.0)):
        feet[side, 3] = heading + sign * 0.08
        ball = np.array([sign * HALF_STANCE * body.size, 0.0, 0.0])
        way = yaw(heading) @ ball - yaw(feet[side, 3]) @ [0.0, 0.0, middle]
        feet[side, :3] = place + way + np.array([0.0, raised(body, slope) + rise(way[[0, 2]], slope), 0.0])
    return feet


def striding_feet(place: np.ndarray, heading: float, body: BodyTables, side: int, slope: np.ndarray = LEVEL) -> np.ndarray:
    """Two feet (2, 5) of which that on a side, 0 left or 1 right, comes down at `place` (3,), a little to its side, on ground that rises by slope (2,) [m/m]."""
    feet = landing_feet(place, heading, body, slope)
    way = (1 - 2 * side) * (HALF_STANCE - NARROW) * body.size * yaw(heading)[:, 0]
    feet[:, :3] -= way + np.array([0.0, float(rise(way[[0, 2]], slope)), 0.0])
    return feet
