"""Let everything go before an edge or on a box, or leap right before a wall: who stays, who runs off, and how hard he is stopped.

    python scripts/measure/let_go.py [--only edges|boxes|walls] [--phases 6] [--count 40] [--strips FOLDER]

Edges: somebody walks or runs on a platform and lets go so far before its edge, in several phases of a step. Who needs no more than 8 m/s² to stop, toes over the edge, can.
Boxes: hands run at boxes 0.7 to 1.2 m deep, tap the leap's key and let go of the stick with it, or up to 0.6 s later. Walls: walkers and runners leap to places before a wall and wish to go
on; how much speed they lose in a sixtieth of a second at most once they have landed, and in how much time most of it. Strips: each kind's first few as stick figures, ten a second.
"""

from __future__ import annotations

import argparse
import os
from collections import Counter
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from _plots import pyplot

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import CharacterState, Intent, Leap
from gambol.controllers.jump import Jumping
from gambol.controllers.locomotion import Settings
from gambol.controllers.person import person
from gambol.game.input import AHEAD, Wish
from gambol.game.scene import Box
from gambol.game.session import Timeline, begin
from gambol.game.world import DT, Character, World

HIGH, STRIDE = 1.0, 1.4
"""How high the platform is, and over how much of the way starts are spread [m]."""
SPEEDS, ROOMS = (0.6, 1.0, 1.3, 1.8, 2.5, 3.0, 3.5), (0.3, 0.5, 0.7, 0.9, 1.2, 1.6, 2.0)
"""Of who lets go [m/s], and how far his middle is before the edge then [m]."""
CAN, TOES = 8.0, 0.12
"""Who has to brake by no more than the first [m/s²] to stop with his middle so far before the edge [m] can."""
LATER = 0, 12, 24, 36
"""So many steps after the key hands let go of the stick."""
BEFORE, PACES = (0.5, 0.7, 1.0, 1.4), (1.3, 2.0, 2.6, 3.2)
"""So far before a wall somebody means to land [m], who comes so fast [m/s]."""


def released(who: Any, speed: float, room: float, shift: float) -> list[CharacterState]:
    """The states, from when he lets go, of who goes at an edge at z = 0 until he is so near to it [m]."""
    around = (Box((0.0, 0.5 * HIGH, -10.0), (20.0, HIGH, 20.0)),)
    state, states = who.start((0.0, -4.0 - shift, 0.0), HIGH), []
    for _ in range(round((6.0 / speed + 4.0) / DT)):
        goes = not states and state.ground[1] < -room
        if not goes:
            states.append(state)
        state, _ = who.step(state, Intent(np.array([speed if goes else 0.0, 0.0, 0.0]), around=around), DT)
    return states


def onto_box(who: Any, rng: np.random.Generator) -> tuple[list[CharacterState], Box]:
    """All states of somebody whose hands run at a box, tap the leap's key and let go, and the box."""
    deep, high, run, later = rng.uniform(0.7, 1.2), rng.uniform(0.26, 0.5), rng.uniform(0.7, 1.0), int(rng.choice(LATER))
    inside, far = rng.uniform(0.15, deep - 0.2), 4.5 + rng.uniform(0.0, STRIDE)
    box, states, since = Box((0.0, 0.5 * high, far + 0.5 * deep), (2.0, high, deep)), [], 0
    line = Timeline(begin(World((Character("A", who, who.start()),), (box,)), 1))
    for _ in range(round(6.5 / DT)):
        state = line.now.after.characters[0].state
        states.append(state)
        since += bool(since) or float(state.ground[1]) + AHEAD[0] + AHEAD[1] * float(state.velocity[0]) > far + inside
        line.advance((Wish(move=(0.0, 1.0 if since <= 4 + later else 0.0), run=run, jump=0 < since <= 4).rounded(),))
    return states, box


def before_wall(who: Any, pace: float, room: float, shift: float) -> list[CharacterState]:
    """All states of somebody who leaps to a place so far [m] before a wall at z = 6 m, and wishes to go on."""
    place, wall, jumped, states = np.array([0.0, 0.0, 6.0 - room]), (Box((0.0, 1.2, 6.2), (6.0, 2.4, 0.4)),), False, []
    state = who.start((0.0, 1.0 - shift, 0.0))
    for _ in range(round(5.0 / DT)):
        leaps = not jumped and place[2] - state.ground[1] < AHEAD[0] + AHEAD[1] * pace + 0.3
        state, _ = who.step(state, Intent(np.array([pace, 0.0, 0.0]), leap=Leap(place, slack=0.3) if leaps else None, around=wall), DT)
        jumped = jumped or state.active == "jump"
        states.append(state)
    return states


def leapt(state: CharacterState) -> Jumping | None:
    """What somebody remembers who leaps, or falls."""
    memory = getattr(state.memory, "memory", None)
    return memory if isinstance(memory, Jumping) else None


def edges(who: Any, phases: int) -> list[list[CharacterState]]:
    """Print who goes over an edge though he can stop, how hard he brakes, and how near to it he rests; ways to look at."""
    shown = []
    for speed in SPEEDS:
        could, off, rests, brakes = 0, 0, [], []
        for room in ROOMS:
            for shift in np.linspace(0.0, STRIDE, phases, endpoint=False):
                states = released(who, speed, room, shift)
                goes, left = float(states[0].velocity[0]), -float(states[0].ground[1]) - TOES
                if left <= 0.0 or goes * goes > 2.0 * CAN * left:
                    continue
                could += 1
                if any(leapt(state) for state in states) or states[-1].ground[1] > 0.0:
                    off += 1
                else:
                    rests.append(-float(states[-1].ground[1]))
                    brakes.append(-np.diff([float(state.velocity[0]) for state in states]).min() / DT)
                if shift == 0.0 and room in (0.5, 0.9):
                    shown.append(states)
        print(f"edges, {speed:.1f} m/s: {off} of {could} who can stop go over; rest {min(rests, default=np.nan):.2f} to {max(rests, default=np.nan):.2f} m before, braking by "
              f"{np.median(brakes):.1f} m/s² (at most {max(brakes, default=np.nan):.1f})", flush=True)
    return shown


def boxes(who: Any, count: int) -> list[list[CharacterState]]:
    """Print what becomes of who leaps onto boxes and lets go; ways to look at."""
    fates, shown = Counter[str](), []
    for number in range(count):
        states, box = onto_box(who, np.random.default_rng(number))
        plans = [memory for state in states if (memory := leapt(state)) is not None]
        up = max(float(state.floor) for state in states) > box.size[1] - 0.02
        if plans and up:
            fates[f"{'stays' if states[-1].floor > 0.2 else 'goes off'}, landed on {'both feet' if plans[0].plan.path.lands is None else 'one foot'}"] += 1
            shown.append(states[next(k for k, state in enumerate(states) if leapt(state)):])
    print(f"boxes: {sum(fates.values())} of {count} leap onto them: " + "; ".join(f"{n} {fate}" for fate, n in fates.most_common()), flush=True)
    return shown


def walls(who: Any) -> list[list[CharacterState]]:
    """Print how hard those are stopped who land before a wall; ways to look at."""
    shown = []
    for room in BEFORE:
        hard, took = [], []
        for pace in PACES:
            for shift in (0.0, 0.3):
                states = before_wall(who, pace, room, shift)
                last = max((k for k, state in enumerate(states) if leapt(state)), default=None)
                if last is None:
                    continue
                speeds = np.array([float(state.velocity[0]) for state in states[last:]])
                hard.append(float(-np.diff(speeds).min() / DT))
                if speeds[0] > 1.0:
                    took.append(float((speeds > 0.2 * speeds[0]).argmin() * DT))
                shown.append(states[last - 40:])
        print(f"walls, {room:.1f} m beyond the place: {len(hard)} leap, braked by {np.median(hard):.0f} m/s² (at most {max(hard):.0f}) once walking takes over; of {len(took)} who still run "
              f"four fifths of that take {min(took, default=np.nan):.2f} s at least", flush=True)
    return shown


def strips(who: Any, ways: list[list[CharacterState]], path: Path) -> None:
    """Draw ways as strips of stick figures from the side, ten a second."""
    plt = pyplot()
    figure, axes = plt.subplots(len(ways), 1, figsize=(18, 2.2 * len(ways)), squeeze=False)
    for axis, states in zip(axes[:, 0], ways):
        for k, state in enumerate(states[:150:6]):
            placed, _ = forward_kinematics(who.skeleton, np.asarray(state.pose.root, float), np.asarray(state.pose.rotations, float))
            for j, i in enumerate(who.skeleton.parents):
                name = who.skeleton.names[j]
                if j:
                    axis.plot(placed[[i, j], 2] + 0.7 * k, placed[[i, j], 1], lw=1.2, color="tab:red" if name.startswith("Left") else "tab:blue" if name.startswith("Right") else "k")
            axis.plot(float(state.ground[1]) + 0.7 * k, float(state.floor), "|", color="tab:green")
        axis.set_aspect("equal")
        axis.axis("off")
    figure.savefig(path, dpi=70)
    plt.close(figure)


def main() -> None:
    """Print the figures of each kind."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--only", choices=("edges", "boxes", "walls"), default="")
    parser.add_argument("--phases", type=int, default=6)
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--strips", type=Path, help="a folder for pictures of some")
    given = parser.parse_args()
    who: Any = person()
    who = who.tuned(Settings(idle=0.0))
    for name, shown in (("edges", lambda: edges(who, given.phases)), ("boxes", lambda: boxes(who, given.count)), ("walls", lambda: walls(who))):
        ways = shown() if given.only in ("", name) else []
        if ways and given.strips:
            strips(who, ways[:8], given.strips / f"{name}.png")


if __name__ == "__main__":
    main()
