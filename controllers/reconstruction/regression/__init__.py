"""Mousas 2014, 4: the local regression that says what pose comes next (eq. 3-10), and the MAP solver that weighs it against
the points that are seen (eq. 2, 11); `method` makes frames of both.
"""

from .beliefs import Gaussian, compact, fuse
from .frame_kernel import seen_kernel
from .local_regression import FLOOR, PAPER, Regression, regress, weights
from .map_solver import Solver, in_world, on_ground
from .method import SPAN, Fused, Local, LocalRegression, Memory, Method, Near, Prior, posed
from .solver_kernel import EXACT, FAR, kinematics_kernel, positive_solve_kernel

__all__ = [
    "EXACT", "FAR", "FLOOR", "PAPER", "SPAN", "Fused", "Gaussian", "Local", "LocalRegression", "Memory", "Method", "Near",
    "Prior", "Regression", "Solver", "compact", "fuse", "in_world", "kinematics_kernel", "on_ground", "posed",
    "positive_solve_kernel", "regress", "seen_kernel", "weights",
]
