"""How far the network for trackers is off by itself, before any solve: on what it was learnt from, and on what it never saw.

    python scripts/measure/tracker_unseen.py LARGE --small FOLDER [--network FILE] [--also FILE …]

LARGE, FOLDER: as for scripts/measure/reconstruction_trackers.py. Moments are drawn on bodies of all proportions, with ideal trackers and the last half
second before; every subject, and within it every moment, counts as it does in learning. Of several networks each has its table. What the
second column is more than the first, others teach that it takes from recordings and not from its trackers.
"""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

import numpy as np

from gambol.controllers.body import forward_kinematics
from gambol.controllers.reconstruction import ANGLES, JOINTS, SKELETON, decode
from gambol.controllers.reconstruction.database import Database
from gambol.controllers.reconstruction.evaluation import foreign, learnt_from, small_of, strangers
from gambol.controllers.reconstruction.trackers import GROUND, Batch, Moments, Network, exactly, members
from reconstruction_figures import table
from reconstruction_trackers import asked, opened

WORN = {"6 points": ("Hips Head LeftHand RightHand LeftFoot RightFoot", False), "4 points": ("LeftHand RightHand LeftFoot RightFoot", False),
        "6 that turn": ("Hips Head LeftHand RightHand LeftFoot RightFoot", True), "3 that turn": ("Head LeftHand RightHand", True)}
COUNT = 1500


def off(network: Network, batch: Batch) -> tuple[float, float]:
    """Mean distance of joints [m] and root mean square of rotation vectors' differences [rad]."""
    found = network.predict(batch.inputs)[0]
    apart = []
    for pose, truth, offsets in zip(found, batch.truth, batch.bodies, strict=True):
        body = replace(SKELETON, offsets=offsets)
        a, b = (forward_kinematics(body, *decode(one, one[GROUND]))[0] for one in (pose, truth))
        apart.append(np.linalg.norm(a - b, axis=-1)[JOINTS].mean())
    turns = (found - batch.truth)[:, :ANGLES].reshape(len(found), -1, 3)
    return float(np.mean(apart)), float(np.sqrt((turns ** 2).sum(-1).mean()))


def sources(large: Database, folder: Path, tested: tuple) -> dict[str, Moments]:
    """Whose moments are drawn."""
    return {"learnt from": Moments.of(learnt_from(large, small_of(large, folder))), "Table 1's takes": Moments.of(large.only(tested)),
            "unseen subjects": Moments.of(large.only(strangers(large))), "other data sets": Moments.of(large.only(foreign(large)))}


def main() -> None:
    """Print a table for each network."""
    parser = asked(__doc__)
    parser.add_argument("--also", type=Path, nargs="+", default=[], metavar="FILE", help="more networks")
    options = parser.parse_args()
    network, large, core = opened(options)
    those = sources(large, options.small, core.validation if options.tuned else core.test)
    for name, one in [(options.network, network), *((path, Network.load(path)) for path in options.also)]:
        rows = []
        for worn, (text, turning) in WORN.items():
            placed = members(text)
            wearing = exactly(COUNT, placed, placed & turning)
            found = [off(one, moments.draw(COUNT, 1, 5, wearing)) for moments in those.values()]
            rows.append([worn, *(f"{100 * far:.2f}, {np.degrees(askew):.1f}°" for far, askew in found)])
        print(f"\n{name}, after {512 * one.learnt:,} samples\n\n{table(('', *those), rows)}", flush=True)


if __name__ == "__main__":
    main()
