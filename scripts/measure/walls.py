"""Measure how near walls come to who walks and runs straight at them, and how hard he brakes.

    python scripts/measure/walls.py [--walls METRES ...]

Somebody sets off from 2.0 … 2.4 m before a wall, and from 6 m, so that runners are as fast as they were told. Told: his wish heeds the wall, as scripts' and keys' do.
Untold: only the walk itself holds him up, as who imports it without heeding anything. Each figure is the worst of all distances: how far his middle is from the wall's face at
least, negative inside; how far at rest; how fast he was at most; how hard he brakes at most, over 1/10 s.
"""

from __future__ import annotations

import argparse

import numpy as np

from gambol.controllers.contract import Intent
from gambol.controllers.person import person
from gambol.game.scene import Box
from gambol.game.world import stopped

SPEEDS, DISTANCES, SECONDS = (0.7, 1.0, 1.4, 1.8, 2.5, 3.5, 4.2), (2.0, 2.1, 2.2, 2.3, 2.4, 6.0), 10.0


def approach(who, speed, far, thick, told):
    """How far (T,) somebody's middle is from a wall's face in every step; he wishes for a speed all the while."""
    state, wall, left = who.start(), (Box((0.0, 1.2, far + 0.5 * thick), (9.0, 2.4, thick)),), []
    for _ in range(round(60 * SECONDS)):
        intent = Intent(np.array([speed, 0.0, 0.0]), around=wall)
        state, _ = who.step(state, stopped(state, intent, wall) if told else intent, 1 / 60)
        left.append(far - float(state.ground[1]))
    return np.array(left)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--walls", nargs="+", type=float, default=[0.1, 1.5], help="how thick [m]")
    thicknesses, who = parser.parse_args().walls, person()
    print(f"{'wall':>6} {'wished':>7} {'told':>5} {'nearest':>9} {'at rest':>9} {'fastest':>9} {'brakes':>8}")
    for thick in thicknesses:
        for speed in SPEEDS:
            for told in (True, False):
                ways = np.array([approach(who, speed, far, thick, told) for far in DISTANCES])
                pace = -np.diff(ways, axis=-1) * 60
                brakes = (pace[:, :-6] - pace[:, 6:]) * 10
                print(f"{thick:6.1f} {speed:7.1f} {'yes' if told else 'no':>5} {100 * ways.min():6.1f} cm {100 * ways[:, -1].min():6.1f} cm {pace.max():5.2f} m/s {brakes.max():4.1f} m/s²", flush=True)


if __name__ == "__main__":
    main()
