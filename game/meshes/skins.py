"""Gambol's bodies as surfaces that a tracker can pose, and figures as triangles in the world."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from gambol.controllers.body import Skeleton, human
from gambol.controllers.tracking.silhouettes import Surface, skin_kernel
from gambol.controllers.tracking.twists import chain_of

from ..render import LEVELS, Body, dressed, mannequin, scale_of, size_of, skin
from ..scene import Box, Figure, Goal, Pillar, Prop

SIDES = 32
"""Of a pillar."""
_CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
_FACES = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])


def surface_of(skeleton: Skeleton | None = None, freedom: Literal["paper", "full"] = "paper", body: Body | None = None,
               level: str = "near") -> Surface:
    """A body's skin on the chain of a skeleton, the mannequin on the standard human by default. level: how fine a mesh."""
    skeleton, body = skeleton or human(), body or mannequin()
    rest = np.zeros((len(skeleton), 3))
    for j, parent in enumerate(skeleton.parents):
        rest[j] = skeleton.offsets[j] + (rest[parent] if parent >= 0 else 0.0)
    size = float(scale_of(rest, body.joints, skeleton.parents))
    mesh = body.levels[LEVELS.index(level)]
    hands, twists = skin.borrowed()
    joints = len(skeleton)
    return Surface(chain_of(skeleton, freedom), mesh.positions * size, mesh.triangles, mesh.joints, mesh.weights, body.joints * size,
                   skin.AT[joints:], hands, twists)


def posed_meshes(figures: Sequence[Figure]) -> list[tuple[np.ndarray, np.ndarray, bool]]:
    """Each figure's vertices (V, 3) [m] in the world, triangles (T, 3), and whether only their outsides are seen, as it is drawn."""
    out = []
    for figure in dressed(figures):
        body = figure.body or mannequin()
        positions, orientations = figure.positions[None].astype(float), figure.orientations[None].astype(float)
        scale = size_of(body, positions)
        motion = skin.motions(positions, orientations, scale, body.joints)[0].reshape(-1, 8).astype(float)
        mesh = body.levels[0]
        vertices = np.ascontiguousarray(mesh.positions, float) * float(scale[0])
        made = np.empty_like(vertices)
        skin_kernel(vertices, mesh.joints.astype(np.int32), mesh.weights.astype(float), motion, made)
        out.append((made, mesh.triangles.astype(np.int32), not body.thin))
    return out


def solid_meshes(props: Sequence[Prop]) -> list[tuple[np.ndarray, np.ndarray, bool]]:
    """The same of what stands on the stage; goals are light, and hide nothing."""
    out = []
    for prop in props:
        if isinstance(prop, Goal):
            continue
        if isinstance(prop, Pillar):
            angles = 2 * np.pi * np.arange(SIDES) / SIDES
            ring = np.stack([np.sin(angles), np.zeros(SIDES), np.cos(angles)], 1) * prop.radius
            at = np.concatenate([ring, ring + [0, prop.height, 0]]) + prop.foot
            a = np.arange(SIDES)
            b = (a + 1) % SIDES
            faces = np.concatenate([np.stack([a, b, b + SIDES], 1), np.stack([a, b + SIDES, a + SIDES], 1),
                                    np.stack([np.zeros_like(a) + SIDES, a + SIDES, b + SIDES], 1)[1:-1]])
        else:
            at, faces = _box(prop)
        out.append((np.ascontiguousarray(at, float), faces.astype(np.int32), False))
    return out


def _box(box: Box) -> tuple[np.ndarray, np.ndarray]:
    at = _CUBE * 0.5 * np.array(box.size)
    at[:, 1] += box.slope * at[:, 2]
    c, s = np.cos(box.heading), np.sin(box.heading)
    at = at @ np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]]) + box.centre
    return at, np.concatenate([_FACES[:, [0, 1, 2]], _FACES[:, [0, 2, 3]]])
