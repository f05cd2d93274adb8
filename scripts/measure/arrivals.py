"""Measure how near people who are sent to a place come to rest to it, and how often they step on the spot then; and, of those who go there
with any heading, in how many steps and how long they make the last 0.3 m and turn. After how long the body rests from the moment that it is sent.

    python scripts/measure/arrivals.py [--goals 16]

Walks and runs straight to places at many distances (`walk_to`), round corners, and planned walks to places, with a heading or without (`go_to`).
"""

from __future__ import annotations

import argparse
import math

import numpy as np

from gambol.controllers.contract import Goal, Intent
from gambol.controllers.person import person
from gambol.game.input import Move, Script

FPS = 60
SPEEDS, FAR = (0.5, 0.8, 1.2, 1.4), (0.3, 0.6, 1.0, 1.5, 2.1, 2.6, 3.0, 3.3, 4.0)
RUNS = (((0.0, 6.0),), 2.6), (((0.0, 6.0),), 3.2), (((0.0, 3.0), (1.0, 5.0)), 2.6)
WAYS = (((0.0, 2.0), (2.0, 3.0)), ((0.0, 2.0), (2.0, 2.0)), ((3.0, 0.0),), ((2.0, -2.2),), ((0.1, -3.0),))
NEAR, ASIDE = (0.3, 0.6, 0.9, 1.2), (math.pi / 2, -2.4, math.pi)
STEPS = 0.04, 0.08, 0.12, 0.18
LAST = 0.3
"""So near to the place [m] those who are to face any way there turn."""
SLOW = 0.05
"""Whoever is slower than this [m/s] from some moment on rests from then on …"""
CREEPS = 0.01
"""… but when he rests is told by this [m/s]: some creep."""


def steps_at_rest(states) -> int:
    """How many feet come down once the body rests."""
    ground = np.array([state.ground for state in states])
    moving = np.flatnonzero(np.hypot(*np.diff(ground[:, :2], axis=0).T) * FPS > SLOW)
    feet = np.array([np.asarray(state.contacts).reshape(2, 2).any(-1) for state in states]).astype(int)
    return int((np.diff(feet, axis=0)[moving[-1] + 1:] > 0).sum())


def rests(states) -> float:
    """After how long [s] a body rests."""
    ground = np.array([state.ground for state in states])
    moving = np.hypot(*np.diff(ground[:, :2], axis=0).T) * FPS > CREEPS
    return float(np.flatnonzero(moving)[-1] + 1) / FPS


def sent(someone, points, speed) -> tuple[float, int, float]:
    """How far off [m] somebody ends who walks along points, how often he steps on the spot, and after how long he rests [s]."""
    script, state, states, left = Script((Move(math.inf, points=points, speed=speed),)), someone.start(), [], 3 * FPS
    while left > 0 and len(states) < 25 * FPS:
        script, intent = script.step(state, 1 / FPS)
        left -= script.done
        state, _ = someone.step(state, intent, 1 / FPS)
        states.append(state)
    return float(math.dist(points[-1], state.ground[:2])), steps_at_rest(states), rests(states)


def beside(someone, place) -> tuple[float, int, float]:
    """The same, and how many feet come down at all in place of those on the spot, of somebody who stands beside a place (2,) [m] and steps there."""
    state, states, place = someone.start(), [], np.array(place)
    for _ in range(5 * FPS):
        x, z = 0.3 * place / np.hypot(*place)
        state, _ = someone.step(state, Intent(np.array([z, 0.0, x]), halt=np.array([*place, math.nan])), 1 / FPS)
        states.append(state)
    feet = np.array([np.asarray(state.contacts).reshape(2, 2).any(-1) for state in states]).astype(int)
    return float(np.hypot(*(place - state.ground[:2]))), int((np.diff(feet, axis=0) > 0).any(-1).sum()), rests(states)


def went(someone, goal) -> list:
    """The states of somebody who goes to a goal as it is planned."""
    state, states, left = someone.start(), [], 2 * FPS
    while left > 0 and len(states) < 25 * FPS:
        state, _ = someone.step(state, Intent(goal=goal), 1 / FPS)
        left -= state.going is not None and state.going.there
        states.append(state)
    return states


def planned(someone, goal) -> tuple[float, int, float]:
    """How far off [m] he ends, how often he steps on the spot, and after how long he rests [s]."""
    states = went(someone, goal)
    return float(np.hypot(*(goal.floor - states[-1].ground[:2]))), steps_at_rest(states), rests(states)


def facing(someone, goal) -> tuple[float, int, float, float]:
    """How far he is to turn from the line to the goal [rad], in how many steps and seconds he makes the end of his way, and how far off [m] he ends."""
    states = went(someone, goal)
    ground = np.array([state.ground for state in states])
    far = np.hypot(*(ground[:, :2] - goal.floor).T)
    feet = np.array([np.asarray(state.contacts).reshape(2, 2).any(-1) for state in states]).astype(int)
    near = int(np.flatnonzero(far > LAST)[-1])
    pace = np.abs(np.diff(np.column_stack([ground[:, :2], np.unwrap(ground[:, 2])]), axis=0)).max(-1) * FPS
    strikes = (np.diff(feet, axis=0)[near:] > 0).any(-1).sum()
    return abs(math.remainder(goal.heading - math.atan2(*goal.floor), math.tau)), int(strikes), float((np.flatnonzero(pace > SLOW)[-1] - near) / FPS), float(far[-1])


def turned(rows) -> None:
    """Print that of those who turn little, and by a right angle or more."""
    found = np.array(rows)
    for name, these in (("under 90°", found[found[:, 0] < 0.5 * math.pi]), ("by 90–180°", found[found[:, 0] >= 0.5 * math.pi])):
        _, steps, seconds, off = these.T
        print(f"go_to and turn {name} ({len(these)}): the last {LAST:g} m in {steps.mean():.1f} steps (most {steps.max():.0f}), {seconds.mean():.2f} s ({seconds.max():.2f}); "
              f"{100 * off.mean():.1f} cm off (worst {100 * off.max():.1f})", flush=True)


def told(name: str, rows, steps_are: str = "steps on the spot") -> None:
    off, steps, seconds = np.array(rows).T
    print(f"{name} ({len(rows)}): {100 * off.mean():.1f} cm off (worst {100 * off.max():.1f}), {steps_are} {steps.mean():.2f} (most {steps.max():.0f}), "
          f"rests after {seconds.mean():.2f} s ({seconds.max():.2f})", flush=True)


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--goals", type=int, default=16)
    parser.add_argument("--headings", type=int, default=50, help="goals with any heading, whose last steps are counted")
    asked = parser.parse_args()
    someone, rng = person(), np.random.default_rng(0)
    told("walk_to, straight on", [sent(someone, ((0.0, far),), speed) for speed in SPEEDS for far in FAR])
    told("walk_to, another way or round a corner", [sent(someone, points, 1.2) for points in WAYS])
    told("walk_to, a few steps another way", [sent(someone, ((far * math.sin(way), far * math.cos(way)),), 1.2) for way in ASIDE for far in NEAR])
    told("walk_to, running", [sent(someone, points, speed) for points, speed in RUNS])
    told("a step beside the place", [beside(someone, far * np.array(way)) for far in STEPS for way in ((1, 0), (-1, 0), (0, 1), (0, -1))], "steps")
    places = [rng.uniform((-3, 1), (3, 5)) for _ in range(asked.goals)]
    told("go_to", [planned(someone, Goal(tuple(place))) for place in places])
    told("go_to with a heading", [planned(someone, Goal(tuple(place), float(rng.uniform(-2, 2)))) for place in places])
    if asked.headings:
        rng = np.random.default_rng(7)
        turned([facing(someone, Goal(tuple(rng.uniform((-3, 1), (3, 5))), float(rng.uniform(-math.pi, math.pi)))) for _ in range(asked.headings)])


if __name__ == "__main__":
    main()
