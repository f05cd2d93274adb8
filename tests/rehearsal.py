"""A body from points: `python tests/rehearsal.py` compiles what most tests of one need. Of a made-up motion: to walk is compiled by others, at the same time."""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).parent / "reconstruction"))
import trajectories  # noqa: E402

from gambol.controllers.reconstruction.pose_vector import SKELETON  # noqa: E402
from gambol.controllers.reconstruction.control_points import parse  # noqa: E402
from gambol.controllers.reconstruction.regression.method import Local, LocalRegression, Method  # noqa: E402
from gambol.controllers.reconstruction.neighbours.cells import Cells  # noqa: E402
from gambol.controllers.reconstruction.ours.combined import LISTENED  # noqa: E402
from gambol.controllers.reconstruction.neighbours.segments import Segments  # noqa: E402
from gambol.controllers.reconstruction.regression.map_solver import Solver  # noqa: E402
from gambol.game.world.learnt_methods import rehearse  # noqa: E402

if __name__ == "__main__":
    with TemporaryDirectory() as folder:
        known = trajectories.calm_database(Path(folder) / "calm.gambolmotion")
        four = parse("4", SKELETON)
        search = Cells(Segments.of(known, 3, 4, four.joints))
        rehearse(Method(Local(LocalRegression(LISTENED), search, 50), Solver(four, 1 / known.fps)), four)
