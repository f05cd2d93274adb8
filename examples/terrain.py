"""Walk over ground of your own: hills that a function tells, laid out as small ramps round the walker.

Gambol's ground is boxes and ramps. Hills, meshes and height maps become ramps of 25 cm, each as high and as steep as the ground is
there; only those that the feet may reach soon are made, and only when the walker has gone on.

    python examples/terrain.py
"""

import numpy as np

from gambol.controllers.body import contact_points, forward_kinematics, human
from gambol.controllers.contract import Intent
from gambol.controllers.person import person
from gambol.game.scene import Box

RATE, CELL, REACH = 60, 0.25, 1.5
"""Steps a second; how wide a ramp is, and how far from the walker there are any [m]."""


def height(x, z):
    """How high the ground lies [m], nowhere below 0: yours comes from a mesh or a picture."""
    return 0.6 + 0.6 * np.sin(0.5 * x) * np.cos(0.4 * z)


def ramps(x, z, near=1e-3):
    """The ground round a place x, z [m]: a ramp rises along its own z, so each is turned to where the ground rises."""
    made = []
    for i in np.arange(-REACH, REACH + 1e-6, CELL):
        for k in np.arange(-REACH, REACH + 1e-6, CELL):
            a, b = CELL * round(x / CELL) + i, CELL * round(z / CELL) + k
            rise = np.array([height(a + near, b) - height(a - near, b), height(a, b + near) - height(a, b - near)]) / (2 * near)
            high = float(height(a, b))
            made.append(Box((a, 0.5 * high, b), (CELL, high, CELL), float(np.arctan2(*rise)), slope=float(np.hypot(*rise))))
    return tuple(made)


def main(seconds=8.0):
    """How far soles that stand are off the ground at the most [m]."""
    somebody, off, cell, around = person(), [], None, ()
    state = somebody.start((0.0, 0.0, 0.3), floor=height(0.0, 0.0))
    for _ in range(round(seconds * RATE)):
        x, z, _ = state.ground
        if cell != (cell := (round(x / CELL), round(z / CELL))):
            around = ramps(x, z)
        state, pose = somebody.step(state, Intent(np.array([1.2, 0.15, 0.0]), around=around), 1 / RATE)
        soles = contact_points(human(), *forward_kinematics(human(), pose.root, pose.rotations))  # (4, 3) [m], 2 cm above them
        off.append(np.abs(soles[:, 1] - 0.02 - height(soles[:, 0], soles[:, 2]))[state.contacts])
    print(f"walked to {state.ground[:2].round(1)} m, now {float(state.floor):.2f} m high; soles are off by {100 * np.concatenate(off).max():.1f} cm at most")
    return float(np.concatenate(off).max())


if __name__ == "__main__":
    main()
