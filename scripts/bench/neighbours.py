"""How well and how fast each search finds the nearest recorded segments.

    python scripts/bench/neighbours.py DATABASE [--queries 60] [--noise 0.02]

Takes are queried frame after frame, as a reconstruction does, each with its own recording and its
mirror image forbidden. `noise` [rad, m, ...] is added to the queries, as a method's own output is
off. Recall@100 is against the exact search; times are of one query, on one thread.
"""

from __future__ import annotations

import argparse
import os
import resource
import time

for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

import numpy as np  # (threads are counted when numpy is loaded)

from gambol.controllers.reconstruction import SKELETON
from gambol.controllers.reconstruction.database import Database
from gambol.controllers.reconstruction.neighbours import Cells, Exact, Graph, Segments, Tree

K = 100
POINTS = {"paper's query": (), "4 points": ("LeftHand", "RightHand", "LeftFoot", "RightFoot")}


def passages(segments: Segments, queries: int, rng: np.random.Generator) -> list[np.ndarray]:
    """Runs of `queries` segments in a row, from takes all over the database."""
    recordings = rng.permutation(np.unique(segments.recordings))
    found = []
    for recording in recordings:
        first, end = segments.span(int(recording))
        if end - first > 2 * queries:
            start = int(rng.integers(first, end - queries))
            if segments.last[start + queries - 1] == segments.last[start] + queries - 1:
                found.append(np.arange(start, start + queries))
        if len(found) == 8:
            break
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("database")
    parser.add_argument("--queries", type=int, default=60, help="frames in a row of each of eight takes")
    parser.add_argument("--noise", type=float, default=0.02)
    options = parser.parse_args()
    database = Database.open(options.database)
    print(f"{len(database):,} frames of {len(database.takes)} takes, {database.path.stat().st_size / 1e6:.0f} MB")
    for name, joints in POINTS.items():
        segments = Segments.of(database, 3, 4, [SKELETON.index(joint) for joint in joints])
        rng, runs = np.random.default_rng(0), []
        for run in passages(segments, options.queries, rng):
            features = segments.features(run)
            noise = rng.normal(0, options.noise, features.shape).astype(np.float32)
            runs.append((int(segments.recordings[run[0]]), features + noise))
        print(f"\n{name}: {len(segments):,} segments of {segments.width} features; "
              f"{len(runs)} takes × {options.queries} queries")
        truth = measure(Exact(segments), runs, None)
        measure(built(Tree, segments), runs, truth)
        cells = built(Cells, segments)
        measure(cells, runs, truth)
        measure(built(Graph, segments, cells), runs, truth)
    print(f"\nmost memory in use: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6:.2f} GB, the mapped file included")


def built(kind, *arguments):
    """A search, and how long it took to build."""
    began = time.perf_counter()
    search = kind(*arguments)
    print(f"  {kind.__name__:6} built in {time.perf_counter() - began:.1f} s")
    return search


def measure(search, runs, truth) -> list[np.ndarray]:
    """Query every run, print recall and times; what was found, query by query."""
    found, times = [], []
    search.query(runs[0][1][0], K)
    for recording, features in runs:
        hint = None
        for feature in features:
            began = time.perf_counter()
            indices, _, hint = search.query(feature, K, hint, recording)
            times.append(time.perf_counter() - began)
            found.append(indices)
    recall = "" if truth is None else f"recall {np.mean([np.isin(t, f).mean() for t, f in zip(truth, found)]):.4f}, "
    low, middle, high = 1e3 * np.percentile(times, [10, 50, 95])
    print(f"  {type(search).__name__:6} {recall}{middle:.3f} ms a query (10 %: {low:.3f}, 95 %: {high:.3f})")
    return found


if __name__ == "__main__":
    main()
