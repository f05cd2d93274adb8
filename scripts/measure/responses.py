"""Measure how soon people go as they are asked, from any speed to any other and any way, and by how much they overshoot.

    python scripts/measure/responses.py [--agility 1]

Whoever walks or runs along a line, or stands, is asked at PHASES moments of his stride to go another way, at another speed. Told of each angle and each
pair of speeds: when his mass centre goes as asked for good [s], in the mean and at worst; then the ways on which the ground frame was faster
than both speeds, and the most friction there.
"""

from __future__ import annotations

import argparse

import numpy as np
from scipy.ndimage import uniform_filter1d

from _motion import Motion

from gambol.controllers.locomotion import Locomotion, Settings
from gambol.controllers.navigation import steer

FPS, BEFORE, AFTER = 60, 150, 180
SPEEDS, ANGLES, PHASES, APART = (0.0, 0.3, 0.6, 1.0, 1.3, 1.8, 2.5, 3.5), (0, 45, 90, 135, 180), 6, 8
"""[m/s]; [degrees]; so many moments, so many frames apart."""
STRIDE = 18
"""The mass centre's velocity is told over so many frames: within a stride it comes and goes."""
NEAR, LEAST = 0.12, 0.03
"""Who is no farther from what was asked than this share of it and so much [m/s] goes as asked."""
OVER = 0.05
"""Overshooting by less [m/s] is not told."""


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--agility", type=float, default=1.0)
    options = parser.parse_args()
    locomotion = Locomotion.load(settings=Settings(agility=options.agility))
    ways = np.array([(a, b, angle, phase) for a in SPEEDS for b in SPEEDS if b for angle in ANGLES for phase in range(PHASES)])
    first, then, angle, moment = ways[:, 0], ways[:, 1], np.radians(ways[:, 2]), BEFORE + APART * ways[:, 3].astype(int)
    state, states = locomotion.start(np.zeros((len(ways), 3))), []
    for k in range(BEFORE + APART * PHASES + AFTER):
        asked = k >= moment
        way, speed = np.where(asked, angle, 0.0), np.where(asked, then, first)
        state, _ = locomotion.step(state, steer(state.ground, speed[:, None] * np.stack([np.sin(way), np.cos(way)], -1), None, state.velocity[:, 1]), 1 / FPS)
        states.append(state)
    motion = Motion(locomotion.skeleton, FPS, np.array([s.pose.root for s in states]), np.array([s.pose.rotations for s in states]),
                    locomotion.library.accelerations)
    along = uniform_filter1d((motion.com_velocity[..., [0, 2]] * np.stack([np.sin(angle), np.cos(angle)], -1)).sum(-1), STRIDE, axis=0)
    fast = np.array([np.hypot(*s.velocity[:, [0, 2]].T) for s in states])
    soon, over, slips = np.zeros(len(ways)), np.zeros(len(ways)), np.zeros(len(ways))
    for n in range(len(ways)):
        here = slice(moment[n], moment[n] + AFTER - STRIDE)
        off = np.flatnonzero(np.abs(along[here, n] - then[n]) > NEAR * then[n] + LEAST)
        soon[n] = (off[-1] + 1) / FPS if len(off) else 0.0
        over[n], slips[n] = fast[here, n].max() - max(first[n], then[n]), motion.friction[here, n].max()
    for turn in ANGLES:
        print(f"{turn}°: goes as asked after, mean (worst) [s]; from m/s down, to m/s across\n       " + "".join(f"{b:11.1f}" for b in SPEEDS[1:]))
        for a in SPEEDS:
            cells = [soon[(first == a) & (then == b) & (ways[:, 2] == turn)] for b in SPEEDS[1:]]
            print(f"  {a:4.1f} " + "".join(f"  {cell.mean():3.1f} ({cell.max():3.1f})" for cell in cells))
    print(f"faster than both speeds by more than {OVER:g} m/s: {100 * (over > OVER).mean():.1f} % of {len(ways)}, at most {over.max():.2f} m/s")
    pairs: dict[tuple, list[int]] = {}
    for n in np.flatnonzero(over > OVER):
        pairs.setdefault((first[n], then[n], ways[n, 2]), []).append(n)
    for (a, b, turn), those in sorted(pairs.items(), key=lambda pair: -over[pair[1]].max())[:10]:
        print(f"  {a:g} → {b:g} m/s, {turn:g}°: by {over[those].max():.2f} m/s, friction {slips[those].max():.2f}")


if __name__ == "__main__":
    main()
