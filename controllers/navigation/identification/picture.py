"""People's walks to goals and planned ones, drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..planning import Plan
from .human_paths import HumanPaths

COLOURS = "#d1495b", "#2e86ab", "#6a994e"
ARROWS = 14
"""So many headings are drawn on a walk."""


def picture(paths: HumanPaths, planned: Mapping[str, Sequence[Plan]], path) -> None:
    """Draw every walk in a panel, recorded in black and planned ones by name in colours, seen from above, into a PNG.

    Needs matplotlib (`.venv/bin/pip install -e ".[report]"`).
    """
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    across = min(len(paths), 5)
    down = -(-len(paths) // across)
    figure, axes = plt.subplots(down, across, figsize=(3.1 * across, 3.1 * down), layout="constrained", squeeze=False)
    for axis in axes.flat:
        axis.axis("off")
    for n, axis in zip(range(len(paths)), axes.flat):
        axis.plot(*paths.places[n].T, color="black", lw=2.2, label="people")
        for (name, plans), colour in zip(planned.items(), COLOURS):
            if plans[n].reason:
                continue
            _, ground, _ = plans[n].sampled(8 * ARROWS + 1)
            axis.plot(ground[:, 0], ground[:, 1], color=colour, lw=1.3, label=name)
            some = ground[::8]
            axis.quiver(some[:, 0], some[:, 1], np.sin(some[:, 2]), np.cos(some[:, 2]), color=colour, angles="xy", scale=16, width=0.005)
        for end, marker in ((paths.starts[n], "o"), (paths.goals[n], "s")):
            axis.plot(end[0], end[1], marker, color="black", ms=5)
        axis.set(title=paths.names[n], aspect="equal", adjustable="datalim")
        axis.invert_xaxis()  # left is +x
    axes.flat[0].legend(frameon=False, fontsize=8)
    figure.savefig(path, dpi=80)
    plt.close(figure)
