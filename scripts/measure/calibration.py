"""How far a body is off whose trackers are worn anyhow: as they are, after a standing pose, and after five seconds of moving.

    python scripts/measure/calibration.py LARGE --small FOLDER [--network FILE] [--tuned] [--out docs/reconstruction/calibration.md]

LARGE, FOLDER: as for scripts/build/trackers.py. Performers move as subjects of CMU of whom nothing was learnt, or with --tuned as in takes that
settings are chosen on, on limbs as long as those of others of CMU's (`_performers`). Trackers are 10 cm and 20° off, in whatever direction. They
stand in T-pose, arms 6° low, other joints 1.5° off about each axis, then the take's first five seconds are heard, and all of it is judged. In
the other set poses their arms are as low, joints 4° off, those of trunk and legs 2°, and knees bent by 15° more or less; of these are the last columns.
Beside it: arms as they were asked; trackers right on their joints, for the performer's own proportions; and what exact mounts and bones would
give. All distances are centimetres in the room over 19 joints.
With --raw: every third of the takes that are tested, as they were captured, against the performers' own joints, with six and four trackers.
With --people FOLDER, as for scripts/build/calibration/bones.py: likely bones are fitted to everybody there but whoever is measured; without it those that ship are
taken, which know most of them. --bones tells how far each bone is found from the performer's own.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

import numpy as np

from gambol.controllers.body import Skeleton, contact_height, exp, forward_kinematics, yaw
from gambol.controllers.reconstruction import SKELETON, parse
from gambol.controllers.reconstruction.calibration import (BEFORE, FRAMES, JOINTS, POSES, SHIPPED, STRIDE, WORN, CalibrationNetwork, LikelyBones, Stood,
                                                           calibrated, fitted)
from gambol.controllers.reconstruction.database import Database, DatabaseError
from gambol.controllers.reconstruction.evaluation import performers, small_of, strangers, trials
from gambol.controllers.reconstruction.live import placed
from gambol.controllers.reconstruction.trackers import Network, Trackers
from _performers import people, performing, posing
from reconstruction_figures import table
from reconstruction_trackers import FPS, Performance, raw

OFF, TURNED, UNREST, RESTLESS = 0.10, np.radians(20.0), np.radians(1.5), np.radians(4.0)
SETS = {"6": ("Hips", "Head", "LeftHand", "RightHand", "LeftFoot", "RightFoot"), "3": ("Head", "LeftHand", "RightHand")}
RAW = {"6": SETS["6"], "4": SETS["6"][2:]}
CASES = {"10 cm and 20° off, arms 6° low": (OFF, np.radians(6.0), RESTLESS), "10 cm and 20° off, arms as asked": (OFF, 0.0, RESTLESS),
         "on their joints, arms 6° low": (0.0, np.radians(6.0), RESTLESS), "on their joints, arms as asked": (0.0, 0.0, RESTLESS),
         "10 cm and 20° off, arms 12° low, poses twice as careless": (OFF, np.radians(12.0), 2.0 * RESTLESS)}
HEAD = ("", "trackers", "places alone", "standing", "standing and 5 s", "eight poses", "exact", "sure of mounts, cm", "mounts off, cm", "bones off, cm")
BONES = {name.removeprefix("Left"): ("Left", "Right") if name.startswith("Left") else ("",) for name in SKELETON.names[1:]
         if not name.startswith("Right") and not name.endswith("Toe")}
ROOM = 0.7, np.array([0.4, 0.01, -0.8])
"""How the room is turned [rad], and where its middle is [m]; its floor is not quite level with the body's."""
SEEDS = 3
TITLE = """# Calibration, measured

    python scripts/measure/calibration.py LARGE --small FOLDER --out docs/reconstruction/calibration.md

"""


def standing(skeleton: Skeleton, arms: float, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Joints (J, 3) [m] and their orientations (J, 3, 3) of somebody in T-pose, arms low, and not quite straight otherwise."""
    turns = exp(rng.normal(0.0, UNREST, (len(skeleton), 3)))
    turns[0] = np.eye(3)
    for side, way in (("Left", -1.0), ("Right", 1.0)):
        turns[skeleton.index(side + "Arm")] = exp(np.array([0.0, 0.0, way * arms])) @ turns[skeleton.index(side + "Arm")]
    positions, orientations = forward_kinematics(skeleton, np.zeros(3), turns)
    toes = [skeleton.index(side + "Toe") for side in ("Left", "Right")]
    return positions + [0.0, contact_height(skeleton) - positions[toes, 1].min(), 0.0], orientations


def likely(known: dict[str, dict[str, Skeleton]], without: str) -> LikelyBones | None:
    """What bones people have as all performers but one tell it; as shipped where nobody is given."""
    return LikelyBones.of({name: [own for who, own in people.items() if who != without] for name, people in known.items()}) if known else None


def off(networks: tuple[Network, CalibrationNetwork], on: Performance, which: tuple[str, ...], case: tuple[float, float, float], rng: np.random.Generator,
        bones_of: LikelyBones | None = None) -> tuple[list[float], np.ndarray]:
    """A row's numbers of one performance, and how far bones (J,) [cm] are found in poses, NaN of those the performer doesn't have."""
    there = np.array([name in which for name in WORN])
    mine = JOINTS[there]
    where, axis = (each / np.linalg.norm(each, axis=-1, keepdims=True) for each in rng.normal(size=(2, len(WORN), 3)))
    beside, mount = case[0] * where, exp(TURNED * axis)

    def seen(positions, orientations):
        turns = orientations[..., JOINTS, :, :]
        places = positions[..., JOINTS, :] + np.einsum("...nij,nj->...ni", turns, beside)
        return places @ yaw(ROOM[0]).T + ROOM[1], yaw(ROOM[0]) @ turns @ mount
    stand = standing(on.skeleton, case[1], rng)
    place, turn = seen(*stand)
    places, turns = seen(on.positions, on.orientations)
    truth = on.positions @ yaw(ROOM[0]).T + ROOM[1]
    stood = Stood.of(place[None], turn[None], there[None])
    last = min(len(places), int(5 * FPS)) - 1
    at = np.arange(last, BEFORE, -STRIDE)[:FRAMES]
    pairs = np.stack([at, at - BEFORE], 1)
    controls = parse(",".join(which), SKELETON)

    def judged(found):
        return float(100 * np.linalg.norm(found - truth, axis=-1)[:, 1:][:, on.known[1:]].mean())
    placement = placed(place[there], controls, turns=turn[there])
    bodies = played(networks[0], SKELETON, controls, placement(places[:, there]), np.stack([placement.turned(some) for some in turns[:, there]]))
    found = [judged((bodies - placement.shift) @ yaw(placement.heading) / placement.scale)]
    shown = posing(on.skeleton, np.array(list(POSES.values())[1:]), case[1], case[2], rng)
    posed = tuple(np.concatenate([first[None], rest]) for first, rest in zip((place, turn), seen(*shown), strict=True))
    for known in (calibrated(networks[1], stood), calibrated(networks[1], stood, places[pairs], turns[pairs]), fitted(stood, *posed, range(len(POSES)), bones_of)):
        points, oriented = known.joints(places, turns)
        bodies = played(networks[0], known.skeleton, controls, points[:, there], oriented[:, there])
        found.append(judged((bodies + [0.0, known.floor, 0.0]) / known.stood.scale[0]))
    exact = played(networks[0], on.skeleton, controls, on.positions[:, mine], on.orientations[:, mine])
    away = known.offsets - known.stood.scale[0] * np.einsum("nij,njk,nk->ni", np.swapaxes(known.stood.mounts[0], -1, -2), np.swapaxes(mount, -1, -2), beside)
    bones = np.where(on.known, 100 * np.linalg.norm(known.bones / known.stood.scale[0] - on.skeleton.offsets, axis=-1), np.nan)
    return [*found, judged(exact @ yaw(ROOM[0]).T + ROOM[1]), 100 * known.unsure[1][there].mean(),
            100 * np.linalg.norm(away[there], axis=-1).mean(), np.nanmean(bones[1:])], bones


def played(network, skeleton, controls, points, turns):
    """Joints (T, J, 3) of the body that follows points (T, n, 3) with turns (T, n, 3, 3)."""
    method = Trackers(network, controls, 1 / FPS, skeleton)
    memory = method.begin(*method.find(points[0], None, turns[0]))
    bodies = []
    for point, turn in zip(points, turns, strict=True):
        memory, pose = method.step(memory, point, turn)
        bodies.append(forward_kinematics(skeleton, pose.root, pose.rotations)[0])
    return np.array(bodies)


def main() -> None:
    """Print the table, and write it down if asked."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("large", type=Path, metavar="LARGE")
    parser.add_argument("--small", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--network", type=Path, default=SHIPPED)
    parser.add_argument("--tuned", action="store_true", help="long takes that settings are chosen on, instead of strangers")
    parser.add_argument("--raw", action="store_true", help="tested takes as they were captured, instead of strangers' motion on others' limbs")
    parser.add_argument("--cases", type=int, nargs="+", default=list(range(len(CASES))), help="numbers of cases, from 0 on: " + "; ".join(CASES))
    parser.add_argument("--seeds", type=int, default=SEEDS)
    parser.add_argument("--people", type=Path, metavar="FOLDER", help="recorded people, to whom likely bones are fitted")
    parser.add_argument("--bones", action="store_true", help="how far each bone is found, too")
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    try:
        networks, large = (Network.load(), CalibrationNetwork.load(options.network)), Database.open(options.large)
        takes = strangers(large)
        if options.tuned:
            small = small_of(large, options.small)
            takes = tuple(take for take in trials.split(small.only([one for one in small.takes if not one.interpolated])).validation
                          if take.stop - take.start > 5 * FPS)
    except (DatabaseError, ValueError) as error:
        sys.exit(str(error))
    if options.raw:
        small = small_of(large, options.small)
        takes = trials.split(small.only([one for one in small.takes if not one.interpolated])).test[::3]
    if not takes:
        sys.exit(f"{options.small}: has no take of five seconds that settings are chosen on")
    bodies = [] if options.raw else list(people(options.small / "cmu").items())
    known = performers(options.people) if options.people else {}
    rows, bones = [], []
    for name, case in list(CASES.items()):
        if list(CASES).index(name) not in options.cases:
            continue
        for count, which in (RAW if options.raw else SETS).items():
            found = []
            for number, take in enumerate(takes):
                for seed in range(options.seeds):
                    who, body = (take.subject, None) if options.raw else bodies[(options.seeds * number + seed) % len(bodies)]
                    on = raw(options.small, take) if body is None else performing(large, take, body)
                    found.append(off(networks, on, which, case, np.random.default_rng([seed, number]), likely(known, who)))
            rows.append([name, count, *(f"{number:.2f}" for number in np.mean([one[0] for one in found], 0))])
            print(" | ".join(rows[-1]), flush=True)
            each = np.array([one[1] for one in found])
            bones.append([name, count, *(f"{np.nanmean(each[:, [SKELETON.index(side + bone) for side in sides]]):.1f}" for bone, sides in BONES.items())])
    text = (f"{len(takes)} takes, each worn in {options.seeds} ways; the network learnt from {networks[1].people:,} performers.\n\n" + table(HEAD, rows)
            + (f"\n\nBones found in eight poses are off by, cm:\n\n{table(['', 'trackers', *BONES], bones)}" if options.bones else ""))
    print(f"\n{text}")
    if options.out:
        options.out.write_text(TITLE + text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
