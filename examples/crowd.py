"""Thousands of people walk round a square, all in one call for each step.

A walker's state may have any leading axes: a crowd is a longer array, not a longer loop.

    python examples/crowd.py --people 10000
"""

import argparse
import time

import numpy as np

from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation import Steering, steer

RATE = 60
STEERING = Steering()


def main(people=4000, seconds=3.0):
    """Let so many people circle for so long; their state at the end."""
    walker = Locomotion.load()
    state = walker.start(square(people))
    begun = time.perf_counter()
    for _ in range(round(seconds * RATE)):
        intent = steer(state.ground, round_the_middle(state.ground), turning=state.velocity[:, 1], settings=STEERING)
        state, poses = walker.step(state, intent, 1 / RATE)
    took = time.perf_counter() - begun
    speed = np.hypot(state.velocity[:, 0], state.velocity[:, 2])
    print(f"{people} people walked {seconds:g} s in {took:.1f} s: {speed.mean():.2f} m/s on average, "
          f"{1e6 * took / (people * seconds * RATE):.1f} µs a person and step; poses {poses.rotations.shape}")
    return state


def square(people, apart=1.5):
    """Ground frames (people, 3) x, z [m], heading [rad] of a crowd that stands in rows and looks about."""
    side = int(np.ceil(np.sqrt(people)))
    rows, columns = np.divmod(np.arange(people), side)
    headings = np.random.default_rng(1).uniform(-np.pi, np.pi, people)
    return np.stack([(columns - side / 2) * apart, (rows - side / 2) * apart, headings], -1)


def round_the_middle(ground, speed=1.1):
    """Velocities (..., 2) in the world [m/s] that lead everybody round the middle of the square."""
    around = np.stack([ground[..., 1], -ground[..., 0]], -1)
    return speed * around / np.maximum(np.linalg.norm(around, axis=-1, keepdims=True), 1e-6)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--people", type=int, default=4000)
    parser.add_argument("--seconds", type=float, default=3.0)
    main(**vars(parser.parse_args()))
