"""Measure crowds that avoid each other: collisions, who gets stuck, how fast it runs; beside them one pair that crosses.

    python scripts/measure/crowd.py [--people 50] [--seconds 60] [--seed 0] [--only SCENE] [--plots DIR]

Bodies are capsules of 0.22 m about the ground frame, looked at after every step. Beside them real limbs: thighs, shins, feet, arms and
trunk of every two people who are near each other, as capsules about their bones. Stuck is who got nowhere for the last ten seconds, and had not
arrived. Rates are of one core: avoidance, ways and the step of the whole crowd.
"""

from __future__ import annotations

import argparse
import os
import time
from pathlib import Path
from typing import NamedTuple

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("NUMBA_NUM_THREADS", "1")
import numpy as np

from _crowds import SCENES, Scene, facing
from _limbs import limb_depths
from _plots import pictures, pyplot

from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation import is_box
from gambol.controllers.navigation.crowd import aims, crowd_intent, crowd_turns
from gambol.controllers.navigation.routes import distance, shapes_of

RATE = 60
BODY = 0.22
"""A body's capsule has this radius [m]."""
ARRIVED = 0.5
"""Who is as near to his goal gets the next one [m]."""
LOOKED = 20
"""Everybody looks for his way once in so many steps."""


class Walked(NamedTuple):
    """trails: (T, N, 3). speeds: (N,) wished. touched: how many pairs' capsules overlapped in a frame, summed; deepest [m]. limbs: likewise, and legs and trunks without arms. walls: (T, N)
    how far capsules were from what stands there [m]. arrivals: (N,). stuck: (N,) bool. rate: steps a second."""

    trails: np.ndarray
    speeds: np.ndarray
    touched: int
    deepest: float
    limbs: int
    limbs_deepest: float
    legs: int
    legs_deepest: float
    walls: float
    arrivals: np.ndarray
    stuck: np.ndarray
    rate: float


def walked(walker: Locomotion, scene: Scene, seconds: float, rng, speeds=None) -> Walked:
    """A crowd walks through a scene."""
    count, steps = len(scene.start), round(RATE * seconds)
    speeds = np.clip(rng.normal(1.25, 0.15, count), 0.9, 1.55) if speeds is None else speeds
    arrivals, done = np.zeros(count, int), np.zeros(count, bool)
    goals = np.array([scene.goal(who, 0, rng) for who in range(count)])
    state, aim, turns = walker.start(scene.start), goals.copy(), None
    trails, spent = np.empty((steps, count, 3)), 0.0
    touched = limbs = legs = 0
    deepest = limbs_deepest = legs_deepest = 0.0
    for step in range(steps):
        for who in np.flatnonzero((np.linalg.norm(state.ground[:, :2] - goals, axis=1) < ARRIVED) & ~done):
            arrivals[who] += 1
            following = scene.goal(who, arrivals[who], rng)
            done[who] = following is None
            if following is not None:
                goals[who] = following
                aim[who] = aims(state.ground[who:who + 1, :2], goals[who:who + 1], scene.around)[0]
        begun = time.process_time()
        looks = np.arange(step % LOOKED, count, LOOKED)
        aim[looks] = aims(state.ground[looks, :2], goals[looks], scene.around)
        far = np.linalg.norm(aim - state.ground[:, :2], axis=1)
        turn = (np.abs(aim - goals).max(1) > 1e-6) & (far > 1e-6)  # nobody slows down for a corner
        lead = state.ground[:, :2] + (aim - state.ground[:, :2]) * np.where(turn, np.maximum(1.0 / np.maximum(far, 1e-6), 1.0), 1.0)[:, None]
        turns = crowd_turns(state.ground, state.velocity, lead, speeds, scene.around, turns, 1 / RATE)
        intent = crowd_intent(state.ground, state.velocity, lead, speeds, BODY, scene.around, turns=turns)
        state, pose = walker.step(state, intent, 1 / RATE)
        spent += time.process_time() - begun
        trails[step] = state.ground
        pairs, gaps = near_pairs(state.ground[:, :2], 1.2)
        over = 2 * BODY - gaps
        touched += int((over > 0).sum())
        deepest = max(deepest, float(over.max(initial=0.0)))
        if step % 3 == 0 and len(pairs):
            depth = limb_depths(walker.skeleton, pose, pairs)
            limbs, limbs_deepest = limbs + int((depth > 0).sum()), max(limbs_deepest, float(depth.max()))
            depth = limb_depths(walker.skeleton, pose, pairs, arms=False)
            legs, legs_deepest = legs + int((depth > 0).sum()), max(legs_deepest, float(depth.max()))
    late = trails[-min(10 * RATE, steps):]
    moved = np.linalg.norm(late[:, :, :2] - late[:1, :, :2], axis=-1).max(0)
    return Walked(trails, speeds, touched, deepest, limbs, limbs_deepest, legs, legs_deepest, nearest_wall(trails, scene.around), arrivals,
                  (moved < 0.5) & ~done, steps / spent)


def waits(trails: np.ndarray) -> str:
    """Who waits for whom at a door at z = 0, in words: for each side, how long nobody of it passed at most while some of it stood within 3 m of the
    door, and how many of the other side passed meanwhile."""
    sides, told = np.sign(trails[:, :, 1]), []
    passes = [(int(t), float(sides[t, who])) for who in range(trails.shape[1]) for t in np.flatnonzero(np.diff(sides[:, who]))[:1]]
    for side in (-1.0, 1.0):
        mine = sides[0] == side
        there = np.any((sides[:, mine] == side) & (np.hypot(trails[:, mine, 0], trails[:, mine, 1]) < 3.0), 1)
        longest, most, since, others = 0, 0, 0, 0
        own, theirs = ([t for t, from_ in passes if from_ == s] for s in (side, -side))
        for t in range(len(trails)):
            if t in own or not there[t]:
                since, others = 0, 0
            else:
                since, others = since + 1, others + theirs.count(t)
            longest, most = max(longest, since), max(most, others)
        told.append(f"{longest / RATE:.1f} s, {most} others")
    return "; ".join(told)


def near_pairs(places, within: float) -> tuple[np.ndarray, np.ndarray]:
    """Pairs (P, 2) nearer than `within` [m], and how near (P,) they are."""
    gaps = np.linalg.norm(places[:, None] - places[None], axis=-1)
    pairs = np.argwhere(np.triu(gaps < within, 1))
    return pairs, gaps[pairs[:, 0], pairs[:, 1]]


def nearest_wall(trails, around) -> float:
    """How near any capsule came to what stands there [m], below 0 in it."""
    shapes, out = shapes_of(around), np.empty(3)
    places = trails[::6, :, :2].reshape(-1, 2)
    return min((distance(x, z, shape, out) for shape in shapes for x, z in places), default=np.inf) - BODY


def pair(walker: Locomotion, angle: float, late: float, rng) -> None:
    """Two people whose ways cross at an angle [degrees], one of them `late` [s] at the crossing: told in a line."""
    turn, speed, far = np.radians(angle), 1.25, 5.0
    way = np.array([[0.0, 1.0], [np.sin(turn), np.cos(turn)]])
    start = -way * np.array([[far], [far + late * speed]])
    ends = 8.0 * way
    scene = Scene(facing(start, ends), lambda who, number, rng: ends[who] if number == 0 else None, [])
    made = walked(walker, scene, 11.0, rng, np.array([speed, speed]))
    places = made.trails[:, :, :2]
    gap = np.linalg.norm(places[:, 0] - places[:, 1], axis=-1)
    speeds = np.linalg.norm(np.diff(places, axis=0), axis=-1)[60:300] * RATE
    aside = np.array([np.abs(places[:300, who] @ np.array([way[who, 1], -way[who, 0]])).max() for who in (0, 1)])
    first = [int(np.argmax(places[:, who] @ way[who] > 0.0)) for who in (0, 1)]
    print(f"  {angle:.0f}°, {late:.1f} s late: nearest {gap.min():.2f} m; slowest {speeds[:, 0].min():.2f} and {speeds[:, 1].min():.2f} m/s; aside "
          f"{100 * aside[0]:.0f} and {100 * aside[1]:.0f} cm; {'the late one gives way' if first[0] < first[1] else 'the early one gives way'}")


def drawn(folder: Path, name: str, scene: Scene, made: Walked) -> None:
    """The trails as a picture."""
    plt = pyplot()
    figure, axes = plt.subplots(figsize=(8, 8))
    for who in range(made.trails.shape[1]):
        axes.plot(made.trails[::6, who, 0], made.trails[::6, who, 1], lw=0.8, alpha=0.8)
        axes.plot(*made.trails[-1, who, :2], "o", ms=4, color="red" if made.stuck[who] else "black")
    for thing in scene.around:
        if is_box(thing):
            axes.add_patch(plt.Rectangle((thing.centre[0] - thing.size[0] / 2, thing.centre[2] - thing.size[2] / 2), thing.size[0], thing.size[2], color="grey"))
        else:
            axes.add_patch(plt.Circle((thing.foot[0], thing.foot[2]), thing.radius, color="grey"))
    axes.set_aspect("equal")
    axes.invert_xaxis()  # +X is left
    axes.set_title(name)
    figure.savefig(folder / f"crowd_{name}.png")
    plt.close(figure)


def main() -> None:
    """Measure what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--people", type=int, default=50)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", choices=[*SCENES, "pairs"])
    parser.add_argument("--plots", type=Path)
    asked = parser.parse_args()
    pictures(parser, asked.plots)
    walker = Locomotion.load()
    if asked.only in (None, "pairs"):
        print("two people whose ways cross, both at 1.25 m/s (recorded: none; the cross_walk clips hold one person each, who side-steps):")
        for angle in (45.0, 90.0, 135.0, 180.0):
            for late in (0.0, 0.3, 0.6):
                pair(walker, angle, late, np.random.default_rng(asked.seed))
    for name, build in SCENES.items():
        if asked.only in (None, name):
            rng = np.random.default_rng(asked.seed)
            scene = build(asked.people, rng)
            made = walked(walker, scene, asked.seconds, rng)
            speed = np.linalg.norm(np.diff(made.trails[:, :, :2], axis=0), axis=-1) * RATE
            print(f"{name}: {made.touched} frames of two capsules in each other, deepest {100 * made.deepest:.1f} cm; limbs {made.limbs} of each third frame, deepest "
                  f"{100 * made.limbs_deepest:.1f} cm, without arms {made.legs}, {100 * max(made.legs_deepest, 0.0):.1f} cm; walls {100 * made.walls:.1f} cm away; arrivals {made.arrivals.sum()}, never {(made.arrivals == 0).sum()}; "
                  f"stuck {made.stuck.sum()}; mean speed {speed.mean():.2f} of {made.speeds.mean():.2f} m/s; {made.rate:.0f} Hz", flush=True)
            if name == "two_ways":
                print(f"  longest wait of each side, and who passed meanwhile: {waits(made.trails)}")
            if asked.plots:
                drawn(asked.plots, name, scene, made)


if __name__ == "__main__":
    main()
