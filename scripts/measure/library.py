"""Measure how well the library tells gaits it has not seen, and what its Fourier series leave out.

    python scripts/measure/library.py DIR [--recipe assets/library/default.toml]

DIR is the folder of motion capture that the recipe names. Leave-one-out: for every primitive of
one actor, all cycles of its source clip are taken away, the control space is triangulated anew,
and the blend at the primitive's velocity is compared with the recorded cycle: RMS joint angle and
mean joint position in the ground frame. Beside it the nearest primitive, and the actor's own
repeatability: two recorded cycles of different clips at nearly the same velocity. And how straight knees are while
their foot stands, as recorded and on Gambol's skeleton.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from rich.progress import Progress

from gambol import assets
from gambol.controllers.body import contact_points, forward_kinematics, human, rotations as rot
from gambol.controllers.locomotion import (HIPS, LABELS, SCALE, ControlSpace, channels, collect, fourier, neighbours,
                                           read_recipe, reference_rotations, select, thin)
from gambol.controllers.mocap import calibrate, load, retarget


def pose(samples: np.ndarray, reference: np.ndarray):
    """Local rotations and joint positions of samples (S, D)."""
    chart = samples[:, :HIPS].reshape(len(samples), -1, 3)
    local = reference @ rot.exp(chart)
    return local, forward_kinematics(human(), samples[:, HIPS:LABELS], local)[0]


def difference(a: np.ndarray, b: np.ndarray, reference: np.ndarray) -> tuple[float, float]:
    """RMS joint angle [degrees] and mean joint distance [cm] of two cycles (S, D)."""
    (ra, pa), (rb, pb) = pose(a, reference), pose(b, reference)
    angle = rot.log(np.swapaxes(ra, -1, -2) @ rb)
    return (float(np.degrees(np.sqrt(np.mean(np.sum(angle**2, -1))))),
            float(100 * np.linalg.norm(pa - pb, axis=-1).mean()))


def knees(folder: Path) -> None:
    """The knee's angle (2nd, 10th and 50th percentile) while its foot stands, in recordings and on the standard human."""
    print("Knees while their foot stands, 2 / 10 / 50 % under: recorded → ours")
    for name, pattern in (("the actor, walking", "woody2/wd2_WalkForward*"), ("side-steps, turns", "cmu_30fps/69/*"),
                          ("brisk walks", "cmu_bvh/0[78]/*"), ("runs", "cmu/09/*.amc")):
        groups: dict = {}
        for path in sorted(folder.glob(pattern)):
            clip = load(path)
            if len(clip) * clip.frame_time > 0.9:
                groups.setdefault((clip.skeleton.names, tuple(np.round(clip.skeleton.offsets[1:], 3).ravel())), []).append(clip)
        found: list[list[np.ndarray]] = [[], []]
        for clips in groups.values():
            known = calibrate(clips)
            for clip in clips:
                body = retarget(clip, calibration=known)
                positions, orientations = body.kinematics()
                points = contact_points(body.skeleton, positions, orientations)
                for k, side in enumerate(("Left", "Right")):
                    speed = np.linalg.norm(np.gradient(points[:, 2 * k:2 * k + 2], clip.frame_time, axis=0), axis=-1).min(-1)
                    stands = (speed < 0.35) & (points[:, 2 * k:2 * k + 2, 1].min(-1) < 0.04)
                    ours = [body.skeleton.index(side + n) for n in ("UpLeg", "Leg", "Foot")]
                    theirs = [known.roles.limbs[side + n] for n in ("UpLeg", "Leg", "Foot")]
                    found[0].append(bend(clip.kinematics()[0][stands][:, theirs]))
                    found[1].append(bend(positions[stands][:, ours]))
        if groups:
            told = [" / ".join(f"{a:.1f}" for a in np.percentile(np.concatenate(f), [2, 10, 50])) for f in found]
            print(f"  {name:18s} {told[0]}° → {told[1]}°")


def bend(leg: np.ndarray) -> np.ndarray:
    """The angle (T,) [degrees] between thigh and shank of hips, knees and ankles (T, 3, 3)."""
    bones = np.diff(leg, axis=1)
    bones /= np.linalg.norm(bones, axis=-1, keepdims=True)
    return np.degrees(np.arccos(np.clip((bones[:, 0] * bones[:, 1]).sum(-1), -1, 1)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--recipe", type=Path, default=assets.path("library", "default.toml"))
    arguments = parser.parse_args()
    knees(arguments.folder)
    sources, _ = read_recipe(arguments.recipe)
    with Progress(transient=True) as bar:
        tasks = {}

        def progress(what, done, total):
            if what not in tasks:
                tasks[what] = bar.add_task(what)
            bar.update(tasks[what], completed=done, total=total)
        found = collect(arguments.folder, sources, progress)
    chosen, _ = select(found.cycles, found.rank, "walk")
    reference = reference_rotations([found.cycles[c.cycle] for c in chosen])
    samples = {i: channels(c, reference) for i, c in enumerate(found.cycles) if c.family == "walk"}
    velocity = np.array([c.velocity for c in found.cycles])
    clip = np.array([c.clip for c in found.cycles])
    keep = thin(velocity[[c.cycle for c in chosen]], np.zeros(len(chosen), bool))
    chosen = [chosen[i] for i in keep]

    cut = [difference(fourier.evaluate(fourier.fit(samples[c.cycle]), np.arange(96) / 96), samples[c.cycle], reference)
           for c in chosen]
    print(f"Fourier truncation at {fourier.HARMONICS} harmonics, {len(cut)} cycles: "
          f"{np.mean([c[0] for c in cut]):.2f}°, {np.mean([c[1] for c in cut]):.2f} cm")

    main_actor = found.actor[next(c.cycle for c in chosen if found.rank[c.cycle] == found.rank.min())]
    errors = {"library, all": [], "library, inside": [], "nearest primitive": [], "repeatability": []}
    for choice in chosen:
        i = choice.cycle
        if choice.mirrored or found.actor[i] != main_actor:
            continue
        others = [c for c in chosen if clip[c.cycle] != clip[i] and found.actor[c.cycle] == main_actor]
        flip = np.array([[1, -1, -1] if c.mirrored else [1, 1, 1] for c in others])
        blends, places = [], []
        for c, f in zip(others, flip):
            near, weight = neighbours(found.cycles, found.actor, c.cycle, "walk")
            free = clip[near] != clip[i]
            near, weight = near[free], weight[free] / weight[free].sum()
            blends.append((near, weight))
            places.append(weight @ velocity[near] * f)
        natural = np.flatnonzero((flip > 0).all(1))  # mirrored samples would need turning: leave them out
        places = np.array(places)[natural]
        left = thin(places, np.zeros(len(places), bool))
        space = ControlSpace.build(places[left], np.median(places[left], 0))
        weights = space.weights(velocity[i], correct=0)
        parts = [blends[natural[k]] for k in left]
        blend = sum(w * sum(v * samples[j] for j, v in zip(*parts[k])) for k, w in enumerate(weights) if w > 0)
        errors["library, all"].append(difference(blend, samples[i], reference))
        if not space.inside(velocity[i]):
            continue  # nothing around it is left: the rest of the table is about interpolation
        errors["library, inside"].append(errors["library, all"][-1])
        distance = np.linalg.norm((velocity[[c.cycle for c in others]] * flip - velocity[i]) / SCALE, axis=-1)
        distance[(flip < 0).any(1)] = np.inf
        errors["nearest primitive"].append(difference(samples[others[int(distance.argmin())].cycle], samples[i], reference))
        same = np.array([j for j in samples if found.actor[j] == main_actor and clip[j] != clip[i]])
        gap = np.linalg.norm((velocity[same] - velocity[i]) / SCALE, axis=-1)
        if gap.min() < 0.15:
            errors["repeatability"].append(difference(samples[same[gap.argmin()]], samples[i], reference))
    print(f"Leave-one-out over {len(errors['library, all'])} primitives of the main actor, source clip excluded:")
    for name, values in errors.items():
        angle, place = np.mean(values, 0)
        print(f"  {name:18s} {angle:.1f}°  {place:.1f} cm   ({len(values)} cycles)")


if __name__ == "__main__":
    main()
