"""Learn the network that calibrates trackers from CMU's motion, and write assets/reconstruction/calibration.npz.

    python scripts/build/calibration.py LARGE --small FOLDER --work FOLDER [--batches 12000] [--ship]

LARGE, --small, --work, --ship: as for scripts/build/trackers.py; learnt is from the same takes. Performers are simulated: bodies of all proportions,
trackers worn anyhow, poses that are stood in not quite as asked, five seconds of a recorded take. It takes half an hour of one thread. The same
seed gives the same network, wherever it was cut off.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")  # before numpy; more of them help only on a machine that does nothing else

from gambol.controllers.files import whole
from gambol.controllers.reconstruction.calibration import SHIPPED, SetLearner
from gambol.controllers.reconstruction.database import Database, DatabaseError
from gambol.controllers.reconstruction.evaluation import learnt_from, small_of
from gambol.controllers.reconstruction.trackers import Moments

CHECKPOINT = "calibration-learning.npz"


def main() -> None:
    """Learn, or write what was learnt."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("large", type=Path, metavar="LARGE")
    parser.add_argument("--small", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--work", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--batches", type=int, default=12_000, help="in all; with more the rate falls later")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--every", type=int, default=500, help="batches between two checkpoints")
    parser.add_argument("--ship", action="store_true", help="write the network of the newest checkpoint")
    parser.add_argument("--out", type=Path, default=SHIPPED, help="where to")
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    path = options.work / CHECKPOINT
    try:
        large = Database.open(options.large)
        learner = SetLearner(Moments.of(learnt_from(large, small_of(large, options.small))), options.batches, options.seed)
        if path.exists():
            learner.resume(path)
            _say(f"going on from batch {learner.batch}")
        elif options.ship:
            sys.exit(f"{path}: there is no checkpoint to ship")
        if not options.ship:
            learner.learn(path, options.every, lambda done, count, error: _say(f"batch {done} of {count}: squared error {error:.4f}"))
    except (DatabaseError, ValueError) as error:
        sys.exit(str(error))
    options.out.parent.mkdir(parents=True, exist_ok=True)
    with whole(options.out) as own:
        learner.network().save(own)
    _say(f"{options.out}: {options.out.stat().st_size / 1e6:.1f} MB after {learner.batch} batches")


def _say(text: str) -> None:
    print(text, flush=True)


if __name__ == "__main__":
    main()
