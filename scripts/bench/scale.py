"""How the search and learning scale: a database, and copies of it with motion of their own, up to ten million poses.

    python scripts/bench/scale.py DATABASE [--copies 9] [--folder FOLDER]

Each copy moves every joint by up to 3 degrees, smoothly and otherwise in every take. Printed are for both sizes: the time to build the
indices, of a query by them and by looking at everything, and how many of the hundred nearest they find; the time to ready what `ours` and the
network for trackers learn from, and of a batch of either; and memory of the process's own, without what is mapped of the file.
Times are the process's own, on one thread.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import threading
import time
from pathlib import Path

for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

import numpy as np

from gambol.controllers.reconstruction import SKELETON, parse
from gambol.controllers.reconstruction.baselines import Samples
from gambol.controllers.reconstruction.database import Database, Writer
from gambol.controllers.reconstruction.neighbours import Cells, Exact, Lists, Segments, at_hand
from gambol.controllers.reconstruction.ours import learn
from gambol.controllers.reconstruction.regression import Solver
from gambol.controllers.reconstruction.trackers import Moments

OFF, KNOTS, K, RUNS, QUERIES, BATCHES = np.radians(3.0), 30, 100, 5, 16, 60


def copied(database: Database, copies: int, path: Path) -> Database:
    """The database and so many copies of it, in a file of their own."""
    rng, angles = np.random.default_rng(0), database.poses.shape[1]
    with Writer(path, database.fps, mirrors=False) as writer:
        for copy in range(1 + copies):
            for take in database.takes:
                frames = np.array(database.frames[take.start:take.stop])
                if copy:
                    knots = rng.uniform(-OFF, OFF, (2 + len(frames) // KNOTS, angles)).astype(np.float32)
                    at = np.arange(len(frames)) / KNOTS
                    low, share = at.astype(int), (at % 1.0)[:, None].astype(np.float32)
                    frames[:, :angles] += (1 - share) * knots[low] + share * knots[low + 1]
                writer.add(f"{copy}/{take.clip}", take.subject, take.action, frames, database.sound[take.start:take.stop], take.interpolated)
    return Database.open(path)


class Watched:
    """What a block of code takes: the process's time [s], and the most memory of its own at any moment [GB]."""

    def __enter__(self) -> Watched:
        self._began, self.memory, self._over = time.process_time(), 0.0, threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)
        self._thread.start()
        return self

    def _watch(self) -> None:
        while not self._over.wait(0.05):
            self.memory = max(self.memory, own_memory())

    def __exit__(self, *_) -> None:
        self.time, self.memory = time.process_time() - self._began, max(self.memory, own_memory())
        self._over.set()
        self._thread.join()


def own_memory() -> float:
    """Memory [GB] that is no file's, as Linux tells it; 0 elsewhere."""
    try:
        lines = Path("/proc/self/status").read_text().splitlines()
    except OSError:
        return 0.0
    return sum(int(line.split()[1]) for line in lines if line.startswith("RssAnon")) / 1e6


def asked(segments: Segments) -> tuple[list[list[tuple[np.ndarray, int, np.ndarray]]], float]:
    """Queries in runs of frames that go on: the feature, the recording that is forbidden, and the nearest in truth; and what such a look at
    everything takes [s]."""
    rng, exact, runs, times = np.random.default_rng(1), Exact(segments), [], []
    for start in rng.integers(len(segments) - QUERIES, size=RUNS):
        runs.append([])
        for which in range(start, start + QUERIES):
            feature = segments.features(np.array([which]))[0]
            feature, own = feature + rng.normal(0.0, 0.02, feature.shape).astype(np.float32), int(segments.recordings[which])
            began = time.process_time()
            true, _, _ = exact.query(feature, K, None, own)
            times.append(time.process_time() - began)
            runs[-1].append((feature, own, true))
    return runs, float(np.median(times))


def measured(database: Database) -> None:
    """Print the figures of a database."""
    print(f"{len(database):,} poses of {len(database.takes):,} takes, {database.path.stat().st_size / 1e9:.2f} GB; {own_memory():.1f} GB before")
    controls = parse("4", SKELETON)
    segments = Segments.of(database, 3, 4, controls.joints)
    queries, every = asked(segments)
    print(f"  looking at everything: {1e3 * every:.0f} ms a query")
    for kind in (Cells, Lists) if at_hand() else (Cells,):
        with Watched() as watched:
            search = kind(segments)
        print(f"  {kind.__name__}: {watched.time:.0f} s, {watched.memory:.1f} GB at most, {own_memory():.1f} kept", end="; ")
        found, times = [], []
        for run in queries:
            hint = None
            for feature, own, true in run:
                began = time.process_time()
                near, _, hint = search.query(feature, K, hint, own)
                times.append(time.process_time() - began)
                found.append(len(np.intersect1d(near, true)) / K)
        print(f"a query {1e3 * np.median(times):.2f} ms, {1e3 * np.max(times):.1f} at most; it finds {100 * np.mean(found):.1f} % of the {K} nearest")
        del search
    del segments
    solver = Solver(controls, 1 / database.fps)
    with Watched() as watched:
        samples = Samples.of(database, solver)
    print(f"  ours: samples {watched.time:.0f} s, {watched.memory:.1f} GB at most", end="")
    with Watched() as watched:
        learn(samples, seeds=1, batches=BATCHES)
    print(f"; {1e3 * watched.time / BATCHES:.0f} ms a batch, {watched.memory:.1f} GB")
    del samples
    with Watched() as watched:
        moments = Moments.of(database)
    print(f"  trackers: moments {watched.time:.0f} s, {watched.memory:.1f} GB at most", end="")
    with Watched() as watched:
        for number in range(BATCHES):
            moments.draw(512, 0, number)
    print(f"; {1e3 * watched.time / BATCHES:.0f} ms to draw a batch, {watched.memory:.1f} GB", flush=True)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("database", type=Path)
    parser.add_argument("--copies", type=int, default=9)
    parser.add_argument("--folder", type=Path, help="where the copies are written for as long as they are measured")
    options = parser.parse_args()
    database = Database.open(options.database)
    measured(database)
    with tempfile.TemporaryDirectory(dir=options.folder) as folder:
        measured(copied(database, options.copies, Path(folder) / "copies.gambolmotion"))


if __name__ == "__main__":
    main()
