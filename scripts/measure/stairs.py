"""Measure walks up and down stairs of all kinds, by bodies of all sizes, as fast as they are asked to; and runs over single kerbs.

    python scripts/measure/stairs.py [--only HEIGHT ...] [--kerbs] [--knees] [--paces] [--keys]

Treads of 22–35 cm, rises of 12–20 cm, bodies of 1.2–2.1 m who are asked for 0.5–3.0 m/s: up six steps, over a landing and down
again. Four people walk each way, each from another phase. In: frames with a heel, ball or toe's end more than 1 cm in the steps,
told by the shortest way out of them; the deepest that a standing heel or ball, and that anything, got. Falls: people
who set a foot down over nothing, or did not arrive. Labels: points said to be in contact more than 4 cm over what lies under them,
in the standard body's size. Jerk: of feet's joints, the highest [km/s³], and the 95th percentile of each way's highest.
Kerbs: up one of 6–16 cm after five metres, on for 0.5–6 m, down again, straight on and askew; at least so fast meanwhile, as a share of
the fastest before.
Knees: up at 0.5 m/s, facing each way; how much a knee's velocity changes at most from one frame to the next, and how many frames it changes by more than 3 m/s.
Paces: how fast who asks for a walk and who asks for a run gets up and down.
Keys: how fast somebody whom keys tell to run gets up flights of 17 × 29 cm to a landing as high as their last tread, and how slow he gets on the way.
"""

from __future__ import annotations

import argparse
import math
from collections import defaultdict
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np

from gambol.controllers.body import contact_points, end_positions, forward_kinematics
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import DEFAULT_LIBRARY, Locomotion
from gambol.controllers.person import person
from gambol.game.input import Wish
from gambol.game.scene import Box
from gambol.game.session import Timeline, begin
from gambol.game.world import Character, World

FPS = 60
FACING = {"ahead": (0.0, 0.5, 0.0), "backward": (np.pi, -0.5, 0.0), "to the left": (-0.5 * np.pi, 0.0, 0.5), "to the right": (0.5 * np.pi, 0.0, -0.5)}
"""Who goes up so faces this way [rad], and goes so fast ahead and to the left [m/s]."""
SOLE = 0.02
"""How high heels, balls and toes' ends are in flat stance [m]."""
TREADS, RISES = (0.22, 0.25, 0.27, 0.29, 0.35), (0.12, 0.15, 0.17, 0.20)
HEIGHTS, SPEEDS = (1.2, 1.5, 1.74, 1.9, 2.1), (0.5, 0.8, 1.2, 2.0, 3.0)
STANDARD = 1.74
"""How tall the standard body is [m]: another walks as it does, in its own size (`controllers/scaled.py`)."""
PEOPLE, COUNT, LANDING = 4, 6, 2.5
KERBS, PACES, WIDTHS, ASKEW = (0.06, 0.10, 0.14, 0.16), (2.0, 2.5, 3.0, 3.5), (6.0, 0.5, 1.0, 2.0), 40.0
"""How high kerbs are, how fast they are run over [m/s], how far it is to their other edge [m], and how far askew some run [degrees]."""
BEFORE, AT_SPEED = 5.0, 1.5
"""So far away a kerb is as they set off, and so near to it they are under way [m]."""
FLIGHTS, RISE, TREAD = (6, 10, 14), 0.17, 0.29
"""So many treads, so high and long [m], are run up by keys."""
DEEP, OVER, NOTHING = 0.01, 0.04, 0.33
SLOWEST = 0.16
"""Who gets ahead slower than this on the way [m/s] does not arrive."""


class Walked(NamedTuple):
    """What a way's walk came to: depths [m] over frames and people, shares, jerk [m/s³], the lowest speed as a share."""

    deep: np.ndarray
    standing: float
    falls: int
    labels: float
    jerk: float
    slowest: float


def flight(rise, tread, size):
    """Stairs up, a landing and stairs down, as a body so many times the standard one's size sees them; and where they end [m]."""
    end = 2.0 + COUNT * tread
    spans = [(2.0 + k * tread, end, h) for k, h in enumerate(rise * np.arange(1, COUNT + 1))]
    spans += [(end, end + LANDING, COUNT * rise)]
    spans += [(end + LANDING, end + LANDING + (k + 1) * tread, h) for k, h in enumerate(rise * np.arange(COUNT, 0, -1))]
    boxes = tuple(SimpleNamespace(centre=(0.0, 0.5 * h / size, 0.5 * (a + b) / size), size=(4.0, h / size, (b - a) / size),
                                  heading=0.0, slope=0.0) for a, b, h in spans)
    return boxes, spans[-1][1] / size


def ground(points, around):
    """The ground (...) under points (..., 3): the highest of the steps, or the floor."""
    high = np.zeros(points.shape[:-1])
    for b in around:
        high = np.where(np.abs(points[..., 2] - b.centre[2]) <= 0.5 * b.size[2], np.maximum(high, b.size[1]), high)
    return high


def depth(points, around):
    """How deep points (..., 3) are in steps [m] by the shortest way out, up, along or both: a point at the foot of a riser is as deep in it as it is beyond it. Negative: how high over them."""
    below = ground(points, around) - points[..., 1]
    at = below > DEEP
    inside, deep = points[at], below[at]
    for out in np.linspace(-0.3, 0.3, 61):
        up = np.maximum(ground(inside + [0.0, 0.0, out], around) - inside[:, 1], 0.0)
        deep = np.minimum(deep, np.hypot(out, up))
    below[at] = deep
    return below


def walked(locomotion, rise, tread, height, speed, seconds=None) -> Walked:
    """Four people's walk up and down a flight of stairs, or for as long."""
    size = height / STANDARD
    around, end = flight(rise, tread, size)
    return crossed(locomotion, around, end, size, speed, seconds or (end + 2.0) * math.sqrt(size) / SLOWEST)


def ran(locomotion, rise, width, height, speed, askew=0.0) -> Walked:
    """Four people's run up a kerb and down its other edge, askew [degrees] if they are told to."""
    size = height / STANDARD
    kerb = SimpleNamespace(centre=(0.0, 0.5 * rise / size, (BEFORE + 0.5 * width) / size), size=(60.0, rise / size, width / size),
                           heading=0.0, slope=0.0)
    end = (BEFORE + width + 2.0) / size
    return crossed(locomotion, (kerb,), end, size, speed, 1.5 * end * math.sqrt(size), math.radians(askew))


def crossed(locomotion, around, end, size, speed, seconds, askew=0.0) -> Walked:
    """Four people's way over what stands about, until it ends [m] or for so many seconds, by bodies so many times the standard one's size."""
    begin = np.zeros((PEOPLE, 3))
    begin[:, 1], begin[:, 2] = np.linspace(0.0, 0.5, PEOPLE), askew
    state, states = locomotion.start(begin, np.zeros(PEOPLE)), []
    wish = Intent(np.array([speed / math.sqrt(size), 0.0, 0.0]), around=around)
    for _ in range(round(seconds * FPS)):
        state, _ = locomotion.step(state, wish, 1 / FPS)
        states.append(state)
        if (state.ground[:, 1] > end + 0.5).all():
            break
    skeleton = locomotion.skeleton
    roots, rotations = (np.array([getattr(s.pose, name) for s in states], float) for name in ("root", "rotations"))
    posed = forward_kinematics(skeleton, roots, rotations)
    points, labels = contact_points(skeleton, *posed), np.array([s.contacts for s in states])
    held = np.array([s.memory["grip"] for s in states]) >= 1.0
    ends = end_positions(skeleton, *posed)[..., [skeleton.end_index["LeftToe"], skeleton.end_index["RightToe"]], :]
    deep = depth(np.concatenate([points, ends], 2) - [0.0, SOLE, 0.0], around) * size
    floor = np.array([s.floor for s in states])[..., None]
    void = (np.maximum(points[..., 1], floor) - ground(points, around) > NOTHING).reshape(*labels.shape[:2], 2, 2).all(-1)
    void &= labels.reshape(*labels.shape[:2], 2, 2).any(-1)
    falls = int((void.any((0, 2)) | (state.ground[:, 1] < end)).sum())
    feet = [skeleton.index(name) for name in ("LeftFoot", "LeftToe", "RightFoot", "RightToe")]
    jerk = np.linalg.norm(np.diff(posed[0][:, :, feet], 3, axis=0), axis=-1).max() * FPS**3
    wrong = float((-deep[..., :4][labels] > OVER * size).mean())
    goes, near = np.array([s.velocity[:, 0] for s in states]), np.array([s.ground[:, 1] for s in states]) > (BEFORE - AT_SPEED) / size
    slowest = float((goes / np.maximum(np.maximum.accumulate(goes, 0), 0.1))[near].min(initial=1.0))
    return Walked(deep.max(-1), float(deep[..., :4][held].max()), falls, wrong, float(jerk / math.sqrt(size)), slowest)


def row(name, found: list[Walked]) -> str:
    """A line of figures of several ways."""
    deep = np.concatenate([one.deep.ravel() for one in found])
    jerks = np.array([one.jerk for one in found]) / 1000.0
    return (f"  {name:18s} in {100 * (deep > DEEP).mean():4.1f} %, standing {100 * max(max(one.standing for one in found), 0.0):4.1f} cm, at all "
            f"{100 * deep.max():4.1f} cm · falls {sum(one.falls for one in found):2d} of {PEOPLE * len(found):3d} · labels "
            f"{100 * np.mean([one.labels for one in found]):4.2f} % · jerk {jerks.max():4.0f}, {np.percentile(jerks, 95):4.0f} km/s³")


def kerbs(locomotion, heights) -> None:
    """Print the figures of runs over kerbs."""
    found = defaultdict(list)
    for i, height in enumerate(heights):
        for k, speed in enumerate(PACES):
            for n, rise in enumerate(KERBS):
                for askew in (0.0, ASKEW):
                    one = ran(locomotion, rise, WIDTHS[(i + k + n) % len(WIDTHS)], height, speed, askew)
                    for name in (f"{height:g} m tall", f"run at {speed:g} m/s", f"kerbs of {100 * rise:.0f} cm",
                                 f"{WIDTHS[(i + k + n) % len(WIDTHS)]:g} m wide", "askew" if askew else "straight on", "all kerbs"):
                        found[name].append(one)
    for name in sorted(found):
        print(row(name, found[name]) + f" · at least {100 * np.median([one.slowest for one in found[name]]):.0f} % of the speed", flush=True)


def knees(locomotion) -> None:
    """Print how hard knees are thrown of who climbs ahead, backward and aside, each from four places."""
    joints = [locomotion.skeleton.index(side + "Leg") for side in ("Left", "Right")]
    for name, (facing, ahead, left) in FACING.items():
        for rise, tread in ((0.17, 0.30), (0.12, 0.40)):
            around, _ = flight(rise, tread, 1.0)
            state, places = locomotion.start(np.array([(0.4 * k, 0.8 + 0.1 * k, facing) for k in range(4)])), []
            for _ in range(9 * FPS):
                off = np.pi - (np.pi - facing + np.asarray(state.ground)[:, 2]) % (2.0 * np.pi)
                state, pose = locomotion.step(state, Intent(np.stack([np.full(4, ahead), -2.0 * off, np.full(4, left)], -1), around=around), 1 / FPS)
                places.append(forward_kinematics(locomotion.skeleton, pose.root, pose.rotations)[0][:, joints])
            change = np.linalg.norm(np.diff(places, 2, axis=0), axis=-1).max(-1) * FPS
            print(f"  {name:18} {100 * rise:.0f} × {100 * tread:.0f} cm  knees by {change.max():3.1f} m/s in a frame, {change.max(0).min():3.1f} at least · over 3 m/s in {(change > 3.0).sum() / 4:4.1f} frames a climb")


def paces(locomotion, heights) -> None:
    """Print how fast stairs are walked and run, up and down."""
    for height in heights:
        size = height / STANDARD
        for rise, tread in ((0.12, 0.35), (0.15, 0.33), (0.17, 0.29), (0.20, 0.25)):
            around, end = flight(rise, tread, size)
            for speed in (1.3, 3.0):
                state, on = locomotion.start((0.0, -1.0, 0.0)), np.zeros(2)
                wish = Intent(np.array([speed / math.sqrt(size), 0.0, 0.0]), around=around)
                while state.ground[1] < end:
                    state, _ = locomotion.step(state, wish, 1 / FPS)
                    at = float(state.ground[1]) * size
                    on += (0.0 < at - 2.0 < (COUNT - 1) * tread, 0.0 < at - 2.0 - COUNT * tread - LANDING < (COUNT - 1) * tread)
                up, down = (COUNT - 1) * tread * FPS / on / math.sqrt(size)
                print(f"  {height:g} m tall, {100 * rise:.0f} × {100 * tread:.0f} cm, asked {speed:g} m/s  up {up:4.2f}, down {down:4.2f} m/s", flush=True)


def keys() -> None:
    """Print how fast flights are run up by keys."""
    who = person()
    for count in FLIGHTS:
        steps = tuple(Box((0.0, 0.5 * RISE * (k + 1), 2.0 + TREAD * (k + 0.5)), (2.4, RISE * (k + 1), TREAD)) for k in range(count))
        landing = Box((0.0, 0.5 * RISE * count, 2.0 + TREAD * count + 1.5), (2.4, RISE * count, 3.0))
        line, speeds = Timeline(begin(World((Character("A", who, who.start((0.0, -1.0, 0.0))),), (*steps, landing)), 1)), []
        for _ in range(20 * FPS):
            line.advance((Wish(move=(0.0, 1.0), run=1.0).rounded(),))
            state = line.now.after.characters[0].state
            if 2.0 < state.ground[1] < 2.0 + (count - 1) * TREAD:
                speeds.append(float(state.velocity[0]))
        print(f"  {count} treads by keys  up {np.mean(speeds):4.2f} m/s, at least {min(speeds):4.2f}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--library", default=DEFAULT_LIBRARY)
    parser.add_argument("--only", nargs="+", type=float, help="only bodies so tall [m]")
    parser.add_argument("--kerbs", action="store_true", help="only runs over kerbs")
    parser.add_argument("--knees", action="store_true", help="only knees of who climbs ahead, backward and aside")
    parser.add_argument("--paces", action="store_true", help="only how fast stairs are walked and run")
    parser.add_argument("--keys", action="store_true", help="only how fast keys run up flights")
    arguments = parser.parse_args()
    if arguments.keys:
        keys()
        return
    if arguments.paces:
        paces(Locomotion.load(arguments.library), arguments.only or (1.2, STANDARD))
        return
    if arguments.knees:
        knees(Locomotion.load(arguments.library))
        return
    locomotion, found = Locomotion.load(arguments.library), defaultdict(list)
    kerbs(locomotion, arguments.only or HEIGHTS)
    if arguments.kerbs:
        return
    for i, height in enumerate(arguments.only or HEIGHTS):
        for k, speed in enumerate(SPEEDS):
            for n, tread in enumerate(TREADS):
                rise = RISES[(i + k + n) % len(RISES)]
                one = walked(locomotion, rise, tread, height, speed)
                for name in (f"{height:g} m tall", f"asked {speed:g} m/s", f"treads {100 * tread:.0f} cm", f"rises {100 * rise:.0f} cm", "all"):
                    found[name].append(one)
    for name in sorted(found):
        print(row(name, found[name]), flush=True)


if __name__ == "__main__":
    main()
