"""Measure how long arms are lost of who is tracked in the game: people who stand for 20 s, fold their arms or not, and then walk and run.

    python scripts/measure/idle_arms.py [--people 5] [--seeds 1] [--without]

Everybody idles in a way of their own, which follows from where they stand. Four cameras see them as in `gambol play --cameras`, with 15 % of
pixels wrong and three rectangles. A hand is lost while it is more than 15 cm off.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import replace

import numpy as np

from gambol.controllers.contract import Intent
from gambol.controllers.person import person
from gambol.game.world import RATE, Character, beginning, tracked_of, watches_of

SPOILT = {"wrong": 0.15, "rectangles": 3}
"""What goes wrong in silhouettes of `gambol play --cameras`."""
STANDS, WALKS, RUNS = 20.0, 3.0, 2.0
"""How long [s]."""
LOST = 0.15
"""A hand that is farther off is lost [m]."""
HANDS = ("LeftHand", "RightHand")


def followed(who: int, seed: int, restarts: bool) -> tuple[np.ndarray, float]:
    """How far all joints of the tracked one are off in each step (T, J) [m], and the processor's time for a step [s]."""
    someone, beside = person(), np.array([1.2, 0.0, 0.0])
    state = someone.start((1.7 * who, 0.3 * who, 0.0))
    performer = Character("performer", someone, state, (0.5, 0.5, 0.5))
    watches = watches_of(performer.name, someone.skeleton, beside=beside, seed=seed, **SPOILT)
    controller = tracked_of(someone, watches, RATE)
    tracking = controller.parts["tracking"]
    controller.parts = {**controller.parts, "tracking": tracking.tuned(replace(tracking.settings, restarts=restarts))}
    tracked = Character("tracked", controller, beginning(controller, state, beside), (0.5, 0.5, 0.5), watches=watches)
    off, spent = [], 0.0
    for number in range(1, round((STANDS + WALKS + RUNS) * RATE) + 1):
        ahead = 0.0 if number <= STANDS * RATE else 1.3 if number <= (STANDS + WALKS) * RATE else 2.8
        performer, begun = performer.step(Intent(velocity=np.array([ahead, 0.0, 0.0])), number), time.process_time()
        tracked = tracked.tracked({performer.name: performer}, number)
        spent += time.process_time() - begun
        off.append(np.linalg.norm(tracked.joints[0] - performer.joints[0] - beside, axis=-1))
    return np.array(off), spent / len(off)


def longest(lost: np.ndarray) -> float:
    """The longest time without a break [s] of steps (T,) bool."""
    ends = np.flatnonzero(np.diff(np.concatenate([[0], lost.astype(int), [0]])))
    return float((ends[1::2] - ends[::2]).max(initial=0)) / RATE


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--people", type=int, default=5)
    parser.add_argument("--seeds", type=int, default=1, help="of what goes wrong in the silhouettes")
    parser.add_argument("--without", action="store_true", help="arms that were lost are not looked for")
    args = parser.parse_args()
    hands = [person().skeleton.index(name) for name in HANDS]
    every, lengths = [], []
    for who in range(args.people):
        for seed in range(args.seeds):
            off, spent = followed(who, seed, not args.without)
            arms = off[:, hands]
            every.append(off)
            lengths.append([longest(one > LOST) for one in arms.T])
            print(f"  person {who}, noise {seed}: joints {100 * off.mean():.1f} cm; " + "; ".join(
                f"{name} {100 * one.mean():.0f} cm (worst {100 * one.max():.0f}), lost in {100 * (one > LOST).mean():.0f} %, {long:.1f} s without a break"
                for name, one, long in zip(("left hand", "right hand"), arms.T, lengths[-1])) + f"; {1e3 * spent:.0f} ms a step", flush=True)
    whole, arms = np.concatenate(every), np.concatenate(every)[:, hands]
    print(f"all joints {100 * whole.mean():.1f} cm; hands {100 * arms.mean():.1f} cm (worst {100 * arms.max():.0f}), "
          f"lost in {100 * (arms > LOST).mean():.1f} % of the time, for {np.max(lengths):.1f} s at the longest")


if __name__ == "__main__":
    main()
