"""Which soles stand in recorded takes, told from how low and slow they are."""

from __future__ import annotations

import numpy as np

from ...body import contact_points, detect_contacts, forward_kinematics, point_speeds
from ..pose_vector import FORWARD, LEFTWARD, SKELETON, YAW_RATE, decode
from .database import Database

_CHUNK = 4096  # frames whose contacts are told at once


def contacts(database: Database) -> np.ndarray:
    """Which of left heel, left ball, right heel and right ball stand (N, 4) bool in each frame of a database."""
    found = np.zeros((len(database.frames), 4), bool)
    for take in database.takes:
        found[take.start:take.stop] = standing(database.frames[take.start:take.stop], take.action == "run", database.fps)
    return found


def standing(frames: np.ndarray, running: bool, fps: float) -> np.ndarray:
    """Which of heels and balls stand (T, 4) in frames (T, WIDTH) of a take on the standard body's floor."""
    parts, heights, velocities = np.asarray(frames, float), [], []
    tracks = tracks_of(parts, 1.0 / fps)
    for begin in range(0, len(parts), _CHUNK):
        end = min(begin + _CHUNK, len(parts))
        low, high = max(begin - 1, 0), min(end + 1, len(parts))  # speeds look one frame either way
        points = contact_points(SKELETON, *forward_kinematics(SKELETON, *decode(parts[low:high], tracks[low:high])))
        heights.append(points[begin - low:end - low, :, 1])
        velocities.append(point_speeds(points, 1.0 / fps)[begin - low:end - low])
    return detect_contacts(np.concatenate(heights), np.concatenate(velocities), running=running)


def tracks_of(frames: np.ndarray, dt: float) -> np.ndarray:
    """The ground tracks (T, 3) of a take's frames (T, WIDTH), from the origin on."""
    rates = frames[1:] * dt
    heading = np.concatenate([[0.0], np.cumsum(rates[:, YAW_RATE])])
    c, s = np.cos(heading[:-1]), np.sin(heading[:-1])
    way = np.stack([s * rates[:, FORWARD] + c * rates[:, LEFTWARD], c * rates[:, FORWARD] - s * rates[:, LEFTWARD]], -1)
    return np.concatenate([np.concatenate([np.zeros((1, 2)), np.cumsum(way, 0)]), heading[:, None]], -1)
