"""Learn the network that calibrates trackers from CMU's motion, and write assets/reconstruction/calibration.npz.

    python scripts/build/calibration/network.py LARGE --small FOLDER [--people 100000]

LARGE, --small: as for scripts/build/trackers.py; learnt is from the same takes. Performers are simulated: bodies of all proportions, trackers worn
anyhow, poses that are stood in not quite as asked, five seconds of a recorded take. It takes a quarter of an hour of one thread; progress is
shown. The same seed gives the same network.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")  # before numpy; more of them help only on a machine that does nothing else

from gambol.controllers.files import whole
from gambol.controllers.reconstruction.calibration import SHIPPED, learnt
from gambol.controllers.reconstruction.database import Database, DatabaseError
from gambol.controllers.reconstruction.evaluation import learnt_from, small_of
from gambol.controllers.reconstruction.trackers import Moments


def main() -> None:
    """Learn, and write what was learnt."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("large", type=Path, metavar="LARGE")
    parser.add_argument("--small", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--people", type=int, default=200_000, help="how many performers are simulated")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, default=SHIPPED, help="where to")
    options = parser.parse_args()
    try:
        large = Database.open(options.large)
        moments = Moments.of(learnt_from(large, small_of(large, options.small)))
    except (DatabaseError, ValueError) as error:
        sys.exit(str(error))
    network = learnt(moments, options.people, options.seed, _say)
    options.out.parent.mkdir(parents=True, exist_ok=True)
    with whole(options.out) as own:
        network.save(own)
    print(f"{options.out}: {options.out.stat().st_size / 1e6:.1f} MB of {network.people:,} performers", flush=True)


def _say(what: str, done: int, count: int, error: float) -> None:
    print(f"{what} {done} of {count}" + (f": squared error {error:.4f}" if error else ""), flush=True)


if __name__ == "__main__":
    main()
