"""Measure jumps that are tapped at odd moments: how soon who brakes or turns back is in the air, and where who is held up before a box or an edge lands.

    python scripts/measure/hasty_jumps.py [--delays 12]

Hands run, let go of the stick or throw it back, and tap the jump so much later; or they walk at a box, or over it to its edge, hold the stick on and tap; or they tap twice. Told from what is
played: the first moment of a leap in which no foot stands, and how often he leaves the floor.
"""

from __future__ import annotations

import argparse
import os
from dataclasses import replace

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from gambol.controllers.contract import CharacterState
from gambol.controllers.person import person
from gambol.game.input import Wish
from gambol.game.scene import Box
from gambol.game.session import Timeline, begin, refused
from gambol.game.world import DT, Character, World

RUNS, TAPS, LATER = 1.7, 0.1, 3.0
"""So long hands run first, tap, and go on [s]."""
LATEST = 1.1
"""They tap up to so long after that [s]."""
TWICE = 1.3
"""Or the second time up to so long after the first [s]."""
HIGH = 0.3, 0.45
"""How high the box is [m]."""


def played(who, things, start, plan) -> tuple[list[CharacterState], list[str]]:
    """All states of somebody at x, z [m], heading [rad], on a floor [m], whose hands do a plan of seconds and wishes seen from behind him at first; and what he was told."""
    line, states, why = Timeline(begin(World((Character("A", who, who.start(start[:3], start[3])),), things), 1)), [], []
    for seconds, wish in plan:
        for _ in range(round(seconds / DT)):
            yaw, before, (x, z) = line.now.players[0].camera.yaw - start[2], line.now, wish.move
            move = x * np.cos(yaw) + z * np.sin(yaw), z * np.cos(yaw) - x * np.sin(yaw)  # the same way, wherever the camera looks
            line.advance((Wish(move=move, run=wish.run, jump=wish.jump).rounded(),))
            states.append(line.now.after.characters[0].state)
            why += refused(before, line.now)
    return states, why


def aloft(states: list[CharacterState], since: float) -> float:
    """How long after a moment [s] no foot stands in a leap; infinite where none goes off."""
    later = states[round(since / DT):]
    return next((k * DT for k, state in enumerate(later) if state.active == "jump" and not np.any(state.contacts)), np.inf)


def leaves(states: list[CharacterState]) -> int:
    """How often somebody leaves the floor in a leap."""
    flies = np.array([state.active == "jump" and not np.any(state.contacts) for state in states])
    return int((np.diff(flies.astype(int)) == 1).sum())


def told(name: str, times: list[float], more: str) -> None:
    """Print when leaps went off."""
    found = np.array(times)
    went = found[np.isfinite(found)]
    print(f"{name}: in the air {np.median(went):.2f} s after the key was let go (median), {went.max():.2f} (worst); never {len(found) - len(went)} of {len(found)}{more}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--delays", type=int, default=12, help="so many moments to tap")
    given, who = parser.parse_args(), person()
    delays = np.linspace(0.03, LATEST, given.delays)
    for name, run in (("run", 1.0), ("walk", 0.0)):
        on, back = Wish(move=(0.0, 1.0), run=run), Wish(move=(0.0, -1.0), run=run)
        for does, wish in (("goes on", on), ("is let go of", Wish()), ("is thrown back", back)):
            found = [played(who, (), (0.0, 0.0, 0.0, 0.0), ((RUNS, on), (delay, wish), (TAPS, Wish(move=wish.move, run=wish.run, jump=True)), (LATER, wish))) for delay in delays]
            why = sum(len(told_why) for _, told_why in found)
            told(f"{name}, {does}", [aloft(states, RUNS + delay + TAPS) for delay, (states, _) in zip(delays, found)], f"; refused {why}")
    for name, wish in (("stands", Wish()), ("walks", Wish(move=(0.0, 1.0))), ("runs", Wish(move=(0.0, 1.0), run=1.0))):
        tap, again = (TAPS, replace(wish, jump=True)), np.linspace(0.05, TWICE, 2 * given.delays)
        leaps = [leaves(played(who, (), (0.0, 0.0, 0.0, 0.0), ((RUNS, wish), tap, (delay, wish), tap, (LATER, wish)))[0]) for delay in again]
        fewer = ", ".join(f"{delay:.2f}" for delay, count in zip(again, leaps) if count < 2)
        print(f"{name}, tapped twice: two leaps {sum(count == 2 for count in leaps)} of {len(leaps)}{f'; fewer {fewer} s after the first' if fewer else ''}")
    on, tap = Wish(move=(0.0, 1.0)), Wish(move=(0.0, 1.0), jump=True)
    for high in HIGH:
        box = Box((0.0, 0.5 * high, 4.0), (4.0, high, 3.0))
        for name, at, floor, ends in (("at a box", 0.6, 0.0, high), ("on it, at its edge", 3.0, high, 0.0)):
            there, times = 0, []
            walks = 1.4 + 1.2 * delays
            for seconds in walks:
                states, _ = played(who, (box,), (0.0, at, 0.0, floor), ((seconds, on), (TAPS, tap), (0.2, on), (LATER, Wish())))
                there += abs(float(states[-1].floor) - ends) < 0.02
                times.append(aloft(states, seconds + TAPS))
            told(f"walk, held up {name} of {high:g} m", times, f"; {there} of {len(walks)} there")


if __name__ == "__main__":
    main()
