"""Measure a scenario full of people, each on his way to a goal: who comes too near to whom, who arrives, how fast it runs.

    python scripts/measure/fifty.py [SCENARIO]

Bodies are capsules of 0.22 m, looked at after every step. Rates are steps a second of the processor's time, all threads together: over all, and the
best two seconds of the scenario, which other programs disturb least.
"""

from __future__ import annotations

import argparse
import os
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import numpy as np

from gambol.controllers.person import person
from gambol.game.scenario import film, load
from gambol.game.world import RATE

BODY = 0.22
"""A body's capsule has this radius [m]."""
WINDOW = 2 * RATE
"""Steps over which the best rate is told."""


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenario", nargs="?", default="fifty")
    asked = load(parser.parse_args().scenario)
    acts, spent, touched, nearest = film.acts(asked, person()), [], 0, np.inf
    act = next(acts)
    while act.world.time < asked.duration:
        begun = time.process_time()
        act = next(acts)
        spent.append(time.process_time() - begun)
        places = np.array([one.state.ground[:2] for one in act.world.characters])
        gaps = np.linalg.norm(places[:, None] - places[None], axis=-1)[np.triu_indices(len(places), 1)]
        touched, nearest = touched + int((gaps < 2 * BODY).sum()), min(nearest, float(gaps.min(initial=np.inf)))
    sums = np.convolve(spent, np.ones(WINDOW), "valid")
    print(f"{asked.title}: {len(act.scripts)} people, {asked.duration:g} s: {touched} frames of two capsules in each other, nearest {nearest:.2f} m; "
          f"{sum(script.done for script in act.scripts)} arrived, {len(act.refused)} gave up; {len(spent) / sum(spent):.0f} steps a second, "
          f"{WINDOW / sums.min():.0f} in the best two seconds")


if __name__ == "__main__":
    main()
