"""How long from nothing to a picture, to somebody who walks, to steering them, and to jumps: a fresh process opens the game without a window.

    python scripts/bench/start.py [--runs 5]

Cold: with an empty folder for what is compiled, as on the first start ever. Warm: the same folder again.
The processor time, of the programs that compile beside it as well once they have ended, tells what a start costs where
other programs were running too.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SIZE = (1280, 720)


def start(began: float) -> dict[str, tuple[float, float]]:
    """Open the game; seconds since `began` to the end of each phase, and processor time spent until then."""
    done = {}

    def after(what: str) -> None:
        spent = os.times()
        done[what] = time.time() - began, spent.user + spent.system + spent.children_user + spent.children_system
    after("interpreter")
    from gambol.game.cli import unswept
    with unswept():  # as the command does
        from gambol.controllers.locomotion import Locomotion
        from gambol.controllers.person import person, preparing as compiling
        walker = Locomotion.load()
        programs = compiling.begun(walker)
        from gambol.game.app import Opening, Play, Preparing
        from gambol.game.hosts import Offscreen
    after("imports")
    preparing = Preparing(walker, programs)
    opening = Opening(lambda: Play(person(walker), preparing=preparing), preparing)
    with Offscreen(SIZE, "full") as host:
        opening.tick(0.0)
        host.frame(opening.scene(SIZE))
        after("first picture")
        last, walks = time.perf_counter(), False
        while opening.game is None or not walks:
            now = time.perf_counter()
            opening.tick(now - last)
            seen, last = opening.scene(SIZE), now
            host.frame(seen)
            if seen.figures and not walks:
                walks = True
                after("somebody who walks")
        after("steered")
        while not preparing.jumps:
            opening.tick(1.0 / 60.0)
            time.sleep(0.02)
        after("jumps")
    opening.close()
    return done


def started(cache: str) -> dict[str, list[float]]:
    """What `start` tells of a process of its own, with what lies compiled in a folder."""
    run = subprocess.run([sys.executable, __file__, "--began", str(time.time())], cwd=ROOT, capture_output=True, text=True,
                         env=os.environ | {"GAMBOL_CACHE": cache, "OPENBLAS_NUM_THREADS": "1"})
    if run.returncode:
        sys.exit(f"The start failed: {run.stderr.strip().splitlines()[-1]}")
    return json.loads(run.stdout.splitlines()[-1])


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--runs", type=int, default=5)
    options.add_argument("--began", type=float, help=argparse.SUPPRESS)
    options = options.parse_args()
    if options.began is not None:
        print(json.dumps(start(options.began)))
        return
    with tempfile.TemporaryDirectory() as cache:
        cold = started(cache)
        runs = [started(cache) for _ in range(options.runs)]
    warm = {phase: [statistics.median(run[phase][k] for run in runs) for k in range(2)] for phase in cold}
    for name, times in (("cold", cold), ("warm", warm)):
        print(f"{name}: " + ", ".join(f"{phase} {wall:.2f} ({processor:.2f})" for phase, (wall, processor) in times.items())
              + "  seconds until then (of the processor)")


if __name__ == "__main__":
    main()
