"""How long from nothing to a picture: a fresh process imports Gambol, loads the library and draws one frame.

    python scripts/bench/start.py [--runs 5]

Cold: in a copy of the sources, where no kernel has been compiled yet. Warm: the same copy again.
The processor time tells what a start costs where other programs were running too.
"""

from __future__ import annotations

import argparse
import json
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
START = """
import json, sys, time
began, done = float(sys.argv[1]), {}
def after(what): done[what] = time.time() - began, time.process_time()
after("interpreter")
from gambol.game.cli.base import person_of
from gambol.game.hosts import Offscreen
from gambol.game.app.app import Play
after("imports")
controller = person_of(None)
play = Play(controller)
after("library")
with Offscreen((1280, 720), "full") as host:
    after("context and shaders")
    play.tick(1.0 / 60.0)
    host.frame(play.scene((1280, 720)))
    after("first frame")
print(json.dumps(done))
"""


def started(folder: Path) -> dict[str, list[float]]:
    """Seconds from the start of a process in `folder` to the end of each phase, and processor time spent until then."""
    run = subprocess.run([sys.executable, "-c", START, str(time.time())], cwd=folder, capture_output=True, text=True)
    if run.returncode:
        sys.exit(f"The start failed: {run.stderr.strip().splitlines()[-1]}")
    return json.loads(run.stdout.splitlines()[-1])


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--runs", type=int, default=5)
    options = options.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for part in ("controllers", "game", "assets"):
            shutil.copytree(ROOT / part, Path(folder) / part, ignore=shutil.ignore_patterns("__pycache__"))
        cold = started(Path(folder))
        runs = [started(Path(folder)) for _ in range(options.runs)]
    warm = {phase: [statistics.median(run[phase][k] for run in runs) for k in range(2)] for phase in cold}
    for name, times in (("cold", cold), ("warm", warm)):
        print(f"{name}: " + ", ".join(f"{phase} {wall:.2f} ({processor:.2f})" for phase, (wall, processor) in times.items())
              + "  seconds until then (of the processor)")


if __name__ == "__main__":
    main()
