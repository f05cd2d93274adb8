"""Measure tracking: how far poses are off with clean and with noisy silhouettes, corrupted frames, the rivals, and a frame's time.

    python scripts/measure/tracking.py DIR [--seeds 3] [--frames 120] [--only clean,noise,corrupted,rivals,images,time] [--plots FOLDER]

DIR is a folder of motion capture with CMU's subjects 14, 16 and 49 in it. Each clip is first brought onto the chain's 26
degrees of freedom, and that is filmed from four sides at 60 frames a second: what is measured is tracking, not how stiff a
trunk is. The film's mesh and the model's are the same. Angles are geodesic, of each joint that turns and the hips; the turn
of a limb about itself is told apart, as silhouettes hardly show it. Noise: silhouettes with 15 % of all pixels wrong and
three rectangles, then the majority of 5 × 5 pixels, in place of a segmentation of such pictures. Images are the real thing:
somebody in patterned clothes among clutter, drawn as the studio draws, segmented and followed; a second of it takes a minute.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from _plots import pictures
from _tracking import RATE, Film, errors, films, overlay, silhouette
from _tracking_ways import BARE, OURS, WAYS, lied, told, track, with_lies, with_noise

from gambol.controllers.tracking import Tracker
from gambol.controllers.tracking.rivals import KalmanFilter, OneEuro, savitzky_golay, smoothed
from gambol.controllers.tracking.segmentation import segmented

def clean(film: Film, _seeds: int, _plots: Path | None) -> None:
    """Perfect silhouettes."""
    masks = [film.masks(t) for t in range(2, len(film.truth))]
    for name, settings in WAYS.items():
        told(name, [errors(film.chain, track(film, masks, settings)[0], film.truth)])


def noise(film: Film, seeds: int, plots: Path | None) -> None:
    """The paper's 15 % and rectangles."""
    masks = [with_noise(film, seed) for seed in range(seeds)]
    for name, settings in WAYS.items():
        made = [track(film, one, settings)[0] for one in masks]
        told(name, [errors(film.chain, one, film.truth) for one in made])
        if plots is not None:
            from PIL import Image

            shown = overlay(film, masks[0], made[0], [len(film.truth) * k // 5 for k in (1, 2, 3, 4)])
            Image.fromarray(shown).save(plots / f"{film.name} {name}.png".replace(" ", "_").replace(",", "").replace("'", ""))


def corrupted(film: Film, seeds: int, _plots: Path | None) -> None:
    """Two frames in 22 in which every camera stored something else: the silhouette of another moment, mirrored and elsewhere."""
    for kind in ("clean", "noisy"):
        made = [with_lies(film, seed, kind) for seed in range(seeds)]
        for name in ("no penalty", "the paper's penalty", "ours, joints at rest", "ours, gate"):
            told(f"{kind}: {name}", [errors(film.chain, track(film, masks, WAYS[name])[0], film.truth) for masks in made])


def images(film: Film, seeds: int, plots: Path | None) -> None:
    """Pictures instead of silhouettes: without a fault, with the paper's 15 % and rectangles in them, with frames of something else."""
    from _footage import contours, shots, spoilt

    made = shots(film)
    kinds = {"clean": [made.pictures], "noisy": [spoilt(made.pictures, seed) for seed in range(seeds)]}
    kinds |= {f"{kind}, corrupted": [lied(one, seed) for seed, one in enumerate(kinds[kind])] for kind in ("clean", "noisy")}
    for kind, films_ in kinds.items():
        for name in ("no penalty", "the paper's penalty", "ours, joints at rest", "ours, gate", "ours, gate, empty pictures known"):
            plates = made.plates if "empty" in name else None
            runs = [track(film, one, WAYS[name.removesuffix(", empty pictures known")], plates) for one in films_]
            told(f"{kind}: {name}", [errors(film.chain, one, film.truth) for one, _ in runs])
            if plots is not None and name == "ours, gate":
                from PIL import Image

                frames = [len(film.truth) * k // 5 for k in (1, 2, 3, 4)]
                Image.fromarray(contours(film, films_[0], runs[0][0], frames)).save(plots / f"{film.name} images {kind}.png".replace(" ", "_").replace(",", ""))
    tracker, drawn = Tracker(film.surface, film.lenses, RATE), silhouette(film, film.lenses[0], film.truth[2])
    state = tracker.step(tracker.start(film.truth[1], film.truth[0]), made.pictures[0])
    for what, act in (("one view's segmentation", lambda _: segmented(made.pictures[0][0], drawn)),
                      ("a frame of four views, all in", lambda k: tracker.step(state, made.pictures[1]))):
        spent, worked = [], []
        for k in range(20):
            begun, own = time.perf_counter(), time.process_time()
            act(k)
            spent.append(1e3 * (time.perf_counter() - begun))
            worked.append(1e3 * (time.process_time() - own))
        print(f"    {what}: {np.median(spent):.1f} ms (least {min(spent):.1f}); processor {np.median(worked):.1f} ms (least {min(worked):.1f})")


def rivals(film: Film, seeds: int, _plots: Path | None) -> None:
    """Filters after each frame of a bare track, tuned to lag as far as the penalty does, or as little as they can; and both."""
    masks = [with_noise(film, seed) for seed in range(seeds)]
    bare = [track(film, one, BARE)[0] for one in masks]
    ours = [track(film, one, OURS)[0] for one in masks]
    base = [errors(film.chain, one, film.truth) for one in ours]
    lag = float(np.mean([one.lag for one in base]))
    told("none", [errors(film.chain, one, film.truth) for one in bare])
    told("our penalty, in the loop", base)
    families: dict[str, list[Callable]] = {
        "One-Euro": [lambda p, c=c, b=b: smoothed(film.chain, p, OneEuro(RATE, c, b)) for c in (1.0, 2.0, 4.0, 8.0) for b in (0.3, 1.0, 3.0)],
        "Kalman, constant velocity": [lambda p, q=q: smoothed(film.chain, p, KalmanFilter(RATE, q, 0.05)) for q in (10.0, 30.0, 60.0, 120.0)],
        "Savitzky-Golay, sees the future": [lambda p, r=r: savitzky_golay(film.chain, p, r) for r in (3, 5, 8)]}
    for name, ways in families.items():
        trials = [[errors(film.chain, way(one), film.truth) for one in bare] for way in ways]
        near = [one for one in trials if np.mean([e.lag for e in one]) <= max(lag, 0.0) + 0.25] or [
            min(trials, key=lambda one: np.mean([e.lag for e in one]))]
        told(name, min(near, key=lambda one: np.mean([e.angles.mean() for e in one])))


def times(folder: Path, frames: int) -> None:
    """A frame's time, all in but the segmentation, four cameras; beside it the processor's own, which other programs hardly lengthen."""
    for width in (640, 320):
        for film in films(folder, width, frames, ("run 16_35",)):
            masks = [film.masks(t) for t in range(2, len(film.truth))]
            tracker, spent, worked = Tracker(film.surface, film.lenses, RATE), [], []
            for _ in range(2):
                state, spent, worked = tracker.start(film.truth[1], film.truth[0]), [], []
                for seen in masks:
                    begun, own = time.perf_counter(), time.process_time()
                    state = tracker.step(state, seen)
                    spent.append(1e3 * (time.perf_counter() - begun))
                    worked.append(1e3 * (time.process_time() - own))
            print(f"  {width} × {width * 3 // 4}: {np.median(spent):.0f} ms a frame (p95 {np.percentile(spent, 95):.0f}, least {min(spent):.0f}); processor {np.median(worked):.0f} ms (least {min(worked):.0f})")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, metavar="DIR")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--frames", type=int, default=120)
    parser.add_argument("--width", type=int, default=640)
    parser.add_argument("--only", default="clean,noise,corrupted,rivals,time")
    parser.add_argument("--clips", default="", help="parts of clips' names, with commas")
    parser.add_argument("--plots", type=Path, help="a folder for pictures of contours and model under noise")
    args = parser.parse_args()
    pictures(parser, args.plots)
    parts = {"clean": clean, "noise": noise, "corrupted": corrupted, "rivals": rivals, "images": images}
    wanted = [part for part in args.only.split(",") if part]
    every = [film for film in films(args.folder, args.width, args.frames) if any(word in film.name for word in args.clips.split(","))]
    for name in wanted:
        if name not in parts:
            continue
        print(f"{name}: {' '.join((parts[name].__doc__ or '').split())}")
        for film in every:
            print(f"  {film.name}, {len(film.truth)} frames, {args.width} × {args.width * 3 // 4}")
            parts[name](film, args.seeds, args.plots)
    if "time" in wanted:
        print("time: four cameras, one thread, silhouettes given")
        times(args.folder, 80)


if __name__ == "__main__":
    main()
