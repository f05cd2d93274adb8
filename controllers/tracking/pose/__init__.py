"""The pose that fits what cameras see: correspondences, Plücker constraints, the penalty on jitter, and the solver of all."""

from .bringing import brought
from .evidence import Evidence, judged, overlap
from .observed import Observed, observed
from .penaliser import Penalty, calmed, carried, part_way, penalty_of, penalty_rows, predicted
from .plucker import constraint, normal_rows, plucker_rows
from .pose_solver import SETTINGS, Fit, SolverSettings, solve
from .restarts import Doubt, held
from .hindsight import Glimpse, in_hindsight

__all__ = [
    "SETTINGS", "Doubt", "Evidence", "Fit", "Glimpse", "Observed", "Penalty", "SolverSettings", "brought", "calmed", "carried", "constraint", "held", "in_hindsight", "judged", "normal_rows", "observed",
    "overlap", "part_way", "penalty_of", "penalty_rows", "plucker_rows", "predicted", "solve",
]
