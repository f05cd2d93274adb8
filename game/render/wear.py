"""A figure's pose on a body of other proportions.

The body is scaled until its legs are as long as the figure's, and its hips stand where the figure's
do; the limbs keep the body's own lengths. Where thigh and shank share the leg differently, two-bone
inverse kinematics brings the soles to where the figure's are, so that a foot that stands still
stands still on every body. Arms that would be in the body's own flesh are kept out of it (`girth`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from gambol.controllers.body import two_bone_turns

from ..scene import Figure
from . import skin
from .girth import ARMS, arms_out
from .mesh import Body, mannequin
from .view import scale_of

_UP = [skin.STANDARD.index(f"{side}UpLeg") for side in ("Left", "Right")]
_KNEES = [skin.STANDARD.index(f"{side}Leg") for side in ("Left", "Right")]
_FEET = [skin.STANDARD.index(f"{side}Foot") for side in ("Left", "Right")]


def leg_length(joints: np.ndarray) -> np.ndarray:
    """Mean length (...) [m] of thigh and shank together, of joints (..., 22, 3)."""
    thighs = np.linalg.norm(joints[..., _UP, :] - joints[..., _KNEES, :], axis=-1)
    return (thighs + np.linalg.norm(joints[..., _KNEES, :] - joints[..., _FEET, :], axis=-1)).mean(-1)


def ankle_height(positions: np.ndarray) -> np.ndarray:
    """How high (...) [m] the ankles of a standard human's figures (..., 22, 3) are above the sole."""
    return leg_length(positions) / leg_length(skin.REST) * skin.REST[_FEET[0], 1]


@lru_cache(maxsize=64)
def bulk(body: Body) -> float:
    """How far a body's flesh reaches from its joints over the mannequin's, for what its shadow may cover: at least 1."""
    return float(np.clip((_reach(body) / np.maximum(_reach(mannequin()), 0.1)).max(), 1.0, 3.0))


def _reach(body: Body) -> np.ndarray:
    """How far (22,) the flesh on each joint reaches over the length of the legs."""
    mesh, out = body.levels[-1], np.zeros(len(body.joints))
    joint = skin.AT[mesh.joints[np.arange(len(mesh.joints)), mesh.weights.argmax(1)]]
    np.maximum.at(out, joint, np.linalg.norm(mesh.positions - body.joints[joint], axis=1))
    return out / leg_length(body.joints)


def worn(body: Body, positions: np.ndarray, orientations: np.ndarray
         ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Joint positions (N, 22, 3) [m] and orientations (N, 22, 3, 3) of the body in figures' poses,
    and its scale (N,).

    positions, orientations: (N, 22, 3) [m], (N, 22, 3, 3) of figures with the standard human's proportions.
    """
    positions, orientations = np.asarray(positions, float), np.array(orientations, float)
    high = body.joints[_FEET, 1].mean()  # soles are at 0
    scale = (leg_length(positions) + ankle_height(positions)) / (leg_length(body.joints) + high)
    parents = skin.STANDARD.parents
    bones = (body.joints[1:] - body.joints[parents[1:]]) * scale[:, None, None]
    middle = 0.5 * (body.joints[_UP[0]] + body.joints[_UP[1]]) - body.joints[0]
    hips = 0.5 * (positions[:, _UP[0]] + positions[:, _UP[1]]) - np.einsum(
        "nij,nj->ni", orientations[:, 0], middle * scale[:, None])
    lower_sole = scale * high - ankle_height(positions)
    for up, knee, foot in zip(_UP, _KNEES, _FEET):
        at = _placed(hips, bones, orientations)
        # the sole, not the ankle, has to be where the figure's is
        target = positions[:, foot] + orientations[:, foot, :, 1] * lower_sole[:, None]
        line = at[:, foot] - at[:, up]
        bend = positions[:, knee] - positions[:, up]
        along = np.sum(bend * line, -1, keepdims=True) / np.maximum(np.sum(line * line, -1, keepdims=True), 1e-12)
        pole = bend - along * line + 0.02 * orientations[:, up, :, 2]
        upper, lower = two_bone_turns(at[:, up], at[:, knee], at[:, foot], target, pole)
        orientations[:, up] = upper @ orientations[:, up]
        orientations[:, knee] = lower @ orientations[:, knee]
    at = _placed(hips, bones, orientations)
    orientations[:, ARMS] = arms_out(body, at, orientations, scale)[:, :, None] @ orientations[:, ARMS]
    return _placed(hips, bones, orientations), orientations, scale


def dressed(figures: Sequence[Figure]) -> tuple[Figure, ...]:
    """Figures with the joints of what they wear, as they are drawn: where its own elbows are, not the standard human's."""
    out, wearers = list(figures), {}
    for k, figure in enumerate(figures):
        if figure.body is not None:
            wearers.setdefault(figure.body, []).append(k)
    for body, group in wearers.items():
        at, turned, _ = worn(body, np.stack([figures[k].positions for k in group]), np.stack([figures[k].orientations for k in group]))
        for k, positions, orientations in zip(group, at, turned):
            out[k] = replace(figures[k], positions=positions, orientations=orientations)
    return tuple(out)


def size_of(body: Body, positions: np.ndarray) -> np.ndarray:
    """The scale (N,) at which a body has joints at (N, 22, 3) [m], `dressed` in it."""
    return scale_of(positions, skin.REST, skin.STANDARD.parents) if body is mannequin() else leg_length(positions) / leg_length(body.joints)


def _placed(hips, bones, orientations):
    """Joint positions (N, 22, 3) from the hips (N, 3), bones (N, 21, 3) and orientations."""
    out = np.empty(orientations.shape[:2] + (3,))
    out[:, 0] = hips
    turned = np.einsum("njkl,njl->njk", orientations[:, skin.STANDARD.parents[1:]], bones)
    for j, parent in enumerate(skin.STANDARD.parents[1:], 1):
        out[:, j] = out[:, parent] + turned[:, j - 1]
    return out
