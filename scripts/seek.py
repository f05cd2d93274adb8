"""Seek examples that break a law: `python scripts/seek.py [-n CORES] [--rounds 10] [--times 1] [pytest's arguments]`.

The tests try each law on the same examples in every run. This tries all laws on new ones, so many rounds, each by a seed
of its own and on so many times the examples. What fails is told with the command that shows it again. Exits with 1 if
anything did.
"""

from __future__ import annotations

import argparse
import re
import secrets
import shlex
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0].partition(":")[0])
    parser.add_argument("-n", default="auto", help="how many processes try laws at once")
    parser.add_argument("--rounds", type=int, default=10, help="how many seeds are tried")
    parser.add_argument("--times", type=int, default=1, help="how many times the examples of the tests' own runs")
    parser.add_argument("--seed", type=int, help="the first round's seed, the next ones following; else any")
    given, rest = parser.parse_known_args()
    broken: dict[str, list[str]] = {}
    for number in range(given.rounds):
        seed = secrets.randbits(32) if given.seed is None else given.seed + number
        wanted = ["-m", "hypothesis", "--hypothesis-profile=seek", f"--hypothesis-seed={seed}", f"--times={given.times}", *rest]
        done = subprocess.run([sys.executable, "-m", "pytest", "-n", given.n, *wanted], cwd=ROOT, capture_output=True, text=True)
        found = re.findall(r"^(?:FAILED|ERROR) (\S+)", done.stdout, re.M)
        if done.returncode and not found:
            found = ["the run itself"]
        print(f"round {number + 1} of {given.rounds}, seed {seed}: {(done.stdout.strip().splitlines() or ['nothing'])[-1]}", flush=True)
        for test in found:
            broken.setdefault(test, []).append(shlex.join(["python", "-m", "pytest", "-n", "0", *wanted, test]))
        if found:
            print(done.stdout, done.stderr, flush=True)
    for test, commands in broken.items():
        print(f"{test} fails {len(commands)} times: {commands[0]}")
    print(f"laws broken in {given.rounds} rounds: {len(broken)}")
    return bool(broken)


if __name__ == "__main__":
    sys.exit(main())
