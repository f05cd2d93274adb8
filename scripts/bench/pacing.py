"""Open the real window for a while and tell how evenly its frames come, and whether the clock drifts.

    python scripts/bench/pacing.py [--seconds 60] [--preset fast] [--size 1280x720] [--film]

Without a display it opens one of its own (Xvfb), where drawing is software and nothing paces frames
but the loop itself. A character walks in circles. Drift is the wall time of the run less all that the
game accounts for: time simulated, time owed to the next step, and time dropped by frames that came too
late. --film: film all but the ends while it runs, as F10 does, to see what that costs.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from gambol.controllers.locomotion import Locomotion
from gambol.game.app import Play, Capture
from gambol.game.hosts import DisplayError, KeyEvent, run_window
from gambol.game.session import LogWriter
from gambol.game.world import DT

WARM_UP = 2.0
"""Seconds at the beginning that are not counted: shaders are compiled, pages loaded."""


class Watched(Play):
    """The game, noting by a clock of its own when it was ticked and asked for frames."""

    def __init__(self, controller: Locomotion, folder: Path, film: bool):
        super().__init__(controller, log=LogWriter(folder / "pacing.gambol", controller, 1), capture=Capture(folder))
        self.frames, self.film, self.wall, self.counted = [], film, [], []
        for key in ("W", "Q"):
            self.handle(KeyEvent(key, True))

    def tick(self, seconds: float) -> None:
        self.wall.append(time.perf_counter())
        super().tick(seconds)
        self.counted.append(self.now.number * DT + self.clock.owed + self.clock.dropped + self.held)
        if self.film and len(self.frames) in (120, 360):
            self.do("film")

    def scene(self, size):
        self.frames.append(time.perf_counter())
        return super().scene(size)


def display():
    """A display of our own where there is none; None where there is one."""
    if os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY") or not sys.platform.startswith("linux"):
        return None
    if not shutil.which("Xvfb"):
        sys.exit("no display, and no Xvfb to make one")
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1920x1080x24", "-nolisten", "tcp"],
                              pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.environ["DISPLAY"] = f":{os.read(read, 16).decode().strip()}"
    return server


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--seconds", type=float, default=60.0)
    options.add_argument("--preset", default="fast")
    options.add_argument("--size", default="1280x720", type=lambda s: tuple(map(int, s.split("x"))))
    options.add_argument("--film", action="store_true")
    options = options.parse_args()
    server = display()
    try:
        with tempfile.TemporaryDirectory() as folder:
            game = Watched(Locomotion.load(), Path(folder), options.film)
            run_window(game, options.size, options.preset, limit=options.seconds + WARM_UP)
            if options.film:
                game.close()
                print("film while playing:", *game.kept.capture.status() or ["done"])
                game.kept.capture.finish(print)
    except DisplayError as error:
        sys.exit(str(error))
    finally:
        if server is not None:
            server.terminate()
            server.wait()
    frames = np.array(game.frames)
    shown = frames[frames - frames[0] > WARM_UP]
    took = 1000.0 * np.diff(shown)
    print(f"window {options.size[0]}×{options.size[1]} {options.preset}, {shown[-1] - shown[0]:.1f} s, {len(shown)} frames: "
          f"interval p50 {np.percentile(took, 50):.2f} ms, p99 {np.percentile(took, 99):.2f} ms, longest {took.max():.1f} ms")
    drift = (game.wall[-1] - game.wall[0]) - (game.counted[-1] - game.counted[0])
    print(f"clock: drift {1000 * drift:+.3f} ms in {game.wall[-1] - game.wall[0]:.1f} s; "
          f"{game.now.number} ticks, dropped {1000 * game.clock.dropped:.1f} ms, owed {1000 * game.clock.owed:.2f} ms")


if __name__ == "__main__":
    main()
