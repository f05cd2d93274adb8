"""Measure leaps of who walks or runs to a place that lies aside of his way, by scripts and by hands, on level ground.

    python scripts/measure/leaps_aside.py [--ways script,path,hands] [--phases 2] [--speeds 0.8,1.3] [--angles 0,20,-20] [--far 0.8,1.3,2] [--verbose]

`script`: somebody goes straight on by a velocity, and is told, at many moments of a stride, a place so far away and so far aside of his way; then he goes on. `path`: he walks there. `hands`: a stick leads him, is thrown so far aside, and the button is tapped in that moment, or held as much longer; the stick stays there. Told of each: how many leave
the floor within 1.5 s, and ever, after how long; how many are refused, or never asked; how far from the place they land, of hands from where the ring was as they left, in the mean and at worst; how far aside of
the way to the place, or of the stick, they fly; the least of their speed, over 0.1 s, from there until 0.6 s after touch-down, over that before; on how many feet they land; how far hips turn in the
air, chests against hips, and feet that stand; how hard the centre of mass is pulled from there on; and how far soles slide.
"""

from __future__ import annotations

import argparse
import os
from collections import Counter
from typing import Any, NamedTuple

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from leap_ways import OVER, moved, pulled

from gambol.controllers.body import anatomy, centre_of_mass, forward_kinematics
from gambol.controllers.contract import CharacterState, Intent
from gambol.controllers.jump import Jumping
from gambol.controllers.jump.body import soles
from gambol.controllers.locomotion import Locomotion, Settings
from gambol.controllers.navigation import in_world
from gambol.controllers.person import person
from gambol.game.input import Jump, Move, Script, Wish
from gambol.game.session import Timeline, begin, refused
from gambol.game.world import DT, RATE, Character, World, stopped

ANGLES, SPEEDS, FAR, HELD = (0, 20, -20, 40, -40, 60, -60, 90, -90), (0.8, 1.3, 1.8, 2.5, 3.0), (0.8, 1.3, 2.0, 3.0), (0.1, 0.4)
"""How far aside places lie, to the left [°]; how fast they go [m/s]; how far away places are as they are told [m]; and how long hands hold the button [s]."""
LED, STRIDE, SOON, LASTS, AFTER = 3.0, 0.8, 1.5, 6.0, 0.6
"""They have gone so long, and longer by up to so much, until they are told; so soon most leap; they are looked at for so long, and after their landing [s]."""


class Gone(NamedTuple):
    """What somebody did: all his states, in which of them he was told, where (2,) he was told to leap to, None of hands, which way (2,), and why he did not."""

    states: list[CharacterState]
    asked: int
    place: np.ndarray | None
    way: np.ndarray
    why: str


class Leapt(NamedTuple):
    """What became of one, see the docstring. turns, twists, feet: [°]; pulls: [m/s²]."""

    why: str
    off: float = np.inf
    push: float = 0.0
    misses: float = 0.0
    askew: float = 0.0
    kept: float = 0.0
    single: float = 0.0
    turns: float = 0.0
    twists: float = 0.0
    feet: float = 0.0
    pulls: float = 0.0
    slides: float = 0.0


def scripted(who: Any, way: str, speed: float, angle: float, far: float, later: float) -> Gone:
    """What a script makes of one who is told a place so far away [m], `angle` [rad] to the left of his way, after LED and so much longer [s]."""
    world, states, intent = World((Character("A", who, who.start()),)), [], Intent(np.array([speed, 0.0, 0.0]))
    asked = round((LED + later) * RATE)
    for _ in range(asked):
        states.append(world.characters[0].state)
        world = world.step([intent])
    here, ahead = np.asarray(world.characters[0].state.ground, float), np.asarray(in_world(world.characters[0].state.ground, world.characters[0].state.velocity))
    course = float(np.arctan2(*ahead))
    place = here[:2] + far * np.array([np.sin(course + angle), np.cos(course + angle)])
    jump = Jump((float(place[0]), 0.0, float(place[1])))
    walks = Move(LASTS, (speed, 0.0, 0.0), jump=jump) if way == "script" else Move(LASTS, points=((float(place[0]), float(place[1])),), speed=speed, jump=jump)
    script = Script((walks, Move(LASTS, (speed, 0.0, 0.0))))
    for _ in range(round(LASTS * RATE)):
        state = world.characters[0].state
        states.append(state)
        script, intent = script.step(state, DT)
        script, intent = script.held(who, state, intent, (), DT)
        world = world.step([intent if script.leaps else stopped(state, intent, ())])
    return Gone(states, asked, place, place - here[:2], script.refused[0] if script.refused else "")


def by_hands(who: Any, speed: float, angle: float, held: float, later: float) -> Gone:
    """What becomes of one whose stick is thrown `angle` [rad] to the left as the button goes down, for so long [s]."""
    line, states, why = Timeline(begin(World((Character("A", who, who.start()),)), 1)), [], ""
    asked, throw, run = round((LED + later) * RATE), min(speed / 1.3, 1.0), max((speed - 1.3) / 1.7, 0.0)
    for step in range(asked + round(LASTS * RATE)):
        yaw, before, there = line.now.players[0].camera.yaw, line.now, angle * (step >= asked)
        states.append(before.after.characters[0].state)
        line.advance((Wish(move=(-throw * float(np.sin(there - yaw)), throw * float(np.cos(there - yaw))), run=run, jump=0 <= step - asked < held * RATE).rounded(),))
        why = why or "; ".join(refused(before, line.now))
    return Gone(states, asked, None, np.array([np.sin(angle), np.cos(angle)]), why.removeprefix("no jump: "))


def headings(turned: np.ndarray) -> np.ndarray:
    """The headings (..., N) [°] of turns (N, ..., 3, 3)."""
    return np.degrees(np.unwrap(np.arctan2(turned[..., 0, 2], turned[..., 2, 2]), axis=0))


def leapt(who: Any, gone: Gone) -> Leapt:
    """What became of it."""
    states, skeleton = gone.states, who.skeleton
    at = next((k for k in range(gone.asked, len(states)) if states[k].active == "jump" and isinstance(states[k].memory.memory, Jumping)), None)
    if at is None:
        return Leapt(gone.why or "nothing")
    memory = states[at].memory.memory
    made, down = memory.plan, at + int(np.ceil(memory.plan.touch_down * RATE))
    if memory.fault or down + AFTER * RATE >= len(states):
        return Leapt("fell" if memory.fault else gone.why or "late")
    until = down + round(AFTER * RATE)
    hips = np.array([np.asarray(one.pose.root)[[0, 2]] for one in states])
    paces = np.linalg.norm(hips[OVER:] - hips[:-OVER], axis=1) * RATE / OVER
    some = states[gone.asked:until]
    joints, turned = forward_kinematics(skeleton, np.array([np.asarray(one.pose.root, float) for one in some]), np.array([np.asarray(one.pose.rotations, float) for one in some]))
    centre = centre_of_mass(anatomy(skeleton), joints, turned)
    pelvis, chest = headings(turned[:, 0]), headings(turned[:, skeleton.index("Neck")])
    feet = headings(turned[:, [skeleton.index("LeftFoot"), skeleton.index("RightFoot")]])
    stands = np.array([one.contacts for one in some]).reshape(-1, 2, 2).all(-1)
    twist, most = np.zeros(2), 0.0
    for step, on in zip(np.abs(np.diff(feet, axis=0)), stands[1:] & stands[:-1]):
        twist = (twist + step) * on
        most = max(most, float(twist.max()))
    off, lands = at + round(made.take_off * RATE) - gone.asked, down - gone.asked
    asked = None if memory.asked is None or memory.asked.place is None else np.asarray(memory.asked.place, float)[[0, 2]]
    place = gone.place if gone.place is not None else asked
    down_on = made.feet if made.path.lands is None else made.feet[made.path.lands:made.path.lands + 1]
    landed = soles(down_on, who.parts["jump"].physique.tables)[:, [0, 2]].mean(0)
    flown = (made.path.land - made.path.leave)[[0, 2]]
    wanted = gone.way if gone.place is None else place - np.asarray(states[at].ground, float)[:2]
    askew = np.degrees(np.arctan2(flown @ [wanted[1], -wanted[0]], flown @ wanted))
    return Leapt("", off / RATE, made.take_off, 0.0 if place is None else float(np.linalg.norm(landed - place)), abs(float(askew)), float(paces[gone.asked:until - OVER].min() / paces[gone.asked - OVER - 1]),
                 float(made.path.lands is not None), abs(float(pelvis[lands] - pelvis[off])), float(np.abs(chest - pelvis).max()), most,
                 float(np.linalg.norm(pulled(centre), axis=1).max()), moved(some, skeleton)[3])


def told(name: str, some: list[Leapt]) -> str:
    """A line about some leaps."""
    made, reasons = [one for one in some if not one.why], Counter(" ".join(one.why.split(": ", 1)[-1].split()[:8]) for one in some if one.why)
    line = f"  {name}: {len(some)}; {sum(one.off <= SOON for one in made)}, {len(made)}"
    if made:
        off, push, misses, askew, kept, single, turns, twists, feet, pulls, slides = np.array([one[1:] for one in made]).T
        line += (f"; {np.median(off):.2f}, {off.max():.2f}; {np.median(push):.2f}, {push.max():.2f}; {misses.mean():.2f}, {misses.max():.2f}; {np.median(askew):.0f}, {askew.max():.0f}; {100 * np.median(kept):.0f}, {100 * kept.min():.0f}; "
                 f"{single.sum():.0f}; {np.median(turns):.0f}, {turns.max():.0f}; {np.median(twists):.0f}, {twists.max():.0f}; {feet.max():.0f}; {np.median(pulls):.0f}, {pulls.max():.0f}; {100 * slides.max():.1f}")
    return line + "".join(f"\n      {count} × {why}" for why, count in reasons.most_common())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--ways", default="script,path,hands")
    parser.add_argument("--phases", type=int, default=2)
    for name, usual in (("speeds", SPEEDS), ("angles", ANGLES), ("far", FAR), ("held", HELD)):
        parser.add_argument(f"--{name}", default=",".join(f"{value:g}" for value in usual))
    parser.add_argument("--verbose", action="store_true", help="a line for each leap")
    given = parser.parse_args()
    if given.phases < 1:
        parser.error("--phases must be 1 or more")
    who: Any = person(Locomotion.load(settings=Settings(idle=0.0)))
    speeds, angles, fars, helds = ([float(value) for value in text.split(",")] for text in (given.speeds, given.angles, given.far, given.held))
    print("Of how many; off within 1.5 s, ever; to the air s, median, longest; of that from where he begins to leap, median, longest; misses m, mean, most; flies askew °, median, most; speed kept at the least %, median, least; lands on one foot; hips turn in "
          "the air °, median, most; chest against hips °, median, most; feet turn that stand °, most; centre of mass m/s², median, most; soles slide cm, most")
    for way in given.ways.split(","):
        found: dict[str, list[Leapt]] = {}
        for speed in speeds:
            for angle in angles:
                for much in helds if way == "hands" else fars:
                    for k in range(given.phases):
                        later = STRIDE * k / given.phases
                        one = leapt(who, by_hands(who, speed, float(np.radians(angle)), much, later) if way == "hands" else scripted(who, way, speed, float(np.radians(angle)), much, later))
                        if given.verbose:
                            print(told(f"{way}, {speed:g} m/s, {angle:g}°, {much:g} {'s held' if way == 'hands' else 'm away'}, phase {k}", [one]), flush=True)
                        kind = "walks" if speed < 1.9 else "runs"
                        for name in (f"{kind}, {abs(angle):g}° aside", f"{speed:g} m/s, aside" if angle else "", f"{kind}, {much:g} {'s held' if way == 'hands' else 'm away'}, aside" if angle else ""):
                            found.setdefault(name, []).append(one)
        print(way)
        for name in sorted(found.keys() - {""}):
            print(told(name, found[name]), flush=True)


if __name__ == "__main__":
    main()
