"""The mannequin's two materials as two sets of triangles, for files that know no shader of ours."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..render import Mesh, skin
from .surface import unit


def field(at: np.ndarray) -> np.ndarray:
    """How far (N,) [m] points (N, 3) on the standard mannequin lie inside the dark material: paint.glsl's first value."""
    x, y, z = np.abs(at[:, 0]), at[:, 1], at[:, 2]

    def strip(t, low, high):
        return np.minimum(t - low, high - t)
    least = np.full(len(at), -0.03)
    arm = np.maximum(x - 0.722 - 0.10 * np.abs(z + 0.015),
                     strip(x + 0.30 * np.clip(z + 0.015, -0.05, 0.05), 0.436, 0.490))
    leg = np.maximum(0.098 - 0.22 * np.clip(z, -0.08, 0.06) - y, strip(y - 0.25 * np.clip(z, -0.05, 0.05), 0.470, 0.540))
    collar = np.where(x < 0.10, strip(y + 0.35 * np.clip(z, -0.05, 0.10) - 2.6 * x * x, 1.492, 1.522), -0.03)
    radii = np.array([0.063, 0.074, 0.085])
    q = (at - [0.0, 1.605, 0.120]) / radii
    k0, k1 = np.linalg.norm(q, axis=1), np.linalg.norm(q / radii, axis=1)
    belt = strip(y - 1.9 * x * x + 0.12 * z, 1.030, 1.088)
    trunk = np.maximum(np.maximum(belt, collar), k0 * (1.0 - k0) / np.maximum(k1, 1e-9))
    return np.maximum(least, np.where(x > 0.24, arm, np.where(y < 0.80, leg, trunk)))


def cut(mesh: Mesh) -> tuple[Mesh, np.ndarray]:
    """The mesh cut along the border of its two materials, and which of its triangles (T,) are dark."""
    value = field(mesh.paint.astype(float))
    dark = value > 0.0
    faces = mesh.triangles.astype(np.int64)
    mixed = dark[faces].any(1) & ~dark[faces].all(1)
    # turn each mixed triangle so that its lone corner comes first
    some = faces[mixed]
    lone = np.argmax(dark[some] == (dark[some].sum(1) == 1)[:, None], 1)
    some = some[np.arange(len(some))[:, None], (lone[:, None] + np.arange(3)) % 3]
    edges = np.sort(np.concatenate([some[:, [0, 1]], some[:, [0, 2]]]), 1)
    edges, which = np.unique(edges, axis=0, return_inverse=True)
    p, q = len(mesh.positions) + which.ravel().reshape(2, -1)
    a, b, c = some.T
    pieces = np.concatenate([np.stack(t, 1) for t in ((a, p, q), (p, b, c), (p, c, q))])
    sides = np.concatenate([dark[a], dark[b], dark[b]])
    triangles = np.concatenate([faces[~mixed], pieces])
    grown = _with(mesh, edges, _crossing(mesh, edges))
    return replace(grown, triangles=triangles), np.concatenate([dark[faces[~mixed, 0]], sides])


def _crossing(mesh, edges):
    """How far along each edge (E,) the border runs, by halving."""
    start, end = (mesh.paint[edges[:, i]].astype(float) for i in (0, 1))
    side = field(start) > 0.0
    low, high = np.zeros(len(edges)), np.ones(len(edges))
    for _ in range(12):
        middle = 0.5 * (low + high)
        same = (field(start + middle[:, None] * (end - start)) > 0.0) == side
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return np.clip(0.5 * (low + high), 0.04, 0.96)


def _with(mesh, edges, share):
    """The mesh with one more vertex on each edge (E, 2)."""
    def between(values):
        start, end = values[edges[:, 0]], values[edges[:, 1]]
        return start + share.reshape(-1, *[1] * (values.ndim - 1)) * (end - start)
    full = np.zeros((len(mesh.positions), len(skin.NAMES)))
    for k in range(4):
        full[np.arange(len(full)), mesh.joints[:, k]] += mesh.weights[:, k]
    mixed = between(full)
    joints = np.argsort(-mixed, 1)[:, :4]
    weights = np.take_along_axis(mixed, joints, 1)
    grown = {"positions": between(mesh.positions), "normals": unit(between(mesh.normals)), "joints": joints,
             "weights": weights / weights.sum(1, keepdims=True), "open": between(mesh.open), "paint": between(mesh.paint)}
    return replace(mesh, **{name: np.concatenate([getattr(mesh, name), value]).astype(getattr(mesh, name).dtype)
                            for name, value in grown.items()})
