"""Play the whole game by random hands: walk, run, leap, be pushed, be sent to places, among what stands about; and look at the body in every step.

    python scripts/measure/hands.py [--minutes 4] [--seed 0] [--stage course yard rooms] [--pictures DIR]

Hands do what players do: head for a thing or away from it on eight keys or a stick, run or walk, tap and hold the leap's key, let go of all keys, step aside, turn on
the spot, click at places, push. Nothing is asked of the controllers but the final pose: how deep flesh is in things and in the ground, how far soles slide that
touch it, whether a body in the air is pushed by nothing, how hard joints are thrown, how near the axes of legs come to each other, by who moves the body, and about hand-overs. The worst moments are told by
their seconds; --pictures draws them, five a row, 0.2 s apart in all. The rooms are another one for each seed: walls, boxes, kerbs, ramps and pillars at random.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import islice
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np
from scipy.ndimage import minimum_filter1d

from _limbs import legs_apart
from gambol.controllers.body import anatomy, centre_of_mass, forward_kinematics
from gambol.controllers.navigation import gap
from gambol.controllers.person import person
from gambol.controllers.struck import flesh
from gambol.game.input import Wish
from gambol.game.scene import Box, Camera, Pillar, Prop, Scene
from gambol.game.session import Timeline, begin
from gambol.game.world import COURSE, DT, RATE, Character, World, figures

RISE, GOING = 0.17, 0.29
YARD: tuple[Prop, ...] = (
    *(Box((-3.0, 0.5 * RISE * (n + 1), 3.0 + GOING * n), (2.0, RISE * (n + 1), GOING)) for n in range(6)),
    Box((-3.0, 3.0 * RISE, 3.0 + 5.5 * GOING + 1.0), (2.0, 6 * RISE, 2.0)),
    Box((0.5, 0.06, 4.0), (2.0, 0.12, 2.0)), Box((3.2, 0.2, 3.0), (2.0, 0.4, 0.2)), Box((3.2, 0.15, 5.5), (1.2, 0.3, 1.2), 0.5),
    Pillar((1.5, 0.0, 1.5), 0.2, 2.2), Pillar((-0.8, 0.0, 2.6), 0.25, 2.2), Box((0.0, 1.0, 7.5), (4.0, 2.0, 0.2)), Box((5.2, 0.4, 6.0), (1.5, 0.8, 2.5)))
"""Stairs to a platform, a kerb, a hurdle, low and high boxes, pillars, a wall."""
THINGS, WITHIN, APART, CLEAR = 24, 4.5, 0.45, 1.0
"""So many things are tried for a room, no farther from its middle on each side [m]; those that are so near to another, or to where somebody begins [m], are left out."""
CROSS = 0.04
"""Legs whose axes are nearer than this to each other [m] go through each other."""
WHO = "walks", "leaps", "is struck", "changes"
"""Who moves the body; "changes": within CHANGE of a hand-over."""
CHANGE = 0.1
NEAR, TOUCHES, ALOFT = 1.5, 0.006, 0.02
"""Things are looked at that are nearer to the pelvis than this; soles touch what is nearer, a body is in the air where nothing is nearer [m]."""
SLIDES, LASTS = 0.3, 4
"""A sole all of whose touching places are faster than this [m/s] for so many frames slides: a strike is shorter."""


def room(seed: int) -> tuple[Prop, ...]:
    """Walls, boxes, kerbs, ramps and pillars as a seed has them."""
    rng, found = np.random.default_rng(seed), []
    for _ in range(THINGS):
        kind, heading = rng.choice(["wall", "box", "kerb", "pillar", "ramp"], p=[0.25, 0.2, 0.2, 0.15, 0.2]), rng.uniform(-np.pi, np.pi)
        x, z = rng.uniform(-WITHIN, WITHIN, 2)
        if kind == "pillar":
            radius = rng.uniform(0.05, 0.4)
            thing, reach = Pillar((x, 0.0, z), radius, rng.uniform(0.5, 2.5)), radius
        else:
            wide, high, deep = {"wall": (rng.uniform(1.0, 4.0), 2.0, rng.uniform(0.08, 0.5)), "box": (*rng.uniform(0.4, 2.0, 2), rng.uniform(0.4, 2.0)),
                                "kerb": (rng.uniform(0.4, 2.5), rng.uniform(0.05, 0.2), rng.uniform(0.4, 2.5)), "ramp": (rng.uniform(1.0, 2.0), 1.0, rng.uniform(1.5, 3.0))}[kind]
            high, slope = (0.6 * high, 0.0) if kind == "box" else (high, rng.uniform(0.1, 0.3) if kind == "ramp" else 0.0)
            thing, reach = Box((x, 0.5 * high - (0.0 if not slope else 1.0 - 0.5 * slope * deep), z), (wide, high, deep), heading, slope=slope), 0.5 * float(np.hypot(wide, deep))
        if np.hypot(x, z) > reach + CLEAR and all(np.hypot(x - a, z - b) > reach + far + APART for _, a, b, far in found):
            found.append((thing, x, z, reach))
    return tuple(thing for thing, *_ in found)


STAGES = {"course": lambda seed: COURSE, "yard": lambda seed: YARD, "rooms": room}


def deeds(rng: np.random.Generator, things: Sequence[Prop]) -> Iterator[tuple[str, float, tuple[float, float], dict[str, Any]]]:
    """What hands do one after the other: its name, how long [s], the place that they look at (x, z) [m] and the rest of the wish."""
    solid = [thing for thing in things if isinstance(thing, (Box, Pillar))]
    while True:
        thing = solid[rng.integers(len(solid))]
        x, z = np.array(thing.centre if isinstance(thing, Box) else thing.foot)[[0, 2]] + rng.normal(0.0, 1.0, 2)
        run, keys = float(rng.choice([0.0, 0.0, 1.0, rng.uniform(0.0, 1.0)])), rng.random() < 0.6
        tilt = 1.0 if keys else float(rng.uniform(0.3, 1.0))
        on = dict(run=run, tilt=tilt, keys=keys)
        kind = rng.choice(["go", "leap", "stand leap", "rest", "away", "aside", "spot", "click", "push"], p=[0.34, 0.22, 0.06, 0.14, 0.08, 0.04, 0.04, 0.05, 0.03])
        yield from {
            "go": [("go", rng.uniform(0.3, 2.5), (x, z), on)],
            "leap": [("go", rng.uniform(0.3, 1.5), (x, z), on), ("leap", rng.uniform(0.05, 1.3), (x, z), on | dict(jump=True)), ("go", rng.uniform(0.0, 1.5), (x, z), on)],
            "stand leap": [("rest", rng.uniform(0.3, 1.2), (x, z), {}), ("leap", rng.uniform(0.1, 1.2), (x, z), dict(jump=True, tilt=float(rng.uniform(0.0, 1.0)))), ("rest", rng.uniform(0.2, 1.0), (x, z), {})],
            "rest": [("rest", rng.uniform(0.1, 1.5), (x, z), {})],
            "away": [("away", rng.uniform(0.2, 1.2), (x, z), on | dict(away=True))],
            "aside": [("aside", rng.uniform(0.3, 1.5), (x, z), on | dict(strafe=True))],
            "spot": [("spot", rng.uniform(0.2, 1.2), (x, z), dict(turn=float(rng.choice([-1.0, 1.0]))))],
            "click": [("click", rng.uniform(1.0, 5.0), (x, z), dict(pressed=(f"goto={x:.2f}/{z:.2f}",)))],
            "push": [("push", rng.uniform(0.8, 3.0), (x, z), on | dict(pressed=("push",)))],
        }[kind]


def wished(state: Any, yaw: float, place: tuple[float, float], first: bool, *, run: float = 0.0, tilt: float = 0.0, keys: bool = True, away: bool = False,
           jump: bool = False, strafe: bool = False, turn: float = 0.0, pressed: tuple[str, ...] = ()) -> Wish:
    """The hands at one moment; directions are the camera's."""
    move = (0.0, 0.0)
    if tilt and not (pressed and pressed[0].startswith("goto")):
        x, z = (np.array(place) - state.ground[:2]) * (-1.0 if away else 1.0)
        angle = float(np.arctan2(x, z)) - yaw  # positive to the left of the camera
        angle = round(angle / (np.pi / 4)) * np.pi / 4 if keys else angle
        move = (-tilt * np.sin(angle), tilt * np.cos(angle))
    return Wish(move=move, run=run, jump=jump, strafe=strafe, turn=turn, pressed=pressed if first else ()).rounded()


def playing(who: Any, stage: Sequence[Prop], seed: int) -> Iterator[tuple[Any, str]]:
    """The state of a person before each step of play, without end, and what hands do in it. A step is made as the next is asked for."""
    rng, line = np.random.default_rng(seed), Timeline(begin(World((Character("A", who, who.start()),), tuple(stage)), 1))
    for name, lasts, place, how in deeds(rng, stage):
        for tick in range(max(1, round(lasts / DT))):
            state = line.now.after.characters[0].state
            yield state, name
            line.advance((wished(state, line.now.players[0].camera.yaw, place, tick == 0, **how),))


def played(stage: Sequence[Prop], seed: int, steps: int) -> tuple[Any, list[Any], list[str]]:
    """A person, the states after so many steps of play, and what hands did in each."""
    who = person()
    states, did = zip(*islice(playing(who, stage, seed), steps))
    return who, list(states), list(did)


@dataclass(frozen=True, eq=False)
class Body:
    """What is told of T states of somebody among things."""

    who: Any
    states: Sequence[Any]
    things: Sequence[Prop]

    @cached_property
    def placed(self) -> tuple[np.ndarray, np.ndarray]:
        """Joints (T, J, 3) [m], and how they are turned."""
        return forward_kinematics(self.who.skeleton, np.stack([np.asarray(s.pose.root, float) for s in self.states]), np.stack([np.asarray(s.pose.rotations, float) for s in self.states]))

    @cached_property
    def flesh(self) -> tuple[np.ndarray, np.ndarray]:
        """Places (T, P, 3) on the body, and how far (T, P) their skin is from things and the ground [m], negative inside."""
        points, thick = flesh(self.who.parts["jump"].physique, *self.placed)
        away = points[..., 1].copy()
        for thing in self.things:
            if isinstance(thing, (Box, Pillar)):
                near = gap(np.ascontiguousarray(points[:, 0]), thing) < NEAR
                away[near] = np.minimum(away[near], gap(points[near].reshape(-1, 3), thing).reshape(-1, points.shape[1]))
        return points, away - thick

    @cached_property
    def moved_by(self) -> np.ndarray:
        """Who moves the body (T,), an index of WHO."""
        names = {"locomotion": 0, "jump": 1, "struck": 2}
        active = np.array([names.get(s.active, 0) for s in self.states])
        changes = np.flatnonzero(np.diff(active)) + 1
        wide = round(CHANGE / DT)
        for k in changes:
            active[max(k - wide, 0):k + wide] = 3
        return active

    @cached_property
    def pulls(self) -> np.ndarray:
        """How hard (T, J) joints are accelerated, over 1/30 s [m/s²]."""
        return np.linalg.norm(_second(self.placed[0]), axis=-1)

    @cached_property
    def legs(self) -> np.ndarray:
        """How far (T,) the axes of both legs are apart [m]."""
        return legs_apart(self.who.skeleton, [s.pose.root for s in self.states], [s.pose.rotations for s in self.states])

    @cached_property
    def unsupported(self) -> np.ndarray:
        """What pushes (T,) a mass centre of whom nothing touches [m/s²]."""
        free = (self.flesh[1].min(1) > ALOFT).astype(int)
        free = np.convolve(free, np.ones(7, int), "same") == 7
        com = centre_of_mass(anatomy(self.who.skeleton), *self.placed)
        return free * np.linalg.norm(_second(com) + [0.0, 9.81, 0.0], axis=-1)

    @cached_property
    def slides(self) -> np.ndarray:
        """How fast (T, 2) soles slide [m/s]: the slowest of their places that touch, over LASTS frames, 0 where none does."""
        points, away = self.flesh[0][:, -6:].reshape(-1, 2, 3, 3), self.flesh[1][:, -6:].reshape(-1, 2, 3)
        speed = np.linalg.norm(np.diff(points, axis=0, append=points[-1:]), axis=-1) / DT
        touches = (away < TOUCHES) & (np.roll(away, -1, 0) < TOUCHES)
        slow = np.where(touches, speed, np.inf).min(-1)
        return minimum_filter1d(np.where(np.isfinite(slow), slow, 0.0), LASTS, axis=0)


def _second(x: np.ndarray) -> np.ndarray:
    out = np.zeros_like(x)
    out[2:-2] = (x[4:] - 2.0 * x[2:-2] + x[:-4]) * (0.5 * RATE) ** 2
    return out


def worst(values: np.ndarray, count: int) -> list[int]:
    """The moments of the greatest values (T,), at least a second apart."""
    values, found = values.copy(), []
    for _ in range(count):
        k = int(values.argmax())
        if values[k] <= 0.0:
            break
        found.append(k)
        values[max(k - RATE, 0):k + RATE] = 0.0
    return found


def report(body: Body, did: Sequence[str]) -> dict[str, list[tuple[int, float]]]:
    """Print the figures; the worst moments of each kind with their values."""
    away, moved, pulls = body.flesh[1], body.moved_by, body.pulls.max(1)
    deep, slides = -100.0 * away.min(1), body.slides.max(1)
    finite = all(np.isfinite(part).all() for part in body.placed)
    print(f"  {len(moved) * DT / 60:.1f} minutes, {np.mean([s.active == 'jump' for s in body.states]):.0%} in leaps, {np.mean([s.active == 'struck' for s in body.states]):.0%} struck; "
          f"poses {'all finite' if finite else 'NOT FINITE'}")
    for k, name in enumerate(WHO):
        now = moved == k
        if now.any():
            print(f"    {name:10} {now.mean():4.0%}: flesh in things > 2 cm {np.mean(deep[now] > 2.0):6.2%}, > 5 cm {np.mean(deep[now] > 5.0):6.2%}, worst {deep[now].max():4.1f} cm · "
                  f"soles slide {np.mean(slides[now] > SLIDES):5.2%} · joints {np.percentile(pulls[now], 99):.0f} m/s² (99 %), {np.percentile(pulls[now], 99.9):.0f} (99.9 %), worst {pulls[now].max():.0f} · "
                  f"legs nearer than {100 * CROSS:g} cm {np.mean(body.legs[now] < CROSS):5.2%}, at least {100 * body.legs[now].min():.1f} cm · "
                  f"pushed in the air by > 2 m/s² {np.mean(body.unsupported[now] > 2.0):5.2%}, worst {body.unsupported[now].max():.0f}")
    kinds = {"flesh in things [cm]": deep, "soles slide [m/s]": slides, "joints thrown [m/s²]": pulls, "legs in each other [cm]": 100.0 * (CROSS - body.legs), "pushed by nothing [m/s²]": body.unsupported}
    found = {}
    for kind, values in kinds.items():
        found[kind] = [(k, float(values[k])) for k in worst(values, 6)]
        print(f"    {kind}: " + ", ".join(f"{value:.3g} at {k * DT:.2f} s ({body.states[k].active}, {did[k]})" for k, value in found[kind]))
    return found


def seen_from(body: Body, k: int) -> np.ndarray:
    """From where (3,) [m] off its hips a body is seen in a moment, most of it past whatever stands about: from its side if that can be."""
    joints, heading = body.placed[0][k], float(body.states[k].ground[2])
    sights = []
    for turned in heading + np.pi * np.array([0.5, -0.5, 0.25, -0.25, 0.75, -0.75, 0.0, 1.0]):
        eye = np.array([2.6 * np.sin(turned), 0.5, 2.6 * np.cos(turned)])
        way = (joints[:, None] + np.linspace(0.05, 1.0, 30)[:, None] * (joints[0] + eye - joints)[:, None]).reshape(-1, 3)
        hidden = sum(((gap(way, thing) < 0.0).reshape(len(joints), -1).any(1) for thing in body.things), np.zeros(len(joints), int)) > 0
        sights.append((hidden.sum(), len(sights), eye))
    return min(sights, key=lambda one: one[:2])[2]


def draw(body: Body, found: dict[str, list[tuple[int, float]]], folder: Path) -> None:
    """The worst moments, a row of five pictures each."""
    from PIL import Image

    from gambol.game.hosts import Offscreen
    with Offscreen((320, 240), "fast") as stage:
        for kind, moments in found.items():
            rows = []
            for k, _ in moments:
                eye, row = seen_from(body, k), []
                for frame in np.clip(k + np.arange(-6, 7, 3), 0, len(body.states) - 1):
                    now = Character("A", body.who, body.states[frame])
                    world = World((now,), tuple(body.things))
                    hips = body.placed[0][frame, 0]
                    view = Camera(hips + eye, hips)
                    row.append(stage.frame(Scene(view, figures(world, world, 0.0), tuple(body.things)))[..., :3].copy())
                rows.append(np.concatenate(row, 1))
            if rows:
                Image.fromarray(np.concatenate(rows)).save(folder / f"{kind.split(' [')[0].replace(' ', '_')}.png")


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--minutes", type=float, default=4.0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--stage", nargs="+", choices=list(STAGES), default=list(STAGES))
    parser.add_argument("--pictures", type=Path)
    asked = parser.parse_args()
    for name in asked.stage:
        print(f"On the {name}, seed {asked.seed}:", flush=True)
        things = STAGES[name](asked.seed)
        who, states, did = played(things, asked.seed, round(60 * RATE * asked.minutes))
        body = Body(who, states, things)
        found = report(body, did)
        if asked.pictures is not None:
            (asked.pictures / name).mkdir(parents=True, exist_ok=True)
            draw(body, found, asked.pictures / name)


if __name__ == "__main__":
    main()
