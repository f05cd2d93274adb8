"""How much better the network that ships is for one's own motion, once it has learnt on from some of it.

    python scripts/measure/tuning.py LARGE --small FOLDER [--tuned] [--share 0.5] [--batches 1000] [--work FOLDER]

LARGE, FOLDER: as for scripts/build/trackers.py. Own motion is that of SNU, nothing of which the network was learnt from, or with --tuned that of
NCSOFT, on which settings were chosen: every other take, mirror images beside it, is learnt on from, as `gambol database tune` does; of the
rest those are measured that are sound from their beginning, twelve at most. Beside them: CMU's test takes, for what is forgotten. All from nothing.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from reconstruction_trackers import HEAD, WORN, recorded, row

from gambol.controllers.reconstruction.database import Database, DatabaseError
from gambol.controllers.reconstruction.evaluation import CMU, small_of, trials
from gambol.controllers.reconstruction.trackers import BATCHES, SHARE, Moments, Network, Tuner
from reconstruction_figures import table

OTHERS = ("martial_arts/",)
"""Folders of NCSOFT's; SNU's are all that are neither these nor CMU's."""
COUNT = 12


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("large", type=Path, metavar="LARGE")
    parser.add_argument("--small", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--tuned", action="store_true", help="the motion that settings were chosen on")
    parser.add_argument("--share", type=float, default=SHARE, help="how much of what is learnt is used")
    parser.add_argument("--batches", type=int, default=BATCHES)
    parser.add_argument("--work", type=Path, help="where the checkpoint lies, and the network in the end")
    options = parser.parse_args()
    try:
        large = Database.open(options.large)
        small = small_of(large, options.small)
    except DatabaseError as error:
        sys.exit(str(error))
    own = [take for take in large.takes if not take.clip.startswith(CMU) and take.clip.startswith(OTHERS) == options.tuned]
    clips = sorted({take.clip for take in own if not take.mirrored})
    taught = set(clips[::2])
    learnt = large.only([take for take in own if take.clip in taught])
    held = [take for take in own if take.clip not in taught and not take.mirrored and take.stop - take.start >= 90
            and bool(large.sound[take.start:min(take.stop, take.start + 631)].all())]
    held = held[::max(1, len(held) // COUNT)][:COUNT]
    core = trials.split(small.only([take for take in small.takes if not take.interpolated]))
    network = Network.load()
    tuner = Tuner(network, Moments.of(learnt), options.batches, share=options.share)
    work = (options.work or Path(".")) / "tuning.npz"
    work.parent.mkdir(parents=True, exist_ok=True)
    if work.exists():
        tuner.resume(work)
    tuner.learn(work, 500, lambda done, count, loss: print(f"batch {done} of {count}: loss {loss:.3f}", file=sys.stderr, flush=True))
    after = tuner.network()
    print(f"{len(learnt):,} poses of {len(taught)} clips, mirror images included; {options.batches} batches")
    for name, takes in ((f"own motion, {len(held)} other takes", held), ("CMU's test takes", core.validation if options.tuned else core.test)):
        those = [recorded(large, take) for take in takes]
        rows = [row(f"{worn}, {when}", one, those, points, turning, False) for worn, (points, turning) in WORN.items()
                for when, one in (("as it ships", network), ("learnt on", after))]
        print(f"\n## {name}\n\n{table(HEAD, rows)}", flush=True)
    if options.work:
        after.save(options.work / "own.npz")


if __name__ == "__main__":
    main()
