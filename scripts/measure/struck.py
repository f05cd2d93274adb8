"""Figures of those who are struck: how hard a push walkers and runners take in with their next steps, how hard it takes to make people step, stumble and fall, whether momentum is
kept, what slides, what goes through the floor; how near legs come to each other and how fast feet go of those who are pushed to any side (--legs: nothing else); and what becomes of those who are struck in random rooms, beside walls, on platforms and on stairs.

    python scripts/measure/struck.py [--rooms 40] [--seed 0] [--only-rooms] [--legs]
"""

from __future__ import annotations

import argparse

import numpy as np

from _pushed_legs import SPEEDS, pushes, told
from _struck_rooms import report

from gambol.controllers.body import centre_of_mass, contact_points, forward_kinematics
from gambol.controllers.contract import Intent, Strike
from gambol.controllers.jump import Physique
from gambol.controllers.jump.motion import places
from gambol.controllers.person import person
from gambol.controllers.struck import FALLS, STEPS

WAYS = {"from behind": (0.0, 1.0), "from before": (0.0, -1.0), "from the right": (1.0, 0.0), "from the left": (-1.0, 0.0)}
HARD = np.arange(4.0, 200.0, 4.0)
"""Impulses [N·s]."""
PHASES = 12
"""So many moments of a stride are struck in."""
DT, PLAYED, BACK = 1.0 / 60.0, 2.0, 0.05
"""Steps [s], for how long who goes on is followed [s], and how near to his wish he is back at it [m/s]."""


def _goes_on(somebody, state, wish, impulse):
    """Of somebody who takes an impulse (2,) [N·s] in stride: how far the ground frame's speed is off v + J/m after a step, after how long he is back at his wish for good [s], how
    fast a sole that stands slides, and how fast it does unpushed [m/s]."""
    found, was = [], np.asarray(state.ground, float)
    for strike in (Strike(tuple(impulse)), None):
        rows, speeds, first = [], [], None
        now = state
        for n in range(round(PLAYED / DT)):
            now, _ = somebody.step(now, Intent(np.array(wish), strike=None if n else strike), DT)
            placed = forward_kinematics(somebody.skeleton, np.asarray(now.pose.root, float), np.asarray(now.pose.rotations, float))
            rows.append((contact_points(somebody.skeleton, *placed)[:, [0, 2]], now.contacts))
            speeds.append(float(np.hypot(*(now.velocity - wish)[[0, 2]])))
            first = now.ground if first is None else first
        points, stands = (np.stack(column) for column in zip(*rows))
        flow = np.linalg.norm(np.diff(points, axis=0), axis=-1) / DT
        found.append((((first - was) / DT)[:2], speeds, float(np.where(stands[1:] & stands[:-1], flow, 0.0).max())))
    (pushed, speeds, slides), (calm, _, unpushed) = found
    far = np.flatnonzero(np.array(speeds) > BACK)
    gained = impulse / somebody.parts["struck"].physique.mass
    return float(np.hypot(*(pushed - calm - gained))), DT * (1.0 + far[-1] if len(far) else 0.0), slides, unpushed


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rooms", type=int, default=40, help="so many of each kind, or none")
    parser.add_argument("--seed", type=int, default=0, help="of the rooms")
    parser.add_argument("--only-rooms", action="store_true", help="nothing of how hard it takes")
    parser.add_argument("--legs", action="store_true", help="only how near legs come, and how fast feet go")
    given = parser.parse_args()
    body, somebody = Physique(), person()
    if given.legs:
        found = pushes(somebody)
        print("\n".join(told(found, speed) for speed in SPEEDS))
        return
    if given.rooms > 0:
        report(somebody, given.seed, given.rooms)
    if given.only_rooms:
        return
    struck = somebody.parts["struck"]
    for wish in ((0.0, 0.0, 0.0), (1.2, 0.0, 0.0), (3.0, 0.0, 0.0)):
        states, walked, state = [], [], somebody.start()
        for n in range(150 + 5 * PHASES):
            state, _ = somebody.step(state, Intent(np.array(wish)), 1.0 / 60.0)
            if n >= 150 and n % 5 == 0 or n == 149:
                states.append(somebody.active(state)[1])
                walked.append(state)
        states, walked = (states[:1], walked[:1]) if not wish[0] else (states, walked)
        print(f"{'standing' if not wish[0] else f'at {wish[0]:g} m/s, {len(states)} moments'}, {body.mass:g} kg:")
        for name, way in WAYS.items():
            taken = [[somebody.parts["locomotion"].pushed(one, struck.gain(Strike(tuple(hard * np.array(way))))) is not None for hard in HARD] for one in states]
            most = [int(np.argmin(row)) for row in taken]  # the first that is not
            if min(most) > 0:
                ways = [_goes_on(somebody, one, wish, HARD[k - 1] * np.array(way)) for one, k in zip(walked, most)]
                err, late, slid, unpushed = np.max(ways, 0)
                print(f"  {name}: taken in stride up to {HARD[min(most) - 1] / body.mass:.2f} m/s, where the ground frame's speed is off v + J/m by {err:.3f} m/s after a step and within "
                      f"{BACK:g} m/s of the wish after {late:.2f} s; soles slide {slid:.2f} m/s at most, unpushed {unpushed:.2f}")
            made = [[struck.recovery(one, Intent(np.array(wish)), Strike(tuple(hard * np.array(way)))) for hard in HARD] for one in states]
            steps, falls = ([HARD[next((k for k, one in enumerate(row) if one.fate >= fate and not known[k]), -1)] / body.mass for row, known in zip(made, taken)] for fate in (STEPS, FALLS))
            kept = [np.abs(one.velocities[0][[0, 2]] - one.velocities[1][[0, 2]]).max() for row in made for one in row]
            slides, low, under = [], [], []
            for one in (one for row in made for one in row[::4]):
                placed = forward_kinematics(body.skeleton, one.roots, one.local)
                points = contact_points(body.skeleton, *placed)
                flow = np.linalg.norm(np.diff(points[..., [0, 2]], axis=0), axis=-1) / np.diff(one.times)[:, None]
                if one.fate < FALLS:
                    slides.append(float(np.where(one.contacts[1:] & one.contacts[:-1], flow, 0.0).max()))
                    low.append(float(points[..., 1].min()) - body.tables.sole)
                else:
                    under.append(float(places(body, *placed)[1].min()))
                    centre = centre_of_mass(body.anatomy, *placed)
                    assert np.isfinite(centre).all()
            print(f"  {name}: steps from {np.median(steps):.2f} m/s, falls from {np.min(falls):.2f} (median {np.median(falls):.2f}) m/s; soles slide {max(slides, default=0.0):.3f} m/s at most, "
                  f"{1e3 * min(low, default=0.0):.1f} mm below the floor, in falls {1e3 * min(under, default=0.0):.2f} mm; "
                  f"speed changes by {max(kept):.3f} m/s in the first 1/120 s")


if __name__ == "__main__":
    main()
