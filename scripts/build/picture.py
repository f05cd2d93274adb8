"""The moving picture of the README: a walk, a run, a leap and the control space, in a loop.

    python scripts/build/picture.py [-o docs/gambol.webp] [--size 640x360] [--fps 20]

It is cut from the demo (assets/scenarios/demo.toml), without its captions.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

from gambol.controllers.person import person
from gambol.controllers.supervisor import Supervisor
from gambol.game.cli import learn, pixels_of
from gambol.game.hosts import Offscreen
from gambol.game.scenario import Scenario, load, scenes, worlds
from gambol.game.world import RATE

WALK, RUN, SPACE = (5.2, 7.0), (8.0, 9.5), (10.6, 12.9)
"""Of the demo, from and to [s]."""
LEAPS, BEFORE, AFTER = (1, 2), 0.3, 0.4
"""Which leaps of the first person are shown, the first is 0, and so much before and after each [s]."""
FINER = 2
"""Drawn so many times as large, and made smaller with care."""


def cuts(film: Scenario, controller: Supervisor) -> tuple[tuple[float, float], ...]:
    """From and to [s] of the demo, in the order in which they are shown."""
    leaps, jumps = [], False
    for number, world in enumerate(worlds(film, controller)):
        if jumps != (jumps := world.characters[0].state.active == "jump"):
            leaps.append(number / RATE)
            if len(leaps) == 2 * (max(LEAPS) + 1):
                return WALK, RUN, *((leaps[2 * k] - BEFORE, leaps[2 * k + 1] + AFTER) for k in LEAPS), SPACE
    raise AssertionError("worlds go on without end")


def frames(size: tuple[int, int], fps: int, shown: Sequence[tuple[float, float]], controller: Supervisor) -> Iterator[tuple[float, np.ndarray]]:
    """Time [s] and picture of the demo's frames that are shown."""
    film = load("demo").at_fps(fps).at_size((FINER * size[0], FINER * size[1]))
    film = film.model_copy(update={"duration": max(end for _, end in shown)})
    learn(film.wanted, film.database)
    with Offscreen(film.size) as stage:
        for frame, seen in scenes(film, controller):
            if any(start <= frame.time < end for start, end in shown):
                yield frame.time, stage.frame(tuple(replace(scene, caption=None) for scene in seen))[..., :3]


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("-o", "--out", type=Path, default=Path("docs/gambol.webp"))
    options.add_argument("--size", type=pixels_of, default=(640, 360))
    options.add_argument("--fps", type=int, default=20)
    options.add_argument("--quality", type=int, default=60)
    chosen = options.parse_args()
    controller = person()
    wanted = cuts(load("demo"), controller)
    drawn = [(time, Image.fromarray(np.ascontiguousarray(picture)).resize(chosen.size, Image.Resampling.LANCZOS))
             for time, picture in frames(chosen.size, chosen.fps, wanted, controller)]
    shown = [picture for start, end in wanted for time, picture in drawn if start <= time < end]
    # each frame stands for a whole number of milliseconds
    shown[0].save(chosen.out, save_all=True, append_images=shown[1:], duration=round(1000 / chosen.fps), loop=0,
                  quality=chosen.quality, method=6, minimize_size=True)
    print(f"{chosen.out}: {len(shown)} frames, {len(shown) / chosen.fps:.1f} s, {chosen.out.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
