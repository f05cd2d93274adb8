"""Pictures of walks to goals: plans in rooms, and to goals about a start."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from _plots import pyplot

from gambol.controllers.navigation.identification import read_paths
from gambol.controllers.navigation.planning import HUMAN, PUBLISHED, plan

RECORDED = Path(__file__).resolve().parents[2].parent / "shared" / "human_paths" / "human_paths.npz"
CLEARANCE = 0.30
BODY = 0.22
"""A body's capsule has this radius [m]."""
SETS = {"published": PUBLISHED, "human": HUMAN}


def draw_rooms(drawn, path: Path) -> None:
    """Plans in rooms, the disc of the clearance along them."""
    plt = pyplot()
    figure, axes = plt.subplots(3, 4, figsize=(16, 12))
    for axis, (shapes, made) in zip(axes.flat, drawn):
        for x, z, half, long, heading, radius in shapes:
            if radius > 0:
                axis.add_patch(plt.Circle((x, z), radius, color="0.6"))
            else:
                c, s = np.cos(heading), np.sin(heading)
                axis.fill(*[[x + a * c * half + b * s * long for a, b in ((1, 1), (1, -1), (-1, -1), (-1, 1))],
                            [z - a * s * half + b * c * long for a, b in ((1, 1), (1, -1), (-1, -1), (-1, 1))]], color="0.6")
        _, ground, _ = made.sampled(40)
        for place in ground:
            axis.add_patch(plt.Circle(place[:2], CLEARANCE, color="tab:blue", alpha=0.07))
        _arrows(axis, ground, "tab:blue")
        axis.set(aspect="equal", xlim=(4.5, -4.5), ylim=(-4.5, 4.5), title=f"{made.seconds:.1f} s")
    figure.savefig(path)
    plt.close(figure)


def _arrows(axis, ground, colour) -> None:
    axis.plot(ground[:, 0], ground[:, 1], color=colour)
    axis.quiver(ground[:, 0], ground[:, 1], np.sin(ground[:, 2]), np.cos(ground[:, 2]), color=colour, angles="xy", scale=25, width=0.004)


def around_the_start(limits, folder: Path) -> None:
    """Ten goals about the start, as figure 13 of Truong 2010 shows one; beside people's walks, moved to begin where the plans do."""
    plt = pyplot()
    figure, axes = plt.subplots(1, 3, figsize=(18, 6))
    for axis, (name, weights) in zip(axes, SETS.items()):
        for k in range(10):
            angle = 2 * np.pi * k / 10
            made = plan(np.zeros(3), (2 * np.sin(angle), 2 * np.cos(angle), 0.0), weights=weights, limits=limits)
            _arrows(axis, made.sampled(25)[1], f"C{k}")
        axis.set(aspect="equal", title=f"ten goals at 2 m, {name} weights, all to face up")
        axis.invert_xaxis()
    if RECORDED.exists():
        paths = read_paths(RECORDED)
        for n in range(len(paths)):
            axes[2].plot(*(paths.places[n] - paths.goals[n, :2]).T, color="black", lw=1.5)
            made = plan(paths.starts[n] - [*paths.goals[n, :2], 0], (0.0, 0.0, paths.goals[n, 2]), limits=limits)
            _arrows(axes[2], made.sampled(15)[1], "tab:blue")
        axes[2].set(aspect="equal", title="people (black) and plans to where they went, to face up")
        axes[2].invert_xaxis()
    figure.savefig(folder / "goals.png")
    plt.close(figure)
