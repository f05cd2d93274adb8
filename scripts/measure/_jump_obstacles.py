"""Whether finished plans of jumps touch what stands about: hurdles, platforms' edges, walls, roofs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from jump_trials import Motion

from gambol.controllers.body import end_positions, sole_corners
from gambol.controllers.contract import CharacterState, Intent, Leap, Unable
from gambol.controllers.jump import Jump
from gambol.controllers.jump.motion import Plan
from gambol.controllers.navigation import gap
from gambol.game.scene import Box

BONES = (("Leg", "Foot"), ("UpLeg", "Leg"), ("ForeArm", "Hand"), ("Arm", "ForeArm"))


def depth(jump: Jump, made: Plan, around: Sequence[Any]) -> dict[str, float]:
    """How deep [cm] bones, feet, head and hands are in things, over the whole plan."""
    skeleton = jump.skeleton
    seen = Motion.of(jump, made, np.arange(0.0, min(made.duration, made.through), 1 / 120))
    ends = end_positions(skeleton, seen.positions, seen.orientations)
    parts = {}
    for above, below in BONES:
        lines = [seen.positions[:, skeleton.index(s + above)] + part * (seen.positions[:, skeleton.index(s + below)] - seen.positions[:, skeleton.index(s + above)])
                 for s in ("Left", "Right") for part in np.linspace(0.0, 0.9, 6)]
        parts["shins" if above == "Leg" else "thighs" if above == "UpLeg" else "arms"] = np.stack(lines, 1)
    parts["feet"] = sole_corners(skeleton, seen.positions, seen.orientations).reshape(len(seen.times), -1, 3) + [0.0, 0.01, 0.0]
    parts["head"] = ends[:, [skeleton.end_index["Head"]]]
    parts["hands"] = ends[:, [skeleton.end_index[s + "Hand"] for s in ("Left", "Right")]]
    parts["trunk"] = seen.positions[:, [skeleton.index(n) for n in ("Hips", "Spine", "Spine1", "Spine2", "Neck")]]
    return {name: 100.0 * max(0.0, *(-gap(points.reshape(-1, 3), thing).min() for thing in around)) for name, points in parts.items()}


def obstacles(states: dict[str, list[CharacterState]]) -> Iterator[tuple[str, CharacterState, np.ndarray, tuple[Box, ...]]]:
    """Hurdles, platforms, walls behind the target and roofs: what stands there, from which state, to where."""
    for high in (0.2, 0.4, 0.6):
        for pace, far in (("standing", 0.9), ("standing", 1.3), ("walking", 1.4), ("running", 2.2), ("running", 2.8)):
            for state in states[pace][::4]:
                for part in (0.4, 0.5, 0.6, 0.7):
                    yield f"hurdle of {high:.1f} m", state, np.array([0.0, 0.0, far]), (Box((0.0, 0.5 * high, part * far), (2.0, high, 0.2)),)
    for high in (0.15, 0.3, 0.45):
        for pace, far in (("standing", 0.6), ("standing", 0.9), ("walking", 1.3), ("running", 2.0)):
            for state in states[pace][::4]:
                for inside in (0.16, 0.25, 0.4):
                    yield "platform's edge", state, np.array([0.0, high, far]), (Box((0.0, 0.5 * high, far - inside + 1.0), (3.0, high, 2.0)),)
    for pace, far in (("standing", 0.5), ("standing", 0.9), ("walking", 1.4), ("running", 2.4)):
        for state in states[pace][::4]:
            for behind in (0.2, 0.3, 0.45, 0.7):
                yield "wall behind the target", state, np.array([0.0, 0.0, far]), (Box((0.0, 1.5, far + behind + 0.1), (4.0, 3.0, 0.2)),)
    for pace, far in (("standing", 0.5), ("standing", 1.0), ("walking", 1.4)):
        for state in states[pace][::4]:
            for low in (1.8, 1.9, 2.0, 2.2):
                yield "roof", state, np.array([0.0, 0.0, far]), (Box((0.0, low + 0.5, far), (4.0, 1.0, 1.6)),)


def report_obstacles(states: dict[str, list[CharacterState]]) -> None:
    """How deep finished plans are in what stands about, and whether a place that is offered instead is one."""
    jump, deepest, count, refused, bad, offered = Jump(), {}, Counter(), Counter(), Counter(), 0
    for name, state, place, around in obstacles(states):
        count[name] += 1
        try:
            made = jump.plan(state, Intent(leap=Leap(place), around=around))
        except Unable as reason:
            refused[name] += 1
            near = getattr(reason, "nearest", None)
            if near is not None:
                offered += 1
                try:
                    deep = depth(jump, jump.plan(state, Intent(leap=Leap(near), around=around)), around)
                    if max(deep.values()) > 0.0:
                        bad["touches something"] += 1
                except Exception as error:
                    bad[f"{type(error).__name__}: {str(error)[:40]}"] += 1
            continue
        for part, deep in depth(jump, made, around).items():
            deepest.setdefault(name, {})[part] = max(deepest.get(name, {}).get(part, 0.0), deep)
    for name, total in count.items():
        told = {part: round(deep, 1) for part, deep in deepest.get(name, {}).items() if deep > 0.0}
        print(f"{name}: {total - refused[name]} planned, {refused[name]} refused; deepest [cm] {told or 0}")
    print(f"places offered instead: {offered}, that can't be jumped to or touch something {sum(bad.values())} {dict(bad.most_common(3))}")
