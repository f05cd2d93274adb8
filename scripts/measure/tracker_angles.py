"""Whether joints of another data set's people are off because their rotations are told otherwise: what part of each joint's error is always the same.

    python scripts/measure/tracker_angles.py LARGE --small FOLDER [--points 6] [--places] [--count 48]

LARGE, FOLDER: as for scripts/measure/reconstruction_trackers.py. --points: trackers, which turn unless --places. Takes of other data sets than CMU's, from nothing;
every take counts alike. If a joint's rotations are told with another rest, the true one is the found one times one rotation on either side (the parent's rest and
its own). The rotations that explain most (chordal means) are taken from the set's other takes, and taken away; then from the very take, which takes away as well how
its performer holds himself. Beside are CMU's tested takes.
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path

for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

import numpy as np
from scipy.spatial.transform import Rotation

from gambol.controllers.body import forward_kinematics
from gambol.controllers.reconstruction import JOINTS, SKELETON
from gambol.controllers.reconstruction.evaluation import foreign
from gambol.controllers.reconstruction.trackers import SHIPPED, Network
from reconstruction_figures import table
from reconstruction_trackers import Performance, opened, played, recorded

ROUNDS = 30
"""Of the search for two rotations at once."""


def nearest(sums: np.ndarray) -> np.ndarray:
    """The rotations (J, 3, 3) that are nearest to sums of rotations."""
    left, _, right = np.linalg.svd(sums)
    left[..., -1] *= np.linalg.det(left @ right)[..., None]
    return left @ right


def together(found: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """All products (J, 3, 3, 3, 3) of found rotations' entries and true ones', (T, J, 3, 3) each, summed over frames."""
    return np.einsum("tjab,tjcd->jabcd", found, truth, optimize=True)


def constants(sums: np.ndarray, sides: int) -> tuple[np.ndarray, np.ndarray]:
    """Rotations (J, 3, 3) by which found ones, times them before and after, come nearest to the truth, by `together` (J, 3, 3, 3, 3).

    sides: 1, only after."""
    before = np.broadcast_to(np.eye(3), sums.shape[:3])
    after = nearest(np.einsum("jabcd,jca->jbd", sums, before))
    for _ in range(ROUNDS if sides == 2 else 0):
        before = nearest(np.einsum("jabcd,jbd->jca", sums, after))
        after = nearest(np.einsum("jabcd,jca->jbd", sums, before))
    return before, after


def angles(found: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Between rotations (T, J, 3, 3) [deg]: (T, J)."""
    between = (np.swapaxes(truth, -1, -2) @ found).reshape(-1, 3, 3)
    return np.degrees(Rotation.from_matrix(between).magnitude()).reshape(found.shape[:2])


def told(network: Network, on: Performance, points: str, turning: bool) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Found and true rotations (T, J, 3, 3) of the chart's joints, and how far (J,) [cm] they are off on the average."""
    root, rotations, _ = played(network, on, points, turning)
    positions = forward_kinematics(on.skeleton, root, rotations)[0]
    off = 100 * np.linalg.norm(positions - on.positions, axis=-1).mean(0)
    return rotations[:, JOINTS], on.rotations[:, JOINTS], off[JOINTS]


def by_joint(of: list[np.ndarray]) -> np.ndarray:
    """Means over takes (J + 1,) of angles (T, J) [deg]: each joint's, and their root mean square."""
    return np.mean([np.append(one.mean(0), np.sqrt((one ** 2).mean(1)).mean()) for one in of], 0)


def main() -> None:
    """Print a table for each data set."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("large", type=Path, metavar="LARGE")
    parser.add_argument("--small", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--network", type=Path, default=SHIPPED)
    parser.add_argument("--points", default="6")
    parser.add_argument("--places", action="store_true", help="trackers tell only where they are")
    parser.add_argument("--count", type=int, default=48, help="takes of other data sets, evenly spread")
    options = parser.parse_args()
    network, large, core = opened(options)
    beside = by_joint([angles(*told(network, recorded(large, take), options.points, not options.places)[:2]) for take in core.test])
    takes = foreign(large, options.count)
    names = [SKELETON.names[j].removeprefix("Left").removeprefix("Right") for j in JOINTS]
    for folder in dict.fromkeys(take.clip.split("/")[0] for take in takes):
        of = [told(network, recorded(large, take), options.points, not options.places) for take in takes if take.clip.startswith(f"{folder}/")]
        if len(of) < 2:
            print(f"{folder}: one take alone tells no constants; ask for more by --count")
            continue
        ways: dict[str, list[np.ndarray]] = {}
        sums = [together(found, truth) for found, truth, _ in of]
        every = np.sum(sums, 0)
        for number, (found, truth, _) in enumerate(of):
            ways.setdefault("as found", []).append(angles(found, truth))
            after = constants(every - sums[number], 1)[1]
            ways.setdefault("constant", []).append(angles(after[None], np.eye(3)[None, None]))
            ways.setdefault("left", []).append(angles(found @ after, truth))
            before, after = constants(every - sums[number], 2)
            ways.setdefault("left, both sides", []).append(angles(before @ found @ after, truth))
            before, after = constants(sums[number], 2)
            ways.setdefault("left by the very take's", []).append(angles(before @ found @ after, truth))
        means, off = {way: by_joint(some) for way, some in ways.items()}, np.mean([one[2] for one in of], 0)
        rows = []
        for name in dict.fromkeys(names):
            own = np.array([k for k, other in enumerate(names) if other == name])
            rows.append((name, f"{off[own].mean():.1f}", *(f"{some[own].mean():.1f}" for some in (*means.values(), beside))))
        rows.append(("all, root mean square", f"{off.mean():.2f}", *(f"{some[-1]:.1f}" for some in (*means.values(), beside))))
        print(f"\n{folder}, {len(of)} takes\n\n" + table(("joint", "cm", *(f"{way}, deg" for way in means), "CMU's, deg"), rows), flush=True)


if __name__ == "__main__":
    main()
