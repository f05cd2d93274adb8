"""From outcomes to figures, and from figures to tables and plots."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from gambol.controllers.body import forward_kinematics
from gambol.controllers.reconstruction import SKELETON, parse
from gambol.controllers.reconstruction.evaluation import Outcome, metrics
from gambol.controllers.reconstruction.regression import SPAN

TRACKERS = """### Network for trackers

| chosen | among | on | in use |
|---|---|---|---|
| how much of one's own motion is taught | 0, 0.25, 0.5, 0.75, 1 of the way | eight of NCSOFT's takes, and these takes | 0.5 |

Versions of it were compared on these takes alone; [what the one in use has there](validation.md). Set poses' deviations were not tuned."""
"""What was chosen of the network for trackers, told beside what was tuned of the methods."""
FAR = 0.2
"""A frame is lost beyond this mean error [m]."""
PRINTED = {
    "GPLVM": (56.76, 41.88, 16.13, 9.45, 5.92), "LPCA": (43.27, 29.25, 10.56, 6.39, 3.81),
    "LPCR": (38.71, 23.61, 7.33, 4.73, 3.22), "Proposed Method": (18.63, 7.86, 2.67, 2.25, 1.90),
}
"""Table 1 of Mousas 2014, for 2 … 6 points; its unit is not told."""
PRINTED_SIZES = {"GPLVM": (5.86, 26.57), "LPCA": (3.92, 3.02), "LPCR": (3.38, 2.75), "Proposed Method": (2.01, 1.56)}
"""Its Table 2, for 69,888 and 1.1 M poses."""


@dataclass(frozen=True, eq=False)
class Figures:
    """One method on one course, a number for each take (N,): centimetres, degrees, frames.

    position, aligned: mean joint distance. angle: of a joint, root mean square. column: the same of a degree of freedom.
    residual: of the control points. worst: the frame's that is farthest off. lost: frames beyond `FAR`. frames: in all.
    jitter, true_jitter: mean third derivative [m/s³]; of interpolated takes they say nothing. lag: in frames.
    """

    position: np.ndarray
    aligned: np.ndarray
    angle: np.ndarray
    column: np.ndarray
    residual: np.ndarray
    worst: np.ndarray
    lost: np.ndarray
    frames: np.ndarray
    jitter: np.ndarray
    true_jitter: np.ndarray
    lag: np.ndarray

    @property
    def shake(self) -> float:
        """How many times as much as the recordings it jitters."""
        return float(self.jitter.mean() / self.true_jitter.mean())


def figures(outcomes: Sequence[Outcome], points: str) -> Figures:
    """The figures of outcomes with some control points."""
    return Figures(*np.array([_of(outcome, points) for outcome in outcomes]).T)


def _of(outcome, points):
    trial = outcome.trial
    truth, turned, errors = trial.positions[SPAN:], trial.rotations[SPAN:], outcome.errors
    placed = parse(points, SKELETON).on(*forward_kinematics(SKELETON, outcome.positions[:, 0], outcome.rotations))
    return (100 * errors.mean(), 100 * metrics.aligned_error(outcome.positions, truth).mean(),
            np.degrees(metrics.angle_error(outcome.rotations, turned).mean()),
            np.degrees(metrics.column_error(outcome.rotations, turned).mean()),
            100 * np.linalg.norm(placed - trial.points[SPAN:], axis=-1).mean(), 100 * errors.max(), np.sum(errors > FAR),
            len(errors), metrics.jitter(outcome.positions, trial.dt), metrics.jitter(truth, trial.dt),
            metrics.lag(outcome.positions, truth))


def against(ours: np.ndarray, other: np.ndarray) -> str:
    """The mean difference of two methods on the same takes, and its paired bootstrap interval of 95 %."""
    low, high = metrics.interval(ours - other, np.random.default_rng(0))
    return f"{np.mean(ours - other):+.2f} [{low:+.2f}, {high:+.2f}]"


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table in Markdown that is as readable in a terminal."""
    widths = [max(len(str(row[i])) for row in (head, *rows)) for i in range(len(head))]

    def line(cells: Sequence[str]) -> str:
        return "| " + " | ".join(str(cell).ljust(width) if i == 0 else str(cell).rjust(width)
                                 for i, (cell, width) in enumerate(zip(cells, widths, strict=True))) + " |"
    rule = "|" + "|".join("-" * (width + 2) if i == 0 else "-" * (width + 1) + ":" for i, width in enumerate(widths)) + "|"
    return "\n".join([line(head), rule, *map(line, rows)])


def lines(path: Path, across: Sequence[str], errors: dict[str, Sequence[float]], title: str, axis: str) -> None:
    """A line for each method."""
    def draw(ax) -> None:
        for name, values in errors.items():
            ax.plot(range(len(across)), values, "o-", ms=3.5, **_look(name))
        ax.set_xticks(range(len(across)), across)
        ax.set(xlabel=axis, ylabel="mean joint error [cm]", title=title, ylim=(0, _top(errors)))
    _plot(path, draw)


def bars(path: Path, across: Sequence[str], errors: dict[str, Sequence[float]], title: str) -> None:
    """A group of bars for each of `across`."""
    def draw(ax) -> None:
        width = 0.85 / len(errors)
        for k, (name, values) in enumerate(errors.items()):
            ax.bar(np.arange(len(across)) + (k - (len(errors) - 1) / 2) * width, values, width, **_look(name))
        ax.set_xticks(range(len(across)), across)
        ax.set(ylabel="mean joint error [cm]", title=title, ylim=(0, _top(errors)))
    _plot(path, draw)


_COLOURS = {"GPLVM": "#9c9c9c", "LPCA": "#e3a34a", "LPCR": "#c4622d", "Mousas to the letter": "#d9b8d4",
            "Mousas mended": "#93508f", "nearest + IK": "#b9d3a5", "ridge + IK": "#6fa35c", "network + IK": "#4d8fb0"}


def _top(errors):
    """Just above whatever has not wandered off by half a metre."""
    return 1.08 * max((value for values in errors.values() for value in values if value < 50.0), default=1.0)


def _look(name):
    return {"color": _COLOURS.get(name, "#111111"), "label": name, "linewidth": 2.2 if name not in _COLOURS else 1.2}


def _plot(path, draw: Callable) -> None:
    try:
        import matplotlib
    except ImportError:
        print(f"{path.name} is not drawn: matplotlib is missing, which the extra `report` brings", file=sys.stderr)
        return
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, ax = plt.subplots(figsize=(7.5, 3.9), layout="constrained")
    draw(ax)
    ax.spines[["top", "right"]].set_visible(False)
    ax.grid(axis="y", alpha=0.25)
    ax.legend(fontsize=7, frameon=False, ncols=2)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110, metadata={"Software": None})
    plt.close(figure)
