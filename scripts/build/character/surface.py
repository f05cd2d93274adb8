"""From signed distances to a mesh: marching cubes, collapsing short edges, settling on the surface."""

from __future__ import annotations

import heapq

import numpy as np

from . import shape


def sampled(cell: float) -> tuple[np.ndarray, np.ndarray]:
    """Distances on a grid of `cell` metres, (X, Y, Z), and the grid's first corner (3,).

    Only blocks near the surface are sampled finely; the rest keep their middle's distance. Only the
    left half is computed, half a cell off the middle, and mirrored.
    """
    block = 8
    low, high = np.array([0.5 * cell, -0.04, -0.18]), np.array([0.96, 1.80, 0.26])
    counts = np.ceil((high - low) / (cell * block)).astype(int)
    middles = low + (np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), -1) + 0.5) * block * cell
    coarse = shape.body(middles.reshape(-1, 3)).reshape(counts)
    grid = np.repeat(np.repeat(np.repeat(coarse, block, 0), block, 1), block, 2)
    inside = np.stack(np.meshgrid(*[np.arange(block)] * 3, indexing="ij"), -1) * cell
    for at in np.argwhere(np.abs(coarse) < 1.6 * block * cell):
        points = low + at * block * cell + inside
        s = tuple(slice(a * block, (a + 1) * block) for a in at)
        grid[s] = shape.body(points.reshape(-1, 3)).reshape(block, block, block)
    return np.concatenate([grid[::-1], grid]), low - [grid.shape[0] * cell, 0.0, 0.0]


def marched(cell: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (V, 3) [m] on the surface and triangles (T, 3), counter-clockwise from outside."""
    from skimage.measure import marching_cubes

    grid, low = sampled(cell)
    vertices, faces, _, _ = marching_cubes(grid, 0.0, spacing=(cell,) * 3, allow_degenerate=False)
    vertices = vertices + low
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    outward = np.einsum("ij,ij->i", np.cross(b - a, c - a), shape.gradient((a + b + c) / 3))
    return settled(vertices), faces if np.median(outward) > 0 else faces[:, ::-1]


def settled(vertices: np.ndarray, rounds: int = 3) -> np.ndarray:
    """Vertices drawn onto the surface along its gradient."""
    for _ in range(rounds):
        distance = np.clip(shape.body(vertices), -0.01, 0.01)
        vertices = vertices - 0.9 * distance[:, None] * shape.gradient(vertices)
    return vertices


def edge_length(points: np.ndarray, fine: float) -> np.ndarray:
    """How long edges should be at points (N, 3) [m]: finer at hands, head, feet and where joints bend."""
    x, y, z = np.abs(points[:, 0]), points[:, 1], points[:, 2]
    size = np.full(len(points), 1.55)
    for near, radius, least in (((0.85, 1.425, -0.015), 0.15, 0.52), ((0.0, 1.61, 0.08), 0.13, 0.75),
                                ((0.0875, 0.03, 0.12), 0.16, 0.85), ((0.4617, 1.425, -0.015), 0.11, 1.05),
                                ((0.0875, 0.502, 0.0), 0.13, 1.15), ((0.18, 1.425, -0.015), 0.14, 1.15),
                                ((0.0875, 0.93, 0.0), 0.16, 1.30)):
        away = np.linalg.norm(np.stack([x, y, z], 1) - near, axis=1)
        size = np.minimum(size, np.where(away < radius, least, least + (away - radius) * 8.0))
    return fine * size


def collapsed(vertices: np.ndarray, faces: np.ndarray, wanted: int, fine: float = 0.011) -> tuple[np.ndarray, np.ndarray]:
    """About `wanted` triangles: short edges, measured against `edge_length`, collapse first.

    Quadrics place each merged vertex, so that thin parts keep their shape.
    """
    at = vertices.copy()
    tris = [list(map(int, f)) for f in faces]
    alive = [True] * len(tris)
    around = [set() for _ in at]
    for t, f in enumerate(tris):
        for v in f:
            around[v].add(t)
    a, b, c = (at[faces[:, i]] for i in range(3))
    n = np.cross(b - a, c - a)
    n /= np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-12)
    plane = np.concatenate([n, -np.sum(n * a, 1, keepdims=True)], 1)
    quadric = np.zeros((len(at), 4, 4))
    for i in range(3):
        np.add.at(quadric, faces[:, i], plane[:, :, None] * plane[:, None, :])
    wish = edge_length(at, fine)
    stamp = [0] * len(at)
    heap: list = []

    def push(u, v):
        middle = 0.5 * (at[u] + at[v])
        p = np.append(middle, 1.0)
        error = float(p @ (quadric[u] + quadric[v]) @ p)
        ratio = np.linalg.norm(at[u] - at[v]) / (0.5 * (wish[u] + wish[v]))
        heapq.heappush(heap, (ratio * ratio + error * 4e5, u, v, stamp[u], stamp[v]))
    for u, v in {(min(e), max(e)) for f in tris for e in ((f[0], f[1]), (f[1], f[2]), (f[2], f[0]))}:
        push(u, v)
    count = len(tris)
    while heap and count > wanted:
        _, u, v, su, sv = heapq.heappop(heap)
        if su != stamp[u] or sv != stamp[v]:
            continue
        shared = around[u] & around[v]
        ring_u = {w for t in around[u] for w in tris[t]}
        ring_v = {w for t in around[v] for w in tris[t]}
        if len(shared) != 2 or len(ring_u & ring_v) != 4:
            continue  # the collapse would pinch the surface
        target = 0.5 * (at[u] + at[v])
        if any(_flips(at, tris[t], u, v, target) for t in around[u] ^ around[v]):
            continue
        at[u], wish[u] = target, 0.5 * (wish[u] + wish[v])
        quadric[u] += quadric[v]
        for t in shared:
            alive[t] = False
            for w in tris[t]:
                around[w].discard(t)
        count -= 2
        for t in around[v]:
            tris[t][tris[t].index(v)] = u
            around[u].add(t)
        around[v] = set()
        stamp[u] += 1
        stamp[v] += 1
        for w in {w for t in around[u] for w in tris[t]} - {u}:
            push(min(u, w), max(u, w))
    kept = np.array([f for f, a in zip(tris, alive) if a])
    used, index = np.unique(kept, return_inverse=True)
    return at[used], index.reshape(-1, 3)


def _flips(at, tri, u, v, target):
    old = [at[w] for w in tri]
    new = [target if w in (u, v) else at[w] for w in tri]
    m = np.cross(new[1] - new[0], new[2] - new[0])
    n = np.cross(old[1] - old[0], old[2] - old[0])
    return float(n @ m) <= 0.3 * np.linalg.norm(n) * np.linalg.norm(m)


def neighbours(faces: np.ndarray, count: int):
    """The mesh's averaging matrix (V, V), sparse: each row the mean over a vertex's neighbours."""
    from scipy.sparse import coo_matrix, diags

    e = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    e = np.concatenate([e, e[:, ::-1]])
    near = coo_matrix((np.ones(len(e)), (e[:, 0], e[:, 1])), (count, count)).tocsr()
    near.data[:] = 1.0
    return diags(1.0 / np.maximum(near.sum(1).A1 if hasattr(near.sum(1), "A1") else np.asarray(near.sum(1)).ravel(), 1)) @ near


def relaxed(vertices: np.ndarray, faces: np.ndarray, rounds: int = 6) -> np.ndarray:
    """Vertices spread evenly over the surface without leaving it."""
    mean = neighbours(faces, len(vertices))
    for _ in range(rounds):
        step = 0.5 * (mean @ vertices - vertices)
        n = shape.gradient(vertices)
        vertices = settled(vertices + step - n * np.sum(step * n, 1, keepdims=True), 1)
    return settled(vertices, 3)


def openness(vertices: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """How open (V,) each vertex is to the sky, 0 … 1, from the distances along its normal."""
    dark = np.zeros(len(vertices))
    for k, reach in enumerate((0.008, 0.02, 0.04, 0.07, 0.11, 0.16)):
        dark += np.clip(1.0 - shape.body(vertices + reach * normals) / reach, 0.0, 1.0) * 0.62**k
    return np.clip(1.0 - 0.55 * dark, 0.15, 1.0)
