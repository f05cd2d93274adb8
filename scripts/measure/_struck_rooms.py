"""Who is struck beside walls, on platforms and on stairs: what of a body is in things, and where it ends."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Intent, Strike
from gambol.controllers.jump import Physique
from gambol.controllers.navigation import floor_at, gap
from gambol.controllers.struck import flesh
from gambol.game.scene import Box, Pillar

DT, PLAYED = 1.0 / 60.0, 8.0
"""Steps [s], and for how long who is struck is looked at [s]."""
HARD = 0.3, 3.0
"""By how much strikes change a body's velocity [m/s]."""
ALOFT, LONG = 0.05, 0.1
"""Who is farther over the ground than this [m], for longer than this [s], floats."""
ROOMS = "walls", "platforms", "stairs"


def room(kind: str, rng) -> tuple[tuple, tuple[float, float, float], float]:
    """What stands about, and where somebody stands: x, z [m], heading [rad], and how high [m]."""
    heading = rng.uniform(-np.pi, np.pi)
    if kind == "platforms":
        wide, deep, high = rng.uniform(1.2, 3.0), rng.uniform(1.2, 3.0), rng.uniform(0.3, 2.0)
        box = Box((0.0, 0.5 * high, 0.0), (wide, high, deep), 0.0)
        return (box,), (rng.uniform(-1.0, 1.0) * (0.5 * wide - 0.25), rng.uniform(-1.0, 1.0) * (0.5 * deep - 0.25), heading), high
    if kind == "stairs":
        rise, going, treads = rng.uniform(0.12, 0.18), rng.uniform(0.30, 0.36), 8
        steps = tuple(Box((0.0, 0.5 * rise * (n + 1), going * n), (2.4, rise * (n + 1), going)) for n in range(treads))
        top = Box((0.0, 0.5 * rise * treads, going * treads + 1.0), (2.4, rise * treads, 2.0 + going))
        on = int(rng.integers(1, treads - 1))
        return (*steps, top), (0.0, going * on - 0.02, rng.choice([0.0, np.pi])), rise * (on + 1)
    while True:
        things: list[Any] = []
        for _ in range(5):
            x, z, turned, which = *rng.uniform(-2.0, 2.0, 2), rng.uniform(-np.pi, np.pi), rng.integers(3)
            things.append(Pillar((x, 0.0, z), rng.uniform(0.15, 0.4), 2.2) if which == 0 else Box((x, 0.5, z), (rng.uniform(0.3, 1.2), 1.0, rng.uniform(0.3, 1.2)), turned)
                          if which == 1 else Box((x, 1.25, z), (0.2, 2.5, rng.uniform(1.5, 3.0)), turned))
        room = min(float(gap(np.array([[0.0, 1.0, 0.0], [0.0, 0.5, 0.0]]), thing).min()) for thing in things)
        if 0.35 < room < 1.2:
            return tuple(things), (0.0, 0.0, heading), 0.0


def deepest(body: Physique, states: Sequence[Any], things: Sequence[Any]) -> tuple[float, int]:
    """How deep [m] a body's flesh is in anything in any state, beyond how deep it was in it at first, and in which."""
    placed = forward_kinematics(body.skeleton, np.stack([np.asarray(s.pose.root, float) for s in states]), np.stack([np.asarray(s.pose.rotations, float) for s in states]))
    points, thick = flesh(body, *placed)
    worst, when = 0.0, 0
    for thing in things:
        deep = (thick - gap(points.reshape(-1, 3), thing).reshape(points.shape[:2])).max(1)
        deep = deep - max(float(deep[0]), 0.0)
        if deep.max() > worst:
            worst, when = float(deep.max()), int(deep.argmax())
    return worst, when


def floats(body: Physique, states: Sequence[Any], things: Sequence[Any]) -> float:
    """For how long [s] nothing of a body is within ALOFT of the ground, but for falls through the air."""
    placed = forward_kinematics(body.skeleton, np.stack([np.asarray(s.pose.root, float) for s in states]), np.stack([np.asarray(s.pose.rotations, float) for s in states]))
    points, thick = flesh(body, *placed)
    low = [min(y - t - floor_at(x, z, things, y + 0.3) for (x, y, z), t in zip(row, thick)) for row in points]
    return DT * sum(gap > ALOFT for gap, state in zip(low, states) if state.active != "jump")


def struck_in(somebody, kind: str, seed: int, number: int) -> tuple[list[Any], tuple, np.ndarray]:
    """All states of somebody who is struck in a room, what stands about, and the strike [m/s]."""
    rng = np.random.default_rng([seed, ROOMS.index(kind), number])
    things, start, floor = room(kind, rng)
    body = somebody.parts["struck"].physique
    state, angle, hard = somebody.start(start, floor), rng.uniform(-np.pi, np.pi), rng.uniform(*HARD)
    for _ in range(30):
        state, _ = somebody.step(state, Intent(around=things), DT)
    kick, states = hard * np.array([np.sin(angle), np.cos(angle)]), [state]
    for n in range(round(PLAYED / DT)):
        state, _ = somebody.step(state, Intent(around=things, strike=Strike(tuple(body.mass * kick)) if n == 0 else None), DT)
        states.append(state)
    return states, things, kick


def report(somebody, seed: int, count: int) -> None:
    """Print what becomes of people who are struck in so many rooms of each kind."""
    body = somebody.parts["struck"].physique
    for kind in ROOMS:
        depths, fates, wrong, aloft = [], Counter(), [], []
        for number in range(count):
            states, things, _ = struck_in(somebody, kind, seed, number)
            why = states[1].memory.memory.made.why if states[1].active == "struck" else states[1].memory.why
            fates[why + (", over an edge" if any(s.active == "jump" for s in states) else "")] += 1
            depths.append(100.0 * deepest(body, states, things)[0])
            aloft.append(floats(body, states, things))
            x, z, _ = states[-1].ground
            off = abs(float(states[-1].floor) - floor_at(x, z, things, float(states[-1].floor) + 0.24))
            if off > 0.25 or states[-1].active != "locomotion":
                wrong.append(number)
        print(f"{count} struck by {HARD[0]:g} … {HARD[1]:g} m/s beside {kind}: {', '.join(f'{n} {why}' for why, n in fates.most_common())}")
        print(f"  deepest in anything: median {np.median(depths):.1f} cm, 95 % {np.percentile(depths, 95):.1f}, worst {max(depths):.1f} (number {int(np.argmax(depths))}); "
              f"more than 2 cm: {np.mean(np.array(depths) > 2.0):.0%}; float: {np.mean(np.array(aloft) > LONG):.0%}, for {sum(aloft):.1f} s in all; do not stand on ground at the end: {len(wrong)} {wrong[:8] or ''}")
