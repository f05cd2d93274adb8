"""Play who walks about on stairs: goes up, turns on the spot, stands, goes on another way, steps aside; and look at the feet in every step.

    python scripts/measure/about_stairs.py [--plays 150] [--seed 0] [--pictures DIR]

Each play lasts some six seconds, on the stairs of the yard (`hands.py`), begun and led at random. Told from the final pose: a foot said to stand, all of whose sole
is more than 3 cm over what lies under it; nobody's foot within 2 cm of anything, while he walks; flesh more than 3 cm in the stairs; and who lost his footing, and
fell. The worst moments are told by play and second; --pictures draws them.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from hands import GOING, YARD, Body, draw, wished, worst
from gambol.controllers.person import person
from gambol.game.input import Wish
from gambol.game.session import Timeline, begin
from gambol.game.world import DT, Character, World

MIDDLE, FOOT = -3.0, 3.0 - 0.5 * GOING
"""Where the stairs' middle is and where they begin, x and z [m]."""
DEEDS = 5
"""So many things are done once he is on them."""
STANDS, NEAR, DEEP, WALKS = 0.03, 0.02, 0.03, 1.6
"""A foot stands over nothing so far up, a foot is near so far up, flesh is in things so deep [m]; who is faster runs [m/s]."""


def played(who: Any, seed: int) -> tuple[list[Any], list[str]]:
    """The states of one play, and what hands did in each."""
    rng, states, did = np.random.default_rng(seed), [], []
    begins = who.start(ground=(MIDDLE + rng.uniform(-0.5, 0.5), FOOT - rng.uniform(0.4, 1.0), rng.uniform(-0.4, 0.4)))
    line = Timeline(begin(World((Character("A", who, begins),), YARD), 1))

    def does(name: str, lasts: float, place: tuple[float, float] | None = None, turn: float = 0.0, **how: Any) -> None:
        for tick in range(max(1, round(lasts / DT))):
            state = line.now.after.characters[0].state
            states.append(state)
            did.append(name)
            line.advance((Wish(turn=turn).rounded() if place is None else wished(state, line.now.players[0].camera.yaw, place, tick == 0, tilt=1.0, **how),))

    does("up", rng.uniform(0.8, 3.2), (MIDDLE + rng.uniform(-0.7, 0.7), 6.0), run=float(rng.random() < 0.3))
    for _ in range(DEEDS):
        kind, place = rng.choice(["spot", "spot", "rest", "go", "aside"]), tuple(states[-1].ground[:2] + rng.normal(0.0, 2.0, 2))
        if kind == "spot":
            does(kind, rng.uniform(0.2, 1.2), turn=float(rng.choice([-1.0, 1.0])))
        elif kind == "rest":
            does(kind, rng.uniform(0.1, 1.0))
        else:
            does(kind, rng.uniform(0.2, 1.2), place, strafe=kind == "aside")
    does("rest", 1.0)
    return states, did


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--plays", type=int, default=150)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--pictures", type=Path)
    asked = parser.parse_args()
    who, states, did, play, fell = person(), [], [], [], 0
    for seed in range(asked.seed, asked.seed + asked.plays):
        seen, done = played(who, seed)
        fell += any(state.active == "jump" for state in seen)
        states, did, play = states + seen, did + done, play + [seed] * len(seen)
    body, starts = Body(who, states, YARD), np.flatnonzero(np.diff(play, prepend=asked.seed - 1))
    soles = body.flesh[1][:, -6:].reshape(-1, 2, 3).min(-1)
    walks, slow = np.array([s.active == "locomotion" for s in states]), np.array([s.velocity[0] < WALKS for s in states])
    stands = np.array([np.asarray(s.contacts).reshape(2, 2).any(1) for s in states])
    floats, aloft, deep = np.where(stands & walks[:, None], soles, 0.0).max(1), np.where(walks & slow, soles.min(1), 0.0), np.where(walks, -body.flesh[1].min(1), 0.0)
    print(f"{asked.plays} plays, {len(states) * DT / 60:.1f} minutes · a standing foot > {100 * STANDS:g} cm up {np.mean(floats > STANDS):.3%} · nobody's foot within {100 * NEAR:g} cm "
          f"{np.mean(aloft > NEAR):.3%} · in the stairs > {100 * DEEP:g} cm {np.mean(deep > DEEP):.3%} · falls {fell}")
    found = {name: [(k, 100.0 * float(values[k])) for k in worst(values, 6)] for name, values in (("stands up [cm]", floats), ("aloft [cm]", aloft), ("in the stairs [cm]", deep))}
    for name, moments in found.items():
        print(f"    {name}: " + ", ".join(f"{value:.1f} in play {play[k]} at {(k - starts[starts <= k][-1]) * DT:.2f} s ({did[k]})" for k, value in moments))
    if asked.pictures is not None:
        asked.pictures.mkdir(parents=True, exist_ok=True)
        draw(body, found, asked.pictures)


if __name__ == "__main__":
    main()
