"""Step a character: walk a curve, jump over nothing in particular, and say where it is twice a second.

    python examples/step.py --seconds 6
"""

import argparse

import numpy as np

from gambol.controllers.contract import Intent, Leap
from gambol.controllers.person import person

RATE = 60


def main(seconds=6.0):
    """Walk for that long, jump half-way; the state at the end."""
    somebody = person()                                    # walks, runs and jumps
    state = somebody.start(ground=(0.0, 0.0, 0.0))         # x, z [m], heading [rad]
    jumped = False
    for tick in range(round(seconds * RATE)):
        intent = Intent(velocity=np.array([1.2, 0.4, 0.0]))    # forward m/s, turning rad/s, to the left m/s
        if tick >= seconds * RATE / 2 and not jumped:
            intent = Intent(intent.velocity, leap=Leap(ahead(state.ground, 1.2)))
        state, pose = somebody.step(state, intent, 1 / RATE)
        jumped = jumped or state.active == "jump"
        if tick % (RATE // 2) == 0:
            x, z, heading = state.ground
            print(f"{tick / RATE:4.1f} s  at {x:5.2f} {z:5.2f} m, heading {np.degrees(heading):4.0f}°, "
                  f"pelvis {pose.root[1]:.2f} m high, {state.active}")
    return state


def ahead(ground, metres):
    """The place (3,) so far in front of a character, on the floor."""
    x, z, heading = ground
    return np.array([x + metres * np.sin(heading), 0.0, z + metres * np.cos(heading)])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seconds", type=float, default=6.0)
    main(**vars(parser.parse_args()))
