"""Arms kept out of the body's own trunk and thighs.

Recorded arms swing just past the trunk of whoever was recorded; stouter bodies would have them in their flanks and bellies. How far trunk and thighs reach
all round is measured once from a body's own skin. Each upper arm then turns about its shoulder, by as little as takes elbow, forearm and hand out of
there. That follows from the pose and the body alone, and smoothly, so that nothing is remembered.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.spatial.transform import Rotation

from . import skin
from .mesh import Body, Mesh

_TRUNK = "Hips", "Spine", "Spine1", "Spine2"
_THIGHS = "LeftUpLeg", "RightUpLeg"
_SECTIONS = np.array([skin.STANDARD.index(name) for name in _TRUNK + _THIGHS])
ARMS = np.array([[skin.STANDARD.index(side + part) for part in ("Arm", "ForeArm", "Hand")] for side in ("Left", "Right")])
"""Joints (2, 3) of both arms."""
_KNEES = [skin.STANDARD.index(side + "Leg") for side in ("Left", "Right")]
HEIGHTS, ANGLES = 24, 32
"""So many heights of a section are told apart, and so many directions round it."""
SAMPLES = 3
"""Along each side of a triangle of the skin."""
MARGIN = 0.03
"""Sections overlap by this share of the height of the shoulders."""
PLACES = (0, 0.75), (1, 0.0), (1, 0.33), (1, 0.67), (1, 1.0), (2, 0.3), (2, 0.6)
"""Places looked at: on upper arm, forearm or hand, at a share of its length. A hand is as long as HAND of its forearm …"""
HAND = 0.75
_BONE, _SHARE = np.array([bone for bone, _ in PLACES]), np.array([share for _, share in PLACES])
_OUT = np.array([[1.0], [-1.0]])
"""Hands point along their x axis at T-pose, right ones against it."""
SOFT = 0.02
"""Arms begin to give way so much before they touch [m]."""
STIFF = (0.06, 0.01, 0.002)
"""What a turn costs about the chest's axes, beside the squared metres by which places are in too deep [m²]: arms go out to their side rather than ahead or back, where they
would glide off round flanks and swing faster than they do."""
ROUNDS = 4
"""Of Gauss and Newton."""
MOST = 0.9
"""No arm turns farther [rad]."""


@dataclass(frozen=True, eq=False)
class Girth:
    """How thick a body is, in its own size [m], sections B along trunk and thighs, seen in the frames of their joints at T-pose.

    low, high: (B,) where along y each lies. middle: (B, HEIGHTS, 2) its x and z. reach: (B, HEIGHTS, ANGLES) how far the skin is from there, in directions from z towards x.
    thick: (P,) of an arm round its places. None of them where a body has no such skin.
    """

    low: np.ndarray
    high: np.ndarray
    middle: np.ndarray
    reach: np.ndarray
    thick: np.ndarray


@lru_cache(maxsize=64)
def girth(body: Body) -> Girth | None:
    """How thick a body is; None where trunk or thighs have no skin of their own to measure."""
    mesh, joints = body.levels[0], body.joints.astype(float)
    tall = joints[ARMS[:, 0], 1].mean()
    low, high, middle, reach = [], [], [], []
    trunk = _samples(mesh, [skin.STANDARD.index(name) for name in _TRUNK])
    for k, joint in enumerate(_SECTIONS):
        at = joints[joint]
        if k < len(_TRUNK):
            skinned = trunk
            ends = (trunk[:, 1].min() if k == 0 and len(trunk) else at[1]) - MARGIN * tall, (joints[_SECTIONS[k + 1], 1] if k < len(_TRUNK) - 1 else 0.93 * tall) + MARGIN * tall
        else:
            skinned = _samples(mesh, [joint])
            ends = joints[_KNEES[k - len(_TRUNK)], 1], at[1]
        if len(skinned) < ANGLES or not ends[1] > ends[0]:
            return None
        line = np.linspace(*ends, HEIGHTS)
        centre = _centre(skinned, line) if k < len(_TRUNK) else at[[0, 2]] + (line - at[1])[:, None] / (ends[0] - at[1]) * (joints[_KNEES[k - len(_TRUNK)]] - at)[[0, 2]]
        reach.append(_reach(skinned, line, centre))
        middle.append(centre - at[[0, 2]])
        low.append(ends[0] - at[1])
        high.append(ends[1] - at[1])
    return Girth(np.array(low), np.array(high), np.array(middle), np.array(reach), _thickness(mesh, joints))


def arms_out(body: Body, positions: np.ndarray, orientations: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """World turns (N, 2, 3, 3) of both upper arms, with all that hangs on them, that take arms out of trunk and thighs.

    positions, orientations: (N, 22, 3) [m], (N, 22, 3, 3) of the body as it is posed, at a scale (N,). No turn where nothing touches.
    """
    of, count = girth(body), len(positions)
    turns = np.tile(np.eye(3), (count, 2, 1, 1))
    if of is None:
        return turns
    shoulder, elbow, hand = (positions[:, ARMS[:, k]] for k in range(3))
    tip = hand + HAND * np.linalg.norm(hand - elbow, axis=-1, keepdims=True) * orientations[:, ARMS[:, 2]][..., 0] * _OUT
    starts, bones = np.stack([shoulder, elbow, hand], 2), np.stack([elbow - shoulder, hand - elbow, tip - hand], 2)
    arms = starts[:, :, _BONE] + _SHARE[:, None] * bones[:, :, _BONE] - shoulder[:, :, None]
    frames, at = orientations[:, _SECTIONS], positions[:, _SECTIONS]
    chest = frames[:, len(_TRUNK) - 1]
    cost = np.einsum("nij,j,nkj->nik", chest, STIFF, chest)[:, None]
    near = np.arange(count)
    for _ in range(ROUNDS):
        moved = np.einsum("naij,napj->napi", turns[near], arms[near])
        deep, slope, away = _depths(of, frames[near], at[near], scale[near], shoulder[near, :, None] + moved)
        touched = deep.any((1, 2, 3))
        if not touched.any():
            break
        near, moved, deep, slope, away = near[touched], moved[touched], deep[touched], slope[touched], away[touched]
        rows = slope[..., None] * np.cross(moved[:, :, :, None], away)
        pull = np.einsum("napb,napbi->nai", deep, rows)
        stiff = np.einsum("napbi,napbj->naij", rows, rows) + cost[near]
        step = np.linalg.solve(stiff, pull[..., None])[..., 0]
        turns[near] = Rotation.from_rotvec(step.reshape(-1, 3)).as_matrix().reshape(-1, 2, 3, 3) @ turns[near]
    whole = Rotation.from_matrix(turns.reshape(-1, 3, 3)).as_rotvec()
    size = np.linalg.norm(whole, axis=-1, keepdims=True)
    return Rotation.from_rotvec(whole * (MOST * np.tanh(size / MOST) / np.maximum(size, 1e-12))).as_matrix().reshape(count, 2, 3, 3)


def _depths(of: Girth, frames: np.ndarray, at: np.ndarray, scale: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """How deep (N, 2, P, B) [m] places (N, 2, P, 3) of arms are in each section, softly, how much deeper they get with each metre, and the ways out (N, 2, P, B, 3)."""
    size = scale[:, None, None, None]
    local = np.einsum("nbji,napbj->napbi", frames, places[:, :, :, None] - at[:, None, None]) / size[..., None]
    share = (local[..., 1] - of.low) / (of.high - of.low)
    beyond = (np.maximum(-share, 0.0) + np.maximum(share - 1.0, 0.0)) * (of.high - of.low)
    row = np.clip(share, 0.0, 1.0) * (HEIGHTS - 1)
    one = np.minimum(row.astype(int), HEIGHTS - 2)
    part, b = row - one, np.arange(len(of.low))
    middle = of.middle[b, one] + part[..., None] * (of.middle[b, one + 1] - of.middle[b, one])
    x, z = local[..., 0] - middle[..., 0], local[..., 2] - middle[..., 1]
    far = np.sqrt(x * x + z * z) + 1e-9
    turn = (np.arctan2(x, z) / (2 * np.pi) % 1.0) * ANGLES
    left = turn.astype(int) % ANGLES
    right, bit = (left + 1) % ANGLES, turn - turn.astype(int)
    lower = of.reach[b, one, left] * (1 - bit) + of.reach[b, one, right] * bit
    upper = of.reach[b, one + 1, left] * (1 - bit) + of.reach[b, one + 1, right] * bit
    deep = size * (lower + part * (upper - lower) + of.thick[:, None] - far - beyond)
    soft = np.where(deep >= SOFT, deep, np.maximum(deep + SOFT, 0.0) ** 2 / (4.0 * SOFT))
    return soft, np.clip((deep + SOFT) / (2.0 * SOFT), 0.0, 1.0), np.einsum("nbij,napbj->napbi", frames, np.stack([x / far, np.zeros_like(x), z / far], -1))


def _samples(mesh: Mesh, joints: list[int]) -> np.ndarray:
    """Places (K, 3) all over the triangles whose skin hangs on those joints, or helpers of theirs, more than on any other."""
    main = skin.AT[np.take_along_axis(mesh.joints, mesh.weights.argmax(1)[:, None], 1)[:, 0]]
    mine = np.isin(main, joints)[mesh.triangles].all(1)
    corners = mesh.positions[mesh.triangles[mine]].astype(float)
    a, b = np.meshgrid(np.arange(SAMPLES + 1) / SAMPLES, np.arange(SAMPLES + 1) / SAMPLES)
    a, b = a[a + b <= 1.0], b[a + b <= 1.0]
    return np.einsum("sk,tkj->tsj", np.stack([a, b, 1.0 - a - b], 1), corners).reshape(-1, 3)


def _centre(skinned: np.ndarray, line: np.ndarray) -> np.ndarray:
    """The middle (H, 2) of a trunk at heights (H,): x, z."""
    from scipy.ndimage import gaussian_filter1d  # not what a game without other bodies starts with

    out = np.full((len(line), 2), np.nan)
    step = line[1] - line[0]
    for k, y in enumerate(line):
        here = skinned[np.abs(skinned[:, 1] - y) <= step]
        if len(here):
            out[k] = 0.5 * (here[:, [0, 2]].min(0) + here[:, [0, 2]].max(0))
    known = np.flatnonzero(np.isfinite(out[:, 0]))
    out = np.stack([np.interp(np.arange(len(line)), known, out[known, i]) for i in range(2)], 1)
    return gaussian_filter1d(out, 2.0, axis=0, mode="nearest")


def _reach(skinned: np.ndarray, line: np.ndarray, centre: np.ndarray) -> np.ndarray:
    """How far (H, ANGLES) the outermost skin is from the middle (H, 2) at heights (H,), in each direction; what has none is between its neighbours."""
    from scipy.ndimage import gaussian_filter1d

    row = np.round((skinned[:, 1] - line[0]) / (line[1] - line[0])).astype(int)
    inside = (row >= 0) & (row < len(line))
    row, skinned = row[inside], skinned[inside]
    x, z = (skinned[:, [0, 2]] - centre[row]).T
    out = np.full((len(line), ANGLES), -1.0)
    np.maximum.at(out, (row, np.round(np.arctan2(x, z) / (2 * np.pi) * ANGLES).astype(int) % ANGLES), np.hypot(x, z))
    for ring in out:
        known = np.flatnonzero(ring >= 0.0)
        if len(known):
            ring[:] = np.interp(np.arange(ANGLES), known, ring[known], period=ANGLES)
    known = np.flatnonzero(out[:, 0] >= 0.0)
    out = np.stack([np.interp(np.arange(len(line)), known, out[known, k]) for k in range(ANGLES)], 1)
    return gaussian_filter1d(gaussian_filter1d(out, 1.0, axis=0, mode="nearest"), 0.7, axis=1, mode="wrap")


def _thickness(mesh: Mesh, joints: np.ndarray) -> np.ndarray:
    """How thick (P,) [m] both arms are round the places looked at."""
    found = np.zeros((2, len(PLACES)))
    for side, arm in enumerate(ARMS):
        ends = [*joints[arm], joints[arm[2]] + HAND * (joints[arm[2]] - joints[arm[1]])]
        for k, (bone, share) in enumerate(PLACES):
            skinned, line = _samples(mesh, [arm[bone]]), ends[bone + 1] - ends[bone]
            along = (skinned - ends[bone]) @ line / (line @ line)
            near = np.abs(along - share) < 0.15
            if near.any():
                found[side, k] = np.median(np.linalg.norm(skinned[near] - ends[bone] - along[near, None] * line, axis=1))
    return found.mean(0)
