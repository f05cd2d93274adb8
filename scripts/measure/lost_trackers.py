"""How a body comes back whose trackers were lost: how fast joints are carried there, how hard, and how far off they still are.

    python scripts/measure/lost_trackers.py LARGE --small FOLDER [--gaps 10 30 50] [--out docs/reconstruction/lost.md]

LARGE, FOLDER: as for scripts/build/trackers.py. Takes of CMU subjects of whom nothing was learnt, and those that settings are chosen on, from nothing,
by the network as `gambol reconstruct` uses it (`Reconstruction`). After 100 frames all trackers, or one of them, are lost for some frames of 1/60 s.
A step is by how many centimetres a joint goes farther in a frame than the performer's does, from three frames before they are lost until 45 after
they are back; a pull is its acceleration [m/s²]. Both are the largest of any joint, on the average of all takes, and in the worst one. Errors are the
mean distance of 21 joints from the performer's [cm].
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path

for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

import numpy as np

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Intent
from gambol.controllers.reconstruction import SKELETON, Reconstruction, parse
from gambol.controllers.reconstruction.evaluation import strangers
from gambol.controllers.reconstruction.regression import SPAN
from gambol.controllers.reconstruction.trackers import SHIPPED, Network, Trackers
from reconstruction_figures import table
from reconstruction_trackers import FPS, WORN, Performance, opened, recorded

FROM, FRAMES, BEFORE, AFTER = 100, 230, 3, 45
QUARTER, HALF, SECOND = 15, 30, 60
HEAD = ("", "lost", "frames", "step, cm (worst)", "none lost", "pull, m/s² (worst)", "error meanwhile", "quarter second after", "next quarter", "next half second",
        "none lost")
TITLE = """# Trackers that were lost, measured

    python scripts/measure/lost_trackers.py LARGE --small FOLDER --out docs/reconstruction/lost.md

"""


def followed(network: Network, on: Performance, points: str, turning: bool, lost: slice, which: list[int]) -> np.ndarray:
    """Joints (T − 1, J, 3) of the body that follows, from the second frame on; trackers `which` are lost in the frames `lost`."""
    controls = parse(points, SKELETON)
    method = Trackers(network, controls, 1 / FPS)
    controller = Reconstruction(method, controls, starts=method)
    seen, turns = on.positions[:, controls.joints].copy(), on.orientations[:, controls.joints].copy()
    seen[lost, which] = turns[lost, which] = np.nan
    state, bodies = controller.begin(seen[0], (seen[1] - seen[0]) * FPS, turns=turns[0] if turning else None), []
    for point, turn in zip(seen[1:], turns[1:], strict=True):
        state, pose = controller.step(state, Intent(points=point, turns=turn if turning else None), 1 / FPS)
        bodies.append(forward_kinematics(SKELETON, pose.root, pose.rotations)[0])
    return np.array(bodies)


def figures(bodies: np.ndarray, calm: np.ndarray, truth: np.ndarray, back: int) -> list[float]:
    """A row's numbers of one performance (T, J, 3), of the same with no tracker lost, and of the performer; back: the frame in which they are seen again."""
    def steps(some):
        return 100 * np.linalg.norm(np.diff(some, axis=0), axis=-1)
    def errors(some):
        return 100 * np.linalg.norm(some - truth, axis=-1)[:, 1:].mean(-1)
    around = slice(FROM - BEFORE, back + AFTER)
    beyond = [(steps(some) - steps(truth))[around].max() for some in (bodies, calm)]
    pull = np.linalg.norm(np.diff(bodies, 2, axis=0), axis=-1)[around].max() * FPS ** 2
    away, at = errors(bodies), back - 1  # the first frame makes no body
    return [*beyond, pull, away[FROM - 1:at].mean(), away[at:at + QUARTER].mean(), away[at + QUARTER:at + HALF].mean(), away[at + HALF:at + SECOND].mean(),
            errors(calm)[at:at + SECOND].mean()]


def main() -> None:
    """Print the table, and write it down if asked."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("large", type=Path, metavar="LARGE")
    parser.add_argument("--small", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--network", type=Path, default=SHIPPED)
    parser.add_argument("--gaps", type=int, nargs="+", default=[10, 30, 50], help="for how many frames they are lost")
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    network, large, core = opened(options)
    takes = [take for take in strangers(large) + core.validation if take.stop - take.start >= SPAN + FRAMES]
    those = []
    for take in takes:
        on = recorded(large, take)
        those.append(Performance(*(on.skeleton, *(part[SPAN:SPAN + FRAMES] for part in (on.root, on.rotations, on.positions, on.orientations)), on.known)))
    rows = []
    for worn, (points, turning) in WORN.items():
        count = len(parse(points, SKELETON))
        calm = [followed(network, on, points, turning, slice(0), []) for on in those]
        for gap in options.gaps:
            for kind in ("all", "one"):
                found = np.array([figures(followed(network, on, points, turning, slice(FROM, FROM + gap), list(range(count)) if kind == "all" else [k % count]),
                                          calm[k], on.positions[1:], FROM + gap) for k, on in enumerate(those)])
                mean, worst = found.mean(0), found.max(0)
                rows.append([worn, kind, str(gap), f"{mean[0]:.1f} ({worst[0]:.1f})", f"{mean[1]:.1f} ({worst[1]:.1f})", f"{mean[2]:.0f} ({worst[2]:.0f})",
                             *(f"{number:.1f}" for number in mean[3:])])
                print(" | ".join(rows[-1]), flush=True)
    text = f"{len(those)} takes.\n\n{table(HEAD, rows)}"
    print(f"\n{text}")
    if options.out:
        options.out.write_text(TITLE + text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
