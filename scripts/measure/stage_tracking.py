"""Measure who is tracked on the stage: how far joints of the scenario `tracked` are from the performer's, with arms drawn to how people carry them, or not.

    python scripts/measure/stage_tracking.py [--seed 0] [--carriage 100]

Angles are geodesic, of orientations in the world; lost is what is off by more than 60°.
"""

from __future__ import annotations

import argparse
from dataclasses import replace

import numpy as np

from gambol.controllers.person import person
from gambol.game.scenario import film, load
from gambol.game.world import RATE, World

SHOWN = 8
ARMS = ("LeftForeArm", "LeftHand", "RightForeArm", "RightHand")


def set_to(world: World, carriage: float) -> World:
    """The world with its trackers' `carriage` as given."""
    made = []
    for one in world.characters:
        if one.watches is not None:
            tracking = one.controller.parts["tracking"]
            one.controller.parts = {**one.controller.parts, "tracking": tracking.tuned(replace(tracking.settings, carriage=carriage))}
        made.append(one)
    return replace(world, characters=tuple(made))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=0, help="of what goes wrong in the silhouettes")
    parser.add_argument("--carriage", type=float, default=100.0, help="1/σ² [1/rad²]; 0 for none")
    args = parser.parse_args()
    scenario = load("tracked")
    actors = [one if one.tracks is None else one.model_copy(update={"tracks": one.tracks.model_copy(update={"seed": args.seed})})
              for one in scenario.actors if one.follows is None]
    scenario = scenario.model_copy(update={"actors": tuple(actors)})
    turns, metres, skeleton = [], [], None
    for number, world in zip(range(round(scenario.duration * RATE)), film.worlds(scenario, person())):
        if number == 0:
            set_to(world, args.carriage)  # in place: the run goes on with these controllers
        performer, tracked = world.characters
        assert tracked.watches is not None
        skeleton, one, other = tracked.controller.skeleton, performer.joints, tracked.joints
        metres.append(np.linalg.norm(other[0] - one[0] - tracked.watches.beside, axis=-1))
        cosines = (np.einsum("jab,jab->j", one[1], other[1]) - 1) / 2
        turns.append(np.degrees(np.arccos(np.clip(cosines, -1, 1))))
    assert skeleton is not None
    away, off = np.array(turns), 100 * np.array(metres)
    arms = [skeleton.index(name) for name in ARMS]
    print(f"seed {args.seed}, carriage {args.carriage:g}: {away.mean():.1f}°, {off.mean():.1f} cm; forearms and hands {away[:, arms].mean():.1f}°, "
          f"{off[:, arms].mean():.1f} cm (worst {off[:, arms].max():.0f}), lost in {100 * (away[:, arms] > 60).mean():.1f} % of the time")
    for j in np.argsort(-away.mean(0))[:SHOWN]:
        print(f"  {skeleton.names[j]:14} {away[:, j].mean():5.1f}° (worst {away[:, j].max():3.0f}) {off[:, j].mean():5.1f} cm (worst {off[:, j].max():.0f})")


if __name__ == "__main__":
    main()
