"""Standing about: weight shifts, glances and idle hands, as they were recorded, in an order that never repeats.

Stretches in which somebody's feet stay are kept as uniform cubic B-splines of the standing pose's columns. Wherever
two moments of them are alike one may follow the other, so that a short recording goes on for ever: a chain that a
character's own luck leads. A character's luck is part of its state, so the same log shows the same idling.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..body import contact_points, forward_kinematics, rotations as rot, spring_kernel
from ..compiled import kernel
from .arms_apart import apart
from .cycles import RATE, Track
from .kernel import COLUMNS, LABELS_AT
from .library import Idle, Library
from .spline import in_columns, spline_kernel

PER_SECOND = 5
"""Spline coefficients a second: glances take about half a second."""
STILL, LONGEST_STEP = 0.2, 0.05
"""Feet stay while all their points are slower than this [m/s], and no farther [m] from where they were on average."""
SHORTEST = 10.0
"""Shorter stretches are not kept [s]."""
APART = 4.0
"""Moments nearer to each other than this [s] do not follow one another."""
ALIKE = 20
"""The share of moments [%], the most alike ones, at which the chain may leave."""
LEAVES = 0.18
"""How likely it does where it may."""
LOOKS_AHEAD = 0.4
"""A difference of 1 m/s between two moments counts as this many metres."""
AFTER, COMES, GOES = 1.0, 0.8, 0.25
"""Somebody who stands begins to idle after this time [s], within this half-life [s], and stops within this one [s]."""
CRAMPED = 0.3
"""So much of it is shown where arms have no room."""
ENDS = 5
"""So many coefficients before the end of a stretch it must be left."""
FADE = 0.35
"""Half-life of what is left of one moment where another follows it [s]."""


class Idling(NamedTuple):
    """What the step must know: the coefficients (K, COLUMNS) beyond the standing pose, for each which may follow it
    (K,), or −1, and whether one must, since its stretch ends."""

    coefficients: np.ndarray
    follows: np.ndarray
    must: np.ndarray


def idle_of(tracks: Sequence[Track], reference: np.ndarray, rest: np.ndarray) -> Idle | None:
    """The longest stretches of some tracks in which somebody stands about; None where there are none.

    reference: (J, 3, 3). rest: (3 J + 3,) the standing pose in the library's columns: feet that stay are laid onto its.
    """
    found = [part for part in (_stretch(track, reference, rest) for track in tracks) if part is not None]
    if not found:
        return None
    return Idle(np.concatenate(found).astype(np.float32), np.cumsum([len(part) for part in found]))


def _stretch(track: Track, reference: np.ndarray, rest: np.ndarray) -> np.ndarray | None:
    """The longest stretch of one track as spline coefficients (K, 3 J + 3), relative to `rest`."""
    from scipy.interpolate import make_lsq_spline
    from scipy.ndimage import uniform_filter1d

    quiet = (uniform_filter1d(track.speeds, int(0.2 * RATE), axis=0) < STILL).all(-1)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], quiet.astype(int), [0]])))
    if not len(edges):
        return None
    a, b = max(edges.reshape(-1, 2), key=lambda span: span[1] - span[0])
    flat = track.points[a:b, :, [0, 2]]
    far = np.linalg.norm(flat - flat.mean(0), axis=-1).max() if b > a else np.inf
    if b - a < SHORTEST * RATE or far > LONGEST_STEP:
        return None
    local, root = track.clip.slice(a, b).rotations.copy(), track.clip.root[a:b].copy()
    turn, shift = onto(flat.mean(0), _rest_feet(track, reference, rest))
    local[:, 0] = rot.yaw(turn) @ local[:, 0]
    root = root @ rot.yaw(turn).T + [shift[0], 0.0, shift[1]]
    local = apart(track.clip.skeleton, root, local, RATE)
    chart = rot.continuous(rot.log(np.swapaxes(reference, -1, -2) @ local)).reshape(b - a, -1)
    rows = np.concatenate([chart, root], -1) - rest
    count = int((b - a) / RATE * PER_SECOND)
    x = np.linspace(0.0, count - 3, b - a)
    return make_lsq_spline(x, rows, np.arange(-3.0, count + 1.0), k=3).c


def _rest_feet(track: Track, reference: np.ndarray, rest: np.ndarray) -> np.ndarray:
    """Where the standing pose's heels and balls are (4, 2), x and z."""
    local = reference @ rot.exp(rest[:-3].reshape(-1, 3))
    return contact_points(track.clip.skeleton, *forward_kinematics(track.clip.skeleton, rest[-3:], local))[:, [0, 2]]


def onto(points: np.ndarray, goal: np.ndarray) -> tuple[float, np.ndarray]:
    """The turn [rad] and shift (2,) that lay points (N, 2) x, z onto others best."""
    p, g = points - points.mean(0), goal - goal.mean(0)
    turn = float(np.arctan2((p[:, 1] * g[:, 0] - p[:, 0] * g[:, 1]).sum(), (p * g).sum()))
    c, s = np.cos(turn), np.sin(turn)
    x, z = points.mean(0)
    return turn, goal.mean(0) - [c * x + s * z, c * z - s * x]


def idling(library: Library) -> Idling:
    """The kernel's view of a library's idle: none at all where it has none."""
    if library.idle is None:
        return Idling(np.zeros((0, COLUMNS), np.float32), np.zeros(0, np.int64), np.zeros(0, np.bool_))
    coefficients, ends = library.idle
    return Idling(in_columns(coefficients), *_follows(library, coefficients, ends))


def _follows(library: Library, coefficients: np.ndarray, ends: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """For every coefficient the one that may follow it, or −1, and whether one must."""
    rest = library.coefficients[library.rest, 0]
    rows = coefficients + rest[:coefficients.shape[1]]
    local = library.reference @ rot.exp(rows[:, :-3].reshape(len(rows), -1, 3))
    places = forward_kinematics(library.skeleton, rows[:, -3:], local)[0].reshape(len(rows), -1)
    speeds = np.asarray(np.gradient(places, 1.0 / PER_SECOND, axis=0))
    features = np.concatenate([places, LOOKS_AHEAD * speeds], -1).astype(np.float32)
    square = (features**2).sum(-1)
    apart = np.sqrt(np.maximum(square[:, None] + square - 2.0 * features @ features.T, 0.0))
    number = np.arange(len(rows))
    apart[np.abs(number[:, None] - number) < APART * PER_SECOND] = np.inf
    must = np.zeros(len(rows), bool)  # from here a stretch has no four coefficients ahead, nor can one come here
    for end in ends:
        must[max(end - ENDS, 0):end] = True
    apart[:, must] = np.inf
    nearest, distance = apart.argmin(1), apart.min(1)
    may = must | (distance <= np.percentile(distance, ALIKE))
    return np.where(may, nearest, -1).astype(np.int64), must


@kernel
def idle_kernel(m, idle, liveliness, dt):
    """Lead a character's idling on by dt: how far it shows, where in the recordings it is, what it comes to next."""
    if idle.coefficients.shape[0] <= ENDS:
        return
    m.rested = m.rested + dt if m.settled else 0.0
    shows = liveliness * (CRAMPED if m.cramped else 1.0) if m.rested > AFTER and not m.alert else 0.0
    m.presence, m.presence_rate = spring_kernel(m.presence, m.presence_rate, shows, COMES if shows > m.presence else GOES, dt)
    before = int(m.moment)
    m.moment += dt * PER_SECOND
    now = int(m.moment)
    if now == before:
        return
    luck = np.uint32(m.luck)  # xorshift, Marsaglia 2003
    luck ^= np.uint32(luck << np.uint32(13))
    luck ^= np.uint32(luck >> np.uint32(17))
    luck ^= np.uint32(luck << np.uint32(5))
    m.luck = luck
    follows = idle.follows[now]
    if follows < 0 or not (idle.must[now] or luck < LEAVES * 4294967296.0):
        return
    there = follows + (m.moment - now)
    if m.presence > 1e-4:  # who walks fades nothing
        for d in range(LABELS_AT):
            was, was_rate = spline_kernel(idle.coefficients, d, m.moment)
            comes, comes_rate = spline_kernel(idle.coefficients, d, there)
            m.blend[d] += m.presence * (was - comes)
            m.blend_rate[d] += m.presence * (was_rate * PER_SECOND - comes_rate * PER_SECOND)
        m.fade = FADE
    m.moment = there


@kernel
def add_idle(m, idle, row):
    """Add to a row (COLUMNS,) what a character's idling shows."""
    if m.presence > 1e-4:
        for d in range(LABELS_AT):
            row[d] += m.presence * spline_kernel(idle.coefficients, d, m.moment)[0]
