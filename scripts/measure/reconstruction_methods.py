"""The methods of reconstruction that are measured, under the names of the tables, and what of each can be tuned.

Each is learnt from a database for some control points. All local ones get the same K = 100 neighbours; all methods
the same solver, σ_c 1 cm, and the same past, their own output. Only the paper to the letter has a query without points.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from gambol.controllers.reconstruction.evaluation import SETTINGS, baseline
from gambol.controllers.reconstruction.ours import ours

TRIES = 12
"""How many settings of each method are tried on the validation takes."""

Learn = Callable[..., Any]
"""Called with a database, control points and settings; returns what has `begin` and `step`, as `Method` has."""


@dataclass(frozen=True, eq=False)
class Rival:
    """A row of the tables. learn: makes it. printed: its name in the paper's tables. sources: the code below
    controllers/reconstruction that is its own, as patterns. settings: what `learn` gets. grid: what may be tried instead.
    """

    learn: Learn
    printed: str = ""
    sources: tuple[str, ...] = ()
    settings: Mapping[str, Any] = field(default_factory=dict)
    grid: Mapping[str, tuple] = field(default_factory=dict)

    def tries(self, seed: int = 0) -> list[dict[str, Any]]:
        """Settings to try, `TRIES` at most, drawn from the grid; those in use are the first."""
        every = [dict(zip(self.grid, values, strict=True)) for values in product(*self.grid.values())]
        drawn = [every[i] for i in np.random.default_rng(seed).permutation(len(every))]
        used = {name: self.settings[name] for name in self.grid}
        return [used, *(tried for tried in drawn if tried != used)][:TRIES] if self.grid else []


def _rival(name, printed="", sources=(), grid=None):
    return Rival(partial(baseline, name), printed, sources, SETTINGS[name], grid or {})


OURS, BASE = "ours", "LPCR"
RIVALS = {
    "GPLVM": _rival(
        "gplvm", "GPLVM", ("baselines/gplvm.py",),
        {"active": (70, 100, 150), "dimensions": (3, 5), "loosening": (0.3, 1.0, 3.0), "apart": (0.25, 0.5, 1.0)}),
    "LPCA": _rival(
        "lpca", "LPCA", ("baselines/local.py",),
        {"share": (0.95, 0.99, 0.999), "most": (7, 12, 20), "loosening": (1.0, 3.0, 10.0, 30.0), "loose": (0.5, 1.0, 2.0)}),
    "LPCR": _rival(
        "lpcr", "LPCR", ("baselines/local.py",),
        {"share": (0.9, 0.95, 0.99, 0.999), "loosening": (30.0, 100.0, 300.0, 1000.0), "bandwidth": (None, "knn")}),
    "Mousas to the letter": _rival("letter", "Proposed Method"),
    "Mousas mended": _rival(
        "mousas", "Proposed Method", (),
        {"ridge": (0.01, 0.03, 0.1, 0.3), "loosening": (30.0, 100.0, 300.0, 1000.0), "bandwidth": ("knn", "paper")}),
    "nearest + IK": _rival(
        "nearest", "", ("baselines/local.py",),
        {"spread": (1.0, 2.0, 3.0, 5.0, 10.0, 15.0, 20.0, 30.0, 50.0, 100.0, 200.0, 400.0)}),
    "ridge + IK": _rival(
        "ridge", "", ("baselines/regressors.py", "baselines/windows.py"),
        {"strength": (1e-6, 1e-5, 1e-4, 1e-3), "loosening": (1.0, 10.0, 100.0)}),
    "network + IK": _rival(
        "network", "", ("baselines/regressors.py", "baselines/windows.py"),
        {"hidden": ((384, 384), (768, 768)), "rate": (2e-3, 4e-3), "loosening": (1.0, 10.0, 100.0)}),
    OURS: Rival(lambda database, controls: ours(database, controls), "",
                ("ours/*.py", "regression/*.py", "baselines/regressors.py")),
}
"""By name, in the order of the tables."""
