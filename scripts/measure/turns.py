"""Measure how people turn from rest: into a walk or a run another way, and on the spot.

    python scripts/measure/turns.py

Of every turn: when its heading is within 0.1 rad, the steps until then and, on the spot, all of them; when the mass centre has nine tenths of its
speed that way; what the final pose tells of it (`_motion.py`).
"""

from __future__ import annotations

import argparse

import numpy as np

from _figures import figures, told
from _motion import Motion

from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation import steer

FPS, SECONDS, NEAR = 60, 3.5, 0.1
STOOD = 10
"""So many frames of standing are looked at, too."""
TURNS = ((1.3, (45, 60, 90, 135, 180, -60, -90, -135, -175)), (2.5, (90, 180, -90)), (0.0, (45, 60, 90, 110, 135, 180, -45, -90, -110, -175)))
"""Speeds [m/s], and by how much is turned [degrees]."""


def turned(locomotion: Locomotion, degrees: np.ndarray, speed: float) -> list:
    """The states of characters that stand for STOOD frames and then go or look another way each."""
    angle = np.radians(degrees)
    way = speed * np.stack([np.sin(angle), np.cos(angle)], -1)
    state, states = locomotion.start(np.zeros((len(angle), 3))), []
    for k in range(STOOD + round(SECONDS * FPS)):
        wish = steer(state.ground, way, None if speed else angle, state.velocity[:, 1]) if k >= STOOD else Intent(np.zeros(3))
        state, _ = locomotion.step(state, wish, 1 / FPS)
        states.append(state)
    return states


def main() -> None:
    """Print all figures."""
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    locomotion = Locomotion.load()
    for speed, degrees in TURNS:
        states = turned(locomotion, np.array(degrees, float), speed)
        motion = Motion(locomotion.skeleton, FPS, np.array([s.pose.root for s in states]), np.array([s.pose.rotations for s in states]),
                        locomotion.library.accelerations)
        print(f"Into {speed:.1f} m/s:" if speed else "On the spot:", told([figures(motion)]))
        feet = np.array([s.contacts.reshape(-1, 2, 2).any(-1) for s in states]).astype(int)
        strikes = (np.diff(feet, axis=0) > 0).sum(-1)[STOOD:]
        ground = np.array([s.ground for s in states])[STOOD:]
        for n, angle in enumerate(np.radians(degrees)):
            off = np.abs((ground[:, n, 2] - angle + np.pi) % (2 * np.pi) - np.pi)
            facing = int(np.flatnonzero(off > NEAR)[-1]) + 1
            quick = (motion.com_velocity[STOOD:, n][:, [0, 2]] @ [np.sin(angle), np.cos(angle)] > 0.9 * speed).argmax() / FPS
            steps = strikes[:facing if speed else None, n].sum()
            print(f"  {degrees[n]:5.0f}°: faces there after {facing / FPS:.2f} s, {steps} steps; " + (f"nine tenths of the speed after {quick:.2f} s; " if speed
                  else f"off the place {100 * np.hypot(*ground[-1, n, :2]):.0f} cm; ")
                  + f"peak {np.linalg.norm(motion.com_acceleration[:, n][:, [0, 2]], axis=-1).max():.1f} m/s², friction {motion.friction[:, n].max():.2f}, "
                  f"joints {motion.joints[:, n].max():.1f}×, feet apart {100 * motion.apart[:, n].min():.1f} cm")


if __name__ == "__main__":
    main()
