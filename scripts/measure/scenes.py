"""Play random scenes in which hands let go on ground that is not flat, before edges and before walls, and look at the body in every step.

    python scripts/measure/scenes.py [--count 60] [--seed 0] [--only KIND [SEED ...]] [--strips FOLDER]

Ramp: walk or run down, up or across a slope of 4 to 18°. Edge: the same on a box, its edges ahead, askew and beside. Onto: run at a box, leap onto it. Wall: leap to a place right
before a wall. Stairs: run up a flight to its landing. Each lets go of all keys at a random moment, some of the run key first. Everything is told of the final pose, from when he lets go, or lands,
on. Air: a foot that is still [s] over nothing. Half: one that is still and stands on its heel or its tip alone. Tips: off balance, his mass centre beside all that touches the ground, as he hardly moves.
Slides: how fast a sole does that touches, at least for 1/15 s; free: how fast the foot beside it goes, at most. Mass: its horizontal acceleration, over 1/30 s, and up or down; hips the same. Deep: soles and hands in what stands there.
Each figure: the median of all scenes, the worst, and the seeds of the worst three; --only plays some, --strips draws what is worst of each figure.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np
from scipy.ndimage import binary_opening

from hands import Body, draw

from gambol.controllers.body import anatomy, centre_of_mass, hull, margin
from gambol.controllers.navigation import floor_at, gap
from gambol.controllers.person import person
from gambol.controllers.struck import flesh_of
from gambol.game.input import AHEAD, Wish
from gambol.game.scene import Box, Pillar, Prop
from gambol.game.session import Timeline, begin
from gambol.game.world import DT, RATE, Character, World

AFTER = 3.0
"""So long it is looked on after hands have let go [s]."""
OVER, TOUCHES, STILL = 0.03, 0.012, 0.15
"""A point of a sole stands on nothing that is farther over the ground than the first, touches it where it is nearer than the second [m]; a foot is still that is slower than the third [m/s]."""
SLOW, BESIDE = 0.15, 0.06
"""Who is slower than the first [m/s] is off balance whose mass centre is farther than the second [m] beside what he stands on."""
ALONG = 21
"""A sole is looked at in so many places from its heel to its tip."""
LASTS = 3
"""What lasts for fewer frames than so many is not told."""
FIGURES = ("air [s]", "half [s]", "tips [s]", "slides [m/s]", "free [m/s]", "mass level [m/s²]", "mass up [m/s²]", "hips [m/s²]", "soles deep [cm]", "hands deep [cm]")


class Scene(NamedTuple):
    """What stands about, how far along z [m] somebody begins, what he asks for until he lets go, and when he does: a time [s] and a place along z [m], whichever is first.
    walks: he lets go of the run key so much sooner [s]. leaps: the ring is let go once it is beyond this place along z [m]; presses: the leap's key is held from when the ring would be beyond
    this one, 99 for a tap. later: hands let go of all so much later [s]."""

    things: tuple[Prop, ...]
    begins: float = 0.0
    move: tuple[float, float] = (0.0, 1.0)
    run: float = 1.0
    time: float = 9.0
    place: float = 99.0
    walks: float = 0.0
    leaps: float = 99.0
    later: float = 0.0
    presses: float = 99.0


def _pace(rng: np.random.Generator) -> dict[str, Any]:
    """How hands go: keys, or a stick a little aside; runs, walks, or between."""
    aside = rng.choice([0.0, 0.0, rng.normal(0.0, 0.25)])
    return dict(move=(float(np.sin(aside)), float(np.cos(aside))), run=float(rng.choice([0.0, 1.0, 1.0, 1.0, rng.uniform()])), walks=float(rng.choice([0.0, 0.0, rng.uniform(0.05, 0.5)])))


def ramp(rng: np.random.Generator) -> Scene:
    """A slope that is far too long to be left, and falls any way."""
    slope, heading = np.tan(np.radians(rng.uniform(4.0, 18.0))), rng.choice([0.0, np.pi, np.pi, 0.5 * np.pi, rng.uniform(-np.pi, np.pi)])
    return Scene((Box((0.0, 20.0 * slope, 0.0), (40.0, 1.0, 40.0), heading, slope=slope),), time=rng.uniform(1.2, 3.2), **_pace(rng))


def edge(rng: np.random.Generator) -> Scene:
    """A box whose far edge is come to, straight or askew, some of them narrow."""
    high, wide, heading, far = rng.uniform(0.3, 1.6), rng.choice([1.0, 2.0, 6.0]), rng.choice([0.0, rng.uniform(-0.6, 0.6)]), rng.uniform(2.5, 5.5)
    box = Box((0.0, 0.5 * high, 0.0), (wide, high, 2.0 * far), heading)
    return Scene((box,), -far + 0.6, place=far - rng.uniform(-0.1, 1.6), **_pace(rng))


def onto(rng: np.random.Generator) -> Scene:
    """A box that is leapt onto at a run: the key is pressed as the ring comes to its edge, held, where he stops before it, too, and let go well on it; hands let go then, or a little later."""
    deep, high, far = rng.uniform(0.6, 2.0), rng.uniform(0.2, 0.6), 4.5 + rng.uniform(0.0, 1.4)
    box = Box((0.0, 0.5 * high, far + 0.5 * deep), (2.0, high, deep))
    return Scene((box,), run=rng.uniform(0.3, 1.0), leaps=far + rng.uniform(0.15, max(deep - 0.2, 0.2)), later=rng.choice([0.0, 0.2, 0.4, 0.6]),
                 presses=far + rng.uniform(-0.6, 0.2))


def wall(rng: np.random.Generator) -> Scene:
    """A wall that somebody leaps to right before, and goes on at it or lets go; at times askew."""
    far, heading = rng.uniform(3.0, 5.0), rng.choice([0.0, 0.0, rng.uniform(-0.5, 0.5)])
    return Scene((Box((0.0, 1.2, far + 0.15), (6.0, 2.4, 0.3), heading),), run=rng.choice([0.0, 0.5, 1.0]), leaps=far - rng.uniform(0.2, 1.0), later=rng.choice([0.0, 0.3, 0.8, 2.0]))


def stairs(rng: np.random.Generator) -> Scene:
    """A flight of stairs and its landing, run up."""
    count, rise, tread = int(rng.integers(3, 12)), rng.uniform(0.12, 0.2), rng.uniform(0.25, 0.35)
    steps = [Box((0.0, 0.5 * rise * (k + 1), 2.0 + tread * (k + 0.5)), (2.4, rise * (k + 1), tread)) for k in range(count)]
    landing = Box((0.0, 0.5 * rise * count, 2.0 + tread * count + 2.0), (2.4, rise * count, 4.0))
    return Scene((*steps, landing), -1.0 - rng.uniform(0.0, 1.4), place=2.0 + tread * rng.uniform(-1.0, count + 2.0), run=float(rng.choice([1.0, 1.0, rng.uniform()])))


KINDS: dict[str, Callable[[np.random.Generator], Scene]] = {one.__name__: one for one in (ramp, edge, onto, wall, stairs)}


def played(scene: Scene, who: Any) -> tuple[list[Any], int]:
    """All states of a scene, and in which of them hands let go."""
    start = who.start((0.0, scene.begins, 0.0), floor_at(0.0, scene.begins, scene.things))
    line, states, gone, held, pressed = Timeline(begin(World((Character("A", who, start),), scene.things), 1)), [], 0, False, 0
    while len(states) < 12 * RATE and (not gone or len(states) < gone + AFTER * RATE):
        state, aim, now = line.now.after.characters[0].state, line.now.players[0].aim, len(states) * DT
        states.append(state)
        ring = float(state.ground[1]) + (aim.offset[1] if aim.aiming else AHEAD[0] + AHEAD[1] * float(state.velocity[0]))
        if pressed or ring > scene.leaps or aim.spent:
            pressed += 1
        held = held or ring > scene.presses
        if not gone and (now > scene.time or state.ground[1] > scene.place or pressed > 4 + scene.later * RATE):
            gone = len(states)
        run = 0.0 if now > scene.time - scene.walks else scene.run
        line.advance((Wish(move=(0.0, 0.0) if gone else scene.move, run=0.0 if gone else run, jump=(held or pressed > 0) and pressed <= 4).rounded(),))
    return states, gone or len(states) - 1


class Told(NamedTuple):
    """What is told of a scene: whether he fell, FIGURES (10,), and the states (10,) in which each was as bad as that."""

    fell: bool
    figures: np.ndarray
    moments: np.ndarray


def _lasting(found: np.ndarray) -> tuple[float, int]:
    """How long in all [s] something (T,) is so that lasts, and when for the first time."""
    found = binary_opening(found, np.ones(LASTS))
    return float(found.sum() * DT), int(found.argmax())


def along_soles(body: Body) -> tuple[np.ndarray, np.ndarray]:
    """Places (T, 2 · ALONG, 3) along both soles, and how far (T, 2 · ALONG) each is from what lies there [m]: a sole whose heel is past a tread's edge stands on it from there on."""
    heel, ball, tip = np.moveaxis(body.flesh[0][:, -6:].reshape(-1, 2, 3, 3), 2, 0)
    share = np.linspace(0.0, 2.0, ALONG)[:, None]
    points = (heel[:, :, None] + np.minimum(share, 1.0) * (ball - heel)[:, :, None] + np.maximum(share - 1.0, 0.0) * (tip - ball)[:, :, None]).reshape(len(heel), -1, 3)
    away = points[..., 1].copy()
    for thing in body.things:
        if isinstance(thing, (Box, Pillar)):
            away = np.minimum(away, gap(points.reshape(-1, 3), thing).reshape(away.shape))
    return points, away - flesh_of(body.who.parts["jump"].physique).thick[-1]


def _off_balance(points: np.ndarray, touching: np.ndarray, middle: np.ndarray) -> np.ndarray:
    """How far (T,) [m] a mass centre (T, 2) is beside the hull of points (T, P, 2) that touch; 0 where none does."""
    return np.array([-float(margin(hull(p[t]), m)) if t.any() else 0.0 for p, t, m in zip(points, touching, middle)])


def told(scene: Scene, who: Any, states: Sequence[Any], gone: int) -> Told:
    """What is to be seen of a body from when hands let go, or it lands after that."""
    body = Body(who, states, scene.things)
    points, away = body.flesh
    soles, feet = points[:, -6:].reshape(-1, 2, 3, 3), away[:, -6:].reshape(-1, 2, 3)
    walks = np.array([state.active == "locomotion" for state in states])
    landed = np.array([state.active != "locomotion" and getattr(getattr(state.memory, "memory", None), "landed", False) for state in states])
    from_now = np.arange(len(states)) >= gone
    stands = from_now & (walks | landed)
    speeds = np.linalg.norm(np.gradient(soles, DT, axis=0), axis=-1)
    still = (speeds.max(-1) < STILL) & stands[:, None]
    high = feet > OVER
    mass = centre_of_mass(anatomy(who.skeleton), *body.placed)
    accelerations = [np.pad((x[4:] - 2.0 * x[2:-2] + x[:-4]) * (0.5 * RATE) ** 2, ((2, 2), (0, 0))) for x in (mass, body.placed[0][:, 0])]
    walking = binary_opening(stands & walks, np.ones(5))[:, None]
    along, over = along_soles(body)
    slow = np.linalg.norm(np.gradient(mass, DT, axis=0), axis=-1) < SLOW
    bears = (feet < TOUCHES).any(-1) & walks[:, None] & from_now[:, None]
    joints = flesh_of(who.parts["jump"].physique).joints
    hand = np.isin(joints[:, 0], [who.skeleton.index(side + "Hand") for side in ("Left", "Right")])
    tracks = np.stack([np.where(bears, body.slides, 0.0).max(-1),
                       np.where(bears[:, ::-1], speeds.max(-1), 0.0).max(-1),
                       *(np.where(walking, part, 0.0).max(-1) for part in (np.linalg.norm(accelerations[0][:, [0, 2]], axis=-1)[:, None], np.abs(accelerations[0][:, 1:2]), np.linalg.norm(accelerations[1], axis=-1)[:, None])),
                       *(np.where(from_now, -100.0 * part.min(-1), 0.0) for part in (feet.reshape(-1, 6), away[:, hand]))])
    lasting = [_lasting((high.all(-1) & still).any(-1)), _lasting((still & ((high[..., 1] & high[..., 2]) | (high[..., 0] & high[..., 1]))).any(-1)),
               _lasting(stands & slow & (_off_balance(along[..., [0, 2]], over < TOUCHES, mass[:, [0, 2]]) > BESIDE))]
    asked = scene.leaps < 99.0
    active = [state.active for state in states[gone:]]
    falls = sum(a != b for a, b in zip(active, active[1:]) if b == "jump") > (1 if asked else 0) or "struck" in active
    return Told(falls, np.array([one for one, _ in lasting] + [*tracks.max(-1)]), np.array([k for _, k in lasting] + [*tracks.argmax(-1)]))


def report(kind: str, seeds: Sequence[int], found: Sequence[Told]) -> None:
    """Print the figures of a kind of scenes."""
    fell = [seed for seed, one in zip(seeds, found) if one.fell]
    print(f"{kind}: {len(found)} scenes, {len(fell)} fall or go off" + (f" ({', '.join(map(str, fell[:12]))})" if fell else ""))
    values = np.array([one.figures for one in found])
    for k, name in enumerate(FIGURES):
        worst = np.argsort(-values[:, k])[:3]
        some = f", in {(values[:, k] > 0.0).sum()}" if name.endswith("[s]") else ""
        print(f"    {name:18} {np.median(values[:, k]):6.2f}, 95 % {np.percentile(values[:, k], 95):6.2f}, worst {values[:, k].max():6.2f}{some} · seeds " + ", ".join(f"{seeds[n]} ({values[n, k]:.2f})" for n in worst), flush=True)


def main() -> None:
    """Print the figures of each kind."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--seed", type=int, default=0, help="the first of a kind's seeds")
    parser.add_argument("--only", nargs="+", metavar="KIND", help=f"a kind ({', '.join(KINDS)}), and seeds of it")
    parser.add_argument("--strips", type=Path, help="a folder for pictures of the worst")
    given = parser.parse_args()
    if given.only and given.only[0] not in KINDS:
        parser.error(f"there is no kind of scenes called {given.only[0]!r}; it may be {', '.join(KINDS)}")
    who = person()
    for kind in given.only[:1] if given.only else KINDS:
        seeds = [int(seed) for seed in given.only[1:]] if given.only else []
        seeds = seeds or list(range(given.seed, given.seed + given.count))
        scenes = [KINDS[kind](np.random.default_rng(seed)) for seed in seeds]
        plays = [(scene, *played(scene, who)) for scene in scenes]
        found = [told(scene, who, states, gone) for scene, states, gone in plays]
        report(kind, seeds, found)
        if given.strips:
            folder = given.strips / kind
            folder.mkdir(parents=True, exist_ok=True)
            for k, name in enumerate(FIGURES):
                n = int(np.argmax([one.figures[k] for one in found]))
                at = int(found[n].moments[k])
                draw(Body(who, plays[n][1], plays[n][0].things), {f"{name.split(' [')[0]} {seeds[n]}": [(at + later, 0.0) for later in (-15, 0, 15, 30)]}, folder)


if __name__ == "__main__":
    main()
