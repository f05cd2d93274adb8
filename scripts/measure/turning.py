"""Measure ours for trackers that tell how they are turned beside the network that ships.

    python scripts/measure/turning.py LARGE --small FOLDER

LARGE, FOLDER: as for scripts/measure/reconstruction_trackers.py. Ours is learnt, once, from what Table 1 is learnt from: FOLDER's takes that
are not interpolated, less those that are tested or chosen on. Takes are those of Table 1 and those of subjects of CMU nothing was learnt
from; with --tuned those that settings are chosen on. Differences stand with their paired bootstrap intervals of 95 % over takes.
"""

from __future__ import annotations

import os
import time
from typing import Any

for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

import numpy as np

from gambol.controllers.body import forward_kinematics
from gambol.controllers.reconstruction import SKELETON, ControlPoints, encode, parse
from gambol.controllers.reconstruction.evaluation import metrics, strangers
from gambol.controllers.reconstruction.ours import turning
from gambol.controllers.reconstruction.regression import SPAN
from gambol.controllers.reconstruction.trackers import Trackers
from reconstruction_figures import against, table
from reconstruction_trackers import Performance, asked, in_cells, on_feet, opened, recorded

WORN = {"6 that turn": "6", "head and hands turn": "head,lwrist,rwrist"}
HEAD = ("", "network, cm", "ours, cm", "ours - network [95 %]", "network, deg", "ours, deg", "ours - network [95 %]", "ours, first frame cm", "ours, jitter",
        "network's slide cm/s (theirs)", "ours", "network's flat feet cm/s (theirs)", "ours", "ours, feet off cm", "ours, soles' height off cm",
        "ours, legs' jitter", "ours, knee's leap cm (theirs)", "ours, ms")


def followed(method: Any, controls: ControlPoints, on: Performance, given: bool) -> list[float]:
    """Mean distance [cm], mean angle [deg], the first frame's distance [cm], jitter over the recording's, what `on_feet` tells, and a frame's time [ms].
    given: whether the half second before is known."""
    seen, turns = on.positions[:, controls.joints], on.orientations[:, controls.joints]
    begin = SPAN if given else 0
    memory = method.begin(*(encode(on.root[:SPAN], on.rotations[:SPAN], 1 / 60) if given else method.find(seen[0], None, turns[0])))
    poses, began = [], time.process_time()
    for now in range(begin, len(seen)):
        memory, pose = method.step(memory, seen[now], turns[now])
        poses.append(pose)
    spent = 1e3 * (time.process_time() - began) / len(poses)
    rotations = np.stack([pose.rotations for pose in poses])
    found, turned = forward_kinematics(SKELETON, np.stack([pose.root for pose in poses]), rotations)
    errors = 100 * metrics.position_error(found, on.positions[begin:])
    shake = metrics.jitter(found, 1 / 60) / max(metrics.jitter(on.positions[begin:], 1 / 60), 1e-9)
    return [float(errors.mean()), float(np.degrees(metrics.angle_error(rotations, on.rotations[begin:])).mean()), float(errors[0]), shake,
            *on_feet(SKELETON, (found, turned), (on.positions[begin:], on.orientations[begin:])), spent]


def main() -> None:
    """Print the table."""
    options = asked(__doc__).parse_args()
    network, large, core = opened(options)
    courses = {"chosen on": core.validation} if options.tuned else {"seen subjects": core.test, "unseen subjects": strangers(large)}
    rows = []
    for worn, points in WORN.items():
        controls = parse(points, SKELETON)
        methods = Trackers(network, controls), turning(core.learnt, controls)
        for course, takes in courses.items():
            those = [recorded(large, take) for take in takes]
            for given in (True, False):
                theirs, ours = (np.array([followed(method, controls, on, given) for on in those]) for method in methods)
                feet, beside = in_cells(ours[:, 4:-1]), in_cells(theirs[:, 4:-1])
                rows.append([f"{worn}, {course}, {'half a second given' if given else 'from nothing'}", f"{theirs[:, 0].mean():.2f}",
                             f"{ours[:, 0].mean():.2f}", against(ours[:, 0], theirs[:, 0]), f"{theirs[:, 1].mean():.1f}", f"{ours[:, 1].mean():.1f}",
                             against(ours[:, 1], theirs[:, 1]), f"{ours[:, 2].mean():.1f}", f"{np.median(ours[:, 3]):.2f}",
                             beside[0], feet[0], beside[1], *feet[1:], f"{ours[:, -1].mean():.2f}"])
    print(table(HEAD, rows))


if __name__ == "__main__":
    main()
