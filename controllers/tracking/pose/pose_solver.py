"""The pose that fits contours: render the model, match contours both ways, solve for a step of twists, and again (section 2.3)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve as solved

from ..cameras import Lens, direction_kernel, project_kernel
from ..silhouettes import Contour, Surface, View, contour_of, rendered, skinned
from ..twists import Configuration, posed, retract_kernel
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

    outer: int = 3
    inner: int = 2
    reach: float = 0.08
    bend: float = 3.0
    facing: float = 8.0
    points: int = 300
    effective: float = 400.0
    damping: float = 1e-3
    both: bool = True


SETTINGS = SolverSettings()


@dataclass(frozen=True, eq=False)
class Fit:
    """where: the pose. residual: mean distance of contours [pixels]. overlaps: (C,) of the starting pose with each mask."""

    where: Configuration
    residual: float
    overlaps: np.ndarray


@dataclass(frozen=True, eq=False)
class _Drawn:
    """A model's contour in one view: its points about the centre (N, 3) [m], the vertices about them, pixels and normals."""

    points: np.ndarray
    corners: np.ndarray
    contour: Contour


def solve(surface: Surface, views: Sequence[Observed], start: Configuration, penalty: Penalty | None = None,
          believed: np.ndarray | None = None, settings: SolverSettings = SETTINGS) -> Fit:
    """The pose near `start` that fits what cameras see, and the penalty. believed: (C,) bool, which of them; all by default."""
    chain, size = surface.chain, 6 + len(surface.chain)
    centre = start.root[:3, 3].copy()
    root, angles = start.root.copy(), start.angles.copy()
    root[:3, 3] -= centre
    overlaps, residual = np.zeros(len(views)), 0.0
    buffers: list[View | None] = [None] * len(views)
    for outer in range(settings.outer):
        drawn, columns = [], None
        world = root.copy()
        world[:3, 3] += centre
        positions, orientations, _ = posed(chain, Configuration(world, angles))
        vertices = skinned(surface, positions, orientations)
        for k, view in enumerate(views):
            if believed is not None and not believed[k]:
                drawn.append(None)
                continue
            made = _render(view.lens, vertices, surface, buffers[k])
            buffers[k] = made
            if outer == 0:
                overlaps[k] = _overlap(view.mask, made)
            drawn.append(_points(view.lens, made, surface, centre))
        for inner in range(settings.inner):
            _, _, columns = posed(chain, Configuration(root, angles))
            matrix, vector, residual = _sums(surface, views, drawn, columns, centre, settings)
            here = Configuration(root, angles)
            regular = settings.damping * max(float(np.trace(matrix)) / size, 1e-9)
            full = matrix + np.triu(matrix, 1).T
            full[np.arange(size), np.arange(size)] += regular
            if penalty is not None:
                moved = Configuration(penalty.target.root.copy(), penalty.target.angles)
                moved.root[:3, 3] -= centre
                full[np.arange(size), np.arange(size)] += penalty.weights
                vector = vector + penalty.weights * penalty_rows(chain, Penalty(moved, penalty.weights), here, np.zeros(3))
            step = solved(full, vector, assume_a="pos", check_finite=False)
            step *= min(1.0, 0.5 / max(float(np.abs(step[3:]).max()), 1e-12))
            if inner + 1 < settings.inner:
                for view, one in zip(views, drawn):
                    if one is not None:
                        _shift(one, view.lens, surface, columns, step, centre)
            retract_kernel(chain.first, chain.count, step, root, angles, chain.lower, chain.upper)
    root[:3, 3] += centre
    return Fit(Configuration(root, angles), residual, overlaps)


def _render(lens: Lens, vertices: np.ndarray, surface: Surface, kept: View | None) -> View:
    if kept is not None:
        left, top, right, bottom = kept.box
        kept.depth[top:bottom, left:right] = np.inf
        kept.triangles[top:bottom, left:right] = -1
        kept = View(kept.depth, kept.triangles, (0, 0, 0, 0))
    return rendered(lens, vertices, surface.triangles, kept)


def _overlap(mask: np.ndarray, made: View) -> float:
    left, top, right, bottom = made.box
    inside, ours = mask[top:bottom, left:right], made.triangles[top:bottom, left:right] >= 0
    both = np.count_nonzero(inside & ours)
    union = np.count_nonzero(mask) + np.count_nonzero(ours) - both
    return both / union if union else 0.0


def _points(lens: Lens, made: View, surface: Surface, centre: np.ndarray) -> _Drawn:
    left, top, right, bottom = made.box
    contour = contour_of(made.mask, (left - 1, top - 1, right + 1, bottom + 1))
    count = len(contour)
    directions, points, corners = np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 3), np.int64)
    direction_kernel(contour.pixels, lens.numbers, directions)
    model_points_kernel(contour.pixels, made.depth, made.triangles, surface.triangles, directions, lens.eye - centre,
                        np.ascontiguousarray(lens.rotation[2]), points, corners)
    return _Drawn(points, corners, contour)


def _sums(surface: Surface, views: Sequence[Observed], drawn: Sequence[_Drawn | None], columns: np.ndarray, centre: np.ndarray,
          settings: SolverSettings) -> tuple[np.ndarray, np.ndarray, float]:
    """The normal equations' matrix (its upper half), their vector, and the mean residual [pixels]."""
    size = 6 + len(columns)
    matrix, vector, row, total, used = np.zeros((size, size)), np.zeros(size), np.zeros(size), 0.0, 0
    for view, one in zip(views, drawn):
        if one is None or not len(one.contour) or not len(view.contour):
            continue
        ours, theirs = (np.concatenate([c.pixels, c.normals], 1) for c in (one.contour, view.contour))
        pairs, squares = np.empty((2 * settings.points + 8, 2), np.int64), np.empty(2 * settings.points + 8)
        count = closest_kernel(ours, theirs, settings.facing, -(-len(ours) // settings.points), pairs, squares, False, 0)
        if settings.both:
            count = closest_kernel(theirs, ours, settings.facing, -(-len(theirs) // settings.points), pairs, squares, True, count)
        gate = settings.reach * float(np.ptp(ours[:, :2], axis=0).max()) + 2.0
        more, many = sums_kernel(one.points, one.corners, surface.shares, columns, pairs, squares, count, view.lens.eye - centre,
                                 view.directions, view.across, view.pixel, gate, settings.bend, row, matrix, vector)
        total, used = total + more, used + many
    scale = min(settings.effective / max(used, 1), 1.0)
    return matrix * scale, vector * scale, total / max(used, 1)


def _shift(one: _Drawn, lens: Lens, surface: Surface, columns: np.ndarray, step: np.ndarray, centre: np.ndarray) -> None:
    """Move a drawn contour along with a step, in place, so that it need not be drawn anew."""
    shift_kernel(one.points, one.corners, surface.shares, columns, step)
    seen = np.empty_like(one.points)
    project_kernel(one.points + centre, lens.numbers, seen)
    one.contour.pixels[:] = seen[:, :2]
