"""Measure tracking: how far poses are off with clean and with noisy silhouettes, corrupted frames, the rivals, and a frame's time.

    python scripts/measure/tracking.py DIR [--seeds 5] [--frames 120] [--only clean,noise,corrupted,rivals,images,time] [--plots FOLDER] [--keep FOLDER]

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
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import accumulate
from pathlib import Path

import numpy as np

from _plots import pictures
from _tracking import RATE, Errors, Film, errors, films, overlay, silhouette
from _tracking_ways import WAYS, Runs, lied, perfect, told, track, with_lies, with_noise

from gambol.controllers.tracking import Tracker
from gambol.controllers.tracking.rivals import KalmanFilter, OneEuro, savitzky_golay, smoothed
from gambol.controllers.tracking.segmentation import segmented
from gambol.controllers.tracking.twists import Configuration
from gambol.game.studio import late

LAGS = (0, 1, 2, 4, 8)
"""So many frames late may a pose come."""


def clean(runs: Runs, _seeds: int, _plots: Path | None) -> None:
    """Perfect silhouettes."""
    for name in WAYS:
        told(name, [runs.errors(runs.poses("clean", 0, name, lambda: perfect(runs.film)))])


def noise(runs: Runs, seeds: int, plots: Path | None) -> None:
    """The paper's 15 % and rectangles."""
    film, made = runs.film, {}
    for seed in range(seeds):  # a seed's silhouettes are made once
        for name in WAYS:
            made[name, seed] = runs.poses("noise", seed, name, lambda: with_noise(film, seed))
    for name in WAYS:
        told(name, [runs.errors(made[name, seed]) for seed in range(seeds)])
        if plots is not None:
            from PIL import Image

            shown = overlay(film, with_noise(film, 0), made[name, 0], [len(film.truth) * k // 5 for k in (1, 2, 3, 4)])
            Image.fromarray(shown).save(plots / f"{film.name} {name}.png".replace(" ", "_").replace(",", "").replace("'", ""))


def corrupted(runs: Runs, seeds: int, _plots: Path | None) -> None:
    """Two frames in 22 in which every camera stored something else: the silhouette of another moment, mirrored and elsewhere."""
    names = ("no penalty", "the paper's penalty", "ours, joints at rest", "ours, gate")
    for kind in ("clean", "noisy"):
        made = {(name, seed): runs.errors(runs.poses(f"{kind} 2 of 22", seed, name, lambda: with_lies(runs.film, seed, kind)))
                for seed in range(seeds) for name in names}
        for name in names:
            told(f"{kind}: {name}", [made[name, seed] for seed in range(seeds)])


def images(runs: Runs, seeds: int, plots: Path | None) -> None:
    """Pictures instead of silhouettes: without a fault, with the paper's 15 % and rectangles in them, with frames of something else."""
    from _footage import contours, shots, spoilt

    film = runs.film
    made = shots(film)

    @lru_cache(1)
    def seen(kind: str, seed: int) -> list[list[np.ndarray]]:
        good = made.pictures if kind.startswith("clean") else spoilt(made.pictures, seed)
        return lied(good, seed) if kind.endswith("corrupted") else good
    ways = ("no penalty", "the paper's penalty", "ours, joints at rest", "ours, gate", "ours, gate, empty pictures known")
    for kind in ("clean", "noisy", "clean, corrupted", "noisy, corrupted"):
        poses = {}
        for seed in range(1 if kind == "clean" else seeds):
            for name in ways:
                way, plates = name.removesuffix(", empty pictures known"), made.plates if "empty" in name else None
                poses[name, seed] = runs.poses(f"images {kind}", seed, name, lambda: seen(kind, seed),
                                               lambda film, one: track(film, one, WAYS[way], plates)[0])
        for name in ways:
            told(f"{kind}: {name}", [runs.errors(one) for (known, _), one in poses.items() if known == name])
        if plots is not None:
            from PIL import Image

            shown = contours(film, seen(kind, 0), poses["ours, gate", 0], [len(film.truth) * k // 5 for k in (1, 2, 3, 4)])
            Image.fromarray(shown).save(plots / f"{film.name} images {kind}.png".replace(" ", "_").replace(",", ""))
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


def rivals(runs: Runs, seeds: int, _plots: Path | None) -> None:
    """At lags of 0 to 8 frames: filters after each frame of a bare track, as good as their settings get at each lag, and ours, by one setting."""
    film, chain = runs.film, runs.film.chain

    def followed(way: str, lag: int = 0) -> list[list[Configuration]]:
        def follow(film: Film, masks: list) -> list[Configuration]:
            tracker = Tracker(film.surface, film.lenses, RATE, replace(WAYS[way], lag=lag))
            tracks = accumulate(masks, tracker.step, initial=tracker.start(film.truth[1], film.truth[0]))
            next(tracks)  # the start itself
            return [*film.truth[:2], *late(tracker, tracks)]
        return [runs.poses("noise", seed, way + f" {lag} late" * bool(lag), lambda: with_noise(film, seed), follow if lag else None) for seed in range(seeds)]

    def off(tracks: Sequence[list[Configuration]]) -> list[Errors]:
        return [errors(chain, one, film.truth) for one in tracks]
    bare, ours = followed("no penalty"), followed("ours, joints at rest")
    told("none", off(bare))
    told("our penalty, in the loop", off(ours))
    causal: dict[str, list[Callable]] = {
        "One-Euro": [lambda p, c=c, b=b: smoothed(chain, p, OneEuro(RATE, c, b)) for c in (1.0, 2.0, 4.0, 8.0) for b in (0.3, 1.0, 3.0, 10.0)],
        "Kalman, constant velocity": [lambda p, q=q: smoothed(chain, p, KalmanFilter(RATE, q, 0.05)) for q in (3.0, 10.0, 30.0, 60.0, 120.0)]}
    made = {name: [[way(one) for one in bare] for way in ways] for name, ways in causal.items()}
    waited = {(name, lag): _best([off([poses[lag:] + poses[-1:] * lag for poses in tracks]) for tracks in made[name]]) for name in made for lag in LAGS}
    for lag in LAGS:
        for name in causal:  # what lags less by itself is taken earlier
            told(f"lag {lag}: {name}", _best([waited[name, less] for less in LAGS if less <= lag]))
        for what, tracks in (("Savitzky-Golay", bare), ("Savitzky-Golay after ours", ours)):
            told(f"lag {lag}: {what}", _best([off([savitzky_golay(chain, one, reach, ahead=lag) for one in tracks]) for reach in (3, 5, 8, 12)]))
        if lag:
            told(f"lag {lag}: ours, in hindsight", off(followed("ours, joints at rest", lag)))


def _best(trials: Sequence[list[Errors]]) -> list[Errors]:
    """Those whose angles are least off."""
    return min(trials, key=lambda made: float(np.mean([one.angles.mean() for one in made])))


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
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--frames", type=int, default=120)
    parser.add_argument("--width", type=int, default=640)
    parser.add_argument("--only", default="clean,noise,corrupted,rivals,time")
    parser.add_argument("--clips", default="", help="parts of clips' names, with commas")
    parser.add_argument("--plots", type=Path, help="a folder for pictures of contours and model under noise")
    parser.add_argument("--keep", type=Path, help="a folder for tracks, of one state of the sources: what was broken off goes on")
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
            parts[name](Runs(film, args.keep), args.seeds, args.plots)
    if "time" in wanted:
        print("time: four cameras, one thread, silhouettes given")
        times(args.folder, 80)


if __name__ == "__main__":
    main()
