"""Tell why flesh is in things in random play: which limb, in what, and what its body was doing, by frames and by how deep.

    python scripts/measure/flesh_causes.py [--minutes 4] [--seeds 0] [--stage course yard rooms] [--moments]

Play is that of `hands.py`. Of every frame in which any flesh is deeper than 2 cm each limb that is so deep is told once, with its deepest place. Whatever is no higher than a step
over the lower foot's ground is a tread, what is higher a box, a pillar, a ramp; a foot swings or stands. --moments tells when each cause is at its worst, besides.
"""

from __future__ import annotations

import argparse
import os
from collections import defaultdict
from collections.abc import Sequence
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from gambol.controllers.contract import Duty, OfSize
from gambol.controllers.navigation import STEP, gap, is_box, is_pillar, ramp, span
from gambol.controllers.struck import flesh_of
from gambol.game.world import DT, RATE
from hands import NEAR, STAGES, Body, played

DEEP = 0.02
"""What is deeper than this [m] is told."""
LIMBS = {"UpLeg": "thigh", "Leg": "shin", "Arm": "upper arm", "ForeArm": "forearm", "Hand": "hand", "Hips": "trunk", "Spine2": "trunk", "Head": "head", "Foot": "foot", "Toe": "foot"}
AT, STILL, TURNS = np.cos(np.radians(50.0)), 0.15, 0.4
"""Who goes this straight at a thing walks at it; who is slower than the second [m/s] stands, or turns if he is faster than the third [rad/s]."""


def limbs(skeleton: Any, physique: Any) -> list[tuple[str, int]]:
    """What each place of a body's flesh belongs to, and on which side: 0 left, 1 right, -1 of neither."""
    found = []
    for joint in flesh_of(physique).joints[:, 0]:
        name = skeleton.names[joint]
        side = next((k for k, word in enumerate(("Left", "Right")) if name.startswith(word)), -1)
        found.append((LIMBS[name.removeprefix("Left").removeprefix("Right")], side))
    return found


def doing(state: Any, thing: Any, side: int, limb: str) -> str:
    """What a body does, in words, and a foot of it."""
    if state.active == "struck":
        return "struck"
    memory = _own(state)
    if state.active == "jump":
        return leaping(memory)
    m = memory
    x, z, heading = (float(v) for v in state.ground)
    ahead, turning, left = (float(v) for v in m["velocity"])
    speed = float(np.hypot(ahead, left))
    if m["turn"] != 0.0 or speed < STILL:
        what = "turns" if m["turn"] != 0.0 or abs(turning) > TURNS else "stands"
    else:
        c, s = np.cos(heading), np.sin(heading)
        goes = np.array([c * left + s * ahead, c * ahead - s * left]) / speed
        probe = gap(np.array([[x, 0.5, z], [x + 0.02 * goes[0], 0.5, z + 0.02 * goes[1]]]), _tall(thing))
        what = "walks at" if probe[0] - probe[1] > 0.02 * AT else "walks away" if probe[1] - probe[0] > 0.02 * AT else "walks past"
        what = what.replace("walks", "runs") if m["family"] == 1 else what
    if limb in ("foot", "shin", "thigh") and side >= 0:
        what += ", stands" if max(m["grip"][2 * side], m["grip"][2 * side + 1]) > 0.5 else ", swings"
    return what


def _own(state: Any) -> Any:
    """What the controller on duty remembers."""
    memory = state.memory
    while isinstance(memory, Duty | OfSize):
        memory = memory.memory
    return memory


def leaping(memory: Any) -> str:
    """Which part of a leap it is."""
    made = getattr(memory, "plan", None)
    if made is None:
        return "crouch"
    kind = "fall" if memory.fault else "leap"
    time = memory.time
    part = "push" if time < made.take_off else "flight" if time < made.touch_down else "landing" if time < made.lowest + 0.3 else "gets up"
    return f"{kind}: {part}"


def _tall(thing: Any) -> Any:
    """The same thing as if it reached past a body's middle."""
    from dataclasses import replace
    if is_pillar(thing):
        return replace(thing, foot=(thing.foot[0], -50.0, thing.foot[2]), height=100.0)
    return replace(thing, centre=(thing.centre[0], 0.0, thing.centre[2]), size=(thing.size[0], 100.0, thing.size[2]), slope=0.0)


def kind(state: Any, thing: Any) -> str:
    """What a thing is to somebody."""
    if is_pillar(thing):
        return "pillar"
    if ramp(thing):
        return "ramp"
    return "tread" if span(thing)[1] <= float(np.min(state.floor)) + STEP + 0.01 else "box"


def causes(body: Body, stage: Sequence[Any]) -> dict[tuple[str, str, str], list[tuple[int, float]]]:
    """Frames, and how deep [m], by (limb, thing, doing)."""
    points, away = body.flesh
    physique = body.who.parts["jump"].physique
    thick, parts = flesh_of(physique).thick, limbs(body.who.skeleton, physique)
    found: dict[tuple[str, str, str], list[tuple[int, float]]] = defaultdict(list)
    things = [thing for thing in stage if is_box(thing) or is_pillar(thing)]
    for k in np.flatnonzero(away.min(1) < -DEEP):
        near = [thing for thing in things if gap(points[k, :1].copy(), thing)[0] < NEAR]
        deeps = np.stack([thick - gap(points[k].copy(), thing) for thing in near] + [thick - points[k, :, 1]])
        told: dict[tuple[str, str, str], float] = {}
        for p in np.flatnonzero(deeps.max(0) > DEEP):
            which = int(deeps[:, p].argmax())
            thing = near[which] if which < len(near) else None
            limb, side = parts[p]
            cause = (limb, "ground", "") if thing is None else (limb, kind(body.states[k], thing), doing(body.states[k], thing, side, limb))
            told[cause] = max(told.get(cause, 0.0), float(deeps[which, p]))
        for cause, deep in told.items():
            found[cause].append((int(k), deep))
    return found


def events(frames: Sequence[int]) -> int:
    """How many times something happens in these frames: twice, where half a second lies between."""
    return 1 + int((np.diff(np.unique(frames)) > 0.5 * RATE).sum())


def main() -> None:
    """Print the causes, the most frequent first."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--minutes", type=float, default=4.0)
    parser.add_argument("--seeds", type=int, nargs="+", default=[0])
    parser.add_argument("--stage", nargs="+", choices=list(STAGES), default=list(STAGES))
    parser.add_argument("--moments", action="store_true")
    asked = parser.parse_args()
    every: dict[tuple[str, str, str], list[tuple[str, int, int, float]]] = defaultdict(list)
    total, deep = 0, 0
    for name in asked.stage:
        for seed in asked.seeds:
            things = STAGES[name](seed)
            body = Body(*played(things, seed, round(60 * RATE * asked.minutes))[:2], things)
            total, deep = total + len(body.states), deep + int((body.flesh[1].min(1) < -DEEP).sum())
            for cause, moments in causes(body, things).items():
                every[cause] += [(name, seed, *moment) for moment in moments]
    print(f"{total * DT / 60:.0f} minutes on {', '.join(asked.stage)}, seeds {', '.join(map(str, asked.seeds))}: flesh deeper than {100 * DEEP:g} cm in {deep} frames, {deep / total:.2%}")
    print("limb       in      doing                      frames  times  worst [cm]")
    for cause, moments in sorted(every.items(), key=lambda one: -len(one[1])):
        limb, thing, what = cause
        stage, seed, frame, most = max(moments, key=lambda one: one[3])
        times = sum(events([m[2] for m in moments if m[:2] == play]) for play in {m[:2] for m in moments})
        print(f"{limb:10} {thing:7} {what:25} {len(moments):7} {times:6} {100.0 * most:8.1f}" + (f"    {stage}, seed {seed}, {frame * DT:.2f} s" if asked.moments else ""))


if __name__ == "__main__":
    main()
