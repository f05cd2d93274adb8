"""Taking over a body that something else moved: its pose, its motion and its feet as they are.

The pose becomes the blend's own offset, which then fades (inertialisation); the feet that stand
are locked where they stand.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..body import Pose, contact_height, contact_points, exp, forward_kinematics, log, settle, yaw
from ..contract import CharacterState
from . import fourier
from .command import LEAST_STRETCH, MOST_STRETCH
from .fading import HEAVY, held_up_kernel
from .kernel import COLUMNS, HIPS_AT, LABELS_AT, LANES, series_kernel, time_kernel
from .library import DURATION, HIPS, LABELS
from .memory import RUN, WALK
from .step import sway_kernel

WALKS_ON = 0.35
"""A body that moves faster than this [m/s] walks on; a slower one stands."""
FADES = 0.22, 0.16, 0.12, 0.09, 0.07
"""Half-lives with which the pose that was taken over gives way to the walker's own [s]: the slowest with which the foot that swings comes down, and its leg does not fold up."""
DOWN = 0.02
"""A foot has come down if it is no higher than this over where it stands [m]."""
FOLDED, WAY, HALF = 0.36, 10, 0.5
"""A leg folds up whose ankle comes nearer to its hip than this, over how long it is, as told of so many moments of so much of a cycle: recorded runners' knees bend to 136°."""
ABOUT_TO_STEP = 0.95
"""The phase in which both feet stand and the left one is about to leave."""
AHEAD = 0.01
"""How a gait moves is told from its poses so far apart, in phase."""
TREADS = 0.04
"""Feet that stand so far apart in height [m] are on two treads."""
PHASES, LEAD = 64, 0.1
"""So many phases are compared; a difference of 1 m/s counts as one of so many metres."""


def entered(locomotion: Any, state: CharacterState, wish: float = 0.0) -> CharacterState:
    """The state (no batch axes) of a body that walks or stands on from where it is.

    state: any, with pose, ground, contacts and, if it moves, previous and elapsed. At rest it stands on
    the spot; faster it takes the left foot off next, at the velocity that the state says. wish: how fast ahead it wants to go [m/s]: who wants to run does, if he is
    as fast as a runner.
    """
    ground = _under_the_feet(locomotion, state)
    rest = locomotion.start(ground, state.floor)
    memory = rest.memory.copy()
    speed = float(np.hypot(state.velocity[0], state.velocity[2]))
    stands = np.array(state.contacts, bool)
    if speed > WALKS_ON:
        on, velocity = stands.reshape(2, 2).any(1), np.asarray(state.velocity, float)
        sides = np.flatnonzero(on)
        # no run has a phase in which both feet stand: it goes on off the one that it is more like, lest the other, left behind, pulls its leg straight
        if len(sides) == 1 or len(sides) == 2 and _gait(locomotion, velocity, wish)[0]:
            strides = [_stride(locomotion, state, velocity, int(side), wish) for side in sides]
            like = int(np.argmin([apart for _, apart in strides]))
            on = np.arange(2) == sides[like]
            stands &= np.repeat(on, 2)
            _set_off(locomotion, memory, velocity, strides[like][0], wish)
        else:
            _set_off(locomotion, memory, velocity, ABOUT_TO_STEP, wish)
        if on.sum() == 1:  # its hips go on where they are
            ground = _under_the_hips(state, memory["row"])
            memory["ground"] = ground
    shown = _row(locomotion, state.pose, ground, state.floor)
    memory["blend"][:LABELS_AT] = shown - memory["row"][:LABELS_AT]
    calm = float(memory["weights"][locomotion.library.rest])
    memory["blend"][HIPS_AT] -= sway_kernel(float(memory["breath"]), locomotion.settings.breath, calm)  # it comes on top
    own = _rate(locomotion, memory)  # the gait moves by itself, and what is left of what was taken over by the rest
    memory["row"][:LABELS_AT] = shown
    memory["fade"] = FADES[0]
    if state.previous is not None and state.elapsed > 0.0:
        before = _row(locomotion, state.previous, ground, state.floor)
        rate = (shown - before) / state.elapsed
        rate[[HIPS_AT, HIPS_AT + 2]] = 0.0  # the ground frame moves along the floor, not the hips in it
        memory["row_rate"][:LABELS_AT] = np.clip(rate, -12.0, 12.0)
        memory["blend_rate"][:LABELS_AT] = np.clip(rate - own, -12.0, 12.0)
        if speed > WALKS_ON and on.sum() == 1:
            memory["fade"] = _fade(locomotion, memory, int(on.argmin()))
    points = contact_points(locomotion.skeleton, *forward_kinematics(
        locomotion.skeleton, np.asarray(state.pose.root, float), np.asarray(state.pose.rotations, float)))
    points[:, 1] -= state.floor
    c, s = np.cos(ground[2]), np.sin(ground[2])
    aside, ahead = points[:, 0] - ground[0], points[:, 2] - ground[1]
    memory["points"] = np.stack([c * aside - s * ahead, points[:, 1], s * aside + c * ahead], -1)
    memory["standing"] = memory["grip"] = stands
    memory["bears"] = memory["taut"] = memory["grip"][1::2]
    memory["stood"] = points[:, [0, 2]]
    memory["felt"] = 0  # he did not set off from rest, nor stood there
    memory["left_at"] = points[1::2, [0, 2]]  # a foot in the air passes over what lies from here on, not from where nobody was
    memory["offset"] = memory["offset_rate"] = memory["offset_push"] = memory["raised"] = memory["raised_rate"] = 0.0
    high = points[:, 1] - contact_height(locomotion.skeleton)
    apart = np.where(stands, high, np.inf).reshape(2, 2).min(1)
    apart = np.where(np.isfinite(apart), apart, np.minimum(high.reshape(2, 2).min(1), 0.0))  # a foot that leaves a lower tread goes up from there
    memory["base"] = memory["left"] = np.where(np.abs(apart) > TREADS, apart, 0.0)  # its feet are on two treads
    return CharacterState(memory["ground"], memory["velocity"], state.pose, stands, memory, state.floor)


def _gait(locomotion: Any, velocity: np.ndarray, wish: float) -> tuple[bool, np.ndarray, np.ndarray, np.ndarray]:
    """Whether a velocity (3,) is run by who wishes for so much [m/s], the nearest one that there is, the primitives of that gait and what they weigh in it."""
    settings = locomotion.settings
    running = velocity[0] > (settings.walk_below if wish > settings.run_above else settings.run_above) and locomotion.run is not None
    family = "run" if running else "walk"
    space = locomotion.space(family)
    query = space.clamp(velocity)
    return running, query, locomotion.library.family(family), space.weights(query)


def _stride(locomotion: Any, state: CharacterState, velocity: np.ndarray, side: int, wish: float) -> tuple[float, float]:
    """The phase in which a gait at a velocity (3,) is most like a body that stands on one foot, 0 left or 1 right, and how unlike [m²]: feet about the hips, and
    how they move about them."""
    _, _, members, weights = _gait(locomotion, velocity, wish)
    library = locomotion.library
    rows = fourier.evaluate(np.tensordot(weights, library.coefficients[members], 1), np.arange(PHASES) / PHASES)
    local = library.reference @ exp(rows[:, :HIPS].reshape(PHASES, -1, 3))
    places = contact_points(library.skeleton, *forward_kinematics(library.skeleton, rows[:, HIPS:LABELS], local)) - rows[:, None, HIPS:LABELS]
    moves = (np.roll(places, -1, 0) - np.roll(places, 1, 0)) * (0.5 * PHASES) / rows[:, DURATION, None, None]
    turn = yaw(-float(state.ground[2]))
    ours, before = (_about_the_hips(locomotion, pose, turn) for pose in (state.pose, state.previous or state.pose))
    apart = np.square(places - ours).sum((1, 2))
    if state.previous is not None and state.elapsed > 0.0:
        apart += np.square(LEAD * (moves - (ours - before) / state.elapsed)).sum((1, 2))
    stands = rows[:, LABELS:DURATION].reshape(PHASES, 2, 2).max(-1)
    apart = np.where((stands[:, side] > 0.5) & (stands[:, 1 - side] < 0.5), apart, np.inf)
    return float(np.argmin(apart)) / PHASES, float(apart.min())


def _fade(locomotion: Any, memory: np.ndarray, foot: int) -> float:
    """The half-life [s] with which what was taken over fades, so that foot 0 or 1, in the air, comes down when the gait sets it down: a leg that is on its way
    elsewhere would else pass that strike, and its stance, in the air; and so that no leg, which bent as it landed, is thrown up over its hip."""
    library, phase, weights = locomotion.library, float(memory["phase"]), memory["weights"]
    rows = fourier.evaluate(np.tensordot(weights[:len(library.coefficients)].astype(float), library.coefficients, 1), phase + np.arange(PHASES) / PHASES)
    down = rows[:, LABELS:DURATION].reshape(PHASES, 2, 2)[:, foot].max(-1) > 0.5
    moments = np.append(HALF * np.arange(1, WAY + 1) / WAY, down.argmax() / PHASES)  # the strike is the last of them
    later, way = np.empty((len(moments), 1)), np.empty((len(moments), COLUMNS), np.float32)
    for ahead, time, row in zip(moments, later, way):
        time[0] = time_kernel(locomotion.tables.series, weights, phase, ahead)
        series_kernel(locomotion.tables.series, weights, np.float32((phase + ahead) % 1.0), row)
    slower = np.ones(LABELS_AT)
    slower[HIPS_AT:] = HEAVY
    up, rate = float(memory["blend"][HIPS_AT + 1]), float(memory["blend_rate"][HIPS_AT + 1])
    for half in FADES:
        left = way.astype(float)
        fades = settle(memory["blend"][:LABELS_AT], memory["blend_rate"][:LABELS_AT], slower * half, later)[0]
        fades[:, HIPS_AT + 1] = [held_up_kernel(up, rate, half, float(t[0]))[0] for t in later]
        left[:, :LABELS_AT] += fades
        height, folded = _swings(locomotion, left, foot)
        if height < DOWN and folded > FOLDED:
            break
    return half


def _swings(locomotion: Any, rows: np.ndarray, foot: int) -> tuple[float, float]:
    """How high heel or ball of foot 0 or 1 is over where it stands in the last row of a gait (N, COLUMNS), the lower one [m]; and how near ankles come to their hips, over how long
    legs are."""
    library = locomotion.library
    chart = np.stack([rows[:, axis * LANES:axis * LANES + len(library.reference)] for axis in range(3)], -1)
    places, turned = forward_kinematics(library.skeleton, rows[:, HIPS_AT:LABELS_AT], library.reference @ exp(chart))
    hip, knee, ankle = (places[:, [library.skeleton.index(side + part) for side in ("Left", "Right")]] for part in ("UpLeg", "Leg", "Foot"))
    whole = np.linalg.norm(knee - hip, axis=-1) + np.linalg.norm(ankle - knee, axis=-1)
    points = contact_points(library.skeleton, places[-1], turned[-1])
    return float(points[2 * foot:2 * foot + 2, 1].min()) - contact_height(library.skeleton), float((np.linalg.norm(ankle - hip, axis=-1) / whole).min())


def _about_the_hips(locomotion: Any, pose: Pose, turn: np.ndarray) -> np.ndarray:
    """Heels and balls (4, 3) [m] from the hips, in a frame turned (3, 3)."""
    root = np.asarray(pose.root, float)
    points = contact_points(locomotion.skeleton, *forward_kinematics(locomotion.skeleton, root, np.asarray(pose.rotations, float)))
    return (points - root) @ turn.T


def _under_the_hips(state: CharacterState, row: np.ndarray) -> np.ndarray:
    """The ground frame (3,) in which a row of a gait has the hips where this body has them."""
    heading = float(state.ground[2])
    place = np.asarray(state.pose.root, float) - yaw(heading) @ np.asarray(row[HIPS_AT:LABELS_AT], float)
    return np.array([place[0], place[2], heading])


def _set_off(locomotion: Any, memory: np.ndarray, velocity: np.ndarray, phase: float, wish: float) -> None:
    """Walking or running at a velocity (3,), from a phase of the gait; a little faster or slower than any that was recorded, too, as gaits are stretched to it."""
    running, query, members, weights = _gait(locomotion, velocity, wish)
    stretch = float(np.clip(velocity[0] / query[0], LEAST_STRETCH, MOST_STRETCH)) if query[0] > WALKS_ON else 1.0
    memory["weights"] = 0.0
    memory["weights"][members] = weights
    memory["led"] = memory["weights"]
    memory["family"] = RUN if running else WALK
    memory["command"] = memory["velocity"] = query * [stretch, 1.0, 1.0]
    memory["settled"], memory["phase"] = 0, phase
    row = np.empty(COLUMNS, np.float32)
    series_kernel(locomotion.tables.series, memory["weights"], np.float32(phase), row)
    memory["row"], memory["stretch"] = row, stretch


def _rate(locomotion: Any, memory: np.ndarray) -> np.ndarray:
    """How fast joints turn by themselves in a gait's row (LABELS_AT,) [1/s]; not at all at rest, nor hips, which go on from where they are at the lowest
    point of a landing."""
    if memory["settled"]:
        return np.zeros(LABELS_AT)
    row = np.empty(COLUMNS, np.float32)
    series_kernel(locomotion.tables.series, memory["weights"], np.float32((memory["phase"] + AHEAD) % 1.0), row)
    rate = (row[:LABELS_AT].astype(float) - memory["row"][:LABELS_AT]) / (AHEAD * float(row[DURATION]))
    rate[HIPS_AT:] = 0.0
    return rate


def _under_the_feet(locomotion: Any, state: CharacterState) -> np.ndarray:
    """The ground frame (3,) in which a body at rest has its feet's middle where this body has it."""
    rest = locomotion.start((0.0, 0.0, 0.0))
    ours, theirs = (_middle(locomotion, pose) for pose in (rest.pose, state.pose))
    heading = float(state.ground[2])
    c, s = np.cos(heading), np.sin(heading)
    return np.array([theirs[0] - (c * ours[0] + s * ours[1]), theirs[1] - (-s * ours[0] + c * ours[1]), heading])


def _middle(locomotion: Any, pose: Pose) -> np.ndarray:
    """Where (2,) the middle of the feet is, along x and z."""
    points = contact_points(locomotion.skeleton, *forward_kinematics(
        locomotion.skeleton, np.asarray(pose.root, float), np.asarray(pose.rotations, float)))
    return points[:, [0, 2]].mean(0)


def _row(locomotion: Any, pose: Pose, ground: np.ndarray, floor: np.ndarray | float) -> np.ndarray:
    """A pose as the pose columns of a series row, seen from a ground frame."""
    turn = yaw(-ground[2])
    local = np.array(pose.rotations, float)
    local[0] = turn @ local[0]
    chart = log(np.swapaxes(locomotion.library.reference, -1, -2) @ local)
    row = np.zeros(LABELS_AT)
    for axis in range(3):
        row[axis * LANES:axis * LANES + len(chart)] = chart[:, axis]
    root = np.asarray(pose.root, float) - [ground[0], floor, ground[1]]
    row[HIPS_AT:LABELS_AT] = turn @ root
    return row
