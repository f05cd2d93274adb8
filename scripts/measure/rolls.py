"""How rolls go that end drops of 2.2 … 3.4 m: the floor's force, what is near the floor, how fast joints turn, by phase.

    python scripts/measure/rolls.py

Somebody on a platform jumps down to 2 m ahead of him. Every figure is measured from the poses of the plan, at its own moments: the force from the mass
centre's, so that the corners of what is played are seen.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from gambol.controllers.body import centre_of_mass, forward_kinematics, joint_limits, log
from gambol.controllers.contract import CharacterState, Intent, Leap, Unable
from gambol.controllers.jump import Jump
from gambol.controllers.jump.motion import Plan, places
from gambol.controllers.locomotion import Locomotion
from gambol.game.scene import Box
from gambol.game.world import DT

DROPS = 2.2, 2.5, 2.8, 3.1, 3.4
"""From so high [m]."""
FAR, STANDS = 2.0, 0.7
"""So far ahead [m] of who stands so far [m] from the middle of a platform, whose edge is 1 m from there."""
TIPPING = 0.35
"""So long [s] from the lowest point it tips over its feet onto hands and back, at 120 poses a second with the first moments of what follows."""
HEAD = slice(24, 26)
"""The head's places, of all that may touch the floor."""
LEGS = "UpLeg", "Leg", "Foot"


def stood(locomotion: Locomotion, high: float) -> tuple[CharacterState, tuple[Box, ...]]:
    """Somebody who stands near the edge of a platform so high [m], and the platform."""
    platform = (Box((0.0, 0.5 * high, 0.0), (2.0, high, 2.0)),)
    state = locomotion.start((0.0, STANDS, 0.0), high)
    for _ in range(5):
        state, _ = locomotion.step(state, Intent(around=platform), DT)
    return state, platform


def rates(made: Plan) -> np.ndarray:
    """How fast each joint (N - 1, J) [rad/s] turns from one moment of a plan to the next."""
    return np.linalg.norm(log(np.swapaxes(made.local[:-1], -1, -2) @ made.local[1:]), axis=-1) / np.diff(made.times)[:, None]


def told(jump: Jump, made: Plan, high: float) -> str:
    """One roll in figures."""
    skeleton, times = jump.skeleton, made.times
    placed = forward_kinematics(skeleton, made.roots, made.local)
    over = places(jump.physique, *placed)[1]
    centre = centre_of_mass(jump.physique.anatomy, *placed)[:, 1]
    before, after = np.diff(times)[:-1], np.diff(times)[1:]
    force = 1.0 + 2.0 * (after * centre[:-2] - (before + after) * centre[1:-1] + before * centre[2:]) / (before * after * (before + after)) / -jump.gravity[1]
    turning, middle = rates(made), 0.5 * (times[1:] + times[:-1])
    vectors, limits = log(made.local), joint_limits(skeleton)
    beyond = np.degrees(np.maximum(vectors - limits.upper, limits.lower - vectors).clip(0.0).max(-1))
    knees = [skeleton.index(side + "Leg") for side in ("Left", "Right")]
    lines = [f"down from {high:.1f} m: {float(made.velocities[np.searchsorted(times, made.touch_down), 1]):.1f} m/s at touch-down, lowest after {made.lowest - made.touch_down:.2f} s, "
             f"up {made.rolls - made.touch_down:.2f} s after it"]
    tips = made.lowest + TIPPING
    for name, first, last in (("in the air", made.take_off, made.touch_down), ("on the legs", made.touch_down, made.lowest), ("tips over", made.lowest, tips),
                              ("rolls", tips, made.rolls)):
        within, on = (middle > first) & (middle < last), (times[1:-1] > first + 1e-9) & (times[1:-1] < last - 1e-9)
        here = (times >= first) & (times <= last)
        legs = [turning[within][:, [skeleton.index(side + part) for side in ("Left", "Right")]].max() for part in LEGS]
        worst = int(turning[within].max(0).argmax())
        most, least = (times[1:-1][on][pick(force[on])] - made.touch_down for pick in (np.argmax, np.argmin))
        knee = int(np.flatnonzero(within)[turning[within][:, knees].max(1).argmax()])
        out = int(beyond[here].max(0).argmax())
        floor = "" if name == "in the air" else (f"force {force[on].max():.1f} BW at most ({1e3 * most:.0f} ms after touch-down), {force[on].min():.1f} at least ({1e3 * least:.0f} ms); lowest of the body {100 * over[here].min():.1f} cm, of the head "
                                                 f"{100 * over[here][:, HEAD].min():.0f} cm over the floor; ")
        lines.append(f"  {name:11} {floor}hip, knee, ankle {legs[0]:.0f}, {legs[1]:.0f}, {legs[2]:.0f} rad/s, the knee {1e3 * (middle[knee] - made.touch_down):.0f} ms after touch-down, bent by {np.degrees(np.linalg.norm(vectors[knee, knees], axis=-1).max()):.0f}°; fastest {skeleton.names[worst]} {turning[within].max():.0f} rad/s; beyond its limits "
                     f"{beyond[here].max():.0f}° ({skeleton.names[out]})")
    return "\n".join(lines)


def main() -> None:
    """Print what becomes of each drop."""
    locomotion, jump = Locomotion.load(), Jump()
    for high in DROPS:
        state, platform = stood(locomotion, high)
        try:
            made = jump.plan(state, Intent(leap=Leap(np.array([0.0, 0.0, STANDS + FAR])), around=platform))
        except Unable as reason:
            print(f"down from {high:.1f} m: {reason}")
            continue
        print(told(jump, made, high) if made.rolls else f"down from {high:.1f} m: stays on its feet", flush=True)


if __name__ == "__main__":
    main()
