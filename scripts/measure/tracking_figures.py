"""The figures of Rosenhahn 2007 on films of our own, with tables of errors: knees that bend, a noisy run, a corrupted cartwheel, and what the paper leaves out.

    python scripts/measure/tracking_figures.py DIR -o FOLDER [--seeds 3] [--frames 90]

DIR is a folder of motion capture with CMU's subjects 14, 16 and 49 in it, as for `tracking.py`, which says how things are
measured. Silhouettes, four cameras of 640 × 480. The model is followed from two poses that are known but where it says otherwise.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from _plots import pictures, pyplot
from _tracking import RATE, Film, errors, films, overlay
from _tracking_ways import WAYS, told, track, with_lies, with_noise

from gambol.controllers.tracking import Tracker, fitted_shape
from gambol.controllers.tracking.silhouettes import shaped
from gambol.controllers.tracking.twists import Configuration, exp, local_turns, retract_kernel

SHOWN = ("no penalty", "the paper's penalty", "ours, gate")
COLOURS = {"no penalty": "#d03030", "the paper's penalty": "#3060d0", "ours, gate": "#101010"}
BAD = ((2, 22), (2, 11), (3, 14))
LOST = 15.0
"""A track whose last ten frames are farther off than this on average [°] is lost."""


def joint_angles(film: Film, poses: Sequence[Configuration], joint: str) -> np.ndarray:
    """How far a joint is turned from T-pose in every frame [°]."""
    turned = local_turns(film.chain, Configuration(np.stack([p.root for p in poses]), np.stack([p.angles for p in poses]))).rotations
    j = film.chain.skeleton.index(joint)
    return np.degrees(np.arccos(np.clip((np.trace(turned[:, j], axis1=1, axis2=2) - 1) / 2, -1, 1)))


def curves(film: Film, runs: dict[str, list[Configuration]], joints: Sequence[str], path: Path, title: str) -> None:
    """Angles of joints over time, the truth grey."""
    plt = pyplot()
    figure, axes = plt.subplots(len(joints), 1, figsize=(8, 2.1 * len(joints)), sharex=True, squeeze=False)
    for axis, joint in zip(axes[:, 0], joints):
        axis.plot(joint_angles(film, film.truth, joint), color="#a0a0a0", lw=4, label="truth")
        for name, poses in runs.items():
            axis.plot(joint_angles(film, poses, joint), color=COLOURS[name], lw=1.1, label=name)
        axis.set_ylabel(f"{joint} [°]")
    axes[0, 0].set_title(title)
    axes[0, 0].legend(ncols=4, fontsize=8)
    axes[-1, 0].set_xlabel("frame")
    figure.savefig(path)
    plt.close(figure)


def knees(film: Film, seeds: int, folder: Path) -> None:
    """Figure 1: knee bends with and without the penalty, a frame of something else among them."""
    masks = [with_lies(film, seed, "noisy", 1, 1000) for seed in range(seeds)]
    runs = {name: [track(film, one, WAYS[name])[0] for one in masks] for name in SHOWN}
    for name, made in runs.items():
        told(name, [errors(film.chain, one, film.truth) for one in made])
    curves(film, {name: made[0] for name, made in runs.items()}, ("LeftLeg", "RightLeg"), folder / "fig1_knee_bends.png",
           "Fig. 1: knees, 15 % noise, rectangles, one corrupted frame")


def noisy_run(film: Film, seeds: int, folder: Path) -> None:
    """Figure 2: a run with 15 % of all pixels wrong and three rectangles."""
    masks = [with_noise(film, seed) for seed in range(seeds)]
    runs = {name: [track(film, one, WAYS[name])[0] for one in masks] for name in SHOWN}
    for name, made in runs.items():
        told(name, [errors(film.chain, one, film.truth) for one in made])
    curves(film, {name: made[0] for name, made in runs.items()}, ("LeftLeg", "RightUpLeg", "LeftForeArm", "RightArm"),
           folder / f"fig2_noisy_{film.name.split()[0]}.png", f"Fig. 2: {film.name}, 15 % noise and rectangles")


def cartwheel(film: Film, seeds: int, folder: Path) -> None:
    """Figures 3 to 5: a cartwheel with frames of something else."""
    from PIL import Image

    plt = pyplot()
    for kind in ("clean", "noisy"):
        for many, every in BAD:
            masks = [with_lies(film, seed, kind, many, every) for seed in range(seeds)]
            figure, axis = plt.subplots(figsize=(8, 2.6))
            for name in SHOWN:
                runs = [track(film, one, WAYS[name])[0] for one in masks]
                made = [errors(film.chain, one, film.truth) for one in runs]
                lost = sum(one.angles[-10:].mean() > LOST for one in made)
                told(f"{kind}, {many} of {every}: {name}, {lost} of {seeds} lost", made)
                for one in made:
                    axis.plot(one.angles.mean(1), color=COLOURS[name], lw=1, label=name if one is made[0] else None)
                if (kind, many) == ("clean", 2) and every == 22:
                    shown = overlay(film, masks[0], runs[0], [len(film.truth) * k // 5 for k in (1, 2, 3, 4)])
                    Image.fromarray(shown).save(folder / f"fig4_cartwheel_{SHOWN.index(name)}.png")
            axis.set(ylabel="error [°]", xlabel="frame", yscale="log", title=f"Fig. 3: {film.name}, {kind}, {many} of {every} frames corrupted")
            axis.legend(fontsize=8)
            figure.savefig(folder / f"fig3_cartwheel_{kind}_{many}_of_{every}.png")
            plt.close(figure)


def off(film: Film, pose: Configuration, degrees: float, seed: int) -> Configuration:
    """A pose whose every joint, and whose hips, are turned by so much about some axis."""
    rng, chain = np.random.default_rng(seed), film.chain
    step = np.zeros(6 + len(chain))
    for j in np.flatnonzero(chain.count):
        at, many = chain.first[j], chain.count[j]
        turn = rng.normal(size=many)
        step[6 + at:6 + at + many] = np.radians(degrees) * turn / np.linalg.norm(turn)
    root, angles = pose.root.copy(), pose.angles.copy()
    retract_kernel(chain.first, chain.count, np.concatenate([np.zeros(6), step[6:]]), root, angles, chain.lower, chain.upper)
    axis = rng.normal(size=3)
    root[:3, :3] = exp(np.concatenate([np.zeros(3), np.radians(degrees) * axis / np.linalg.norm(axis)]))[:3, :3] @ root[:3, :3]
    return Configuration(root, angles)


def unknown(film: Film, seeds: int, _folder: Path) -> None:
    """A first pose that is off by 10° in every joint and at the hips; a body 5 % too tall, or too wide; found from six frames."""
    masks = [film.masks(t) for t in range(2, len(film.truth))]

    def run(surface, start: tuple[Configuration, Configuration]) -> list[Configuration]:
        tracker = Tracker(surface, film.lenses, RATE)
        state, poses = tracker.start(*start), list(film.truth[:2])
        for seen in masks:
            state = tracker.step(state, seen)
            poses.append(state.now)
        return poses
    known = (film.truth[1], film.truth[0])
    told("all known", [errors(film.chain, run(film.surface, known), film.truth)])
    made = [run(film.surface, (start, start)) for seed in range(seeds) for start in (off(film, film.truth[1], 10.0, seed),)]
    told("first pose off by 10°", [errors(film.chain, one, film.truth) for one in made])
    told("the same from the tenth frame on", [errors(film.chain, one[10:], film.truth[10:]) for one in made])
    for stature, girth in ((1.05, 1.0), (0.95, 1.0), (1.0, 1.15), (1.05, 0.9)):
        wrong = shaped(film.surface, stature, girth)
        told(f"{stature:g} as tall, {girth:g} as wide", [errors(film.chain, run(wrong, known), film.truth)])
        shape = fitted_shape(Tracker(wrong, film.lenses, RATE), *known, masks[:6])
        told(f"  then fitted: {shape.stature * stature:.3f}, {shape.girth * girth:.3f}", [errors(film.chain, run(shape.surface, known), film.truth)])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, metavar="DIR")
    parser.add_argument("-o", "--plots", type=Path, required=True, help="a folder for the figures")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--frames", type=int, default=90)
    parser.add_argument("--only", default="knees,run,cartwheel,unknown")
    args = parser.parse_args()
    pictures(parser, args.plots)
    parts = {"knees": (knees, ("squats 14_06",)), "run": (noisy_run, ("run 16_35", "squats 14_06")), "cartwheel": (cartwheel, ("cartwheel 49_06",)),
             "unknown": (unknown, ("run 16_35", "squats 14_06"))}
    for name in args.only.split(","):
        act, clips = parts[name]
        print(f"{name}: {' '.join((act.__doc__ or '').split())}", flush=True)
        for film in films(args.folder, 640, args.frames, clips):
            print(f"  {film.name}, {len(film.truth)} frames", flush=True)
            act(film, args.seeds, args.plots)


if __name__ == "__main__":
    main()
