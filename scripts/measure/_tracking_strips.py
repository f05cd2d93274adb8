"""Frames of a tracked clip as a body on a stage, what a camera saw in a corner of each, and under each how far off it is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from _plots import pyplot
from _tracking import Film, errors

from gambol.controllers.tracking.cameras import Lens
from gambol.controllers.tracking.twists import Configuration, posed
from gambol.game.hosts import Offscreen
from gambol.game.scene import Camera, Figure, Scene

FRAMES = 6
SIZE = 300
CAMERA = 0


def strips(rows: Mapping[str, Sequence[Configuration]], film: Film, masks: Sequence[Sequence[np.ndarray]], path: Path, title: str) -> None:
    """A row for each track of a film, over the same frames, as one camera sees them. masks: what cameras saw from the third frame on."""
    plt, lens = pyplot(), film.lenses[CAMERA]
    frames = [2 + (len(film.truth) - 3) * k // (FRAMES - 1) for k in range(FRAMES)]
    figure, axes = plt.subplots(len(rows), FRAMES, figsize=(2.1 * FRAMES, 2.35 * len(rows)), squeeze=False)
    with Offscreen((SIZE, SIZE), "full") as stage:
        for line, (name, poses) in zip(axes, rows.items()):
            off = errors(film.chain, poses, film.truth)
            for axis, t in zip(line, frames):
                positions, orientations, _ = posed(film.chain, poses[t])
                at = posed(film.chain, film.truth[t])[0].mean(0)
                picture = np.asarray(stage.frame(Scene(_towards(lens, at), (Figure(positions, orientations),))))[..., :3].copy()
                small = np.where(masks[t - 2][CAMERA][::6, ::6, None], 230, 40).astype(np.uint8).repeat(3, -1)
                picture[:small.shape[0], -small.shape[1]:] = small
                axis.imshow(picture)
                axis.set_axis_off()
                axis.set_title(f"frame {t}" if name == "truth" else f"{off.angles[t].mean():.1f}°, {100 * off.metres[t].mean():.1f} cm", fontsize=8)
            told = "" if name == "truth" else f"\n{off.angles.mean():.1f}°, {100 * off.metres.mean():.1f} cm"
            line[0].text(-0.05, 0.5, name + told, rotation=90, transform=line[0].transAxes, ha="right", va="center", fontsize=8)
    figure.suptitle(title, y=0.95, fontsize=9)
    figure.savefig(path)
    plt.close(figure)


def _towards(lens: Lens, at: np.ndarray) -> Camera:
    """A camera in a lens's place that looks at somebody closely."""
    return Camera(lens.eye, at, np.array([0.0, 1.0, 0.0]), float(2 * np.arctan(1.15 / np.linalg.norm(lens.eye - at))))
