"""Measure the network for trackers on motion that it was never learnt from.

    python scripts/measure/reconstruction_trackers.py LARGE --small FOLDER [--network FILE] [--out docs/reconstruction/trackers.md]

LARGE, FOLDER: as for scripts/build/trackers.py, a database and the folder whose clips are measured on. Courses: the test takes of
scripts/measure/reconstruction.py, with the half second before given, as there; the same from nothing; the performers' raw proportions,
their own joints on skeletons of their own lengths, from nothing; subjects of CMU and other data sets of whom nothing was learnt.
Feet slide where the performer's stand; a foot that lies flat on the floor slides by an eye's measure, whatever the performer's does. How far off feet and the height of
soles that stand are, how their legs shake over the performer's, and how far a knee is at most from where its motion led, tell what holding feet costs.
All distances are centimetres in the world over 19 joints. A frame's time is the process's own, which others on the machine hardly change.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from dataclasses import dataclass
from pathlib import Path

for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

import numpy as np

from gambol.controllers.body import Skeleton, contact_height, contact_points, detect_contacts, forward_kinematics, point_speeds
from gambol.controllers.mocap import MotionFileError, captured, load
from gambol.controllers.reconstruction import SKELETON, encode, parse
from gambol.controllers.reconstruction.database import Database, DatabaseError, Take
from gambol.controllers.reconstruction.evaluation import foreign, metrics, small_of, strangers, trials
from gambol.controllers.reconstruction.regression import SPAN
from gambol.controllers.reconstruction.trackers import SHIPPED, Network, Trackers
from reconstruction_figures import table

WORN = {"6 points": ("6", False), "4 points": ("4", False), "6 that turn": ("6", True), "3 that turn": ("head,lwrist,rwrist", True)}
HEAD = ("", "takes", "cm", "joint deg", "worst cm", "beyond 20 cm, %", "first frame cm (worst)", "first half second cm", "jitter",
        "slide cm/s (theirs)", "flat feet cm/s (theirs)", "feet off cm", "soles' height off cm", "legs' jitter", "knee's leap cm (theirs)", "ms")
TITLE = """# The network for trackers, measured

    python scripts/measure/reconstruction_trackers.py LARGE --small FOLDER --out docs/reconstruction/trackers.md

"""
TUNED = """# The network for trackers, on what its settings were chosen on

    python scripts/measure/reconstruction_trackers.py LARGE --small FOLDER --tuned --only 1 --out docs/reconstruction/validation.md

No figure to be told: the same for the takes that are tested is in [its own page](trackers.md).

"""
FPS, MOST, HALF, FAR = 60.0, 600, 30, 20.0
_BESIDE = 3  # more clips of a folder that its skeletons are calibrated by


@dataclass(frozen=True, eq=False)
class Performance:
    """What somebody did. root: (T, 3), rotations: (T, J, 3, 3) on a skeleton. positions: (T, J, 3) [m] their joints; they may be off
    the skeleton's, of those that `known` (J,) bool tells. orientations: (T, J, 3, 3)."""

    skeleton: Skeleton
    root: np.ndarray
    rotations: np.ndarray
    positions: np.ndarray
    orientations: np.ndarray
    known: np.ndarray


def recorded(database: Database, take: Take) -> Performance:
    """A take of a database, on the standard body."""
    trial = trials.trial(database, take, parse("4", SKELETON), MOST)
    positions, orientations = forward_kinematics(SKELETON, trial.positions[:, 0], trial.rotations)
    known = np.array([not name.endswith("Toe") for name in SKELETON.names])
    return Performance(SKELETON, trial.positions[:, 0], trial.rotations, positions, orientations, known)


def raw(folder: Path, take: Take) -> Performance:
    """A take as it was captured, in metres, on a skeleton of the performer's own lengths. MotionFileError or ValueError if it can't be used."""
    path = next(path for path in (folder / f"{take.clip}{end}" for end in (".amc", ".bvh")) if path.is_file())
    paths = [path, *[other for other in sorted(path.parent.glob(f"*{path.suffix}")) if other != path][:_BESIDE]]
    clips = [clip.resample(FPS) if clip.frame_time < 0.99 / FPS else clip for clip in map(load, paths)]
    own = captured(clips)
    body, start, rotations = own.skeleton, own.positions[:, 0], own.motion.rotations
    joints, turned = forward_kinematics(body, start, rotations)
    soles = contact_points(body, joints, turned)[..., 1]
    up = contact_height(body) - np.percentile(soles.min(-1), 20)
    return Performance(body, start + [0.0, up, 0.0], rotations, (own.positions + [0.0, up, 0.0])[:MOST + SPAN], turned[:MOST + SPAN], own.known)


def played(network: Network, on: Performance, points: str, turning: bool, given: bool = False) -> tuple[np.ndarray, np.ndarray, float]:
    """The body that follows a performance: root (T, 3), rotations (T, J, 3, 3), and a frame's time [s]. given: whether the half second before is known,
    whose frames are left out then."""
    controls = parse(points, SKELETON)
    method = Trackers(network, controls, 1 / FPS, on.skeleton)
    seen, turns = on.positions[:, controls.joints], on.orientations[:, controls.joints]
    begin = SPAN if given else 0
    if given:
        memory = method.begin(*encode(on.root[:SPAN], on.rotations[:SPAN], 1 / FPS))
    else:
        memory = method.begin(*method.find(seen[0], None, turns[0] if turning else None))
    root, rotations, began = [], [], time.process_time()
    for now in range(begin, len(seen)):
        memory, pose = method.step(memory, seen[now], turns[now] if turning else None)
        root.append(pose.root)
        rotations.append(pose.rotations)
    return np.array(root), np.array(rotations), (time.process_time() - began) / len(root)


def followed(network: Network, on: Performance, points: str, turning: bool, given: bool) -> list[float]:
    """A row's numbers of one performance; see HEAD. given: whether the half second before is known."""
    root, rotations, spent = played(network, on, points, turning, given)
    begin = SPAN if given else 0
    found, turned = forward_kinematics(on.skeleton, root, rotations)
    truth, judged = on.positions[begin:], on.known.copy()
    judged[0] = False
    errors = 100 * np.linalg.norm(found[:, judged] - truth[:, judged], axis=-1).mean(-1)
    angles = np.degrees(metrics.angle_error(rotations, on.rotations[begin:begin + len(root)]))
    own = tuple(part[begin:begin + len(root)] for part in forward_kinematics(on.skeleton, on.root, on.rotations))
    shake = metrics.jitter(found, 1 / FPS) / max(metrics.jitter(own[0], 1 / FPS), 1e-9)
    return [errors.mean(), angles.mean(), errors.max(), 100 * float((errors > FAR).mean()), errors[0], errors[:HALF].mean(), shake,
            *on_feet(on.skeleton, (found, turned), own), 1e3 * spent]


def on_feet(skeleton: Skeleton, found: tuple[np.ndarray, np.ndarray], own: tuple[np.ndarray, np.ndarray]) -> list[float]:
    """How joints, positions (T, J, 3) and orientations, hold feet beside the performer's: sums and counts of the slides [cm/s] of theirs and the performer's, of flat
    feet's likewise; how far off feet are, and soles that stand in height [cm]; the legs' jitter; both's knees' leaps [cm]."""
    shown, soles = (contact_points(skeleton, *some) for some in (found, own))
    height, stands = contact_height(skeleton), detect_contacts(soles[..., 1], point_speeds(soles, 1 / FPS))
    numbers: list[float] = []
    for some in (shown, soles):
        slides, flat = metrics.slides(some, stands, 1 / FPS), metrics.flat_slides(some, height, 1 / FPS)
        numbers += [100 * float(slides.sum()), float(len(slides)), 100 * float(flat.sum()), float(len(flat))]
    knees, feet = ([skeleton.index(side + name) for side in ("Left", "Right") for name in names] for names in (("Leg",), ("Foot", "Toe")))
    shakes = [np.linalg.norm(np.diff(joints[:, knees + feet], 3, axis=0), axis=-1).mean() for joints, _ in (found, own)]
    return [*numbers, 100 * float(np.linalg.norm(found[0][:, feet] - own[0][:, feet], axis=-1).mean()),
            100 * float(np.abs((shown - soles)[..., 1][stands]).mean()) if stands.any() else 0.0, float(shakes[0] / max(shakes[1], 1e-9)),
            *(100 * metrics.knee_leap(joints[:, knees], joints[:, 0]) for joints, _ in (found, own))]


def in_cells(feet: np.ndarray) -> list[str]:
    """What `on_feet` told of N performances (N, 13), in the table's words."""
    total, mean = np.maximum(feet.sum(0), 1e-9), feet.mean(0)
    return [f"{total[0] / total[1]:.1f} ({total[4] / total[5]:.1f})", f"{total[2] / total[3]:.1f} ({total[6] / total[7]:.1f})", f"{mean[8]:.1f}", f"{mean[9]:.1f}",
            f"{np.median(feet[:, 10]):.2f}", f"{mean[11]:.1f} ({mean[12]:.1f})"]


def row(name: str, network: Network, those: list[Performance], points: str, turning: bool, given: bool) -> list[str]:
    """A line of the table."""
    found = np.array([followed(network, on, points, turning, given) for on in those])
    mean, worst = found.mean(0), found.max(0)
    return [name, str(len(those)), f"{mean[0]:.2f}", f"{mean[1]:.1f}", f"{worst[2]:.0f}", f"{mean[3]:.1f}",
            "" if given else f"{mean[4]:.2f} ({worst[4]:.0f})", "" if given else f"{mean[5]:.2f}", f"{np.median(found[:, 6]):.2f}",
            *in_cells(found[:, 7:-1]), f"{mean[-1]:.2f}"]


COURSES = ("takes of seen subjects, the half second before given", "the same from nothing",
           "raw proportions, on their own skeletons, from nothing", "subjects of CMU nothing was learnt from, from nothing",
           "other data sets (SNU, NCSOFT), nothing learnt from, from nothing")


def performances(number: int, large: Database, folder: Path, takes: tuple[Take, ...]) -> list[Performance]:
    """What a course consists of."""
    if number != 2:
        return [recorded(large, take) for take in (takes, takes, (), strangers(large), foreign(large))[number]]
    found = []
    for take in takes:
        try:
            found.append(raw(folder, take))
        except (MotionFileError, ValueError) as error:
            print(f"left out: {take.clip}: {error}", file=sys.stderr)
    return found


def opened(options: argparse.Namespace) -> tuple[Network, Database, trials.Split]:
    """The network, the large database, and what of the small one is learnt from, tested and chosen on; says what can't be used, and exits."""
    try:
        network, large = Network.load(options.network), Database.open(options.large)
        small = small_of(large, options.small)
    except (DatabaseError, ValueError) as error:
        sys.exit(str(error))
    return network, large, trials.split(small.only([take for take in small.takes if not take.interpolated]))


def asked(about: str | None) -> argparse.ArgumentParser:
    """What a script that measures trackers on the large database is told."""
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("large", type=Path, metavar="LARGE")
    parser.add_argument("--small", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--network", type=Path, default=SHIPPED)
    parser.add_argument("--tuned", action="store_true", help="the takes that settings are chosen on, instead of the test's")
    return parser


def main() -> None:
    """Print the tables, and write them down if asked."""
    parser = asked(__doc__)
    parser.add_argument("--only", type=int, nargs="+", default=list(range(len(COURSES))), help="numbers of courses, from 0 on: " + "; ".join(COURSES))
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    network, large, core = opened(options)
    takes = core.validation if options.tuned else core.test
    followed(network, recorded(large, takes[0]), "6", True, False)  # what it compiles is no frame's time
    parts = [f"The network after {512 * network.learnt:,} samples; see scripts/measure/reconstruction_trackers.py."]
    for number in options.only:
        name, those, given = COURSES[number], performances(number, large, options.small, takes), number == 0
        rows = [row(worn, network, those, points, turning, given) for worn, (points, turning) in WORN.items()]
        parts.append(f"## {name[0].upper()}{name[1:]}\n\n{table(HEAD, rows)}")
        print(f"\n{parts[-1]}", flush=True)
    if options.out:
        options.out.write_text((TUNED if options.tuned else TITLE) + "\n\n".join(parts) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
