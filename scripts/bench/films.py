"""What making labelled films costs: frames a second of four cameras with all truth by one program and by two, and the processor's time.

    python scripts/bench/films.py [--frames 30] [--films 4] [--width 640] [--workers 2] [--once]

Each film is of two people who pass each other, with other noise, made by `gambol film` in a folder that is removed again. The same films
are made with one worker and with several, whose frames a second are compared; on a machine that has as many cores to
spare. A first film, not counted, compiles what it takes. --once: by one program alone; the processor's time tells what a frame
costs where other programs were running too.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SCENARIO = """
title = "Two"
duration = {seconds}
fps = 30
[[actors]]
name = "Ann"
start = [-0.4, -2, 0]
moves = [{{ for = 30, velocity = [1.2, 0.1, 0] }}]
[[actors]]
name = "Bob"
start = [0.5, 2, 180]
moves = [{{ for = 30, velocity = [1.0, 0, 0] }}]
"""


def made(scenario: Path, folder: Path, seeds: int, workers: int, width: int) -> tuple[float, float]:
    """Seconds by the clock and of all processors that so many films took."""
    begun, before = time.perf_counter(), os.times()
    done = subprocess.run([sys.executable, "-c", "from gambol.game.cli import main; main()", "film", str(scenario), "-o", str(folder), "--seeds", str(seeds),
                    "--workers", str(workers), "--width", str(width)], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(done.stderr)
    after = os.times()
    return time.perf_counter() - begun, after.children_user + after.children_system - before.children_user - before.children_system


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=30, help="of each film")
    parser.add_argument("--films", type=int, default=4)
    parser.add_argument("--width", type=int, default=640)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--once", action="store_true", help="by one program alone")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as home:
        scenario = Path(home, "two.toml")
        scenario.write_text(SCENARIO.format(seconds=args.frames / 30))
        made(scenario, Path(home, "first"), 1, 1, args.width)
        (_, one), rates = made(scenario, Path(home, "few"), 1, 1, args.width), []
        for workers in (1,) if args.once else (1, args.workers):
            spent, worked = made(scenario, Path(home, f"by{workers}"), args.films, workers, args.width)
            if workers == 1:  # what every program's start takes is in both, and goes
                worked = (worked - one) / (args.frames * (args.films - 1))
                print(f"a frame of four cameras, {args.width} pixels wide: {worked:.2f} s of processor")
            rates.append(args.frames * args.films / spent)
            print(f"{workers} at work: {rates[-1]:.2f} frames a second, {args.films} films of {args.frames} frames in {spent:.0f} s")
        if len(rates) > 1:
            print(f"{args.workers} over 1: {rates[1] / rates[0]:.2f} times")


if __name__ == "__main__":
    main()
