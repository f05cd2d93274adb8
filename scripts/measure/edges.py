"""Measure how people who walk or run on over an edge too high to step down come off it, from the final pose alone.

    python scripts/measure/edges.py [--phases 12]

On platforms of 0.6 … 3 m each goes over the edge in several phases of a step. In the air: how long nothing touches ground before the fall begins, on
average and at most. Off the parabola: how far the mass centre is at touch-down at most from where it would have fallen to since the last contact. Acceleration:
by how much its acceleration differs from gravity between last contact and touch-down, over 1/30 s, median of all who go and the worst. Walks on: who never falls.
"""

from __future__ import annotations

import argparse

import numpy as np

from gambol.controllers.body import anatomy, centre_of_mass, forward_kinematics, sole_corners
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import Settings
from gambol.controllers.person import person
from gambol.game.scene import Box

FPS, WIDE, STRIDE = 120, 4, 1.6
"""Steps a second; accelerations are over so many of them; starts are spread over so much of the way [m]."""
HIGH, SPEEDS = (0.6, 1.0, 2.0, 3.0), (0.8, 1.3, 1.8, 2.5, 3.0, 3.5, 4.0)
TOUCH = 0.03
"""A sole's corner that is no higher over the ground touches it [m]."""


def gone_over(someone, speed: float, high: float, shift: float):
    """Seconds in the air before a fall, metres off the parabola, and the worst difference from gravity [m/s²] of somebody who goes over an edge; None if he never falls."""
    around = (Box((0.0, 0.5 * high, -10.0), (20.0, high, 20.0)),)
    state, centres, touches, fell, down = someone.start((0.0, -3.0 - shift, 0.0), high), [], [], None, None
    for n in range(round((6.0 / speed + 2.0) * FPS)):
        state, pose = someone.step(state, Intent(np.array([speed, 0.0, 0.0]), around=around), 1 / FPS)
        placed = forward_kinematics(someone.skeleton, np.asarray(pose.root, float), np.asarray(pose.rotations, float))
        corners = sole_corners(someone.skeleton, *placed)
        centres.append(centre_of_mass(anatomy(someone.skeleton), *placed))
        touches.append(bool((corners[:, 1] - np.where(corners[:, 2] < 0.0, high, 0.0) < TOUCH).any()))
        if state.memory.active == "jump":
            fell = n if fell is None else fell
            if state.memory.memory.landed:
                down = n
                break
    if fell is None or down is None:
        return None
    height = np.array(centres)[:, 1]
    last = max(n for n in range(fell + 1) if touches[n])
    fallen = (down - 1 - last) / FPS
    rate = (height[last] - height[last - 2]) * FPS / 2 - 9.81 / FPS
    off = height[down - 1] - (height[last] + rate * fallen - 0.5 * 9.81 * fallen**2)
    middle = height[last:down]
    bends = (middle[2 * WIDE:] - 2 * middle[WIDE:-WIDE] + middle[:-2 * WIDE]) * (FPS / WIDE) ** 2 + 9.81
    return (fell - last) / FPS, abs(off), float(np.abs(bends).max(initial=0.0))


def main() -> None:
    """Print a line for each speed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--phases", type=int, default=12)
    phases = parser.parse_args().phases
    someone = person()
    someone = someone.tuned(Settings(idle=0.0))
    for speed in SPEEDS:
        found = [gone_over(someone, speed, high, shift) for high in HIGH for shift in np.linspace(0.0, STRIDE, phases, endpoint=False)]
        air, off, bends = np.array([one for one in found if one is not None]).T
        print(f"{speed:.1f} m/s ({len(found)}): in the air before the fall {air.mean():.3f} s (most {air.max():.3f}) · off the parabola {100 * off.mean():.1f} cm "
              f"(worst {100 * off.max():.0f}) · acceleration off gravity {np.median(bends):.1f} m/s² (worst {bends.max():.1f}) · walks on {sum(one is None for one in found)}", flush=True)


if __name__ == "__main__":
    main()
