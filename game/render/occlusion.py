"""What keeps the sky's light away: limbs as capsules, solids as boxes and cylinders, all in one uniform block.

How much they hide is worked out from their shapes alone, without samples: nothing to smooth, nothing to shimmer.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from gambol.controllers.body import HEEL, end_positions

from ..scene import Box, Camera, Figure, Pillar
from . import gl, skin
from .view import scale_of

FIGURES, SOLIDS = 16, 48
"""How many of either count, the nearest first."""
REACH = 0.5
"""How far from a limb its darkening ends [m]; as in occlusion.glsl."""

# each limb: where it begins and ends (joints, or the tip of the first one's bone) and its radius [m]
_LIMBS = tuple((f"{side}{a}", b if b == "tip" else f"{side}{b}", radius) for side in ("Left", "Right")
               for a, b, radius in (("UpLeg", "Leg", 0.075), ("Leg", "Foot", 0.050), ("Arm", "ForeArm", 0.048),
                                    ("ForeArm", "Hand", 0.040), ("Hand", "tip", 0.036))) + (
    ("Hips", "Spine1", 0.130), ("Spine1", "Neck", 0.130), ("Head", "tip", 0.095))
_JOINTS, _TIPS = skin.STANDARD, {skin.STANDARD.names[i]: k for k, i in enumerate(skin.STANDARD.end_parents)}
_FIRST = np.array([_JOINTS.index(a) for a, _, _ in _LIMBS])
_LAST = np.array([len(_JOINTS) + _TIPS[a] if b == "tip" else _JOINTS.index(b) for a, b, _ in _LIMBS])
_FEET = np.array([_JOINTS.index(f"{side}Foot") for side in ("Left", "Right")])
_TOES = np.array([_TIPS[f"{side}Toe"] for side in ("Left", "Right")])
_SOLE = 0.036
_RADII = np.array([radius for _, _, radius in _LIMBS] + [_SOLE] * 2)
COUNT = len(_RADII)
"""Capsules of a figure."""


def limbs(figures: Sequence[Figure]) -> np.ndarray:
    """The capsules (N, COUNT, 2, 4) of figures in the world, the lowest first: its two ends [m], the radius and its
    lower end's height [m]."""
    if not figures:
        return np.zeros((0, COUNT, 2, 4))
    at = np.stack([f.positions for f in figures]).astype(float)
    turn = np.stack([f.orientations for f in figures]).astype(float)
    scale = scale_of(at, skin.REST, skin.STANDARD.parents)[:, None]
    tips = end_positions(skin.STANDARD, at, turn)
    points = np.concatenate([at, tips], 1)
    # a foot lies on its sole: from the heel to the toes' end, its own radius above and within either
    heels = at[:, _FEET] + turn[:, _FEET] @ HEEL * scale[..., None]
    toes, size = tips[:, _TOES], scale[..., None] * _SOLE
    along = (toes - heels) / np.maximum(np.linalg.norm(toes - heels, axis=-1, keepdims=True), 1e-9) * size
    up = size * [0.0, 1.0, 0.0]
    out = np.empty((len(figures), COUNT, 2, 4))
    out[..., 0, :3] = np.concatenate([points[:, _FIRST], heels + along + up], 1)
    out[..., 1, :3] = np.concatenate([points[:, _LAST], toes - along + 0.6 * up], 1)
    out[..., 0, 3], out[..., 1, 3] = _RADII * scale, out[..., 1].min(2)
    return np.take_along_axis(out, np.argsort(out[..., 1, 3], 1)[..., None, None], 1)


def solid_rows(solids: Sequence[Box | Pillar]) -> np.ndarray:
    """Rows (N, 12): centre and 1 if round, half its size and 0, cosine and sine of its heading, its slope, zero."""
    rows = np.zeros((len(solids), 12))
    for row, solid in zip(rows, solids):
        if isinstance(solid, Pillar):
            row[:4] = *(np.array(solid.foot) + [0.0, 0.5 * solid.height, 0.0]), 1.0
            row[4:7], row[8] = (solid.radius, 0.5 * solid.height, solid.radius), 1.0
        else:
            row[:3], row[4:7] = solid.centre, 0.5 * np.array(solid.size)
            row[8:11] = np.cos(solid.heading), np.sin(solid.heading), solid.slope
    return rows


class Occluders:
    """The uniform block of occlusion.glsl; made once per context."""

    def __init__(self, ctx: Any):
        self.data = np.zeros(4 + FIGURES * 4 + FIGURES * COUNT * 8 + SOLIDS * 12, np.float32)
        self.block = ctx.buffer(reserve=self.data.nbytes, dynamic=True)

    def prepare(self, camera: Camera, figures: Sequence[Figure], solids: Sequence[Box | Pillar], origin: np.ndarray
                ) -> None:
        """Tell the shaders what hides the sky in a scene; positions count from `origin` (3,) [m]."""
        target = np.asarray(camera.target, float)
        figures = sorted(figures, key=lambda f: np.linalg.norm(f.positions[0] - target))[:FIGURES]
        rows = solid_rows(solids)
        if len(rows) > SOLIDS:
            away = np.maximum(np.abs(rows[:, :3] - target) - rows[:, 4:7].max(1, keepdims=True), 0.0)
            rows = rows[np.argsort(np.linalg.norm(away, axis=1), kind="stable")[:SOLIDS]]
        rows[:, :3] -= origin
        capsules = limbs(figures)
        capsules[..., :3] -= origin  # on the floor: heights stay
        # the ball that holds all capsules of a figure, and what they darken
        middle = capsules[..., :3].mean((1, 2))
        far = (np.linalg.norm(capsules[..., :3] - middle[:, None, None], axis=-1) + REACH).max((1, 2), initial=0.0)
        self.data[:4] = len(figures), len(rows), 0, 0
        blocks = np.split(self.data[4:], np.cumsum([FIGURES * 4, FIGURES * COUNT * 8]))
        for block, values in zip(blocks, (np.concatenate([middle, far[:, None] ** 2], 1), capsules, rows)):
            block[:values.size] = values.ravel()
        self.block.orphan()
        self.block.write(self.data.tobytes())
        self.block.bind_to_uniform_block(gl.OCCLUDERS)

    def release(self) -> None:
        self.block.release()
