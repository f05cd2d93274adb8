"""The most probable pose: what the prior believes against what the control points say (Mousas 2014, eq. 2 and 11).

The energy Σ |f(q) − c|² / σ_c² + (q − μ)ᵀΣ⁻¹(q − μ) is minimised by Gauss-Newton from μ, damped (Levenberg-Marquardt)
where a step would climb. With n points a step needs but a 3n × 3n system, δ = ΣJᵀ(JΣJᵀ + σ_c²)⁻¹(c − f).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...body import Skeleton
from ..control_points import ControlPoints
from ..pose_vector import JOINTS, REFERENCE, SKELETON
from .beliefs import Gaussian
from .solver_kernel import kinematics_kernel, points_kernel, solve_all_kernel


@dataclass(frozen=True, eq=False)
class Solution:
    """frame: (..., D) of the chart. points: (..., n, 3) [m] where it has the control points, missing ones too.

    energy: (...) the minimum that was reached, 0 where the prior's mean meets every point.
    """

    frame: np.ndarray
    points: np.ndarray
    energy: np.ndarray


@dataclass(frozen=True, eq=False)
class Solver:
    """Finds frames of the chart for given control points.

    controls: n points on the body. dt: seconds from the frame before. sigma: how exactly points are met [m], one
    for all or (n,). skeleton: like the chart's, maybe of other lengths. steps: at most. tolerance: stop once a step
    lowers the energy by less than this share of it.
    """

    controls: ControlPoints
    dt: float
    sigma: float | np.ndarray = 0.01
    skeleton: Skeleton = SKELETON
    steps: int = 8
    tolerance: float = 1e-5

    def __post_init__(self):
        if self.skeleton.names != SKELETON.names or not np.array_equal(self.skeleton.parents, SKELETON.parents):
            raise ValueError("the solver's skeleton must have the chart's joints")
        sigma = np.asarray(self.sigma, float)
        if not np.all(sigma > 0.0) or not np.all(np.isfinite(sigma)):
            raise ValueError(f"sigma must be above zero, not {self.sigma}")
        np.broadcast_to(sigma, (len(self.controls),))

    @cached_property
    def _body(self):
        first = np.full(len(SKELETON), -1, np.int64)
        first[JOINTS] = 3 * np.arange(len(JOINTS))
        return (self.dt, self.skeleton.parents, self.skeleton.offsets, REFERENCE, first,
                self.controls.joints, self.controls.offsets)

    def solve(self, prior: Gaussian, goals: np.ndarray, start: np.ndarray | None = None,
              sigma: np.ndarray | None = None) -> Solution:
        """The frame that agrees best with the prior and with points at goals (..., n, 3) [m], NaN where not seen.

        Goals are seen from the ground of the frame before (`on_ground`). start: (..., D) where to linearise first;
        the prior's mean by default. sigma: (..., n) [m] for these goals alone.
        ValueError if prior or start is not finite: nothing can be found from there.
        """
        goals = np.asarray(goals, float)
        batch, count, size = goals.shape[:-2], len(self.controls), np.shape(prior.mean)[-1]
        if goals.shape[-2:] != (count, 3):
            raise ValueError(f"points of shape {goals.shape} do not fit {count} control points: expected (..., {count}, 3)")

        if sigma is not None and not np.all(np.asarray(sigma) > 0.0):
            raise ValueError(f"sigma must be above zero, not {sigma}")
        number = math.prod(batch)

        def flat(value, *shape):
            if not batch and isinstance(value, np.ndarray) and value.shape == shape and value.dtype == float and (
                    value.flags.carray):
                return value[None]
            value = np.asarray(value, float)
            if value.shape != (*batch, *shape):
                value = np.broadcast_to(value, (*batch, *shape))
            # the kernel is compiled for one kind of array, which may be written to
            return np.require(value, requirements=["C", "W"]).reshape(number, *shape)

        mean, variance = flat(prior.mean, size), flat(prior.variance, size)
        factor = flat(prior.factor, prior.factor.shape[-2], size)
        begin = mean if start is None else flat(start, size)
        frames, points, energies = np.empty((number, size)), np.empty((number, count, 3)), np.empty(number)
        exact = flat(self.sigma if sigma is None else sigma, count)
        found = solve_all_kernel(mean, variance, factor, begin, flat(goals, count, 3), exact, *self._body, self.steps,
                                 self.tolerance, frames, points, energies)
        if not found:
            raise ValueError("the prior, or where to start, is not finite")
        return Solution(frames.reshape(*batch, size), points.reshape(*batch, count, 3), energies.reshape(batch))

    def points(self, frame: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Where one frame (D,) has the points, (n, 3) [m] seen from the ground of the frame before, and their Jacobian (3n, D)."""
        frame, count = np.array(frame, float), len(self.skeleton)
        dt, parents, offsets, reference, first, joints, beside = self._body
        positions, orientations, axes = np.empty((count, 3)), np.empty((count, 3, 3)), np.empty((count, 3, 3))
        kinematics_kernel(frame, dt, parents, offsets, reference, first, positions, orientations, axes, np.empty((3, 3, 3)))
        points, jacobian = np.empty((len(self.controls), 3)), np.empty((3 * len(self.controls), len(frame)))
        points_kernel(dt, parents, first, positions, orientations, axes, joints, beside, points, jacobian)
        return points, jacobian


def on_ground(points: np.ndarray, track: np.ndarray) -> np.ndarray:
    """World points (..., n, 3) [m] as seen from ground tracks (..., 3) of the chart: x, z [m] and heading."""
    x, z, heading = _parts(track)
    return _turned(points[..., 0] - x, points[..., 1], points[..., 2] - z, np.cos(heading), -np.sin(heading))


def in_world(points: np.ndarray, track: np.ndarray) -> np.ndarray:
    """The inverse of `on_ground`."""
    x, z, heading = _parts(track)
    out = _turned(points[..., 0], points[..., 1], points[..., 2], np.cos(heading), np.sin(heading))
    out[..., 0] += x
    out[..., 2] += z
    return out


def _parts(track):
    """The numbers of ground tracks (..., 3), each with one axis more, for the points."""
    track = np.asarray(track, float)
    return track[..., 0, None], track[..., 1, None], track[..., 2, None]


def _turned(x, y, z, c, s):
    """Points (..., 3) that are turned about the vertical by an angle of that cosine and sine."""
    left = c * x + s * z
    out = np.empty((*left.shape, 3))
    out[..., 0], out[..., 1], out[..., 2] = left, y, c * z - s * x
    return out
