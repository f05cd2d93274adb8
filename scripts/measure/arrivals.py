"""Measure how near people who are sent to a place come to rest to it, and how often they step on the spot then.

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
SLOW = 0.05
"""Whoever is slower than this [m/s] from some moment on rests from then on."""


def steps_at_rest(states) -> int:
    """How many feet come down once the body rests."""
    ground = np.array([state.ground for state in states])
    moving = np.flatnonzero(np.hypot(*np.diff(ground[:, :2], axis=0).T) * FPS > SLOW)
    feet = np.array([np.asarray(state.contacts).reshape(2, 2).any(-1) for state in states]).astype(int)
    return int((np.diff(feet, axis=0)[moving[-1] + 1:] > 0).sum())


def sent(someone, points, speed) -> tuple[float, int]:
    """How far off [m] somebody ends who walks along points, and how often he steps on the spot."""
    script, state, states, left = Script((Move(math.inf, points=points, speed=speed),)), someone.start(), [], 3 * FPS
    while left > 0 and len(states) < 25 * FPS:
        script, intent = script.step(state, 1 / FPS)
        left -= script.done
        state, _ = someone.step(state, intent, 1 / FPS)
        states.append(state)
    return float(math.dist(points[-1], state.ground[:2])), steps_at_rest(states)


def planned(someone, goal) -> tuple[float, int]:
    """The same of somebody who goes to a goal as it is planned."""
    state, states, left = someone.start(), [], 2 * FPS
    while left > 0 and len(states) < 25 * FPS:
        state, _ = someone.step(state, Intent(goal=goal), 1 / FPS)
        left -= state.going is not None and state.going.there
        states.append(state)
    return float(np.hypot(*(goal.floor - state.ground[:2]))), steps_at_rest(states)


def told(name: str, rows) -> None:
    off, steps = np.array(rows).T
    print(f"{name} ({len(rows)}): {100 * off.mean():.1f} cm off (worst {100 * off.max():.1f}), steps on the spot {steps.mean():.2f} (most {steps.max():.0f})", flush=True)


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--goals", type=int, default=16)
    asked = parser.parse_args()
    someone, rng = person(), np.random.default_rng(0)
    told("walk_to, straight on", [sent(someone, ((0.0, far),), speed) for speed in SPEEDS for far in FAR])
    told("walk_to, another way or round a corner", [sent(someone, points, 1.2) for points in WAYS])
    told("walk_to, a few steps another way", [sent(someone, ((far * math.sin(way), far * math.cos(way)),), 1.2) for way in ASIDE for far in NEAR])
    told("walk_to, running", [sent(someone, points, speed) for points, speed in RUNS])
    places = [rng.uniform((-3, 1), (3, 5)) for _ in range(asked.goals)]
    told("go_to", [planned(someone, Goal(tuple(place))) for place in places])
    told("go_to with a heading", [planned(someone, Goal(tuple(place), float(rng.uniform(-2, 2)))) for place in places])


if __name__ == "__main__":
    main()
