"""What a library can walk: which wishes lie in its control space, in figures and in words."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .control_space import SCALE, ControlSpace
from .library import Library
from .velocity_correction import space_of

FORWARD, BACKWARD = np.array([1.4, 2.5, 0.6]), np.array([0.7, 1.5, 0.6])
"""Half-axes of the wishes that a walker should meet: (v_f [m/s], ω [rad/s], v_l [m/s])."""
LEAST_WISHES, LEAST_SPEED, LEAST_QUALITY = 0.3, 0.7, 0.2
"""What meets a smaller share of a walker's wishes, goes ahead no faster [m/s], or whose simplices are flatter on the median, hardly walks."""
PLANES = {"v_l = 0": (0, 1), "ω = 0": (0, 2), "v_f = 0": (1, 2)}


def wishes(axes: tuple[int, int], count: int = 61) -> np.ndarray:
    """A grid (N, 3) over the half-ellipses FORWARD and BACKWARD in the plane of two axes."""
    grid = np.linspace(-1, 1, count)
    a, b = np.meshgrid(grid, grid, indexing="ij")
    points = np.zeros(a.shape + (3,))
    points[..., axes[0]], points[..., axes[1]] = a, b
    points = points[np.hypot(a, b) <= 1]
    return points * np.where(points[:, :1] >= 0, FORWARD, BACKWARD)


def coverage(space: ControlSpace) -> dict[str, float]:
    """The share of wishes in each coordinate plane that lies inside the hull: name → 0 … 1."""
    return {name: float(space.inside(wishes(axes)).mean()) for name, axes in PLANES.items()}


def reach(space: ControlSpace, direction: ArrayLike) -> float:
    """How far the hull reaches from zero along a direction (3,) in SI."""
    steps = np.linspace(0, 6, 1201)
    inside = space.inside(steps[:, None] * np.asarray(direction, float))
    return float(steps[inside][-1]) if inside.any() else 0.0


def report(library: Library) -> list[str]:
    """The library in words, a line each: what it holds, how far it reaches, what is missing."""
    families = {f: sum(p.family == f for p in library.primitives) for f in ("walk", "run", "rest")}
    mirrored = sum(p.mirrored for p in library.primitives)
    lines = [f"{len(library.primitives)} primitives: {families['walk']} walking, {families['run']} running, "
             f"{families['rest']} rest; {mirrored} of them mirrored copies that fill gaps"]
    space = space_of(library, "walk")
    ends = {name: reach(space, d) for name, d in (
        ("forward", (1, 0, 0)), ("backward", (-1, 0, 0)), ("left", (0, 0, 1)), ("right", (0, 0, -1)))}
    lines.append("walking reaches " + ", ".join(f"{name} {v:.2f} m/s" for name, v in ends.items())
                 + f", turning left {reach(space, (0, 1, 0)):.2f} and right {reach(space, (0, -1, 0)):.2f} rad/s")
    for name, speed in ends.items():
        wanted = {"forward": FORWARD[0], "backward": BACKWARD[0]}.get(name, FORWARD[2])
        if speed < wanted:
            lines.append(f"no {'lateral' if name in ('left', 'right') else 'walking'} {name} above {speed:.2f} m/s")
    for name, share in coverage(space).items():
        lines.append(f"plane {name}: {share:.0%} of the wishes of a walker inside the hull")
    quality = space.quality()
    lines.append(f"walking space: {len(space.simplices)} simplices, quality {np.percentile(quality, 5):.2f} (5 %) "
                 f"{np.median(quality):.2f} (median), steepest weight {space.lipschitz():.1f} per unit")
    runs = library.velocities[library.family("run")]
    if len(runs):
        lines.append(f"running from {runs[:, 0].min():.2f} to {runs[:, 0].max():.2f} m/s, "
                     f"turning {runs[:, 1].min():.2f} to {runs[:, 1].max():.2f} rad/s")
    worst = max(library.primitives, key=lambda p: p.closure)
    lines.append(f"worst closure {np.degrees(worst.closure):.1f}° ({worst.label}, {worst.clip})")
    met = float(np.mean(list(coverage(space).values())))
    if met < LEAST_WISHES or ends["forward"] < LEAST_SPEED or np.median(quality) < LEAST_QUALITY:
        lines.append(f"this hardly walks: it meets {met:.0%} of a walker's wishes, reaches {ends['forward']:.2f} m/s ahead, and the median quality is "
                     f"{np.median(quality):.2f}; are these takes of steady walking, straight on, turning and sideways?")
    return lines


def picture(library: Library, path) -> None:
    """Draw the control space as three planes, the hull filled and primitives as points, into a PNG.

    Needs matplotlib (`.venv/bin/pip install -e ".[report]"`).
    """
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    space = space_of(library, "walk")
    names = ("forward m/s", "turn rad/s (left +)", "lateral m/s (left +)")
    figure, axes = plt.subplots(1, 3, figsize=(13, 4.2), layout="constrained")
    for panel, (title, (i, j)) in zip(axes, PLANES.items()):
        half = np.maximum(FORWARD, BACKWARD) * 1.25
        x, y = np.meshgrid(np.linspace(-half[i], half[i], 160), np.linspace(-half[j], half[j], 160))
        query = np.zeros(x.shape + (3,))
        query[..., i], query[..., j] = x, y
        panel.contourf(x, y, space.inside(query), levels=[0.5, 1.5], colors=["#cfe3f2"])
        ring = wishes((i, j), 121)
        panel.plot(ring[:, i], ring[:, j], ",", color="#d9a066", alpha=0.25)
        other = 3 - i - j
        off = np.abs(space.points[:, other] / SCALE[other])
        panel.scatter(space.points[:, i], space.points[:, j], c=off, s=18, cmap="viridis_r")
        panel.set(title=f"{title}: {coverage(space)[title]:.0%} of wishes inside", xlabel=names[i], ylabel=names[j])
        panel.axhline(0, color="0.8", lw=0.5)
        panel.axvline(0, color="0.8", lw=0.5)
    figure.savefig(path, dpi=110)
    plt.close(figure)
