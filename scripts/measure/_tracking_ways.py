"""What measuring tracking shares: the ways that are compared, a track of a film, silhouettes spoilt and frames that lie."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from _tracking import RATE, Errors, Film, errors, noisy

from gambol.controllers.tracking import Track, Tracker, TrackerSettings
from gambol.controllers.tracking.twists import Configuration

BARE = TrackerSettings(penalty=False, gate=False)
PAPER = TrackerSettings(pace=1.0, gate=False)
OURS = TrackerSettings(gate=False)
WAYS = {"no penalty": BARE, "the paper's penalty": PAPER, "ours, joints at rest": OURS, "ours, gate": TrackerSettings(),
        "no penalty, from the last pose": replace(BARE, start="last")}


@dataclass(frozen=True)
class Runs:
    """Tracks of a film, kept in a folder where there is one: what was broken off goes on. A folder is for one state of the sources."""

    film: Film
    folder: Path | None = None

    def poses(self, what: str, seed: int, way: str, seen: Callable[[], Sequence[Sequence[np.ndarray | None]]],
              follow: Callable[..., list[Configuration]] | None = None) -> list[Configuration]:
        """Poses of all frames of what is seen, followed in one of `WAYS`, or by `follow(film, seen)`; from the folder if they are there."""
        name = f"{self.film.name} {self.film.lenses[0].size[0]} {len(self.film.truth)} {what} {seed} {way}".replace(" ", "_")
        path = None if self.folder is None else self.folder / f"{''.join(c for c in name if c.isalnum() or c in '_-.')}.npz"
        if path is not None and path.exists():
            with np.load(path) as file:
                return [Configuration(root, angles) for root, angles in zip(file["root"], file["angles"])]
        made = follow(self.film, seen()) if follow else track(self.film, seen(), WAYS[way])[0]
        if path is not None:
            path.parent.mkdir(parents=True, exist_ok=True)
            part = path.with_suffix(".part.npz")
            np.savez_compressed(part, root=np.stack([one.root for one in made]), angles=np.stack([one.angles for one in made]))
            part.replace(path)
        return made

    def errors(self, poses: Sequence[Configuration], first: int = 0) -> Errors:
        """How far poses are off, from a frame on."""
        return errors(self.film.chain, poses[first:], self.film.truth[first:])


def track(film: Film, masks: Sequence[Sequence[np.ndarray | None]], settings: TrackerSettings, plates: Sequence[np.ndarray] | None = None
          ) -> tuple[list[Configuration], list[Track]]:
    """Poses of all frames, the first two given."""
    tracker = Tracker(film.surface, film.lenses, RATE, settings, None if plates is None else tuple(plates))
    state, tracks = tracker.start(film.truth[1], film.truth[0]), []
    for seen in masks:
        state = tracker.step(state, seen)
        tracks.append(state)
    return [*film.truth[:2], *(one.now for one in tracks)], tracks


def told(name: str, made: Sequence[Errors]) -> None:
    """One line for several tracks: joined, and the mean error of each."""
    joined = Errors(*(np.concatenate([getattr(one, part) for one in made]) for part in ("angles", "swings", "twists", "metres")),
                    float(np.mean([one.jitter for one in made])), float(np.mean([one.lag for one in made])))
    each = "" if len(made) == 1 else "; by seed " + " ".join(f"{one.angles.mean():.1f}" for one in made)
    print(f"    {name:32} {joined.told()}{each}", flush=True)


@lru_cache(1)
def perfect(film: Film) -> list[list[np.ndarray]]:
    """Silhouettes from the third frame on."""
    return [film.masks(t) for t in range(2, len(film.truth))]


@lru_cache(1)
def with_noise(film: Film, seed: int) -> list[list[np.ndarray]]:
    """Silhouettes from the third frame on with the paper's 15 % and rectangles."""
    rng = np.random.default_rng(seed)
    return [[noisy(mask, rng) for mask in masks] for masks in perfect(film)]


def with_lies(film: Film, seed: int, kind: str, many: int = 2, every: int = 22) -> list[list[np.ndarray]]:
    """Silhouettes, clean or noisy, `many` frames in `every` of something else."""
    return lied(perfect(film) if kind == "clean" else with_noise(film, seed), seed, many, every)


def lied(seen: Sequence[list[np.ndarray]], seed: int, many: int = 2, every: int = 22) -> list[list[np.ndarray]]:
    """Masks or pictures, `many` frames in `every` of another moment's, mirrored and elsewhere."""
    rng, out = np.random.default_rng(100 + seed), list(seen)
    for start in range(int(rng.integers(8, 22)), len(out) - many, every):
        for t in range(start, start + many):
            other = out[int(rng.integers(0, len(out)))]
            out[t] = [np.roll(one[:, ::-1], rng.integers(-40, 41, 2) * one.shape[1] // 640, (0, 1)) for one in other]
    return out
