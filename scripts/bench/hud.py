"""What panels cost: the game with none, each and all of them open, and the first frame of all.

    python scripts/bench/hud.py [--frames 120] [--size 1280x720] [--preset fast]

Building is ImGui and what the panels work out; drawing is the picture with the panels in it, offscreen.
The processor time, summed over all cores, tells what a frame costs where other programs were running too.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from gambol.controllers.locomotion import Locomotion
from gambol.game.app import Play
from gambol.game.hosts import KeyEvent, Offscreen
from gambol.game.scene import PANELS


def measured(game: Play, stage: Offscreen, size: tuple[int, int], frames: int) -> tuple[np.ndarray, float]:
    """Milliseconds (frames, 2) to build and to draw a frame, after a warm-up, and processor time a frame."""
    times, spent = [], 0.0
    for n in range(frames + 5):
        if n == 5:
            spent = time.process_time()
        game.tick(1 / 60)
        began = time.perf_counter()
        scene = game.scene(size)
        built = time.perf_counter()
        stage.renderer.draw(scene)
        stage.context.finish()
        times.append((built - began, time.perf_counter() - built))
    return 1000.0 * np.array(times[5:]), 1000.0 * (time.process_time() - spent) / frames


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--frames", type=int, default=120)
    options.add_argument("--size", default="1280x720", type=lambda s: tuple(map(int, s.split("x"))))
    options.add_argument("--preset", default="fast")
    options = options.parse_args()
    game = Play(Locomotion.load())
    game.handle(KeyEvent("W", True))
    with Offscreen(options.size, options.preset) as stage:
        for _ in range(720):  # so that there are ten seconds to plot
            game.tick(1 / 60)
        game.scene(options.size)
        game.do("panels")
        began = time.perf_counter()
        game.scene(options.size)
        print(f"{stage.context.info['GL_RENDERER']}  {options.size[0]}×{options.size[1]}  {options.preset}; "
              f"first frame with panels {1000.0 * (time.perf_counter() - began):.0f} ms")
        game.do("panels")
        for chosen in ((), *((name,) for name in PANELS), PANELS):
            for name in chosen:
                game.do(f"{name}_panel")
            took, spent = measured(game, stage, options.size, options.frames)
            game.do("panels" if chosen else "")
            (build, draw), (build99, draw99) = np.percentile(took, (50, 99), axis=0)
            what = "none" if not chosen else "all" if len(chosen) > 1 else chosen[0]
            print(f"  {what:9} build p50 {build:4.1f} ms p99 {build99:4.1f} ms   draw p50 {draw:5.1f} ms p99 {draw99:5.1f} ms   "
                  f"processor {spent:5.1f} ms")
    game.close()


if __name__ == "__main__":
    main()
