"""Measure how near walls come to who walks and runs at them, how hard he brakes, and what becomes of his legs.

    python scripts/measure/walls.py [--walls METRES ...] [--askew]

Somebody sets off from 2.0 … 2.4 m before a wall, and from 6 m, so that runners are as fast as they were told. Told: his wish heeds the wall, as scripts' and keys' do.
Untold: only the walk itself holds him up, as who imports it without heeding anything. Each figure is the worst of all distances: how far his middle is from the wall's face at
least, negative inside; how far at rest; how fast he was at most; how hard he brakes at most, over 1/10 s.

--askew: bodies of three sizes go at a long wall, and at the end of one, turned from along it by some angles, and go on wishing so for 200 steps: how near to each other the axes of their
legs come, in how many of the ways nearer than 6 cm, how deep a joint of a leg gets into the wall, and the hardest acceleration of a joint.
"""

from __future__ import annotations

import argparse

import numpy as np

from _limbs import legs_apart
from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Intent
from gambol.controllers.jump import Physique
from gambol.controllers.navigation import gap
from gambol.controllers.person import person
from gambol.game.scene import Box
from gambol.game.world import stopped

SPEEDS, DISTANCES, SECONDS = (0.7, 1.0, 1.4, 1.8, 2.5, 3.5, 4.2), (2.0, 2.1, 2.2, 2.3, 2.4, 6.0), 10.0

HEIGHTS, ANGLES, PACES, STEPS, NEAR = (1.3, 1.741, 2.0), (10, 25, 40, 55, 70, 85), (0.8, 1.4, 2.6), 200, 0.06
WAYS = ((Box((0.0, 1.0, 3.0), (8.0, 2.0, 0.3)), 0.0), (Box((1.5, 1.0, 3.0), (3.0, 2.0, 0.3)), -0.15), (Box((1.5, 1.0, 3.0), (3.0, 2.0, 0.3)), 0.1))
"""Walls, and where along them somebody would come to their face, from the middle of the first and the end of the others [m]."""


def approach(who, speed, far, thick, told):
    """How far (T,) somebody's middle is from a wall's face in every step; he wishes for a speed all the while."""
    state, wall, left = who.start(), (Box((0.0, 1.2, far + 0.5 * thick), (9.0, 2.4, thick)),), []
    for _ in range(round(60 * SECONDS)):
        intent = Intent(np.array([speed, 0.0, 0.0]), around=wall)
        state, _ = who.step(state, stopped(state, intent, wall) if told else intent, 1 / 60)
        left.append(far - float(state.ground[1]))
    return np.array(left)


def askew(who, wall, aside, angle, speed, told):
    """How near the axes of legs come to each other, how deep a joint of them gets into the wall [m], and the hardest acceleration of a joint [m/s²]."""
    heading = np.radians(90.0 - angle)
    state = who.start((aside - 1.6 * np.sin(heading), 2.7 - 1.6 * np.cos(heading), heading))
    legs, poses = [who.skeleton.index(side + part) for side in ("Left", "Right") for part in ("Leg", "Foot", "Toe")], []
    for _ in range(STEPS):
        intent = Intent(np.array([speed, 0.0, 0.0]), around=(wall,))
        state, pose = who.step(state, stopped(state, intent, (wall,)) if told else intent, 1 / 60)
        poses.append(pose)
    roots, rotations = np.stack([pose.root for pose in poses]), np.stack([pose.rotations for pose in poses])
    joints, _ = forward_kinematics(who.skeleton, roots, rotations)
    return (legs_apart(who.skeleton, roots, rotations).min(), -gap(joints[:, legs].reshape(-1, 3), wall).min(),
            np.linalg.norm(np.diff(joints, 2, axis=0), axis=-1).max() * 3600)


def legs_askew():
    """Print what becomes of legs beside walls that are come to askew."""
    print(f"{'angle':>6} {'told':>5} {'legs apart':>11} {'nearer':>8} {'inside':>9} {'joints':>11}")
    people, all_ = [person(physique=Physique(height=height)) for height in HEIGHTS], {True: [], False: []}
    for angle in (*ANGLES, None):
        for told in (True, False):
            found = all_[told] if angle is None else [askew(who, wall, aside, angle, speed, told) for who in people for wall, aside in WAYS for speed in PACES]
            all_[told] += [] if angle is None else found
            apart, inside, hard = np.array(found).T
            print(f"{'all' if angle is None else angle:>5}° {'yes' if told else 'no':>5} {100 * apart.min():8.1f} cm {(apart < NEAR).mean():8.1%} {100 * max(inside.max(), 0.0):6.1f} cm {hard.max():6.0f} m/s²",
                  flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--walls", nargs="+", type=float, default=[0.1, 1.5], help="how thick [m]")
    parser.add_argument("--askew", action="store_true", help="who comes to walls askew, and his legs")
    given, who = parser.parse_args(), person()
    if given.askew:
        return legs_askew()
    thicknesses = given.walls
    print(f"{'wall':>6} {'wished':>7} {'told':>5} {'nearest':>9} {'at rest':>9} {'fastest':>9} {'brakes':>8}")
    for thick in thicknesses:
        for speed in SPEEDS:
            for told in (True, False):
                ways = np.array([approach(who, speed, far, thick, told) for far in DISTANCES])
                pace = -np.diff(ways, axis=-1) * 60
                brakes = (pace[:, :-6] - pace[:, 6:]) * 10
                print(f"{thick:6.1f} {speed:7.1f} {'yes' if told else 'no':>5} {100 * ways.min():6.1f} cm {100 * ways[:, -1].min():6.1f} cm {pace.max():5.2f} m/s {brakes.max():4.1f} m/s²", flush=True)


if __name__ == "__main__":
    main()
