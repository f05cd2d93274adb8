"""Measure what hands get that tap a leap while somebody goes otherwise than straight ahead on level ground.

    python scripts/measure/leap_ways.py [--phases 6] [--only curves,ways,ramps,chains] [--speeds 2.2,3]

By the keys and sticks of a session, as one plays: somebody runs or walks along an arc, aside, askew or backward with his heading held, slowly, or up,
down and across ramps. At many moments of a stride the button is pressed for a moment and let go, the stick held on. Told is how many leaps are
refused, and why; how long it takes from letting go to the air; how far he leaps over how fast he came, as a time; how far askew of the way that he
went; on how many feet he lands; and how much of his speed he keeps; how hard hands and hips are pulled meanwhile, and knees bent, how far soles slide that stand, and how near
his legs come to each other. All but when a leap leaves and lands is told from the poses that are played. Or the button is pressed again and again.
"""

from __future__ import annotations

import argparse
import os
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from _limbs import legs_apart

from gambol.controllers.body import contact_points, forward_kinematics
from gambol.controllers.contract import CharacterState
from gambol.controllers.jump import Jumping
from gambol.controllers.locomotion import Locomotion, Settings
from gambol.controllers.person import person
from gambol.game.input import Wish
from gambol.game.scene import Box
from gambol.game.session import SessionState, Timeline, begin, refused
from gambol.game.world import RATE, Character, World

PRESSED, LED, STRIDE, AFTER = 0.15, 3.0, 0.8, 1.0
"""So long the button is held; somebody has gone until it is pressed at first, and longer by up to so much; and is looked at after his leap [s]."""
WAITS = 2.0
"""So long a leap may take to begin [s]: longer than hands wait for one."""
OVER = 6
"""Speeds of hips are told over so many steps."""
RATES, ARCS = (30, -30, 45, -45, 60, -60), (1.3, 2.2, 3.0)
"""How fast a stick turns [°/s], and how fast somebody goes then [m/s]."""
ASKEW, PACES = (45, -45, 90, -90, 135, -135, 180), (1.3, 3.0)
"""Ways to go with the heading held [° to the left], and how fast hands ask for it [m/s]."""
SLOW = 0.4, 0.5, 0.65, 0.8, 0.9
"""Slow walks straight ahead [m/s]."""
AGAIN = (0.6, 0.9, 1.3), (1.3, 0.7), 9.0
"""Who leaps again and again has the button pressed each so many seconds, walks so fast [m/s], and is looked at until then [s]."""
SLOPES, UPON = (10, 15), {"up": 0.0, "down": 180.0, "across": 90.0}
"""How steep ramps are [°], and which way they are gone, from uphill [°]."""


class Way(NamedTuple):
    """A way to go: what it is called, in which group, how fast hands ask for it [m/s], how far to the left of where he first faces [rad] and turning how fast
    [rad/s], whether the heading is held, where he starts x, z [m], heading [rad], and how steep the ramp is that he goes on [m/m], 0 where there is none."""

    group: str
    name: str
    speed: float
    aside: float = 0.0
    rate: float = 0.0
    strafe: bool = False
    ground: tuple[float, float, float] = (0.0, 0.0, 0.0)
    slope: float = 0.0


@dataclass(frozen=True)
class Leapt:
    """What became of a leap that was asked. why: what kept him, "" if he leapt. delay: from letting go to the air [s]. far: how far he leaps over his speed
    before [s]. askew: how far aside of his way [°]. single: whether he lands on one foot. kept: the least of his speed from before he lands until 0.6 s later,
    over that before. whole: his speed from the take-off's beginning until then, over that before. hands, hips [m/s²], knees [°/s²]: how hard they are pulled at most; slides,
    apart: how far a sole slides that stands, and how near the axes of his legs come [m]."""

    why: str
    delay: float = 0.0
    far: float = 0.0
    askew: float = 0.0
    single: bool = False
    kept: float = 0.0
    whole: float = 0.0
    hands: float = 0.0
    hips: float = 0.0
    knees: float = 0.0
    slides: float = 0.0
    apart: float = 0.0


def ways() -> Iterator[Way]:
    """All ways that are measured."""
    for speed in ARCS:
        for rate in RATES:
            yield Way("curves", f"{speed:g} m/s, {abs(rate)}°/s", speed, 0.0, float(np.radians(rate)))
    for speed in PACES:
        for aside in ASKEW:
            yield Way("ways", f"{speed:g} m/s, {abs(aside)}° aside", speed, float(np.radians(aside)), strafe=True)
    for speed in SLOW:
        yield Way("ways", f"{speed:g} m/s, ahead", speed)
    for steep in SLOPES:
        for speed in ARCS:
            for name, heading in UPON.items():
                rise = float(np.tan(np.radians(steep)))
                at = {"up": (0.0, -12.0), "down": (0.0, 12.0), "across": (-8.0, 0.0)}[name]
                yield Way("ramps", f"{steep}°, {speed:g} m/s, {name}", speed, ground=(*at, float(np.radians(heading))), slope=rise)


def stage(way: Way) -> tuple[tuple[Box, ...], float]:
    """What stands there, and how high [m] he starts: a long and wide ramp, or nothing."""
    if not way.slope:
        return (), 0.0
    deep = 40.0 * way.slope
    ramp = Box((0.0, 0.5 * deep, 0.0), (40.0, deep, 40.0), slope=way.slope)
    return (ramp,), deep + way.slope * way.ground[1]


def wished(way: Way, moment: SessionState, seconds: float, jump: bool) -> Wish:
    """What hands wish so long [s] after the beginning: a stick that leads the way in the world, however the camera looks."""
    there = way.ground[2] + way.aside + way.rate * seconds
    yaw = moment.players[0].camera.yaw
    throw, run = (min(way.speed / 1.3, 1.0), max((way.speed - 1.3) / 1.7, 0.0))
    return Wish(move=(-throw * float(np.sin(there - yaw)), throw * float(np.cos(there - yaw))), run=run, strafe=way.strafe, jump=jump).rounded()


def advance(moment: SessionState, wish: Wish) -> SessionState:
    """The moment a step later."""
    line = Timeline(moment)
    line.advance((wish,))
    return line.now


def hips(moment: SessionState) -> np.ndarray:
    """Where x, z [m] the hips are."""
    return np.asarray(moment.after.characters[0].state.pose.root)[[0, 2]]


def leaping(moment: SessionState) -> Jumping | None:
    """What he remembers who leaps."""
    memory = moment.after.characters[0].state.memory.memory
    return memory if isinstance(memory, Jumping) else None


def pulled(values: np.ndarray) -> np.ndarray:
    """The accelerations (N - 4, ...) of values (N, ...) of steps, over two of them."""
    return (values[4:] - 2.0 * values[2:-2] + values[:-4]) * (RATE / 2) ** 2


def moved(states: list[CharacterState], skeleton: Any) -> tuple[float, float, float, float, float]:
    """How hard hands, hips [m/s²] and knees [°/s²] are pulled at most in some states, how far a sole slides that stands, and how near legs come to each other [m]."""
    roots, local = np.array([np.asarray(one.pose.root, float) for one in states]), np.array([np.asarray(one.pose.rotations, float) for one in states])
    joints, turned = forward_kinematics(skeleton, roots, local)
    hands = [np.linalg.norm(pulled(joints[:, skeleton.index(side + "Hand")]), axis=-1).max() for side in ("Left", "Right")]
    knees = []
    for side in "Left", "Right":
        hip, knee, ankle = (joints[:, skeleton.index(side + part)] for part in ("UpLeg", "Leg", "Foot"))
        thigh, shank = hip - knee, ankle - knee
        knees.append(np.abs(pulled(np.degrees(np.arccos((thigh * shank).sum(-1) / np.linalg.norm(thigh, axis=-1) / np.linalg.norm(shank, axis=-1))))).max())
    stands = np.array([one.contacts for one in states])
    steps = np.linalg.norm(np.diff(contact_points(skeleton, joints, turned)[..., [0, 2]], axis=0), axis=-1) * (stands[1:] & stands[:-1])
    far, slides = np.zeros(steps.shape[1]), 0.0
    for step, on in zip(steps, stands[1:]):
        far = (far + step) * on
        slides = max(slides, float(far.max()))
    return float(max(hands)), float(np.linalg.norm(pulled(roots), axis=-1).max()), float(max(knees)), slides, float(legs_apart(skeleton, roots, local).min())


def tapped(way: Way, moment: SessionState, seconds: float, seen: Callable[[SessionState], None] = lambda moment: None) -> Leapt:
    """What becomes of a leap that is tapped so long [s] after the beginning. seen: is shown every moment."""
    gone, told, begun, step, states = [hips(moment)], "", None, 0, [moment.after.characters[0].state]
    while begun is None and step < (PRESSED + WAITS) * RATE:
        before = moment
        moment = advance(moment, wished(way, moment, seconds + step / RATE, step < PRESSED * RATE))
        seen(moment)
        gone.append(hips(moment))
        states.append(moment.after.characters[0].state)
        told = "; ".join(refused(before, moment)) or told
        step += 1
        memory = leaping(moment)
        if memory is not None and not memory.fault:
            begun = memory
        if told and memory is None:
            return Leapt(told.removeprefix("no jump: "))
    if begun is None:
        return Leapt("nothing")
    made, at = begun.plan, step - round(begun.time * RATE)
    down = at + int(made.touch_down * RATE)
    while step < down + AFTER * RATE:
        moment = advance(moment, wished(way, moment, seconds + step / RATE, False))
        seen(moment)
        gone.append(hips(moment))
        states.append(moment.after.characters[0].state)
        step += 1
    place = np.array(gone)
    pace = np.linalg.norm(place[OVER:] - place[:-OVER], axis=1) * RATE / OVER  # until then
    came = place[at - 1] - place[max(at - 1 - OVER, 0)]
    speed = float(np.linalg.norm(came)) * RATE / min(OVER, at - 1)
    flown = (made.path.land - made.path.leave)[[0, 2]]
    askew = np.degrees(np.arccos(np.clip(came @ flown / max(np.linalg.norm(came) * np.linalg.norm(flown), 1e-9), -1.0, 1.0)))
    return Leapt("", at / RATE + made.take_off - PRESSED, float(np.linalg.norm(flown)) / speed, float(askew), made.path.lands is not None,
                 float(pace[down - OVER:down + 36 - OVER].min()) / speed, float(np.linalg.norm(place[down + 36] - place[at - 1])) * RATE / (down + 37 - at) / speed,
                 *moved(states[max(at - OVER, 0):down + 36], moment.after.characters[0].controller.skeleton))


def begun(someone: Any, way: Way) -> SessionState:
    """The first moment of one who will go a way."""
    things, floor = stage(way)
    return begin(World((Character("A", someone, someone.start(way.ground, floor)),), things), 1)


def told(name: str, some: list[Leapt]) -> str:
    """A line about some leaps."""
    made, reasons = [one for one in some if not one.why], Counter(" ".join(one.why.split()[:9]) for one in some if one.why)
    line = f"  {name}: {len(some)}, {len(some) - len(made)}"
    if made:
        delay, far, askew, single, kept, whole, hands, rises, knees, slides, apart = np.array([[float(part) for part in list(vars(one).values())[1:]] for one in made]).T
        line += (f"; {np.median(delay):.2f}, {delay.max():.2f}; {np.median(far):.2f}; {np.median(askew):.0f}, {askew.max():.0f}; {single.sum():.0f}; "
                 f"{100.0 * np.median(kept):.0f}, {100.0 * kept.min():.0f}; {100.0 * np.median(whole):.0f}, {100.0 * whole.min():.0f}; {np.median(hands):.0f}, {hands.max():.0f}; "
                 f"{np.median(rises):.0f}; {np.median(knees):.0f}, {knees.max():.0f}; {100.0 * slides.max():.1f}; {100.0 * apart.min():.0f}")
    return line + "".join(f"\n      {count} × {why}" for why, count in reasons.most_common())


def chained(someone: Any, speed: float, every: float) -> str:
    """What becomes of who walks so fast [m/s] and has the button pressed each so many seconds: a line about it."""
    way, made, place, told = Way("chains", "", speed), [], [], 0
    moment = begun(someone, way)
    for step in range(round(AGAIN[2] * RATE)):
        seconds = step / RATE - LED
        before, moment = moment, advance(moment, wished(way, moment, step / RATE, seconds > 0.0 and seconds % every < PRESSED))
        told += len(refused(before, moment))
        memory = leaping(moment)
        if memory is not None and not (made and made[-1] is memory.plan):
            made.append(memory.plan)
        place.append(hips(moment))
    gone = float(np.linalg.norm(place[-1] - place[round(LED * RATE)])) / (AGAIN[2] - LED)
    flown = [float(np.linalg.norm((one.path.land - one.path.leave)[[0, 2]])) for one in made]
    return f"  {speed:g} m/s, each {every:g} s: {len(made)} leaps, {told} refused; {gone:.2f} m/s in the mean; flies {np.median(flown):.2f}, {min(flown):.2f} m"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--phases", type=int, default=6)
    parser.add_argument("--only", default="curves,ways,ramps,chains")
    parser.add_argument("--speeds", default="")
    given = parser.parse_args()
    if given.phases < 1:
        parser.error("--phases must be 1 or more")
    someone = person(Locomotion.load(settings=Settings(idle=0.0)))
    speeds = [float(speed) for speed in given.speeds.split(",") if speed]
    print("Of how many, refused; to the air s, median, longest; flies for so long as he would have gone s, median; askew of his way °, median, most; "
          "lands on one foot; speed kept at the least %, median, least; in the mean %, median, least; hands m/s², median, most; hips m/s²; knees °/s², median, most; "
          "soles slide cm; legs apart cm")
    found: dict[str, dict[str, list[Leapt]]] = {}
    for way in ways():
        if way.group not in given.only.split(",") or speeds and way.speed not in speeds:
            continue
        moment, made = begun(someone, way), []
        last = round((LED + STRIDE) * RATE)
        at = [round((LED + STRIDE * k / given.phases) * RATE) for k in range(given.phases)]
        for step in range(last):
            if step in at:
                made.append(tapped(way, moment, step / RATE))
            moment = advance(moment, wished(way, moment, step / RATE, False))
        found.setdefault(way.group, {}).setdefault(way.name, []).extend(made)
    if "chains" in given.only.split(","):
        print("chains: leaps, refused; how fast hips go in the mean; how far a leap flies, median, least")
        for speed in AGAIN[1]:
            for every in AGAIN[0]:
                print(chained(someone, speed, every), flush=True)
    for group, lines in found.items():
        print(group)
        for name, some in lines.items():
            print(told(name, some), flush=True)
        every = [one for some in lines.values() for one in some]
        print(told("all", every), flush=True)


if __name__ == "__main__":
    main()
