"""Legs of those who are pushed to any side in any moment of a stride: how near they come to each other, how fast feet go, how hard joints are thrown."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from _limbs import LIMBS, ends_of, segments_apart

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Intent, Strike
from gambol.controllers.struck import FALLS

SPEEDS, SIDES, GAINS, PHASES = (0.0, 0.8, 1.4, 2.5), 12, (0.35, 0.5, 0.7, 0.85, 1.1, 1.5), 8
"""Wishes [m/s]; so many directions; what a push gives [m/s]; so many moments of a stride, 1.1 s long."""
DT, FIRST, SPACED, PLAYED = 1.0 / 60.0, 150, 8, 90
"""Steps [s]; how many are gone before the first push; between moments; and are followed after a push."""
NEAR, FAST = 0.04, 9.0
"""Legs' axes nearer than this [m] are in each other; feet of people who catch themselves are not faster than this [m/s]."""
LEFT, RIGHT = ([list(LIMBS).index(side + part) for part in ("Leg", "Foot")] for side in ("Left", "Right"))


@dataclass(frozen=True)
class Push:
    """One who was pushed. apart: how near axes of shins and feet come [m], and when [s]; foot: how fast an ankle goes at most [m/s]; thrown: how hard a joint is accelerated over
    1/30 s [m/s²]; hips: how low they come, as a share of where they stand. fate: "stride", "steps" or "falls"."""

    speed: float
    towards: float
    gain: float
    phase: int
    apart: float
    when: float
    foot: float
    thrown: float
    hips: float
    fate: str


def pushed(somebody, state, wish: np.ndarray, change: tuple[float, float]) -> tuple[list, str]:
    """The states of somebody after a push that changes his velocity by x, z [m/s], and what became of him."""
    impulse = tuple(somebody.parts["struck"].physique.mass * np.array(change))
    states, fate = [state], "stride"
    for n in range(PLAYED):
        state, _ = somebody.step(state, Intent(wish, strike=None if n else Strike(impulse)), DT)
        states.append(state)
        if state.active == "struck":
            fell = state.memory.memory.made.fate >= FALLS
            fate = "falls" if fell or fate == "falls" else "steps"
    return states, fate


def looked_at(skeleton, states) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Of T states: how far (T,) shins and feet of both sides are apart [m], how fast (T - 1,) the faster ankle is [m/s], how hard (T - 2,) the hardest thrown joint is [m/s²], and how
    high (T,) the hips are, as a share of where they stand."""
    roots, turns = (np.stack([np.asarray(getattr(state.pose, name), float) for state in states]) for name in ("root", "rotations"))
    joints = forward_kinematics(skeleton, roots, turns)[0]
    ends = ends_of(skeleton, roots, turns)
    one, other = ends[:, LEFT][:, :, None], ends[:, RIGHT][:, None]
    apart = segments_apart(one[..., 0, :], one[..., 1, :], other[..., 0, :], other[..., 1, :]).min((1, 2))
    feet = [list(skeleton.names).index(side + "Foot") for side in ("Left", "Right")]
    foot = np.linalg.norm(np.diff(joints[:, feet], axis=0), axis=-1).max(1) / DT
    thrown = np.linalg.norm(joints[2:] - 2.0 * joints[1:-1] + joints[:-2], axis=-1).max(1) / DT**2
    return apart, foot, thrown, (roots[:, 1] - states[0].floor) / skeleton.offsets[0, 1]


def pushes(somebody, speeds=SPEEDS) -> list[Push]:
    """All pushes of the grid; of who stands one moment."""
    found = []
    for speed in speeds:
        wish, state, phases = np.array([speed, 0.0, 0.0]), somebody.start(), []
        for n in range(FIRST + SPACED * PHASES):
            if n >= FIRST and (n - FIRST) % SPACED == 0:
                phases.append(state)
            state, _ = somebody.step(state, Intent(wish), DT)
        for phase, state in enumerate(phases if speed else phases[:1]):
            for towards in np.arange(SIDES) * 360.0 / SIDES:
                for gain in GAINS:
                    angle = np.radians(towards)
                    states, fate = pushed(somebody, state, wish, (gain * np.sin(angle), gain * np.cos(angle)))
                    apart, foot, thrown, hips = looked_at(somebody.skeleton, states)
                    found.append(Push(speed, towards, gain, phase, float(apart.min()), float(apart.argmin() * DT), float(foot.max()), float(thrown.max()), float(hips.min()), fate))
    return found


def told(found: list[Push], speed: float) -> str:
    """A line of text about pushes of who goes so fast; legs, feet, joints and hips of those who step."""
    rows = [push for push in found if push.speed == speed]
    steps = [push for push in rows if push.fate == "steps"]
    fates = ", ".join(f"{sum(push.fate == fate for push in rows)} {said}" for fate, said in (("stride", "in stride"), ("steps", "step"), ("falls", "fall")))
    apart, foot, thrown = (np.array([getattr(push, name) for push in steps]) for name in ("apart", "foot", "thrown"))
    return (f"{'standing' if not speed else f'at {speed:g} m/s'}, {len(rows)} pushes: {fates}; who step: legs' axes within {100 * NEAR:g} cm in {(apart < NEAR).sum()}, nearest {100 * apart.min():.1f} cm; "
            f"ankles {np.median(foot):.1f} m/s (median), {np.quantile(foot, 0.95):.1f} (95 %), {foot.max():.1f} at most, over {FAST:g} in {(foot > FAST).sum()}; "
            f"joints {np.quantile(thrown, 0.95):.0f} m/s² (95 %); hips {min(push.hips for push in steps):.2f}")
