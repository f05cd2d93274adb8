"""Measure what recorded starts and stops have beyond the blend at the same velocity and phase, and how much of it is common.

    python scripts/measure/starts.py DIR [--recipe assets/library/default.toml] [--library FILE]

DIR is the folder of motion capture that the recipe names. What remains is what a primitive made of all other clips'
starts (or stops) leaves of one clip's: where that is no smaller there is nothing that a primitive could tell.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from rich.progress import Progress

from gambol import assets
from gambol.controllers.locomotion import DEFAULT_LIBRARY, ControlSpace, Library, gather, read_recipe, first_stride_build

STOPS = np.linspace(-1.2, 0.0, 31)
"""Phases before the last foot comes down at which stops are compared."""
STANDS = 48
"""Frames of 1/120 s that both feet stand after a stop."""


def stops(track, library: Library, space: ControlSpace) -> list[np.ndarray]:
    """What the stops of a track have beyond the blend, (31, 3 J + 3) each, the left foot coming last."""
    feet, found = first_stride_build.steps(track), []
    for frames, phases in first_stride_build.strides(feet):
        last = phases[-1] % 0.5
        if abs(last - 0.38) < 0.01 and feet[frames[-1]:frames[-1] + STANDS].all() and phases[-1] - phases[0] >= 1.2:
            at = np.interp(STOPS, phases - phases[-1], frames).round().astype(int)
            told = (phases[-1] + STOPS) % 1.0
            way = first_stride_build.way_of(track, library, space, at, told)
            rows = first_stride_build.beyond(track, library, space, at, told, way)
            found.append(rows if phases[-1] % 1.0 < 0.5 else first_stride_build.mirrored(library, rows))
    return found


def remains(rows: np.ndarray, features: np.ndarray, clips: list[str]) -> np.ndarray:
    """Rows (N, G, D) less what a line through all other clips' rows, over features (N, F), says of them."""
    left = np.empty_like(rows)
    for n, clip in enumerate(clips):
        others = np.array([other != clip for other in clips])
        line = np.linalg.lstsq(features[others], rows[others].reshape(others.sum(), -1), rcond=None)[0]
        left[n] = rows[n] - (features[n] @ line).reshape(rows.shape[1:])
    return left


def degrees(rows: np.ndarray) -> np.ndarray:
    """RMS joint angle (G,) of rows (N, G, 3 J + 3), over the joints that differ at all."""
    size = (rows[..., :-3].reshape(*rows.shape[:2], -1, 3) ** 2).sum(-1)
    return np.degrees(np.sqrt(size[..., size.any((0, 1))].mean((0, 2))))


def told(name: str, phases: np.ndarray, rows: np.ndarray, features: np.ndarray, clips: list[str], chosen: np.ndarray) -> None:
    left = remains(rows, features, clips)
    every = np.linspace(0, len(phases) - 1, 7).astype(int)[1:-1]
    print(f"{name}: {chosen.sum()} of {len(set(np.array(clips)[chosen]))} clips, RMS joint angle [degrees] beyond the blend → what remains")
    print("   " + "   ".join(f"phase {phases[k]:5.2f}: {degrees(rows[chosen])[k]:4.1f} → {degrees(left[chosen])[k]:4.1f}" for k in every))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--recipe", type=Path, default=assets.path("library", "default.toml"))
    parser.add_argument("--library", type=Path, default=DEFAULT_LIBRARY)
    arguments = parser.parse_args()
    library = Library.load(arguments.library)
    space = first_stride_build.space_of(library, "walk")
    assert space is not None
    sources = [source for source in read_recipe(arguments.recipe)[0] if source.rest]
    with Progress(transient=True) as bar:
        task = bar.add_task("reading")
        tracks = [track for track, _, _ in gather(arguments.folder, sources, lambda what, done, of: bar.update(task, completed=done, total=of))[0]]
    found = [sample for track in tracks for sample in first_stride_build.samples(track, library, space)]
    turns = np.clip([sample.turn for sample in found], 0.0, first_stride_build.FASTEST_TURN)
    clips = [sample.clip for sample in found]
    rows, features = np.stack([sample.rows[0] for sample in found]), np.stack([np.ones_like(turns), turns], -1)
    told("Starts straight on", first_stride_build.grid(), rows, features, clips, turns <= 0.8)
    told("Starts that turn faster than 0.8 rad/s", first_stride_build.grid(), rows, features, clips, turns > 0.8)
    ends = [(track.clip.name, row) for track in tracks for row in stops(track, library, space)]
    rows = np.stack([row for _, row in ends])
    told("Stops", STOPS, rows, np.ones((len(rows), 1)), [name for name, _ in ends], np.ones(len(rows), bool))


if __name__ == "__main__":
    main()
