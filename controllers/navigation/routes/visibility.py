"""Shortest ways past shapes, on one side of them and on the other: Dijkstra on a visibility graph.

The graph's places are corners of polygons round the shapes, a clearance away; its stretches are those that go round
corners (Lozano-Pérez and Wesley 1979). Another way past a shape is the shortest that does not cross the line from the
shape through the corner where the first way goes round it, up to what stands next.
"""

from __future__ import annotations

import math

import numpy as np

from ...compiled import kernel
from .shapes import clear, distance

CORNERS = 8
"""A shape's polygon has so many."""
ROOM = 1e-3
"""Polygons are so much farther away than they need be [m]."""
FARTHEST = 4.0
"""A line that tells two sides of a shape apart is so long at most [m]."""


def ways(start, goal, shapes: np.ndarray, clearance: float, most: int = 3, longest: float = 1.6) -> list[np.ndarray]:
    """Up to `most` ways (n, 2) [m] from start to goal, (2,) each, the shortest first, each past the shapes (K, 6) on other sides.

    clearance: how far they stay from all shapes [m]. longest: how much longer than the shortest a way may be. None where
    no way was found.
    """
    start, goal = np.asarray(start, float), np.asarray(goal, float)
    if clear(start[0], start[1], goal[0], goal[1], shapes, clearance):
        return [np.stack([start, goal])]
    nodes, owner = corners(shapes, clearance)
    nodes, owner = np.concatenate([[start, goal], nodes]), np.concatenate([[-1, -1], owner])
    lengths = stretches(nodes, owner, shapes, clearance)
    first = shortest(lengths)
    if not len(first):
        return []
    found = {tuple(first): _length(nodes[first])}
    for node in first[1:-1]:
        line = barrier(nodes[node], owner[node], shapes, clearance)
        other = shortest(without(lengths, nodes, line))
        if len(other):
            found.setdefault(tuple(other), _length(nodes[other]))
    near = sorted((length, way) for way, length in found.items())
    return [nodes[list(way)] for length, way in near[:most] if length <= longest * near[0][0]]


def _length(way: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())


def corners(shapes: np.ndarray, clearance: float) -> tuple[np.ndarray, np.ndarray]:
    """The corners (8K, 2) of the polygons round all shapes, in order, and whose they are."""
    far = (shapes[:, 5] + clearance + ROOM) / math.cos(math.pi / CORNERS)
    angles = (np.arange(CORNERS) + 0.5) * 2.0 * math.pi / CORNERS
    sine, cosine = np.sin(angles), np.cos(angles)
    u = np.sign(cosine) * shapes[:, 2:3] + far[:, None] * cosine
    w = np.sign(sine) * shapes[:, 3:4] + far[:, None] * sine
    c, s = np.cos(shapes[:, 4:5]), np.sin(shapes[:, 4:5])
    places = np.stack([shapes[:, 0:1] + c * u + s * w, shapes[:, 1:2] - s * u + c * w], -1)
    return places.reshape(-1, 2), np.repeat(np.arange(len(shapes)), CORNERS)


@kernel
def stretches(nodes, owner, shapes, clearance):
    """How long the straight stretches between places (N, 2) are (N, N) [m], inf where something is in their way or they
    lead into a corner rather than round it. Place 0 is the start, 1 the goal; the others belong to polygons."""
    count = nodes.shape[0]
    lengths = np.full((count, count), np.inf)
    usable = np.ones(count, np.bool_)
    out = np.empty(3)
    for i in range(2, count):
        for k in range(shapes.shape[0]):
            if distance(nodes[i, 0], nodes[i, 1], shapes[k], out) < clearance:
                usable[i] = False
    for i in range(count):
        for j in range(i):
            if usable[i] and usable[j] and _round(i, j, nodes, owner) and _round(j, i, nodes, owner) and clear(
                    nodes[i, 0], nodes[i, 1], nodes[j, 0], nodes[j, 1], shapes, clearance):
                lengths[i, j] = lengths[j, i] = math.hypot(nodes[i, 0] - nodes[j, 0], nodes[i, 1] - nodes[j, 1])
    return lengths


@kernel
def _round(i, j, nodes, owner):
    """Whether the line from place j touches the polygon of place i there, and does not run into it."""
    if owner[i] < 0:
        return True
    first = 2 + CORNERS * owner[i]
    before, after = first + (i - first - 1) % CORNERS, first + (i - first + 1) % CORNERS
    dx, dz = nodes[i, 0] - nodes[j, 0], nodes[i, 1] - nodes[j, 1]
    one = dx * (nodes[before, 1] - nodes[i, 1]) - dz * (nodes[before, 0] - nodes[i, 0])
    other = dx * (nodes[after, 1] - nodes[i, 1]) - dz * (nodes[after, 0] - nodes[i, 0])
    return one * other >= -1e-12


@kernel
def shortest(lengths):
    """The places on the shortest way from 0 to 1, after Dijkstra; none where no way leads there."""
    count = lengths.shape[0]
    far, source, done = np.full(count, np.inf), np.full(count, -1), np.zeros(count, np.bool_)
    far[0] = 0.0
    for _ in range(count):
        here = -1
        for i in range(count):
            if not done[i] and far[i] < np.inf and (here < 0 or far[i] < far[here]):
                here = i
        if here < 0 or here == 1:
            break
        done[here] = True
        for i in range(count):
            if far[here] + lengths[here, i] < far[i]:
                far[i], source[i] = far[here] + lengths[here, i], here
    way = np.empty(count, np.int64)
    if far[1] == np.inf:
        return way[:0]
    length, at = 0, 1
    while at >= 0:
        way[length] = at
        length, at = length + 1, source[at]
    return way[:length][::-1].copy()


@kernel
def barrier(corner, owner, shapes, clearance):
    """The line (4,) from the middle of a shape through a corner of its polygon, up to what stands next."""
    x, z = shapes[owner, 0], shapes[owner, 1]
    length = math.hypot(corner[0] - x, corner[1] - z)
    ux, uz = (corner[0] - x) / length, (corner[1] - z) / length
    out = np.empty(3)
    along = length
    while along < length + FARTHEST:
        near = FARTHEST
        for k in range(shapes.shape[0]):
            if k != owner:
                near = min(near, distance(x + along * ux, z + along * uz, shapes[k], out))
        if near < clearance:
            break
        along += max(near - clearance, 0.05)
    return np.array([x, z, x + along * ux, z + along * uz])


@kernel
def without(lengths, nodes, line):
    """The lengths (N, N) of those stretches that do not cross a line (4,)."""
    left = lengths.copy()
    ex, ez = line[2] - line[0], line[3] - line[1]
    count = nodes.shape[0]
    side, along = np.empty(count), np.empty(count)
    for i in range(count):
        dx, dz = nodes[i, 0] - line[0], nodes[i, 1] - line[1]
        side[i], along[i] = ex * dz - ez * dx, (ex * dx + ez * dz) / (ex * ex + ez * ez)
    for i in range(count):
        for j in range(i):
            if left[i, j] < np.inf and side[i] * side[j] <= 0.0 and side[i] != side[j]:
                share = side[i] / (side[i] - side[j])
                at = along[i] + share * (along[j] - along[i])
                if 0.0 <= at <= 1.0:
                    left[i, j] = left[j, i] = np.inf
    return left
