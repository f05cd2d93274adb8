"""Hops beside recorded ones: on both feet, on one, from foot to foot, skips.

    python scripts/measure/hops.py

Both are measured from their poses, in the same way: a foot is in the air 3.5 cm over its lowest place around that time, so flights are a little
shorter than those of the plans, and stances longer. Recorded hops are looked for in the takes of ../shared/mocap.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Literal

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np
from scipy.spatial.transform import Rotation

from compare_jump import MOCAP

from gambol.controllers.body import Clip, centre_of_mass, contact_points, log
from gambol.controllers.contract import CharacterState, Intent, Leap
from gambol.controllers.jump import Jump, Jumping
from gambol.controllers.jump.prior import flights
from gambol.controllers.locomotion import DEFAULT_LIBRARY, Library, joint_acceleration
from gambol.controllers.mocap import calibrate, load, retarget
from gambol.controllers.person import person

FPS = 60
LASTS, TOGETHER = (0.08, 0.75), 0.62
"""How long flights of hops last [s]; hops follow each other within so long [s] on the ground."""
STEPPED = 0.15
"""The steps of skips fly no longer than this [s]."""
TAKES = "cmu/49/49_02.amc", "cmu/49/49_03.amc", "woody2/wd2_fast_2foot_hop.bvh"
Foot = Literal["left", "right", "both"] | None
OURS: tuple[tuple[str, tuple[Foot, ...], float, tuple[float, ...]], ...] = (
    ("both feet, on the spot", ("both",) * 5, 0.0, (0.4,)), ("both feet, 0.4 m", ("both",) * 5, 0.4, (0.27,)),
    ("left foot, on the spot", ("left",) * 5, 0.0, (0.25,)), ("left foot, 0.4 m", ("left",) * 5, 0.4, (0.25,)),
    ("left foot, 0.8 m", ("left",) * 5, 0.8, (0.25,)), ("from foot to foot, 0.6 m", ("left", "right") * 3, 0.6, (0.27,)),
    ("skips: steps and hops of 0.4 m", ("left", "left", "right", "right") * 2, 0.4, (0.12, 0.26)))


def hopped(feet: Sequence[Foot], far: float, airtimes: Sequence[float]) -> list[CharacterState]:
    """The states of somebody who hops onto feet, each so far [m] ahead of the one before, and then onto both."""
    who, plan, count, states = person(), None, 0, []
    state, feet = who.start(), (*feet, None)
    for _ in range(FPS * (len(feet) + 1)):
        memory, leap = state.memory.memory, None
        if isinstance(memory, Jumping) and memory.plan is not plan:
            plan, count = memory.plan, count + 1
        if count < len(feet) and (count == 0 or not isinstance(memory, Jumping) or memory.landed):
            leap = Leap(np.array([0.0, 0.0, far * (count + 1)]), airtimes[count % len(airtimes)], on=feet[count])
        state, _ = who.step(state, Intent(leap=leap), 1 / FPS)
        states.append(state)
    return states


def stances(jump: Jump, clip: Clip) -> dict[str, list[list[float]]]:
    """Rows of a clip's hops by the feet on which they come down to hop on: flight before [s], on the ground [s], until the lowest point [s], how far the
    centre of mass sinks and rises [m], knees as they land, lowest and as they leave [°]: of the leg that stands, or the mean, and of the other."""
    positions, turned = clip.kinematics()
    height, step = centre_of_mass(jump.physique.anatomy, positions, turned)[:, 1], clip.frame_time
    feet = contact_points(jump.skeleton, positions, turned)[..., 1].reshape(-1, 2, 2).min(-1)
    knees = np.degrees(np.linalg.norm(log(clip.rotations[:, [jump.skeleton.index(side + "Leg") for side in ("Left", "Right")]]), axis=-1))
    found, rows = list(flights(jump.skeleton, jump.physique.anatomy, clip, LASTS)), {}
    for (first, last), (again, _) in zip(found, found[1:]):
        if (again - last) * step > TOGETHER:
            continue
        low = last + int(height[last:again].argmin())
        on = (feet[last:again] - feet[last:again].min() < 0.05).mean(0) > 0.6
        legs = np.flatnonzero(on)
        bent = [float(knees[n, legs].mean()) for n in (last, low, again)]
        other = float(knees[low, ~on].mean()) if len(legs) == 1 else np.nan
        rows.setdefault("one foot" if len(legs) == 1 else "both feet", []).append(
            [(last - first) * step, (again - last) * step, (low - last) * step, height[last] - height[low], height[again] - height[low], *bent, other])
    return rows


def laws(jump: Jump, clip: Clip, contacts: np.ndarray, runs: np.ndarray) -> None:
    """What can be told of skips without a recording, from contacts (N, 4): on which feet they come down, one after the other; how left and right compare; and
    how hard joints are accelerated at most, over the 99th percentile (J,) of recorded runs [m/s²]."""
    turns = np.flatnonzero(np.diff(contacts.any(1).astype(int)))
    offs, downs = (turns[contacts[turns].any(1) == on] for on in (True, False))
    down = [(int(contacts[n + 1, 2:].any()), (n - offs[offs < n][-1]) / FPS, (offs[offs > n][0] - n) / FPS) for n in downs if (offs > n).any() and (offs < n).any()]
    order, told = "".join("LR"[side] for side, *_ in down), []
    for name, hop in (("hops", True), ("steps", False)):  # a hop flies long before it comes down on the same foot, a step shortly
        for part, column in (("in the air", 1), ("on the ground", 2)):
            both = [[row[column] for row in down if row[0] == side and (row[1] > STEPPED) == hop] for side in (0, 1)]
            told += [f"{name} {part} {' and '.join(f'{np.mean(one):.2f}' for one in both if one)} s"]
    over = joint_acceleration(clip.kinematics()[0][downs[0]:downs[-1]], clip.frame_time).max(0) / runs
    worst = np.argsort(-over)[:4]
    print(f"  order {order}, left and right: {'; '.join(told)}; joints' acceleration over recorded runs', at most "
          + ", ".join(f"{over[n]:.1f}× ({jump.skeleton.names[n]})" for n in worst))


def tell(name: str, rows: Sequence[Sequence[float]]) -> None:
    """One line: the range of each."""
    least, most = np.min(rows, axis=0), np.max(rows, axis=0)
    air, ground, low, sinks, rises, *bent, other = (f"{a:.2f}–{b:.2f}" if b < 5.0 else f"{a:.0f}–{b:.0f}" for a, b in zip(least, most))
    print(f"{name}: {len(rows)}; in the air {air} s, on the ground {ground} s, lowest after {low} s; sinks {sinks} m, rises {rises} m; knee as it lands, lowest, "
          f"as it leaves {bent[0]}, {bent[1]}, {bent[2]}°" + ("" if np.isnan(most[-1]) else f", of the leg held up {other}°"))


def main() -> None:
    argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0]).parse_args()
    jump = Jump()
    for take in TAKES if MOCAP.is_dir() else ():
        source = load(MOCAP / take)
        for feet, rows in stances(jump, replace(retarget(source, calibration=calibrate([source])), name=Path(take).stem)).items():
            tell(f"recorded, {Path(take).stem}, {feet}", rows)
    for name, feet, far, airtimes in OURS:
        states = hopped(feet, far, airtimes)
        turned = np.stack([s.pose.rotations for s in states]).astype(float)
        clip = Clip(name, jump.skeleton, 1 / FPS, np.stack([s.pose.root for s in states]).astype(float),
                    Rotation.from_matrix(turned.reshape(-1, 3, 3)).as_quat().reshape(*turned.shape[:2], 4))
        for stood, rows in stances(jump, clip).items():
            if stood == "both feet" and "both" not in feet:
                continue
            parts = {"": rows} if len(airtimes) == 1 else {", hops": [r for r in rows if r[0] > STEPPED], ", steps": [r for r in rows if r[0] <= STEPPED]}
            for part, some in parts.items():
                tell(f"ours, {name}{part}", some)
        if len(airtimes) > 1:
            laws(jump, clip, np.stack([s.contacts for s in states]), Library.load(DEFAULT_LIBRARY).accelerations["run"])


if __name__ == "__main__":
    main()
