"""The pose that fits contours: render the model, match contours both ways, solve for a step of twists, and again (section 2.3)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve as solved

from ..cameras import Lens, direction_kernel, project_kernel
from ..silhouettes import Surface, View, contour_of, redrawn, skinned
from ..together import together
from ..twists import Configuration, adjoint, posed, retract_kernel
from .evidence import overlap
from .matching import closest_kernel, model_points_kernel, shift_kernel, sums_kernel
from .observed import Observed
from .penaliser import Penalty, penalty_rows


@dataclass(frozen=True)
class SolverSettings:
    """outer: how often the model is drawn. inner: steps for each. reach: how far off a contour is still a match, over the
    body's height in the picture. bend: where its pull stops growing [pixels]. facing: what opposite normals count [pixels].
    points: of each contour that seek a match. effective: what all of them count for, as neighbours say the same.
    damping: of a step, over what a pixel's worth of evidence weighs. both: match from the model to the picture, and back.
    """

    outer: int = 4
    inner: int = 2
    reach: float = 0.08
    bend: float = 3.0
    facing: float = 8.0
    points: int = 300
    effective: float = 400.0
    damping: float = 1e-3
    both: bool = True


SETTINGS = SolverSettings()
AROUND = 4
"""So many pixels round a model say where its contour faces."""


@dataclass(frozen=True, eq=False)
class Fit:
    """where: the pose. residual: mean distance of contours [pixels]. overlaps: (C,) of the starting pose with each mask.
    NaN where
    a camera shows nobody, and should not. believed: (C,) which cameras had a say. matrix (6 + D, 6 + D), vector (6 + D,): what cameras say of a step from there, which
    costs ½ δᵀ M δ − vᵀ δ [pixels²] without the penalty; the root's part is a shift of the hips and a turn about them."""

    where: Configuration
    residual: float
    overlaps: np.ndarray
    believed: np.ndarray
    matrix: np.ndarray
    vector: np.ndarray


@dataclass(frozen=True, eq=False)
class _Drawn:
    """A model's contour in one view: its points about the centre (N, 3) [m], the vertices about them, pixels and normals (N, 4)."""

    points: np.ndarray
    corners: np.ndarray
    edge: np.ndarray


def solve(surface: Surface, views: Sequence[Observed], start: Configuration, penalty: Penalty | None = None,
          believe: Callable[[np.ndarray], np.ndarray] | None = None, settings: SolverSettings = SETTINGS,
          shown: list[View | None] | None = None) -> Fit:
    """The pose near `start` that fits what cameras see, and the penalty.

    believe: told how `start` overlaps each mask (C,), it says which cameras (C,) bool have a say; all by default. shown: the
    surface at `start` as each camera sees it, where that was drawn already; in their place the last drawn views are left.
    """
    chain, size = surface.chain, 6 + len(surface.chain)
    centre = start.root[:3, 3].copy()
    root, angles = start.root.copy(), start.angles.copy()
    root[:3, 3] -= centre
    overlaps, residual, believed = np.zeros(len(views)), 0.0, np.ones(len(views), bool)
    buffers: list[View | None] = [None] * len(views) if shown is None else shown
    views = list(views)
    seen, left = np.zeros((size, size)), np.zeros(size)
    for outer in range(settings.outer):
        world = root.copy()
        world[:3, 3] += centre
        positions, orientations, _ = posed(chain, Configuration(world, angles))
        vertices = skinned(surface, positions, orientations)

        def draw(k: int, vertices=vertices, first=outer == 0, believed=believed) -> _Drawn | None:
            if not believed[k]:
                return None
            view = views[k]
            made = buffers[k]
            if made is None or shown is None or not first:
                buffers[k] = made = redrawn(view.lens, vertices, surface.triangles, made)
            if first:
                box = _around(made.box, settings.reach)
                overlaps[k] = _overlap(view, made, box)
                views[k] = view.within(box)
            return _points(view.lens, made, surface, centre)
        drawn = together(draw, range(len(views)))
        if outer == 0 and believe is not None:
            believed = believe(overlaps)
            drawn = [one if sure else None for one, sure in zip(drawn, believed)]
        step, columns = None, None
        for _ in range(settings.inner):
            moved_by, turned_about = step, columns
            _, _, columns = posed(chain, Configuration(root, angles))
            matrix, vector, residual = _sums(surface, views, drawn, columns, centre, settings, moved_by, turned_about)
            here = Configuration(root, angles)
            regular = settings.damping * max(float(np.trace(matrix)) / size, 1e-9)
            seen = matrix + np.triu(matrix, 1).T
            full, pull = seen.copy(), vector
            full[np.arange(size), np.arange(size)] += regular
            if penalty is not None:
                moved = Configuration(penalty.target.root.copy(), penalty.target.angles)
                moved.root[:3, 3] -= centre
                full[np.arange(size), np.arange(size)] += penalty.weights
                pull = vector + penalty.weights * penalty_rows(chain, Penalty(moved, penalty.weights), here, np.zeros(3))
            step = solved(full, pull, assume_a="pos", check_finite=False)
            step *= min(1.0, 0.5 / max(float(np.abs(step[3:]).max()), 1e-12))
            left = vector - seen @ step  # of what cameras say, after it
            retract_kernel(chain.first, chain.count, step, root, angles, chain.lower, chain.upper)
    about_hips, shifted = np.eye(size), np.eye(4)
    shifted[:3, 3] = root[:3, 3]
    about_hips[:6, :6] = adjoint(shifted)
    root[:3, 3] += centre
    return Fit(Configuration(root, angles), residual, overlaps, believed, about_hips.T @ seen @ about_hips, about_hips.T @ left)


def _around(box: tuple[int, int, int, int], reach: float) -> tuple[int, int, int, int]:
    """A box with room for matches on all sides."""
    left, top, right, bottom = box
    more = int(reach * max(right - left, bottom - top)) + 2
    return max(left - more, 0), max(top - more, 0), right + more, bottom + more


def _overlap(view: Observed, made: View, box: tuple[int, int, int, int]) -> float:
    """Of the pixels in a box that are the model's or the mask's, how many are both's; others' don't count."""
    left, top, right, bottom = box
    part = np.s_[top:bottom, left:right]
    return overlap(view.mask[part], made.triangles[part] >= 0, None if view.hidden is None else view.hidden[part])


def _points(lens: Lens, made: View, surface: Surface, centre: np.ndarray) -> _Drawn:
    left, top, right, bottom = made.box
    left, top = max(left - AROUND, 0), max(top - AROUND, 0)
    part = np.s_[top:bottom + AROUND, left:right + AROUND]
    contour = contour_of(made.triangles[part] >= 0)
    pixels = contour.pixels + (left, top)
    count = len(contour)
    directions, points, corners = np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 3), np.int64)
    direction_kernel(pixels, lens.numbers, directions)
    model_points_kernel(pixels, made.depth, made.triangles, surface.triangles, directions, lens.eye - centre,
                        np.ascontiguousarray(lens.rotation[2]), points, corners)
    return _Drawn(points, corners, np.concatenate([pixels, contour.normals], 1))


def _sums(surface: Surface, views: Sequence[Observed], drawn: Sequence[_Drawn | None], columns: np.ndarray, centre: np.ndarray,
          settings: SolverSettings, step: np.ndarray | None, turned_about: np.ndarray | None) -> tuple[np.ndarray, np.ndarray, float]:
    """The normal equations' matrix (its upper half), their vector, and the mean residual [pixels].

    step: by which drawn contours are moved before, in place, about columns (D, 6).
    """
    size = 6 + len(columns)

    def act(view: Observed, one: _Drawn | None) -> tuple[np.ndarray, np.ndarray, float, int]:
        matrix, vector = np.zeros((size, size)), np.zeros(size)
        if one is None or not len(one.edge) or not len(view.edge):
            return matrix, vector, 0.0, 0
        if step is not None:
            _shift(one, view.lens, surface, turned_about, step, centre)
        ours, theirs = one.edge, view.edge
        pairs, squares = np.empty((2 * settings.points + 8, 2), np.int64), np.empty(2 * settings.points + 8)
        seen = None if view.hidden is None else _in_sight(ours, view.hidden)
        asking = ours if seen is None else ours[seen]
        count = closest_kernel(asking, theirs, settings.facing, -(-max(len(asking), 1) // settings.points), pairs, squares, False, 0)
        if seen is not None:
            pairs[:count, 0] = seen[pairs[:count, 0]]
        if settings.both:
            count = closest_kernel(theirs, ours, settings.facing, -(-len(theirs) // settings.points), pairs, squares, True, count)
        gate = settings.reach * float(np.ptp(ours[:, :2], axis=0).max()) + 2.0
        return matrix, vector, *sums_kernel(
            one.points, one.corners, surface.shares, columns, pairs, squares, count, view.lens.eye - centre, view.directions,
            view.across, view.pixel, gate, settings.bend, np.zeros(size), matrix, vector)
    parts = together(act, views, drawn)
    total, used = sum(part[2] for part in parts), sum(part[3] for part in parts)
    scale = min(settings.effective / max(used, 1), 1.0)
    return np.sum([part[0] for part in parts], 0) * scale, np.sum([part[1] for part in parts], 0) * scale, total / max(used, 1)


def _in_sight(edge: np.ndarray, hidden: np.ndarray) -> np.ndarray:
    """Which of a model's contour (N, 4), pixels and normals, are not where others are (H, W) bool, so that there is a match to look for."""
    height, width = hidden.shape
    x, y = np.clip(np.rint(edge[:, :2]).astype(int), 0, (width - 1, height - 1)).T
    return np.flatnonzero(~hidden[y, x])


def _shift(one: _Drawn, lens: Lens, surface: Surface, columns: np.ndarray | None, step: np.ndarray, centre: np.ndarray) -> None:
    """Move a drawn contour along with a step, in place, so that it need not be drawn anew."""
    shift_kernel(one.points, one.corners, surface.shares, columns, step)
    seen = np.empty_like(one.points)
    project_kernel(one.points + centre, lens.numbers, seen)
    order = np.argsort(seen[:, 1], kind="stable")
    one.edge[:, :2] = seen[:, :2]
    for array in (one.edge, one.points, one.corners):
        array[:] = array[order]
