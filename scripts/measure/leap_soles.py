"""How high soles are while they push a leap off, and how deep in the floor in its flight: leaps out of walks, of steady runs and of runs that were let go.

    python scripts/measure/leap_soles.py [--heights 1.741,0.9,2.1]

Bodies of these heights [m] walk or run at seven paces. At each moment at which a leap can go off, leaps ahead of three to four lengths are planned. Of each
plan two figures are told, in cm at standard height: how high the lowest point of the sole that pushes is over the floor while it gives more than 6 m/s² to the
body, at most; and how deep any sole is in the floor between take-off and touch-down. A count stands beside each: so many plans are over 1 cm.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from gambol.controllers.body import forward_kinematics, sole_corners
from gambol.controllers.contract import CharacterState, Intent, Leap, Unable
from gambol.controllers.jump import Jump, Physique
from gambol.controllers.person import person

FPS, ADULT = 60, 1.741
WALKS, RUNS, LET_GO = (0.8, 1.2, 1.6), (2.2, 3.0), (2.2, 2.8, 3.4)
"""Speeds ahead [m/s] at standard height."""
FAR = 0.4, 0.8, 1.2, 1.8
"""How far ahead is leapt [m], at standard height."""
ASKS = Intent(leap=Leap((0.0, 0.0, 0.0)))
"""Whether a leap can go off now does not depend on where it leads."""
PUSHES = 6.0
"""A foot pushes that gives so much to the body [m/s²]."""


def moments(who, velocity: float, brakes: bool) -> Iterator[CharacterState]:
    """States of who goes ahead at a velocity [m/s], a few steps apart, or brakes from it."""
    state, wish = who.start(), Intent(np.array([velocity, 0.0, 0.0]))
    for _ in range(150):
        state, _ = who.step(state, wish, 1 / FPS)
    for _ in range(8 if brakes else 20):
        slows = state
        for _ in range(45 if brakes else 1):
            if slows.active == "locomotion":
                yield slows
            slows, _ = who.step(slows, Intent(), 1 / FPS)
        for _ in range(5 if brakes else 3):
            state, _ = who.step(state, wish, 1 / FPS)


def figures(jump: Jump, state: CharacterState, far: float) -> tuple[float, float] | None:
    """How high [m] the sole is that pushes, and how deep [m] one is in the floor in flight, of a leap so far ahead [m]; None where none can be made."""
    x, z, heading = np.asarray(state.ground, float)
    try:
        made = jump.plan(state, Intent(leap=Leap((x + far * np.sin(heading), float(state.floor), z + far * np.cos(heading)))))
    except Unable:
        return None
    over = sole_corners(jump.skeleton, *forward_kinematics(jump.skeleton, made.roots, made.local)).reshape(len(made.times), 2, -1, 3)[..., 1].min(-1) - float(state.floor)
    single = jump.start_of(state).single
    pushing = (made.times <= made.take_off + 1e-9) & (np.linalg.norm(made.forces, axis=1) > PUSHES * jump.physique.mass)
    flying = (made.times > made.take_off + 1e-9) & (made.times < made.touch_down - 1e-9)
    pushes = over[pushing].min(1) if single is None else over[pushing][:, single]
    return float(pushes.max(initial=0.0)), float(-over[flying].min(initial=0.0))


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--heights", default="1.741,0.9,2.1", help="of bodies [m]")
    for height in map(float, parser.parse_args().heights.split(",")):
        size = height / ADULT
        who = person(physique=Physique(73.0 * size**3, height))
        jump = who.parts["jump"]
        assert isinstance(jump, Jump)
        for name, paces, brakes in (("walks", WALKS, False), ("runs", RUNS, False), ("runs let go", LET_GO, True)):
            found = [figure for pace in paces for state in moments(who, pace * np.sqrt(size), brakes) if jump.precondition(state, ASKS)
                     for far in FAR if (figure := figures(jump, state, far * size)) is not None]
            rows = 100.0 / size * np.array(found).reshape(-1, 2)
            high, deep = rows.T
            print(f"{height:.2f} m, {name:12s} {len(rows):4d} plans: pushing sole {high.max(initial=0.0):4.1f} cm high at most, over 1 cm in {int((high > 1.0).sum()):3d}; "
                  f"in flight {deep.max(initial=0.0):4.1f} cm deep at most, over 1 cm in {int((deep > 1.0).sum()):3d}", flush=True)


if __name__ == "__main__":
    main()
