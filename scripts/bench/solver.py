"""What a reconstructed frame costs besides the search: the local regression, and the solver.

    python scripts/bench/solver.py [--points 6] [--steps 10] [--rounds 200]

Least and median times of one thread; the least one tells what it costs where nothing else runs.
"""

from __future__ import annotations

import argparse
import os
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy: threads cost small matrices far more than they save

import numpy as np

from gambol.controllers.reconstruction import HEIGHT, SETS, SKELETON, WIDTH, parse
from gambol.controllers.reconstruction.regression import Gaussian, Regression, Solver, regress

MANY = 64


def timed(work, rounds: int, each: int = 1) -> str:
    """Least and median time of a call, for each of what it does."""
    work()
    times = []
    for _ in range(rounds):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    least, median = 1000.0 * np.min(times) / each, 1000.0 * np.median(times) / each
    return f"least {least:7.4f} ms   median {median:7.4f} ms"


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--points", default="6", choices=SETS)
    options.add_argument("--steps", type=int, default=10)
    options.add_argument("--rounds", type=int, default=200)
    options = options.parse_args()
    rng = np.random.default_rng(0)

    solver = Solver(parse(options.points, SKELETON), 1 / 60, steps=options.steps, tolerance=-1.0)  # never content
    mean = rng.normal(0, 0.3, WIDTH)
    mean[HEIGHT] = 1.0
    deviation = np.full(WIDTH, 0.1)
    goals = solver.points(mean + deviation * rng.normal(size=WIDTH))[0]
    alone = Gaussian(mean, deviation ** 2)
    full = Gaussian(mean, deviation ** 2, 0.1 * rng.normal(size=(WIDTH, WIDTH)))
    many = Gaussian(np.tile(mean, (MANY, 1)), np.tile(deviation ** 2, (MANY, 1)))
    print(f"solver, {WIDTH} degrees of freedom, {len(solver.controls)} points, {options.steps} steps")
    print(f"  one body                  {timed(lambda: solver.solve(alone, goals), options.rounds)}")
    print(f"  one body, full covariance {timed(lambda: solver.solve(full, goals), options.rounds)}")
    print(f"  each of {MANY}                {timed(lambda: solver.solve(many, np.tile(goals, (MANY, 1, 1))), options.rounds // 8, MANY)}")

    print(f"regression of {WIDTH} outputs on 3 past frames and the points, single precision")
    width = 3 * WIDTH + 6 * len(solver.controls)
    for count in (50, 100, 200, 400):
        x, y = (rng.normal(size=(count, size)).astype(np.float32) for size in (width, WIDTH))
        query, distances = x.mean(0), np.sort(rng.uniform(1, 2, count))
        for how in (Regression(form="dual"), Regression(form="primal"), Regression(covariance="full")):
            name = f"{how.form}, {how.covariance}" if how.form != "auto" else "full covariance"
            cost = timed(lambda: regress(query, x, y, distances, how), options.rounds // 4)  # noqa: B023
            print(f"  K = {count:3} {name:18} {cost}")


if __name__ == "__main__":
    main()
