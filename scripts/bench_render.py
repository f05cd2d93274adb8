"""How long a frame takes offscreen: p50 and p99 for both presets, 1 and 10 characters.

    python scripts/bench_render.py [--frames 120] [--size 1280x720]

Each frame moves the figures, draws them and reads the picture back, as a film does. The processor
time, summed over all cores, tells what a frame costs where other programs were running too.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np

sys.path[:0] = [str(Path(__file__).parent.parent)]

from controllers.body import forward_kinematics, human  # noqa: E402
from controllers.body.rotations import exp, yaw  # noqa: E402
from game.hosts import Offscreen  # noqa: E402
from game.scene import Camera, Figure, Scene  # noqa: E402


def stroll(count: int, time_s: float) -> tuple[Figure, ...]:
    """`count` figures that swing arms and legs, in rows before the camera."""
    skeleton = human()
    figures = []
    for n in range(count):
        swing = np.sin(6.0 * time_s + n)
        turns = np.zeros((len(skeleton), 3))
        for side, sign in (("Left", 1.0), ("Right", -1.0)):
            turns[skeleton.index(f"{side}Arm")] = 0.0, 0.0, -1.25 * sign
            turns[skeleton.index(f"{side}UpLeg")] = -0.5 * sign * swing, 0.0, 0.0
            turns[skeleton.index(f"{side}Leg")] = 0.4 + 0.4 * sign * swing, 0.0, 0.0
        rotations = exp(turns)
        rotations[0] = yaw(0.4 * n)
        root = np.array([(n % 5 - (2 if count > 1 else 0)) * 1.1, 0.98, -1.3 * (n // 5)])
        positions, orientations = forward_kinematics(skeleton, root, rotations)
        figures.append(Figure(positions, orientations, tint=(0.7 - 0.05 * n, 0.4, 0.2 + 0.05 * n)))
    return tuple(figures)


def measured(size: tuple[int, int], preset: str, count: int, frames: int) -> tuple[np.ndarray, float]:
    """Milliseconds (frames,) of draw and read together, after a warm-up, and processor time a frame."""
    camera = Camera(np.array([1.6, 1.6, 4.2 if count == 1 else 5.2]), np.array([0.0, 0.95, 0.0]))
    out = np.empty((size[1], size[0], 4), np.uint8)
    times = []
    with Offscreen(size, preset) as host:
        for n in range(frames + 10):
            if n == 10:
                spent = time.process_time()
            scene = Scene(camera, stroll(count, n / 60.0), text=("Gambol",))
            began = time.perf_counter()
            host.frame(scene, out)
            times.append(time.perf_counter() - began)
        spent = 1000.0 * (time.process_time() - spent) / frames
        print(f"{host.context.info['GL_RENDERER']}  {size[0]}×{size[1]}  {preset:5}  {count:3} characters", end="  ")
    return 1000.0 * np.array(times[10:]), spent


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--frames", type=int, default=120)
    options.add_argument("--size", default="1280x720", type=lambda s: tuple(map(int, s.split("x"))))
    options = options.parse_args()
    for preset in ("full", "fast"):
        for count in (1, 10):
            took, spent = measured(options.size, preset, count, options.frames)
            print(f"p50 {np.percentile(took, 50):5.1f} ms  p99 {np.percentile(took, 99):5.1f} ms  "
                  f"processor {spent:5.1f} ms")


if __name__ == "__main__":
    main()
