"""The control space: which primitives, and how much of each, give a wanted velocity.

Truong 2010, section III: velocities (v_f, ω, v_l) are points of a 3-D Delaunay triangulation and
the weights of the four primitives around a query are its barycentric coordinates (eq. 4). Beyond
the paper: axes are scaled, queries outside are brought back along the ray to the anchor (walking:
rest, which is the same path walked slower; running: straight on at the same speed), and because
blending is not linear in velocity, the error measured at the middle of every edge gives a
quadratic finite element of the velocity a blend really has, whose inverse corrects the query.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import ConvexHull, Delaunay, QhullError

from ..body import brief

SCALE = np.array([0.54, 0.99, 0.25])
"""Spread of (v_f, ω, v_l) in human walking [m/s, rad/s, m/s]: one unit of distance in the space."""
EDGES = np.array([(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)])
"""The six edges of a simplex, as pairs of its vertices."""
STRAIGHT = 0.35
"""Who turns less than this [rad/s] goes straight ahead."""
STEEPEST = 10.0
"""Simplices thinner than 1 / STEEPEST (scaled velocity) are slivers: weights would race across them."""
LANE = 0.95
"""A lane ends this share of the way to the hull, so that there is room around its ends."""
INSIDE = 1.0 - 1e-6
"""Clamped queries end this fraction of the way to the hull, so that rounding leaves them inside."""


@dataclass(frozen=True, eq=False)
class ControlSpace:
    """Q points in velocity space, triangulated into S simplices.

    points: (Q, 3) velocities, SI. anchor: (3,) an inner point and lane: (2,) how far v_f may be
    changed there without leaving the hull; outside queries move towards the nearest point of that
    stretch, which is the anchor alone where speed counts no more than turning.
    simplices, neighbours: (S, 4) vertices, and the simplex opposite to each (-1: none).
    transform: (S, 4, 3) as scipy's: barycentric b = T[:3] @ (p / SCALE − T[3]).
    hull: (H, 4) planes, n·(p / SCALE) + d ≤ 0 inside. bend: (S, 6, 3) what a half-and-half blend
    along each edge has beyond the mean of its ends' velocities.
    """

    __repr__ = brief

    points: np.ndarray
    anchor: np.ndarray
    lane: np.ndarray
    simplices: np.ndarray
    neighbours: np.ndarray
    transform: np.ndarray
    hull: np.ndarray
    bend: np.ndarray

    @staticmethod
    def build(points: np.ndarray, anchor: np.ndarray | None = None, keep_speed: bool = False) -> ControlSpace:
        """Triangulate velocities (Q, 3), finite ones. ValueError if they do not span the space.

        anchor: (3,) the mean by default; one that is not well inside is moved towards the mean.
        keep_speed: whether queries outside keep their v_f as far as the hull reaches; the anchor by
        default is then the mean v_f, straight on.
        """
        points = np.asarray(points, float)
        if points.shape[1:] != (3,) or not np.isfinite(points).all():
            raise ValueError(f"the velocities must be (Q, 3) v_f, ω, v_l, all finite; got an array of shape {points.shape}")
        scaled = points / SCALE
        if len(scaled) < 4 or np.linalg.matrix_rank(scaled - scaled[0], tol=1e-3) < 3:
            raise ValueError("the velocities must span all three of v_f, ω and v_l: "
                             f"{len(scaled)} points given")
        try:
            mesh, hull = Delaunay(scaled), ConvexHull(scaled)
        except QhullError as error:
            raise ValueError(f"the velocities can't be triangulated: {str(error).splitlines()[0]}") from None
        sound = np.isfinite(mesh.transform).all((1, 2))
        middle = scaled.mean(0)
        straight = middle * [1.0, 0.0, 0.0] if keep_speed else middle
        inner = straight if anchor is None else np.asarray(anchor, float) / SCALE
        for _ in range(40):  # an anchor on the hull's rim (rest, where nobody walks backward) moves inwards
            if np.all(hull.equations @ np.append(inner, 1.0) < -1e-3):
                break
            inner = inner + 0.1 * (middle - inner)
        lane = np.full(2, inner[0])
        if keep_speed:
            slope, room = hull.equations[:, 0], -(hull.equations @ np.append(inner, 1.0))
            lane += LANE * np.array([(room[slope < 0] / slope[slope < 0]).max(), (room[slope > 0] / slope[slope > 0]).min()])
        space = ControlSpace(np.asarray(points, float), inner * SCALE, lane * SCALE[0], mesh.simplices.astype(np.int64),
                             mesh.neighbors.astype(np.int64), mesh.transform,
                             np.unique(np.round(hull.equations, 12), axis=0),
                             np.zeros((len(mesh.simplices), 6, 3)))
        if not sound.all():
            raise ValueError(f"{(~sound).sum()} simplices are flat: thin out the velocities")
        return space

    def clamp(self, query: np.ndarray, towards: np.ndarray | None = None) -> np.ndarray:
        """Queries (..., 3) brought into the hull along the ray to a point (..., 3) in it: the lane's nearest."""
        query = np.asarray(query, float)
        if towards is None:
            towards = np.broadcast_to(self.anchor, query.shape).copy()
            towards[..., 0] = np.clip(query[..., 0], *self.lane)
        origin = towards / SCALE
        ray = query / SCALE - origin
        room = np.maximum(-(origin @ self.hull[:, :3].T + self.hull[:, 3]), 1e-12)
        reach = np.max(ray @ self.hull[:, :3].T / room, axis=-1)
        return (origin + ray / np.maximum(reach / INSIDE, 1.0)[..., None]) * SCALE

    def inside(self, query: np.ndarray) -> np.ndarray:
        """Whether queries (..., 3) lie in the hull: (...) bool."""
        return np.all(np.asarray(query) / SCALE @ self.hull[:, :3].T + self.hull[:, 3] <= 1e-9, -1)

    def straight(self) -> tuple[float, float]:
        """The slowest and the fastest way straight ahead (v_f) [m/s] in the hull, no slower than the slowest that was
        recorded there: halfway between two turns lies no gait."""
        slope, room = self.hull[:, 0], -self.hull[:, 3] * INSIDE
        with np.errstate(divide="ignore"):
            reach = room / slope
        low, high = SCALE[0] * float(reach[slope < 0].max()), SCALE[0] * float(reach[slope > 0].min())
        recorded = self.points[np.abs(self.points[:, 1]) < STRAIGHT, 0].min(initial=high)
        return min(max(low, float(recorded)), high) if recorded < high else low, high

    def half_spaces(self, share: float = 1.0) -> np.ndarray:
        """The hull as half-spaces (H, 4) of velocities themselves: n·(v_f, ω, v_l) + d ≤ 0 inside, n of unit length in `SCALE`.
        share: how much of the way from rest to it is used."""
        return np.hstack([self.hull[:, :3] / SCALE, share * self.hull[:, 3:]])

    def locate(self, query: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The simplex (...) and barycentric weights (..., 4) of queries (..., 3), clamped first: eq. (4)."""
        p = self.clamp(query).reshape(-1, 1, 3) / SCALE
        b = np.einsum("sij,nsj->nsi", self.transform[:, :3], p - self.transform[None, :, 3])
        b = np.concatenate([b, 1 - b.sum(-1, keepdims=True)], -1)
        best = np.argmax(b.min(-1), -1)
        weights = np.maximum(b[np.arange(len(b)), best], 0.0)
        weights /= weights.sum(-1, keepdims=True)
        shape = np.shape(query)[:-1]
        return best.reshape(shape), weights.reshape(shape + (4,))

    def weights(self, query: np.ndarray, correct: int = 2) -> np.ndarray:
        """Dense weights (..., Q) for queries (..., 3), after `correct` fixed-point corrections."""
        target = self.clamp(query)
        moved = target
        for _ in range(correct):
            moved = self.clamp(target - self.deviation(moved), target)
        simplex, part = self.locate(moved)
        dense = np.zeros(simplex.shape + (len(self.points),))
        np.put_along_axis(dense, self.simplices[simplex], part, -1)
        return dense

    def deviation(self, query: np.ndarray) -> np.ndarray:
        """Blended minus nominal velocity (..., 3) at queries: Σ 4 b_i b_j · bend of edge ij."""
        simplex, b = self.locate(query)
        pairs = 4 * b[..., EDGES[:, 0]] * b[..., EDGES[:, 1]]
        return np.einsum("...e,...ei->...i", pairs, self.bend[simplex])

    def edges(self) -> tuple[np.ndarray, np.ndarray]:
        """All edges (E, 2) as pairs of points, and which edge (S, 6) each simplex edge is."""
        pairs = np.sort(self.simplices[:, EDGES].reshape(-1, 2), -1)
        unique, number = np.unique(pairs, axis=0, return_inverse=True)
        return unique, number.reshape(-1, 6)

    def with_bend(self, bend: np.ndarray) -> ControlSpace:
        """The same space, knowing the deviations (E, 5) of its edges: two points and what their
        half-and-half blend has beyond the mean (v_f, ω, v_l). Edges not told of count as straight."""
        known = {(int(i), int(j)): deviation for i, j, *deviation in bend}
        pairs, number = self.edges()
        return replace(self, bend=np.array([known.get((i, j), (0.0, 0.0, 0.0)) for i, j in pairs.tolist()])[number])

    def quality(self) -> np.ndarray:
        """How round each simplex is (S,): 1 regular, 0 flat (3 · inradius / circumradius)."""
        corners = (self.points / SCALE)[self.simplices]
        a, b, c = (corners[:, i] - corners[:, 3] for i in range(3))
        volume = np.abs(np.einsum("si,si->s", a, np.cross(b, c))) / 6
        faces = [np.cross(a, b), np.cross(b, c), np.cross(c, a), np.cross(a - c, b - c)]
        area = sum(np.linalg.norm(f, axis=-1) for f in faces) / 2
        square = [np.sum(v * v, -1) for v in (a, b, c)]
        centre = (square[0][:, None] * np.cross(b, c) + square[1][:, None] * np.cross(c, a)
                  + square[2][:, None] * np.cross(a, b))
        circumradius = np.linalg.norm(centre, axis=-1) / (12 * volume)
        return 9 * volume / area / circumradius

    def lipschitz(self) -> float:
        """The steepest slope of any weight over the space, per unit of scaled velocity."""
        return float(_slopes(self.transform).max())


def _slopes(transform: np.ndarray) -> np.ndarray:
    """How steeply each vertex' weight (S, 4) changes in its simplex, per unit of scaled velocity."""
    rows = np.concatenate([transform[:, :3], -transform[:, :3].sum(1, keepdims=True)], 1)
    return np.linalg.norm(rows, axis=-1)


def thin(points: np.ndarray, keep: np.ndarray, steepest: float = STEEPEST) -> np.ndarray:
    """Numbers of the points (Q, 3) that remain when no simplex is a sliver any more.

    Of the thinnest simplex the vertex nearest to its opposite face goes: what it told, its
    neighbours nearly tell. keep: (Q,) bool, points that stay whatever happens.
    """
    left = np.arange(len(points))
    while len(left) > 5:
        try:
            mesh = Delaunay(points[left] / SCALE)
        except QhullError:  # flat altogether: whoever triangulates it says so
            break
        slope = np.nan_to_num(_slopes(mesh.transform), nan=np.inf)
        slope[keep[left][mesh.simplices]] = 0.0
        simplex, vertex = np.unravel_index(np.argmax(slope), slope.shape)
        if slope[simplex, vertex] <= steepest:
            break
        left = np.delete(left, mesh.simplices[simplex, vertex])
    return left
