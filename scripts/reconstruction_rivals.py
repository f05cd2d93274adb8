"""The methods of reconstruction that are measured, under the names of the tables, and what of each can be tuned.

Each is learnt from a database for some control points. All local ones get the same K = 100 neighbours; all methods
the same solver, σ_c 1 cm, and the same past, their own output. Only the paper to the letter has a query without points.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from itertools import product
from typing import Any

import numpy as np

from controllers.reconstruction.baselines import SGPLVM, Layers, LocalPCA, LocalPCR, Nearest, Samples, network, ridge
from controllers.reconstruction.baselines.local import LOOSE
from controllers.reconstruction.controls import Controls
from controllers.reconstruction.database import Database
from controllers.reconstruction.method import Local, LocalRegression, Method
from controllers.reconstruction.ours import cells, ours
from controllers.reconstruction.prior import FLOOR, PAPER, Regression
from controllers.reconstruction.solver import Solver
from controllers.reconstruction.store import kept

K = 100
TRIES = 12
"""How many settings of each method are tried on the validation takes."""
_BLIND = Controls((), np.zeros(0, np.int64), np.zeros((0, 3)))

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


def _solver(database, controls):
    return Solver(controls, 1 / database.fps)


def _local(model, database, controls, seeing=True, stride=4):
    search = cells(database, controls if seeing else _BLIND, 3, stride)
    return Method(Local(model, search, K), _solver(database, controls))


def _gplvm(database, controls, **settings):
    solver = _solver(database, controls)
    return Method(SGPLVM.of(database, solver, **settings), solver)


def _lpca(database, controls, loose, **settings):
    return _local(LocalPCA(**settings, root=loose * LOOSE), database, controls)


def _lpcr(database, controls, **settings):
    return _local(LocalPCR(**settings), database, controls)


def _paper(database, controls):
    return _local(LocalRegression(PAPER), database, controls, seeing=False, stride=1)


def _mended(database, controls, **settings):
    return _local(LocalRegression(Regression(**settings)), database, controls)


def _nearest(database, controls, spread):
    return _local(Nearest(spread * FLOOR), database, controls)


def _ridge(database, controls, strength, loosening):
    solver = _solver(database, controls)
    layers = ridge(Samples.of(database, solver), strength)
    return Method(replace(layers, loosening=loosening), solver)


def _network(database, controls, hidden, rate, batches, loosening):
    solver = _solver(database, controls)
    layers = kept("network", database, (controls.joints.tolist(), controls.offsets.tolist(), hidden, rate, batches),
                  lambda: network(Samples.of(database, solver), hidden, batches, rate=rate), Layers.save, Layers.load,
                  ("chart.py", "baselines/regressors.py", "baselines/windows.py"))
    return Method(replace(layers, loosening=loosening), solver)


OURS, BASE = "ours", "LPCR"
RIVALS = {
    "GPLVM": Rival(
        _gplvm, "GPLVM", ("baselines/gplvm.py",), {"active": 150, "dimensions": 3, "loosening": 10.0, "apart": 1.0},
        {"active": (100, 150, 200), "dimensions": (2, 3, 5), "loosening": (1.0, 10.0, 100.0), "apart": (0.5, 1.0, 2.0)}),
    "LPCA": Rival(
        _lpca, "LPCA", ("baselines/local.py",), {"share": 0.999, "most": 12, "loosening": 3.0, "loose": 1.0},
        {"share": (0.95, 0.99, 0.999), "most": (7, 12, 20), "loosening": (1.0, 3.0, 10.0, 30.0), "loose": (0.5, 1.0, 2.0)}),
    "LPCR": Rival(
        _lpcr, "LPCR", ("baselines/local.py",), {"share": 0.99, "loosening": 300.0, "bandwidth": "knn"},
        {"share": (0.9, 0.95, 0.99, 0.999), "loosening": (30.0, 100.0, 300.0, 1000.0), "bandwidth": (None, "knn")}),
    "Mousas to the letter": Rival(_paper, "Proposed Method"),
    "Mousas mended": Rival(
        _mended, "Proposed Method", (), {"ridge": 0.1, "loosening": 100.0, "bandwidth": "paper"},
        {"ridge": (0.01, 0.03, 0.1, 0.3), "loosening": (30.0, 100.0, 300.0, 1000.0), "bandwidth": ("knn", "paper")}),
    "nearest + IK": Rival(
        _nearest, "", ("baselines/local.py",), {"spread": 10.0},
        {"spread": (1.0, 2.0, 3.0, 5.0, 10.0, 15.0, 20.0, 30.0, 50.0, 100.0, 200.0, 400.0)}),
    "ridge + IK": Rival(
        _ridge, "", ("baselines/regressors.py", "baselines/windows.py"), {"strength": 1e-4, "loosening": 10.0},
        {"strength": (1e-6, 1e-5, 1e-4, 1e-3), "loosening": (1.0, 10.0, 100.0)}),
    "network + IK": Rival(
        _network, "", ("baselines/regressors.py", "baselines/windows.py"),
        {"hidden": (384, 384), "rate": 1e-3, "batches": 6000, "loosening": 10.0},
        {"hidden": ((256, 256), (384, 384)), "rate": (1e-3, 2e-3), "loosening": (1.0, 10.0, 100.0)}),
    OURS: Rival(lambda database, controls: ours(database, controls), "",
                ("ours.py", "moments.py", "learning.py", "filters.py", "method.py", "beliefs.py", "prior.py", "solver*.py", "frame_kernel.py",
                 "baselines/regressors.py")),
}
"""By name, in the order of the tables."""
