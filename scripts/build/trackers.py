"""Learn the network for trackers from CMU's motion, and write assets/reconstruction/trackers.npz.

    python scripts/build/trackers.py LARGE --small FOLDER --work FOLDER [--batches 78000] [--ship]
    python scripts/build/trackers.py LARGE --small FOLDER --work FOLDER --pack PACK.npz
    python scripts/build/trackers.py LARGE --small FOLDER --work FOLDER --weights WEIGHTS.npz
    python scripts/build/trackers.py LARGE --small FOLDER --work FOLDER --judge NETWORK.npz

LARGE: a motion database (`gambol database build`) or a folder of motion files, of which CMU's are learnt from: those below cmu, cmu_bvh
and cmu_30fps. --small: the folder whose clips scripts/measure/reconstruction.py measures on: takes that are tested or tuned on there
are never learnt from, nor what a few subjects did (`evaluation.STRANGERS`). --work: where checkpoints lie; begun again it goes on from the last
one, the same as if it had not stopped. --ship: write the network that the newest checkpoint holds, and learn nothing.
It takes a night on one thread; progress is shown. The same seed gives the same network. --pack: write all that is learnt from, for
scripts/build/trackers_torch.py, which learns on a graphics card in minutes; --weights: write the network of what that learnt.
--judge: write a network that was learnt with how far off it is told anew.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")  # before numpy; more of them help only on a machine that does nothing else

import numpy as np

from gambol.controllers.files import whole
from gambol.controllers.reconstruction.database import Database, DatabaseError, build
from gambol.controllers.reconstruction.evaluation import learnt_from, small_of
from gambol.controllers.reconstruction.trackers import SHIPPED, SIZE, Learner, Moments, Network, judged, packed

CHECKPOINT = "trackers-learning.npz"


def main() -> None:
    """Learn, or write what was learnt."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("large", type=Path, metavar="LARGE")
    parser.add_argument("--small", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--work", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--batches", type=int, default=78_000, help="in all; with more the rate falls later")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--every", type=int, default=1000, help="batches between two checkpoints")
    parser.add_argument("--ship", action="store_true", help="write the network of the newest checkpoint")
    parser.add_argument("--pack", type=Path, metavar="PACK.npz", help="write what is learnt from, and learn nothing")
    parser.add_argument("--weights", type=Path, metavar="WEIGHTS.npz", help="write the network of weights that were learnt elsewhere, and learn nothing")
    parser.add_argument("--judge", type=Path, metavar="NETWORK.npz", help="write this network with how far off it is told anew, and learn nothing")
    parser.add_argument("--out", type=Path, default=SHIPPED, help="where to")
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    path = options.work / CHECKPOINT
    try:
        if options.large.is_dir():
            built = options.work / "trackers.gambolmotion"
            if not built.exists():
                build(options.large, built, progress=lambda done, count: _say(f"reading {done} of {count} files"))
            options.large = built
        large = Database.open(options.large)
        database = learnt_from(large, small_of(large, options.small))
        _say(f"{len(database):,} poses of {len({take.subject for take in database.takes})} subjects, mirror images included")
        moments = Moments.of(database)
        if options.pack:
            with whole(options.pack) as own, own.open("wb") as file:
                np.savez_compressed(file, **packed(moments))
            return
        if options.judge:
            with whole(options.out) as own:
                judged(Network.load(options.judge), moments, options.seed).save(own)
            return
        learner = Learner(moments, options.batches, options.seed)
        if options.weights:
            learner.take(options.weights)
        elif path.exists():
            learner.resume(path)
            _say(f"going on from batch {learner.batch}")
        elif options.ship:
            sys.exit(f"{path}: there is no checkpoint to ship")
        if not (options.ship or options.weights):
            learner.learn(path, options.every, lambda done, count, loss: _say(f"batch {done} of {count}, {SIZE} samples each: loss {loss:.4f}"))
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
