"""The figures of Rosenhahn 2007 on films of our own, with tables of errors: knees that bend, a noisy run, a corrupted cartwheel, and what the paper leaves out.

    python scripts/measure/tracking_figures.py DIR -o FOLDER [--seeds 5] [--frames 90] [--keep FOLDER]

DIR is a folder of motion capture with CMU's subjects 14, 16 and 49 in it, as for `tracking.py`, which says how things are
measured. Silhouettes, four cameras of 640 × 480. The model is followed from two poses that are known but where it says otherwise.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from _plots import pictures, pyplot
from _tracking import RATE, Film, films, overlay
from _tracking_strips import strips
from _tracking_ways import Runs, perfect, told, with_lies, with_noise

from gambol.controllers.tracking import Tracker, fitted_shape
from gambol.controllers.tracking.silhouettes import Surface, shaped
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


def knees(runs: Runs, seeds: int, folder: Path) -> None:
    """Figure 1: knee bends with and without the penalty, a frame of something else among them."""
    made = compared(runs, seeds, "noisy 1 of 1000", lambda seed: with_lies(runs.film, seed, "noisy", 1, 1000))
    curves(runs.film, {name: made[name, 0] for name in SHOWN}, ("LeftLeg", "RightLeg"), folder / "fig1_knee_bends.png",
           "Fig. 1: knees, 15 % noise, rectangles, one corrupted frame")


def noisy_run(runs: Runs, seeds: int, folder: Path) -> None:
    """Figure 2: a run with 15 % of all pixels wrong and three rectangles."""
    film = runs.film
    made = compared(runs, seeds, "noise", lambda seed: with_noise(film, seed))
    curves(film, {name: made[name, 0] for name in SHOWN}, ("LeftLeg", "RightUpLeg", "LeftForeArm", "RightArm"),
           folder / f"fig2_noisy_{film.name.split()[0]}.png", f"Fig. 2: {film.name}, 15 % noise and rectangles")


def compared(runs: Runs, seeds: int, what: str, seen: Callable[[int], list]) -> dict[tuple[str, int], list[Configuration]]:
    """Tracks of what is seen in each of the ways shown, and a line for each way: by (way, seed)."""
    made = {}
    for seed in range(seeds):
        for name in SHOWN:
            made[name, seed] = runs.poses(what, seed, name, lambda: seen(seed))
    for name in SHOWN:
        all_of = [runs.errors(made[name, seed]) for seed in range(seeds)]
        lost = sum(one.angles[-10:].mean() > LOST for one in all_of)
        told(f"{what}: {name}, {lost} of {seeds} lost", all_of)
    return made


def cartwheel(runs: Runs, seeds: int, folder: Path) -> None:
    """Figures 3 to 5: a cartwheel with frames of something else; its curves of errors, its contours, and the body as it is tracked."""
    from PIL import Image

    film, plt = runs.film, pyplot()
    for kind in ("clean", "noisy"):
        for many, every in BAD:
            made = compared(runs, seeds, f"{kind} {many} of {every}", lambda seed: with_lies(film, seed, kind, many, every))
            figure, axis = plt.subplots(figsize=(8, 2.6))
            for (name, seed), poses in made.items():
                axis.plot(runs.errors(poses).angles.mean(1), color=COLOURS[name], lw=1, label=None if seed else name)
            axis.set(ylabel="error [°]", xlabel="frame", yscale="log", title=f"Fig. 3: {film.name}, {kind}, {many} of {every} frames corrupted")
            axis.legend(fontsize=8)
            figure.savefig(folder / f"fig3_cartwheel_{kind}_{many}_of_{every}.png")
            plt.close(figure)
            if every == 22:
                masks, frames = with_lies(film, 0, kind, many, every), [len(film.truth) * k // 5 for k in (1, 2, 3, 4)]
                for k, name in enumerate(SHOWN if kind == "clean" else ()):
                    Image.fromarray(overlay(film, masks, made[name, 0], frames)).save(folder / f"fig4_cartwheel_{k}.png")
                strips({"truth": film.truth, **{name: made[name, 0] for name in SHOWN}}, film, masks, folder / f"fig5_cartwheel_{kind}.png",
                       f"Fig. 5: {film.name}, {kind}, {many} of {every} frames corrupted")


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


def unknown(runs: Runs, seeds: int, _folder: Path) -> None:
    """A first pose that is off by 10° in every joint and at the hips; a body 5 % too tall, or too wide; found from six frames."""
    film = runs.film
    known = (film.truth[1], film.truth[0])

    def run(what: str, seed: int, start: tuple[Configuration, Configuration], body: Callable[[], Surface] = lambda: film.surface) -> list[Configuration]:
        def follow(_film: Film, masks: list) -> list[Configuration]:
            tracker = Tracker(body(), film.lenses, RATE)
            state, poses = tracker.start(*start), list(film.truth[:2])
            for seen in masks:
                state = tracker.step(state, seen)
                poses.append(state.now)
            return poses
        return runs.poses(what, seed, "ours, gate", lambda: perfect(film), follow)
    told("all known", [runs.errors(run("clean", 0, known))])
    made = [run("first pose off", seed, (start, start)) for seed in range(seeds) for start in (off(film, film.truth[1], 10.0, seed),)]
    told("first pose off by 10°", [runs.errors(one) for one in made])
    told("the same from the tenth frame on", [runs.errors(one, 10) for one in made])
    for stature, girth in ((1.05, 1.0), (0.95, 1.0), (1.0, 1.15), (1.05, 0.9)):
        def wrong() -> Surface:
            return shaped(film.surface, stature, girth)

        def found() -> Surface:
            shape = fitted_shape(Tracker(wrong(), film.lenses, RATE), *known, perfect(film)[:6])
            print(f"    found {shape.stature * stature:.3f} as tall, {shape.girth * girth:.3f} as wide")
            return shape.surface
        told(f"{stature:g} as tall, {girth:g} as wide", [runs.errors(run(f"body {stature} {girth}", 0, known, wrong))])
        told("  then its size found from six frames", [runs.errors(run(f"body {stature} {girth} found", 0, known, found))])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, metavar="DIR")
    parser.add_argument("-o", "--plots", type=Path, required=True, help="a folder for the figures")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--frames", type=int, default=90)
    parser.add_argument("--only", default="knees,run,cartwheel,unknown")
    parser.add_argument("--keep", type=Path, help="a folder for tracks, as of tracking.py: what was broken off goes on")
    args = parser.parse_args()
    pictures(parser, args.plots)
    parts = {"knees": (knees, ("squats 14_06",)), "run": (noisy_run, ("run 16_35", "squats 14_06")), "cartwheel": (cartwheel, ("cartwheel 49_06",)),
             "unknown": (unknown, ("run 16_35", "squats 14_06"))}
    for name in args.only.split(","):
        act, clips = parts[name]
        print(f"{name}: {' '.join((act.__doc__ or '').split())}", flush=True)
        for film in films(args.folder, 640, args.frames, clips):
            print(f"  {film.name}, {len(film.truth)} frames", flush=True)
            act(Runs(film, args.keep), args.seeds, args.plots)


if __name__ == "__main__":
    main()
