"""Performers to learn calibration from: bodies of all proportions that wear trackers anyhow, stand not quite as asked, and then do
what somebody did in a recorded take.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...body import contact_height, exp, log, yaw
from ..pose_vector import REFERENCE, SKELETON, WIDTH
from ..trackers import FIRST, LEGS, Moments, bodies, legs, moments_kernel
from .moved import BEFORE, MOVING, told as told_by_moving
from .stood import JOINTS, STANDING_INPUTS, WORN, Stood

FRAMES, STRIDE = 32, 9
"""So many moments of somebody's moving are heard, so many frames of 1/60 s apart."""
_SETS = ((0.45, (1, 1, 1, 1, 1, 1)), (0.30, (0, 1, 1, 1, 0, 0)), (0.05, (1, 1, 1, 1, 0, 0)), (0.05, (1, 0, 0, 0, 1, 1)), (0.05, (0, 1, 1, 1, 1, 1)))
"""How often which of `WORN` are worn together; the rest is any of them."""
_USUAL = np.array([[0.0, 0.03, -0.12], [0.0, 0.13, 0.05], [0.05, 0.03, 0.03], [-0.05, 0.03, 0.03], [0.0, 0.02, 0.08], [0.0, 0.02, 0.08]])
"""Where trackers usually sit from their joints [m]: at the back of the waist, on forehead or crown, in or on hands, on insteps."""
_ANYHOW, _LOOSELY = 0.06, 0.035
"""Half of all people wear them anyhow, others about where it is usual: off by this [m], a standard deviation along each axis."""
_PEOPLE = {"Spine": 1.06, "Spine1": 1.06, "Spine2": 1.06, "Neck": 0.86, "Head": 0.86, "Shoulder": 1.05, "Arm": 1.05, "ForeArm": 1.06, "Hand": 1.08,
           "UpLeg": 1.04, "Toe": 0.94}
"""How much longer bones of CMU's subjects (01 to 49, whose takes are learnt from) are than the standard body's with as long legs, on the average."""
_LIKE = 0.7
"""So many people differ from them, and not from the standard body."""
_UNMOVED = 0.15
"""So many have not moved yet."""
_NOISE, _SHAKE, _FLOOR = 0.001, np.radians(0.3), 0.012
_DOWN = (0.0, 1.3)
_SWAY = {"Hips": 2.0, "Spine": 1.5, "Spine1": 1.5, "Spine2": 1.5, "Neck": 2.5, "Head": 4.0, "Shoulder": 2.0, "Arm": 4.0, "ForeArm": 5.0,
         "Hand": 6.0, "UpLeg": 3.0, "Leg": 2.0, "Foot": 4.0, "Toe": 0.0}
"""How far joints are turned where somebody stands as asked [degrees], a standard deviation about each axis; both arms alike beside that."""
_ARMS = np.radians(6.0)
_TURNS = np.radians([_SWAY[name.removeprefix("Left").removeprefix("Right")] for name in SKELETON.names])
_LONGER = np.array([_PEOPLE.get(name.removeprefix("Left").removeprefix("Right"), 1.0) for name in SKELETON.names])
_MIDDLE = [j for j, name in enumerate(SKELETON.names) if j and not name.startswith(("Left", "Right"))]
_LEFT = [j for j, name in enumerate(SKELETON.names) if name.startswith("Left")]
_RIGHT = [SKELETON.index(SKELETON.names[j].replace("Left", "Right")) for j in _LEFT]
BONES = 2 * len(_MIDDLE) + 3 * len(_LEFT)
"""Numbers of the bones of a body whose sides are alike."""
TARGETS = BONES + 6 * len(WORN) + 1
"""Numbers of a calibration: bones, offsets, turns, the floor."""
INPUTS = STANDING_INPUTS + MOVING + 1
"""… and of what is heard for it."""
SCALES = np.concatenate([np.full(BONES, 0.01), np.full(3 * len(WORN), 0.03), np.full(3 * len(WORN), 0.1), [0.01]])
"""What each is told over [m, rad]."""


def like_people() -> np.ndarray:
    """The offsets (J, 3) [m] of a likely body, built as the standard one."""
    return SKELETON.offsets * (1.0 + _LIKE * (_LONGER[:, None] - 1.0))


def numbers(offsets: np.ndarray, away: np.ndarray, turns: np.ndarray, floor: np.ndarray) -> np.ndarray:
    """A calibration in numbers (..., TARGETS): offsets (..., J, 3) of bodies less the standard one's, what is left of trackers' offsets (..., S, 3),
    turns (..., S, 3) as rotation vectors, floor (...)."""
    shape = *np.shape(floor), -1
    parts = (offsets[..., _MIDDLE, 1:], offsets[..., _LEFT, :], away, turns)
    return np.concatenate([*(part.reshape(shape) for part in parts), floor[..., None]], -1) / SCALES


def told(found: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The inverse of `numbers`; bodies are symmetric."""
    found = found * SCALES
    shape, count = found.shape[:-1], 2 * len(_MIDDLE)
    offsets = np.zeros((*shape, len(SKELETON), 3))
    offsets[..., _MIDDLE, 1:] = found[..., :count].reshape(*shape, -1, 2)
    offsets[..., _LEFT, :] = found[..., count:BONES].reshape(*shape, -1, 3)
    offsets[..., _RIGHT, :] = offsets[..., _LEFT, :] * [-1.0, 1.0, 1.0]
    away, turns = (found[..., begin:begin + 3 * len(WORN)].reshape(*shape, -1, 3) for begin in (BONES, BONES + 3 * len(WORN)))
    return offsets, away, turns, found[..., -1]


@dataclass(frozen=True, eq=False)
class Performances:
    """inputs: (B, INPUTS), what is heard. truth: (B, TARGETS). tells: (B, TARGETS) bool, what is asked: mounts of trackers that are worn."""

    inputs: np.ndarray
    truth: np.ndarray
    tells: np.ndarray


def drawn(moments: Moments, count: int, seed: int, number: int) -> Performances:
    """So many performers: the same for the same seed and number."""
    rng = np.random.default_rng([seed, number])
    people = bodies(count, rng)
    people[rng.random(count) < _LIKE] *= _LONGER[:, None]
    there = _worn(count, rng)
    usual = rng.random((count, 1, 1)) < 0.5
    beside = np.where(usual, _USUAL + _LOOSELY * rng.normal(size=(count, len(WORN), 3)), _ANYHOW * rng.normal(size=(count, len(WORN), 3)))
    mounts = exp(rng.normal(size=(count, len(WORN), 3)))
    floor = _FLOOR * rng.normal(size=count)
    joints, orientations = standing(people, rng)

    def seen(places, turns):
        noise = _NOISE * rng.normal(size=places.shape)
        noise[..., 1] += floor.reshape(-1, *[1] * (places.ndim - 2))
        between = [slice(None), *[None] * (places.ndim - 3)]
        return (places + np.einsum("...ij,...j->...i", turns, beside[tuple(between)]) + noise,
                turns @ mounts[tuple(between)] @ exp(_SHAKE * rng.normal(size=places.shape)))
    stood = Stood.of(*seen(joints, orientations), there)
    places, turns, heard = _moving(moments, people, rng)
    heard &= rng.random((count, 1)) >= _UNMOVED
    inputs = heard_as(stood, *seen(places, turns), heard)
    # what standing got wrong
    right, turned = (part[:, 0] for part in stood.corrected(*(part[:, None] for part in _exactly(joints, orientations, beside, mounts, floor))))
    scale = stood.scale[:, None, None]
    base = joints + [0.0, 1.0, 0.0] * floor[:, None, None]
    away = np.einsum("bsji,bsj->bsi", turned, right - scale * base)
    bones = scale * people - SKELETON.offsets
    bones[:, 0] = 0.0
    truth = numbers(bones, away, log(np.swapaxes(turned, -1, -2) @ orientations), scale[:, 0, 0] * floor)
    tells = np.concatenate([np.ones((count, BONES), bool), np.repeat(there, 3, 1), np.repeat(there, 3, 1), np.ones((count, 1), bool)], -1)
    return Performances(inputs, truth, tells)


def _exactly(joints, orientations, beside, mounts, floor):
    """What trackers say without noise."""
    return (joints + np.einsum("bsij,bsj->bsi", orientations, beside) + [0.0, 1.0, 0.0] * floor[:, None, None], orientations @ mounts)


def heard_as(stood: Stood, places: np.ndarray, turns: np.ndarray, heard: np.ndarray) -> np.ndarray:
    """What is heard of people (B, INPUTS) who stood, and of moments of trackers in pairs of frames: places (B, F, 2, S, 3) [m] above the room's floor,
    turns (B, F, 2, S, 3, 3), those of `heard` (B, F) bool; there may be none."""
    count, frames, slots = len(stood.there), heard.shape[1], len(WORN)
    places, turns = stood.corrected(places.reshape(count, 2 * frames, slots, 3), turns.reshape(count, 2 * frames, slots, 3, 3))
    moving = told_by_moving(places.reshape(count, frames, 2, slots, 3), turns.reshape(count, frames, 2, slots, 3, 3), stood.there, heard)
    return np.concatenate([stood.inputs, moving, heard.mean(-1, keepdims=True)], -1)


def _worn(count, rng):
    kind = np.searchsorted(np.cumsum([share for share, _ in _SETS]), rng.random(count))
    those = np.array([some for _, some in _SETS], bool)
    there = those[np.minimum(kind, len(those) - 1)]
    free = kind >= len(those)
    there[free] = rng.random((int(free.sum()), len(WORN))) < 0.6
    there[:, 1] |= there.sum(-1) < 2
    there[:, 0] |= there.sum(-1) < 2
    return there


def standing(people: np.ndarray, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Joints (B, S, 3) [m] and turns (B, S, 3, 3) of people (B, J, 3) who stand as asked, about."""
    count = len(people)
    turns = _TURNS[:, None] * rng.normal(size=(count, len(SKELETON), 3))
    down = np.array(_DOWN)[(rng.random(count) < 0.5).astype(int)] + _ARMS * rng.normal(size=count)
    before = 0.7 * _ARMS * rng.normal(size=count)
    rotations = exp(turns)
    for side, way in (("Left", -1.0), ("Right", 1.0)):
        arm = SKELETON.index(side + "Arm")
        held = np.zeros((count, 3))
        held[:, 2] = way * down
        rotations[:, arm] = yaw(way * before) @ exp(held) @ rotations[:, arm]
    rotations[:, 0] = yaw(rng.uniform(-np.pi, np.pi, count)) @ rotations[:, 0]
    positions, orientations = np.zeros((count, len(SKELETON), 3)), np.array(rotations)
    for j in range(1, len(SKELETON)):
        p = SKELETON.parents[j]
        positions[:, j] = positions[:, p] + np.einsum("bij,bj->bi", orientations[:, p], people[:, j])
        orientations[:, j] = orientations[:, p] @ rotations[:, j]
    positions[..., 1] += contact_height(SKELETON) - positions[:, LEGS, 1].min(-1, keepdims=True)
    return positions[:, JOINTS], orientations[:, JOINTS]


def _moving(moments, people, rng):
    """Places (B, F, 2, S, 3), turns (B, F, 2, S, 3, 3) in five seconds of takes, and which moments there were (B, F)."""
    count = len(people)
    chosen = np.searchsorted(moments.upto, rng.random(count))
    last, first = moments.which[chosen].astype(np.int64), moments.first[chosen].astype(np.int64)
    back = STRIDE * np.arange(FRAMES) + rng.integers(0, STRIDE, (count, FRAMES))
    at = last[:, None] - back
    heard = at >= first[:, None]
    at = np.maximum(at, first[:, None])
    heard &= moments.database.sound[at]
    flat = at.reshape(-1), np.repeat(first, FRAMES)
    shape = count * FRAMES, 2
    places, turns, there = np.empty((*shape, len(JOINTS), 3)), np.empty((*shape, len(JOINTS), 3, 3)), np.empty(shape, np.bool_)
    whose = np.repeat(people, FRAMES, 0)
    moments_kernel(moments.database.frames, moments.database.sound, *flat, 1.0 / moments.database.fps, np.array([0, BEFORE]), JOINTS, whose,
                   legs(whose) / legs(SKELETON.offsets), SKELETON.offsets, SKELETON.parents, REFERENCE, FIRST, LEGS,
                   np.empty((len(whose), WIDTH)), places, turns, there)
    heard &= there.all(-1).reshape(count, FRAMES)
    turns[~heard.reshape(-1)] = np.eye(3)
    return places.reshape(count, FRAMES, 2, -1, 3), turns.reshape(count, FRAMES, 2, -1, 3, 3), heard
