"""A body from points that blink, come at another rate, or are noisy: how far off its joints are.

    python scripts/measure/blinking.py [--clip FILE] [--seconds 10] [--hands 1] [--exchanged [--noise CM]]

Without a clip the performer is somebody of Gambol's who walks and runs as hands that change their mind have it; others
for other --hands. Where trackers turn, what is missing has neither a place nor a turn. By the network that ships, in a
loop of one's own (`Reconstruction.step`) at 60 steps a second. Figures are the mean distance of the joints from the
performer's [cm], over two seeds, and that of the worst frame. It takes under three minutes of one core.

With --exchanged two points come under each other's number instead, for 0.2 s, 2 s or for ever, with their turns if they turn: from a moment on (at
once), from when they are nearest each other (near), or after neither was seen for 0.3 s (unseen). Figures are of the time from then on; "none" is of
all of it with none exchanged.
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
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.mocap import load, retarget
from gambol.controllers.reconstruction import SKELETON, Reconstruction, parse
from gambol.controllers.reconstruction.trackers import Network, Trackers
from reconstruction_figures import table
from reconstruction_trackers import WORN

PAIRS = {"hands": ("lwrist", "rwrist"), "feet": ("lankle", "rankle"), "hand and foot": ("lwrist", "rankle")}
LASTING, UNSEEN = (0.2, 2.0, np.inf), 18
RATE, SEEDS, CHANGES = 60, 2, 1.5
MISSING, EVERY, NOISE = (0.0, 0.05, 0.1, 0.2, 0.3, 0.5), (2, 3, 4), (1, 2, 3, 5)


def walked(seconds: float, hands: int) -> tuple[np.ndarray, np.ndarray]:
    """Joints (T, J, 3) [m] and orientations (T, J, 3, 3) of somebody who is told something else every second and a half."""
    walker, rng, joints = Locomotion.load(), np.random.default_rng(hands), []
    state, wish = walker.start(), np.zeros(3)
    for number in range(round(seconds * RATE)):
        if number % round(CHANGES * RATE) == 0:
            wish = rng.uniform([0.0, -1.0, -0.3], [2.8, 1.0, 0.3])
        state, pose = walker.step(state, Intent(wish), 1 / RATE)
        joints.append(forward_kinematics(SKELETON, pose.root, pose.rotations))
    return np.array([one[0] for one in joints]), np.array([one[1] for one in joints])


def recorded(file: Path) -> tuple[np.ndarray, np.ndarray]:
    """Joints (T, J, 3) [m] and orientations (T, J, 3, 3) of a clip on Gambol's skeleton."""
    return retarget(load(file)).resample(RATE).kinematics()


def off(network: Network, truth: np.ndarray, points: str, seen: np.ndarray, turns: np.ndarray | None) -> np.ndarray:
    """How far off (T − 1,) the joints of the body are that follows what is seen (T, n, 3), with turns (T, n, 3, 3) if trackers turn, on the average [cm]."""
    controls = parse(points, SKELETON)
    method = Trackers(network, controls, 1 / RATE)
    follower, found = Reconstruction(method, controls, starts=method), []
    told = [None] * len(seen) if turns is None else list(np.where(np.isfinite(seen)[..., None], turns, np.nan))
    state = follower.begin(seen[0], turns=told[0])
    for place, turn, true in zip(seen[1:], told[1:], truth[1:], strict=True):
        state, pose = follower.step(state, Intent(points=place, turns=turn), 1 / RATE)
        found.append(np.linalg.norm(forward_kinematics(SKELETON, pose.root, pose.rotations)[0] - true, axis=-1).mean())
    return 100 * np.array(found)


def spoilt(points: np.ndarray) -> dict[str, list[np.ndarray]]:
    """The same points (T, n, 3) as they are, and spoilt in several ways, each with several seeds."""
    found: dict[str, list[np.ndarray]] = {}
    for seed in range(SEEDS):
        rng = np.random.default_rng(seed)
        for share in MISSING:
            some = points.copy()
            some[1:][rng.random(some[1:].shape[:2]) < share] = np.nan
            found.setdefault(f"{100 * share:.0f} % missing", []).append(some)
        for noise in NOISE:
            found.setdefault(f"{noise} cm of noise", []).append(points + rng.normal(0.0, 0.01 * noise, points.shape))
    for step in EVERY:
        some = np.full_like(points, np.nan)
        some[::step] = points[::step]
        found[f"each {step}. frame alone"] = [some]
    return found


def exchanged(joints: np.ndarray, pair: list[int], way: str, lasting: float, seed: int) -> tuple[np.ndarray, np.ndarray, int]:
    """Which point comes under which number (T, n), which are seen (T, n) bool, and the frame in which a pair of points of joints (T, n, 3) is
    exchanged for so long [s]."""
    total, count = joints.shape[:2]
    some = slice(total // 5, total // 2)
    first = int(np.random.default_rng(seed).integers(some.start, some.stop))
    if way == "near":
        span = slice(first, first + round(2.0 * RATE))
        first += int(np.linalg.norm(joints[span, pair[0]] - joints[span, pair[1]], axis=-1).argmin())
    numbers, there = np.tile(np.arange(count), (total, 1)), np.ones((total, count), bool)
    last = int(min(first + lasting * RATE, total))
    numbers[first:last, pair] = pair[::-1]
    if way == "unseen":
        there[first - UNSEEN:first, pair] = False
    return numbers, there, first


def exchanges(network: Network, truth: np.ndarray, turned: np.ndarray, noise: float) -> str:
    """The table of what becomes of exchanged points, which may be noisy [m]."""
    rows: dict[tuple[str, ...], list[str]] = {}
    for points, turning in WORN.values():
        controls = parse(points, SKELETON)
        seen, turns = truth[:, controls.joints], turned[:, controls.joints]
        seen = seen + np.random.default_rng(7).normal(0.0, noise, seen.shape)
        away = off(network, truth, points, seen, turns if turning else None)
        rows.setdefault(("none", "", ""), []).append(f"{away.mean():.1f} ({away.max():.1f})")
        for name, two in PAIRS.items():
            pair = [controls.names.index(one) for one in two if one in controls.names]
            for way in ("at once", "near", "unseen"):
                for lasting in LASTING:
                    errors = []
                    for seed in range(SEEDS if len(pair) == 2 else 0):
                        numbers, there, first = exchanged(seen, pair, way, lasting, seed)
                        torn = np.where(there[..., None], np.take_along_axis(seen, numbers[..., None], 1), np.nan)
                        spun = np.take_along_axis(turns, numbers[..., None, None], 1) if turning else None
                        errors.append(off(network, truth, points, torn, spun)[first:])
                    found = f"{np.mean(np.concatenate(errors)):.1f} ({np.max(np.concatenate(errors)):.1f})" if errors else "–"
                    rows.setdefault((name, way, "for ever" if np.isinf(lasting) else f"{lasting} s"), []).append(found)
    return table(("exchanged", "how", "for", *WORN), [(*key, *cells) for key, cells in rows.items()])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--clip", type=Path)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--hands", type=int, default=0, help="whose hands: a seed")
    parser.add_argument("--exchanged", action="store_true", help="two points come under each other's number")
    parser.add_argument("--noise", type=float, default=0.0, metavar="CM", help="of exchanged points [cm]")
    args = parser.parse_args()
    truth, turned = (some[:round(args.seconds * RATE)] for some in (walked(args.seconds, args.hands) if args.clip is None else recorded(args.clip)))
    network, columns = Network.load(), {}
    if args.exchanged:
        print(exchanges(network, truth, turned, 0.01 * args.noise))
        return
    for points, turning in WORN.values():
        joints = parse(points, SKELETON).joints
        for name, ways in spoilt(truth[:, joints]).items():
            errors = [off(network, truth, points, seen, turned[:, joints] if turning else None) for seen in ways]
            columns.setdefault(name, []).append(f"{np.mean(errors):.1f} ({np.max(errors):.1f})")
    print(table(("", *WORN), [(name, *cells) for name, cells in columns.items()]))


if __name__ == "__main__":
    main()
