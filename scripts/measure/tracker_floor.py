"""What head and hands can tell of a body at all: how far other recorded people were from each other who had them in the same place.

    python scripts/measure/tracker_floor.py LARGE --small FOLDER

LARGE, FOLDER: as for scripts/build/trackers.py. For moments of the takes that are tested the recorded moments are sought that are most like them by where
head and hands are and how they are turned, now and 16 and 30 frames ago, seen from the ground below them with the head's heading. Told are the joints' mean
distance [cm] of the nearest one, of the mean of the 10 and 100 nearest, and of the best of the 100, which nobody could choose; and the same for six
trackers. Brought onto the moment as trackers are met, by nothing: the network with its solve has less to make up.
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path

for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

import numpy as np

from gambol.controllers.body import forward_kinematics, yaw
from gambol.controllers.reconstruction import SKELETON, parse
from gambol.controllers.reconstruction.database import Database
from gambol.controllers.reconstruction.evaluation import learnt_from, small_of, trials

LAGS, STEP, EVERY = (0, 16, 30), 6, 10
TURN = 0.15
"""Turns' columns count as much as places that are as far apart as this [m]."""
SETS = {"head and hands": "head,lwrist,rwrist", "six": "6"}


def moments(database: Database, takes, points: str, step: int) -> tuple[np.ndarray, np.ndarray]:
    """What trackers say (N, F) in every step-th frame, and the joints (N, J, 3) [m] then, both seen from the ground below the trackers."""
    controls = parse(points, SKELETON)
    head = SKELETON.index("Head")
    told, bodies = [], []
    for take in takes:
        one = trials.trial(database, take, controls, 10 ** 9)
        positions, turns = forward_kinematics(SKELETON, one.positions[:, 0], one.rotations)
        at = np.arange(max(LAGS), len(positions), step)
        middle = positions[at][:, controls.joints].mean(1) * [1.0, 0.0, 1.0]
        facing = turns[at, head]
        back = np.swapaxes(yaw(np.arctan2(facing[:, 0, 2] - facing[:, 2, 0], facing[:, 0, 0] + facing[:, 2, 2])), -1, -2)
        parts = []
        for lag in LAGS:
            places = np.einsum("nij,nkj->nki", back, positions[at - lag][:, controls.joints] - middle[:, None])
            turned = back[:, None] @ turns[at - lag][:, controls.joints]
            parts += [places.reshape(len(at), -1), TURN * turned[..., :2].reshape(len(at), -1)]
        told.append(np.concatenate(parts, 1, dtype=np.float32))
        bodies.append(np.einsum("nij,nkj->nki", back, positions[at] - middle[:, None]).astype(np.float32))
    return np.concatenate(told), np.concatenate(bodies)


def main() -> None:
    """Print a line for each set of trackers."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("large", type=Path, metavar="LARGE")
    parser.add_argument("--small", type=Path, required=True, metavar="FOLDER")
    options = parser.parse_args()
    large = Database.open(options.large)
    small = small_of(large, options.small)
    test = trials.split(small.only([take for take in small.takes if not take.interpolated])).test
    known = learnt_from(large, small)
    judged = [j for j, name in enumerate(SKELETON.names) if not name.endswith("Toe") and j]
    for name, points in SETS.items():
        told, bodies = moments(known, known.takes, points, STEP)
        asked, truth = moments(large, test, points, EVERY)
        size, found = np.sum(told ** 2, -1), []
        for one, body in zip(asked, truth, strict=True):
            near = size - 2.0 * told @ one
            best = np.argpartition(near, 100)[:100]
            best = best[np.argsort(near[best])]
            some = bodies[best][:, judged]
            off = 100 * np.linalg.norm(some - body[judged], axis=-1).mean(-1)
            means = [100 * np.linalg.norm(some[:k].mean(0) - body[judged], axis=-1).mean() for k in (10, 100)]
            found.append([off[0], *means, off.min()])
        nearest, ten, hundred, oracle = np.mean(found, 0)
        print(f"{name}: {len(told):,} recorded moments, {len(asked)} asked for: nearest {nearest:.2f} cm, mean of 10 {ten:.2f}, of 100 {hundred:.2f}; "
              f"best of 100 {oracle:.2f}", flush=True)


if __name__ == "__main__":
    main()
