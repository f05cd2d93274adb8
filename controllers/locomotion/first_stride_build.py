"""How recorded people set off: what their first strides have beyond the blend at the same velocity and phase.

Somebody who starts leans into it, and who turns does so shoulders and arms first. Wherever a recording begins to walk
from standing still, its pose less the blend's is taken over the gait's phase since the first foot left; a line through
all of them, over how fast they turn, is the start as a primitive. Its phase is the gait's own and it is gone where it
ends, so that it ends in the gait; `scripts/measure/starts.py` prints how much it tells, of starts and of stops.
Only what is above the pelvis is kept: way, pelvis and legs follow the wish and the footing, and a recorded pelvis on
another way than the wished one would be pushed about.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ..body import advance, compose, forward_kinematics, mirror_index, relative, rotations as rot
from . import fourier
from .control_space import ControlSpace
from .cycles import EVENTS, RATE, Track, drop_short, stance
from .library import HIPS, LABELS, Library, Start
from .first_stride import BEFORE, END, FASTEST_TURN, PER_CYCLE, WAITING
from .velocity_correction import space_of

SHIFTS = 0.4
"""People shift their weight for this long [s] before the first foot leaves."""
STILL = 0.4
"""Feet that stood for this long [s] before that stood still."""
STEPS = 0.3
"""The first foot is away for at least this long [s], and a body that has started is faster than this [m/s] ahead."""
SMOOTH, SMOOTH_ASIDE = 0.1, 0.5
"""Of the way, once the steady sway is taken off: the standard deviations [s] of the filter ahead and of that to the
side, where a character's way has no shift of weight: that is the body's, over its way."""
WAY_STRIDE = 4
"""Every so many frames are looked at for it."""
LATE = 0.8
"""From this phase on the difference is led to nothing, since strides are steady by then."""
LONGEST_STEP = 0.39
"""No two events of a gait are farther apart than this, in phase."""
SHORTEST = 0.17
"""A foot that is away for less than this [s] has not stepped."""
FEWEST = 6
"""From fewer starts than this no primitive is made."""


class Sample(NamedTuple):
    """One recorded start. rows: (2, G, 3 J + 3) beyond the blend at the phases of `grid`, told with the left foot first
    and with the right one. turn: how fast it turns towards its first foot [rad/s]. clip: where it was found."""

    rows: np.ndarray
    turn: float
    clip: str


def grid() -> np.ndarray:
    """The phases (G,) since the first toe-off at which starts are compared: four for each spline coefficient."""
    x = np.arange(0.0, WAITING + END * PER_CYCLE, 0.25)
    return np.where(x < WAITING, (x / WAITING - 1.0) * BEFORE, (x - WAITING) / PER_CYCLE)


def starts(tracks: Sequence[Track], library: Library) -> Start | None:
    """The start primitive of some tracks' people, over a library whose velocities are settled; None for too few starts."""
    space = space_of(library, "walk")
    assert space is not None
    found = [sample for track in tracks for sample in samples(track, library, space)]
    if len(found) < FEWEST:
        return None
    turns = np.array([sample.turn for sample in found])
    return Start(np.stack([fitted(np.stack([sample.rows[foot] for sample in found]), turns) for foot in range(2)]))


def fitted(rows: np.ndarray, turns: np.ndarray) -> np.ndarray:
    """Spline coefficients (2, K, D) of what N starts (N, G, D) have in common straight on, and by each rad/s of turn (N,)."""
    from scipy.interpolate import make_lsq_spline

    features = np.stack([np.ones_like(turns), np.clip(turns, 0.0, FASTEST_TURN)], -1)
    line = np.linalg.lstsq(features, rows.reshape(len(rows), -1), rcond=None)[0].reshape((2,) + rows.shape[1:])
    count = int(round(WAITING + END * PER_CYCLE))
    x = np.arange(len(grid())) * 0.25
    coefficients = make_lsq_spline(x, np.moveaxis(line, 1, 0), np.arange(-3.0, count + 4.0), k=3).c.swapaxes(0, 1)
    coefficients[:, :3] = coefficients[:, -3:] = 0.0  # it begins and ends at rest: in value, speed and acceleration
    return coefficients


def samples(track: Track, library: Library, space: ControlSpace) -> list[Sample]:
    """The starts of one track: after standing, a foot leaves and at least a stride and a half follows in order."""
    from scipy.interpolate import PchipInterpolator

    feet, above, result = steps(track), _above(library), []
    for frames, phases in strides(feet):
        first = int(phases[0] % 1.0 > 0.25)
        if phases[0] % 0.5 > 0.01 or frames[0] < SHIFTS * RATE or not feet[max(frames[0] - int(STILL * RATE), 0):frames[0]].all() \
                or phases[-1] - phases[0] < END or frames[1] - frames[0] < STEPS * RATE:
            continue
        u = grid()
        since = PchipInterpolator(phases - phases[0], frames)(np.maximum(u, 0.0))
        at = np.where(u < 0.0, frames[0] + u / BEFORE * SHIFTS * RATE, since).round().astype(int)
        phases = (u + 0.5 * first) % 1.0
        frame, velocity = way = way_of(track, library, space, at, phases)
        if velocity[-1, 0] > max(STEPS, 2.0 * abs(velocity[-1, 2])):
            rows = _led(beyond(track, library, space, at, phases, way)) * above
            turn = velocity[u < 0.5, 1].mean() * (1.0 - 2.0 * first)
            both = (rows, mirrored(library, rows)) if first == 0 else (mirrored(library, rows), rows)
            result.append(Sample(np.stack(both), float(turn), track.clip.name))
    return result


def steps(track: Track) -> np.ndarray:
    """Which foot stands (T, 2): one that grazes the floor, or is dragged about by a turn, takes no step."""
    feet = stance(track, "walk")
    for foot in feet.T:
        drop_short(foot, int(SHORTEST * RATE), False)
    return feet


def strides(feet: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Where steps follow each other in order: the frames (E,) of the events and the phases they have, rising without
    a turn back. feet: (T, 2) which foot stands."""
    change = np.diff(feet.astype(int), axis=0)
    events = sorted((int(frame) + 1, float(EVENTS["walk"][2 * foot + int(change[frame, foot] > 0)]))
                    for foot in range(2) for frame in np.flatnonzero(change[:, foot]))
    run: list[tuple[int, float]] = []
    for frame, phase in events:
        at = phase + np.floor(run[-1][1] - phase) + 1.0 if run else phase
        if run and (at - run[-1][1] > LONGEST_STEP or frame - run[-1][0] > RATE):  # an event is missing, or somebody stood
            yield np.array([f for f, _ in run]), np.array([p for _, p in run])
            run, at = [], phase
        run.append((frame, at))
    if run:
        yield np.array([f for f, _ in run]), np.array([p for _, p in run])


def beyond(track: Track, library: Library, space: ControlSpace, at: np.ndarray, phases: np.ndarray,
           way: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """What a recording has at frames (G,) beyond the blend of the same velocity and phase (G, 3 J + 3); way: as `way_of` has it."""
    frame, velocity = way
    local = track.clip.slice(int(at.min()), int(at.max()) + 1).rotations[at - at.min()]
    local[:, 0] = np.swapaxes(rot.yaw(frame[:, 2]), -1, -2) @ local[:, 0]
    root = track.clip.root[at]
    place = relative(frame, np.stack([root[:, 0], root[:, 2], frame[:, 2]], -1))
    hips = np.stack([place[:, 0], root[:, 1], place[:, 1]], -1)
    blend = _blend(library, space, velocity, phases)[:, :LABELS]
    chart = rot.log(np.swapaxes(library.reference, -1, -2) @ local)
    return _short(np.concatenate([chart.reshape(len(at), -1), hips], -1) - blend)


def mirrored(library: Library, rows: np.ndarray) -> np.ndarray:
    """Differences (G, 3 J + 3) with left and right exchanged, as if the reference had no side."""
    vectors = rows[:, :-3].reshape(len(rows), -1, 3)[:, mirror_index(library.skeleton)] * [1.0, -1.0, -1.0]
    return np.concatenate([vectors.reshape(len(rows), -1), rows[:, -3:] * [-1.0, 1.0, 1.0]], -1)


def _short(difference: np.ndarray) -> np.ndarray:
    """Differences (G, 3 J + 3) of rotation vectors the short way round."""
    vectors = difference[:, :-3].reshape(len(difference), -1, 3)
    size = np.linalg.norm(vectors, axis=-1, keepdims=True)
    turned = np.where(size > np.pi, vectors * (1.0 - 2.0 * np.pi / np.maximum(size, 1e-9)), vectors)
    return np.concatenate([turned.reshape(len(difference), -1), difference[:, -3:]], -1)


def _above(library: Library) -> np.ndarray:
    """Which columns (3 J + 3,) are of joints above the pelvis: 1 or 0."""
    names, parents = library.skeleton.names, library.skeleton.parents
    above = np.zeros(len(names))
    for joint in range(1, len(names)):
        above[joint] = above[parents[joint]] if parents[joint] else "Spine" in names[joint]
    return np.concatenate([np.repeat(above, 3), np.zeros(3)])


def _led(beyond: np.ndarray) -> np.ndarray:
    """A difference (G, D) from nothing to nothing: how this person stood is no part of a start, nor how they walk."""
    u = grid()[:, None]
    stood = 1.0 - smooth((u + BEFORE) / (BEFORE + 0.4))
    return (beyond - stood * beyond[:1]) * (1.0 - smooth((u - LATE) / (END - LATE)))


def smooth(share: np.ndarray) -> np.ndarray:
    """From 0 to 1, and level at both ends, as shares (...) do; what is beyond them stays there."""
    share = np.clip(share, 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


def way_of(track: Track, library: Library, space: ControlSpace, at: np.ndarray, phases: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The ground frames (G, 3) of a walk, without the sway that the blend has by itself, and their velocities (G, 3)."""
    from scipy.ndimage import gaussian_filter1d

    span = np.arange(at[0], at[-1] + WAY_STRIDE, WAY_STRIDE)
    rate = RATE / WAY_STRIDE
    phase = np.interp(span, at, np.unwrap(phases, period=1.0)) % 1.0
    raw = track.ground[np.minimum(span, len(track.ground) - 1)]
    frame = raw
    left, right = library.skeleton.index("LeftArm"), library.skeleton.index("RightArm")
    velocity = np.zeros_like(raw)
    for _ in range(4):
        smooth = gaussian_filter1d(frame, SMOOTH * rate, axis=0, mode="nearest")
        smooth = 2.0 * smooth - gaussian_filter1d(smooth, SMOOTH * rate, axis=0, mode="nearest")  # nor is it late in a curve
        step = np.gradient(smooth, 1.0 / rate, axis=0)
        c, s = np.cos(smooth[:, 2]), np.sin(smooth[:, 2])
        velocity = np.stack([s * step[:, 0] + c * step[:, 1], step[:, 2], c * step[:, 0] - s * step[:, 1]], -1)
        rows = _blend(library, space, velocity, phase)
        local = library.reference @ rot.exp(rows[:, :HIPS].reshape(len(span), -1, 3))
        joints = forward_kinematics(library.skeleton, rows[:, HIPS:LABELS], local)[0]
        middle, across = 0.5 * (joints[:, left] + joints[:, right]), joints[:, left] - joints[:, right]
        heading = rot.heading_of(np.cross(across, [0.0, 1.0, 0.0]))
        sway = np.stack([middle[:, 0], middle[:, 2], (heading + np.pi) % (2.0 * np.pi) - np.pi], -1)
        frame = compose(raw, relative(sway, np.zeros(3)))
        frame[:, 2] = np.unwrap(frame[:, 2])
    velocity[:, 2] = gaussian_filter1d(velocity[:, 2], SMOOTH_ASIDE * rate, mode="nearest")
    way = [smooth[0]]
    for speed in velocity[:-1]:
        way.append(advance(way[-1], speed, np.array(1.0 / rate)))
    return _at(at, span, np.array(way)), _at(at, span, velocity)


def _at(at: np.ndarray, span: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Columns (N, D) known at `span` (N,), at others (G,)."""
    return np.stack([np.interp(at, span, column) for column in columns.T], -1)


def _blend(library: Library, space: ControlSpace, velocity: np.ndarray, phases: np.ndarray) -> np.ndarray:
    """The blend's rows (G, D) at velocities (G, 3) and phases (G,)."""
    weights = space.weights(velocity)
    basis = fourier.basis(phases, (library.coefficients.shape[1] - 1) // 2)
    return np.einsum("gp,gk,pkd->gd", weights, basis, library.coefficients[library.family("walk")], optimize=True)
