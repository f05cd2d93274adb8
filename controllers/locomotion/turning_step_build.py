"""How recorded people turn from rest: two steps with a pivot, into a walk another way or on the spot.

Wherever somebody stands, steps with the foot of the side that he turns to and then with the other, the whole of it is told
over the gait's phase: pose, contact labels, how long a phase lasts, and how the ground frame moves. What such turns have in
common, over how far they turn, is a primitive; it ends in the gait's own phase, walking or standing.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..body import compose, contact_points, forward_kinematics, mirror_index, relative, rotations as rot, screw
from .cycles import RATE, Track, labels_of
from .first_stride_build import smooth, steps, strides
from .idle import onto
from .library import HIPS, Library, Turn
from .turning_step import BEFORE, END, PER_CYCLE, SHIFTS, SPOT, WAITING, WALKS, features

STILL = {WALKS: 0.77, SPOT: 0.25}
"""Both feet stood for this long [s] before, and after a turn on the spot."""
LEAVES, STAYS = 0.45, 0.3
"""Who is faster ahead than the first [m/s] after two steps, and than twice to the side, walks, who has moved no farther than the second [m] is on the spot."""
LEAST, MOST = {WALKS: -0.3, SPOT: 0.5}, {WALKS: 3.3, SPOT: 2.1}
"""Turns smaller than the first [rad] are none; nor are larger ones than the second."""
SMOOTH = 0.08
"""The standard deviation [s] of the filter that takes what shakes from the ground frame's way."""
LIFTS = 0.03
"""On the spot the first foot is told to stand until so long before it leaves, in phase."""
ASIDE = np.array([-1.0, 1.0, 1.0])
"""Left and right exchanged."""
ALIKE = 0.35
"""Turns as alike as this [rad] count as one together, so that those of all sizes count alike."""
NEARLY_NONE = 0.5
"""Turns of which none is smaller than this [rad] are told by a line only, since smaller ones are made of it, too."""
FEWEST = 6
"""From fewer turns than this no primitive is made."""


class Sample(NamedTuple):
    """One recorded turn. rows: (2, G, 3 J + 11) at the phases of `grid`, told to the left with the left foot first, and to the right.
    turn: how far [rad]. clip, start [s]: where it was found."""

    rows: np.ndarray
    turn: float
    clip: str
    start: float


def grid() -> np.ndarray:
    """The phases (G,) since the first toe-off at which turns are compared: four for each spline coefficient."""
    x = np.arange(0.0, WAITING + END * PER_CYCLE + 0.25, 0.25)
    return np.where(x < WAITING, (x / WAITING - 1.0) * BEFORE, (x - WAITING) / PER_CYCLE)


def turns(stills: Sequence[Track], tracks: Sequence[Track], library: Library) -> Turn | None:
    """The turning primitives of some tracks' people, None where there are too few turns of either kind. stills: the tracks of whom
    standing and setting off are from."""
    kinds = [[sample for track in group for sample in samples(track, library, kind)] for kind, group in ((WALKS, stills), (SPOT, tracks))]
    if min(map(len, kinds)) < FEWEST:
        return None
    return Turn(np.stack([np.stack([fitted(np.stack([s.rows[foot] for s in found]), np.array([s.turn for s in found])) for foot in range(2)])
                          for found in kinds]))


def fitted(rows: np.ndarray, turned: np.ndarray) -> np.ndarray:
    """Spline coefficients (F, K, D) of what N turns (N, G, D) have in common, over how far they turn (N,)."""
    from scipy.interpolate import make_lsq_spline

    told = features(turned)
    if not turned.min() < NEARLY_NONE:
        told = told[:, :2]
    line = np.zeros((3,) + rows.shape[1:])
    weight = 1.0 / np.sqrt((np.abs(turned[:, None] - turned) < ALIKE).sum(1))[:, None]
    line[:told.shape[-1]] = np.linalg.lstsq(weight * told, weight * rows.reshape(len(rows), -1), rcond=None)[0].reshape((-1,) + rows.shape[1:])
    count = WAITING + int(np.ceil(END * PER_CYCLE))
    x = np.arange(len(grid())) * 0.25
    return make_lsq_spline(x, np.moveaxis(line, 1, 0), np.arange(-3.0, count + 4.0), k=3).c.swapaxes(0, 1)


def samples(track: Track, library: Library, kind: int) -> list[Sample]:
    """The turns of one track: from standing, two steps, the first with the foot of that side; then walking on, or standing."""
    feet, result = steps(track), []
    both = np.asarray(feet.all(1), bool)
    for frames, phases in strides(feet):
        for k in range(len(frames) - 3):
            first = int(phases[k] % 1.0 > 0.25)
            a, b = frames[k], frames[k + 3]
            if phases[k] % 0.5 > 0.01 or a < SHIFTS[kind] * RATE or not both[max(a - int(STILL[kind] * RATE), 0):a].all():
                continue
            if kind == SPOT and not both[b:b + int(STILL[kind] * RATE)].all():
                continue
            at = _moments(frames[k:], phases[k:] - phases[k], kind, len(feet))
            sample = at is not None and _told(track, feet, library, at, first, kind)
            if sample:
                result.append(sample)
    return result


def _moments(frames: np.ndarray, phases: np.ndarray, kind: int, length: int) -> np.ndarray | None:
    """When in frames (G,) the phases of `grid` are; None where the clip ends before. phases: since the first toe-off."""
    from scipy.interpolate import PchipInterpolator

    if kind == SPOT or len(frames) < 5:  # what comes after it is no part of it
        frames, phases = np.append(frames[:4], frames[3] + int(STILL[kind] * RATE)), np.append(phases[:4], 1.0)
    u = grid()
    at = np.where(u < 0.0, frames[0] + u / BEFORE * SHIFTS[kind] * RATE, PchipInterpolator(phases, frames)(np.maximum(u, 0.0)))
    return at if at[-1] < length - 1 else None


def _told(track: Track, feet: np.ndarray, library: Library, at: np.ndarray, first: int, kind: int) -> Sample | None:
    """One turn at frames (G,), if it is one of that kind."""
    from scipy.ndimage import gaussian_filter1d

    seconds, at = at / RATE, at.round().astype(int)
    span = np.arange(max(at[0] - int(0.3 * RATE), 0), min(at[-1] + int(0.3 * RATE), len(feet)))
    way = gaussian_filter1d(track.ground[span], SMOOTH * RATE, axis=0, mode="nearest")
    frame = way[at - span[0]]
    stood = _frame_of(track, library, at[0])
    off = relative(frame[0], stood)
    off[2] = (off[2] + np.pi) % (2.0 * np.pi) - np.pi
    fades = 1.0 - smooth(np.linspace(0.0, 1.0, len(at)))
    frame = compose(frame, fades[:, None] * off)
    if kind == SPOT:  # it ends as it begins, over its feet
        ends = relative(frame[-1], _frame_of(track, library, at[-1]))
        ends[2] = (ends[2] + np.pi) % (2.0 * np.pi) - np.pi
        frame = compose(frame, (1.0 - fades)[:, None] * ends)
    frame[:, 2] = np.unwrap(frame[:, 2])
    side = 1.0 - 2.0 * first
    turn = float(side * (frame[-1, 2] - frame[0, 2]))
    ahead, _, aside = screw(frame[-9], frame[-1], seconds[-1] - seconds[-9])
    moved = np.linalg.norm(frame[-1, :2] - frame[0, :2])
    if not LEAST[kind] < turn < MOST[kind] or (ahead < max(LEAVES, 2.0 * abs(aside)) if kind == WALKS else moved > STAYS):
        return None
    local = track.clip.slice(int(at.min()), int(at.max()) + 1).rotations[at - at.min()].copy()
    local[:, 0] = np.swapaxes(rot.yaw(frame[:, 2]), -1, -2) @ local[:, 0]
    rest = _beside_joints(track, feet, at, seconds, frame, first, kind)
    mirror = local[:, mirror_index(library.skeleton)] * np.outer(ASIDE, ASIDE)
    other = rest[:, [0, 1, 2, 5, 6, 3, 4, 7, 8, 9, 10]] * [-1, 1, 1, 1, 1, 1, 1, 1, 1, -1, -1]
    rows = [np.concatenate([_chart(library, part), r], -1) for part, r in ((local, rest), (mirror, other))]
    return Sample(np.stack(rows if first == 0 else rows[::-1]), turn, track.clip.name, float(at[0] / RATE))


def _chart(library: Library, local: np.ndarray) -> np.ndarray:
    """Local rotations (G, J, 3, 3) in the library's columns (G, 3 J)."""
    return rot.continuous(rot.log(np.swapaxes(library.reference, -1, -2) @ local)).reshape(len(local), -1)


def _beside_joints(track: Track, feet: np.ndarray, at: np.ndarray, seconds: np.ndarray, frame: np.ndarray, first: int, kind: int) -> np.ndarray:
    """Hips, labels, duration and way at frames (G,) and at these seconds (G,), with the ground frame (G, 3): (G, 11)."""
    root, u = track.clip.root[at], grid()
    place = relative(frame, np.stack([root[:, 0], root[:, 2], frame[:, 2]], -1))
    whole = at / RATE
    middle = 0.5 * (whole[1:] + whole[:-1])
    velocity = np.stack([screw(frame[k], frame[k + 1], max(whole[k + 1] - whole[k], 1e-9)) for k in range(len(u) - 1)])
    moved = np.diff(whole) > 0.0
    ahead, aside = (np.interp(seconds, middle[moved], column[moved]) for column in (velocity[:, 0], velocity[:, 2]))
    duration = np.gradient(seconds, u)
    duration[u <= 0.0] = duration[u > 0.0][0]
    labels = labels_of(track, feet, "walk")[at]
    one, other = labels[:, 2 * first:2 * first + 2], labels[:, 2 - 2 * first:4 - 2 * first]
    other[u < 0.0] = 1.0
    if kind == SPOT:
        one[u < -LIFTS] = 1.0
    way = np.stack([ahead, frame[:, 2] - frame[0, 2], aside], -1)
    return np.concatenate([place[:, :1], root[:, 1:2], place[:, 1:2], labels, duration[:, None], way], -1)


def _frame_of(track: Track, library: Library, frame: int) -> np.ndarray:
    """The ground frame (3,) by which the feet that stand in a frame lie as those of the library's rest do."""
    row = library.coefficients[library.rest, 0]
    local = library.reference @ rot.exp(row[:HIPS].reshape(-1, 3))
    stance = contact_points(library.skeleton, *forward_kinematics(library.skeleton, row[HIPS:HIPS + 3], local))[:, [0, 2]]
    turn, shift = onto(stance, track.points[frame][:, [0, 2]])
    return np.array([*shift, turn])
