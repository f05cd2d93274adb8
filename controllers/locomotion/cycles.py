"""Gait cycles: from a clip on the standard human to aligned, periodic samples.

A cycle runs from one left toe-off to the next (Truong 2010, section II.B). Its mean velocity is
the constant screw of the mid-shoulder ground frame over the cycle, and its samples are taken on
a common phase in which the four gait events of all cycles coincide, so that blending two of
them never adds a heel strike to a toe-off.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..body import CONTACT_HEIGHT, Clip, advance, compose, contact_points, relative, rotations as rot, screw

RATE = 120.0
"""Frames a second at which clips are analysed."""
ACCELERATION_RATE = 30.0
"""Frames a second at which accelerations are compared: the slowest recordings' rate."""
SAMPLES = 96
"""Samples of one cycle on the common phase."""
EVENTS = {"walk": np.array([0.0, 0.38, 0.50, 0.88]), "run": np.array([0.0, 0.22, 0.50, 0.72])}
"""Phases of the four events: LTO, LHS, RTO, RHS in a walk; LTO, RHS, RTO, LHS in a run."""
CONTACT_SPEED = {"walk": 0.5, "run": 1.4}
"""A foot stands while its heel or ball is slower than this [m/s] …"""
STANDING_SPEED = {"walk": 0.35, "run": 1.0}
"""… and a single point (heel or ball) is labelled as standing below this [m/s] …"""
CONTACT_GATE = 0.05
"""… and lower than this above where it rests [m]."""

SEAM = 4
"""How far apart the frames are by which speeds are told where a cycle begins and where it ends."""


@dataclass(frozen=True, eq=False)
class Cycle:
    """One gait cycle, sampled at S phases φ = s / S of the common phase.

    clip, start [s], period [s]: where it was recorded. family: "walk" or "run".
    velocity: (3,) mean (v_f, ω, v_l). events: (4,) when its events fell, as fractions of the period.
    closure: RMS joint angle between first and last frame [rad].
    rotations: (S, J, 3, 3) local rotations, the root's relative to the ground frame.
    hips: (S, 3) [m] the root joint in the ground frame. labels: (S, 4) how much left heel, left
    ball, right heel, right ball stand, 0 … 1. duration: (S,) [s] dt/dφ; its mean is the period.
    """

    clip: str
    start: float
    period: float
    family: str
    velocity: np.ndarray
    events: np.ndarray
    closure: float
    rotations: np.ndarray
    hips: np.ndarray
    labels: np.ndarray
    duration: np.ndarray


@dataclass(frozen=True, eq=False)
class Track:
    """A clip prepared for cutting: T frames at RATE on the standard human.

    ground: (T, 3) raw x, z, heading of the mid-shoulder point. points: (T, 4, 3) left heel, left
    ball, right heel, right ball [m]. speeds: (T, 4) of those [m/s]. acceleration: (F, J) [m/s²] of
    all joints as recorded, at ACCELERATION_RATE.
    """

    clip: Clip
    ground: np.ndarray
    points: np.ndarray
    speeds: np.ndarray
    acceleration: np.ndarray


def track(clip: Clip) -> Track:
    """Ground frame and foot points of a clip that already is on the standard human."""
    from scipy.ndimage import uniform_filter1d  # here, as below: only who builds a library needs these parts of scipy

    acceleration = joint_acceleration(clip.kinematics()[0], clip.frame_time)
    clip = clip.resample(RATE)
    positions, orientations = clip.kinematics()
    at = clip.skeleton.index
    left, right = positions[:, at("LeftArm")], positions[:, at("RightArm")]
    middle, across = 0.5 * (left + right), left - right
    heading = np.unwrap(rot.heading_of(np.cross(across, [0.0, 1.0, 0.0])))
    points = contact_points(clip.skeleton, positions, orientations)
    speeds = np.linalg.norm(np.gradient(points, 1 / RATE, axis=0), axis=-1)
    return Track(clip, np.stack([middle[:, 0], middle[:, 2], heading], -1), points,
                 uniform_filter1d(speeds, 5, axis=0), acceleration)


def joint_acceleration(positions: np.ndarray, frame_time: float) -> np.ndarray:
    """Accelerations (F, J) [m/s²] of joint positions (T, J, 3), from whole frames about 1/30 s apart.

    Frames are skipped, never made up: interpolation would put its own corners into the figure.
    """
    stride = max(1, round(1 / (ACCELERATION_RATE * frame_time)))
    step = positions[::stride]
    return np.linalg.norm(np.diff(step, 2, axis=0), axis=-1) / (stride * frame_time) ** 2


def stance(track: Track, family: str) -> np.ndarray:
    """Which foot stands: (T, 2) bool, left and right, without gaps or contacts too short to be real."""
    low = track.points[..., 1] < CONTACT_HEIGHT + CONTACT_GATE
    point = low & (track.speeds < CONTACT_SPEED[family])
    feet = np.stack([point[:, :2].any(1), point[:, 2:].any(1)], 1)
    shortest = int((0.06 if family == "run" else 0.10) * RATE)
    for foot in feet.T:
        drop_short(foot, int(0.06 * RATE), False)
        drop_short(foot, shortest, True)
    return feet


def drop_short(mask: np.ndarray, shortest: int, value: bool) -> None:
    """Flip, in place, the inner runs of `value` shorter than `shortest` frames."""
    edges = np.flatnonzero(np.diff(mask)) + 1
    bounds = np.concatenate([[0], edges, [len(mask)]])
    for a, b in zip(bounds[1:-2], bounds[2:-1]):
        if mask[a] == value and b - a < shortest:
            mask[a:b] = not value


def cut(track: Track, family: str) -> list[Cycle]:
    """All whole cycles of a clip whose four events come in the family's order."""
    feet = stance(track, family)
    change = np.diff(feet.astype(int), axis=0)
    lto, lhs = np.flatnonzero(change[:, 0] < 0) + 1, np.flatnonzero(change[:, 0] > 0) + 1
    rto, rhs = np.flatnonzero(change[:, 1] < 0) + 1, np.flatnonzero(change[:, 1] > 0) + 1
    inner = (lhs, rto, rhs) if family == "walk" else (rhs, rto, lhs)
    labels = labels_of(track, feet, family)
    cycles = []
    for a, b in zip(lto[:-1], lto[1:]):
        marks = [x[(x > a) & (x < b)] for x in inner]
        if all(len(m) == 1 for m in marks) and marks[0] < marks[1] < marks[2] and 0.4 < (b - a) / RATE < 2.6:
            frames = np.array([a, *(m[0] for m in marks), b])
            if np.min(np.diff(frames)) >= 0.03 * RATE:
                cycles.append(_cycle(track, labels, frames, family))
    return cycles


def labels_of(track: Track, feet: np.ndarray, family: str) -> np.ndarray:
    """How much each point stands (T, 4) in 0 … 1: edges softened over 60 ms, gone in the swing."""
    from scipy.ndimage import uniform_filter1d

    low = track.points[..., 1] < CONTACT_HEIGHT + CONTACT_GATE
    point = low & (track.speeds < STANDING_SPEED[family]) & np.repeat(feet, 2, axis=1)
    return uniform_filter1d(point.astype(float), int(0.06 * RATE), axis=0)


def steady_frame(ground: np.ndarray, period: float) -> tuple[np.ndarray, np.ndarray]:
    """The ground frame that moves at constant velocity and about which the shoulders sway evenly.

    ground: (T, 3) raw frames, first and last at the same phase. Returns the first steady frame
    (3,) and the velocity (3,).
    """
    times = np.linspace(0.0, period, len(ground))
    first, last = ground[0], ground[-1]
    for _ in range(3):
        velocity = screw(first, last, period)
        sway = relative(advance(first, velocity, times), ground)[:-1].mean(0)
        first, last = compose(first, sway), compose(last, sway)
    return first, screw(first, last, period)


def warp(events: np.ndarray, canonical: np.ndarray, phase: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Time (as a fraction of the period) at common phases, and its derivative; smooth and monotone.

    events, canonical: (4,) when the events fall in this cycle and on the common phase.
    """
    from scipy.interpolate import PchipInterpolator

    turns = np.arange(-2, 3)[:, None]
    curve = PchipInterpolator((canonical + turns).ravel(), (events + turns).ravel())
    return curve(phase), curve(phase, 1)


def _cycle(track: Track, labels: np.ndarray, frames: np.ndarray, family: str) -> Cycle:
    a, b = frames[0], frames[-1]
    period = (b - a) / RATE
    events = (frames[:4] - a) / (b - a)
    first, velocity = steady_frame(track.ground[a:b + 1], period)
    phase = np.arange(SAMPLES) / SAMPLES
    fraction, slope = warp(events, EVENTS[family], phase)
    quaternions = track.clip.quaternions[a:b + 1]
    local = rot.Rotation.from_quat(quaternions).as_matrix()
    ground = advance(first, velocity, np.linspace(0.0, period, b - a + 1))
    local[:, 0] = np.swapaxes(rot.yaw(ground[:, 2]), -1, -2) @ local[:, 0]
    turn = rot.log(np.swapaxes(local[0], -1, -2) @ local[-1])
    closure = float(np.sqrt(np.mean(np.sum(turn**2, -1))))

    # interpolate in a chart around each joint's mean, where a gait stays far from ±π
    reference = rot.mean(local)
    chart = rot.log(np.swapaxes(reference, -1, -2) @ local)
    root = track.clip.root[a:b + 1]
    middle = relative(ground, np.stack([root[:, 0], root[:, 2], ground[:, 2]], -1))
    hips = np.stack([middle[:, 0], root[:, 1], middle[:, 1]], -1)
    chart, hips = _close(chart, fraction), _close(hips, fraction, True)
    soft = np.stack([np.interp(fraction * (b - a), np.arange(b - a + 1), x) for x in labels[a:b + 1].T], -1)
    return Cycle(track.clip.name, a / RATE, period, family, velocity, events, closure,
                 reference @ rot.exp(chart), hips, soft, period * slope)


def _close(signal: np.ndarray, fraction: np.ndarray, smoothly: bool = False) -> np.ndarray:
    """A signal (T, ...) over one cycle, at `fraction` (S,) of the period: what it drifts by is spread evenly, and, smoothly,
    what it is faster by in the end, too, so that its speed does not jump where the cycle begins again."""
    time = np.linspace(0.0, 1.0, len(signal)).reshape((-1,) + (1,) * (signal.ndim - 1))
    closed = signal - (signal[-1] - signal[0]) * (time - 0.5)
    if smoothly:
        k = min(SEAM, (len(closed) - 1) // 2)
        ends = closed[[0, k, 2 * k, -1 - 2 * k, -1 - k, -1]]
        faster = (3 * ends[5] - 4 * ends[4] + ends[3] + 3 * ends[0] - 4 * ends[1] + ends[2]) * ((len(closed) - 1) / (2 * k))
        closed = closed - 0.5 * faster * (time**2 - time + 1 / 6)
    at = fraction * (len(signal) - 1)
    low = np.minimum(at.astype(int), len(signal) - 2)
    part = (at - low).reshape((-1,) + (1,) * (signal.ndim - 1))
    return closed[low] * (1 - part) + closed[low + 1] * part
