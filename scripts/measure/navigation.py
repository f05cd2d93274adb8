"""Measure walks to goals: cost against IPOPT's optimum, likeness to people, obstacles, times.

    python scripts/measure/navigation.py [--quick] [--scenes 1000] [--seed 0] [--paths FILE] [--plots DIR]

Cost: the same problem stated anew for casadi and IPOPT (`tests/navigation/oracle.py`), where casadi is installed. Likeness: as
`gambol navigate fit` tells it, where recorded walks lie beside the project. Obstacles: random rooms of ten discs, boxes and
walls; a goal counts as to be reached where a search on a grid, finer than the planner's, finds a way for a disc of the clearance's
radius, and that disc is swept along every plan.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from _plots import pictures, pyplot

from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation.identification import likeness, planned_like, read_paths, straight
from gambol.controllers.navigation.planning import HUMAN, PUBLISHED, plan
from gambol.controllers.navigation.planning.planner import FREE
from gambol.controllers.navigation.routes import clear, distance, grid_way, separation, shapes_of
