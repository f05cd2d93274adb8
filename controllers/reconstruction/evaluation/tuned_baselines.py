"""The methods that ours is measured against, with the settings that did best, each from up to twelve that were tried.

Tried was on eleven validation takes of CMU, four points, 79 thousand poses to learn from; docs/reconstruction/tune.md has
all of it. Where the best lay at the edge of its grid, the grid was moved there once, and twelve tried again.
All local ones get the same K = 100 neighbours; all methods the same solver, σ_c 1 cm.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

import numpy as np

from ..baselines import LOOSE, SGPLVM, Layers, LocalPCA, LocalPCR, Nearest, Samples, network, ridge
from ..control_points import ControlPoints
from ..database import Database, kept
from ..ours import cells
from ..regression import FLOOR, PAPER, Local, LocalRegression, Method, Regression, Solver

K = 100
"""Neighbours of the local methods."""
SETTINGS: Mapping[str, Mapping[str, Any]] = MappingProxyType({
    "gplvm": {"active": 100, "dimensions": 3, "loosening": 1.0, "apart": 1.0},
    "lpca": {"share": 0.999, "most": 12, "loosening": 3.0, "loose": 1.0},
    "lpcr": {"share": 0.99, "loosening": 300.0, "bandwidth": "knn"},
    "letter": {},
    "mousas": {"ridge": 0.1, "loosening": 100.0, "bandwidth": "paper"},
    "nearest": {"spread": 10.0},
    "ridge": {"strength": 1e-4, "loosening": 10.0},
    "network": {"hidden": (768, 768), "rate": 2e-3, "batches": 6000, "loosening": 10.0},
})
"""By name: SGPLVM (Grochow 2004); local PCA (Chai & Hodgins 2005); local PCR (Liu 2011); Mousas 2014 to the letter, and
mended; the nearest recording; ridge regression; a small network."""
_BLIND = ControlPoints((), np.zeros(0, np.int64), np.zeros((0, 3)))


def baseline(name: str, database: Database, controls: ControlPoints, **settings: Any) -> Method:
    """A method of `SETTINGS`, learnt from a database for some control points. settings: instead of its own.

    What takes long is kept on disk. KeyError for another name, TypeError for settings that it has not.
    """
    return _MAKERS[name](database, controls, **{**SETTINGS[name], **settings})


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


def _letter(database, controls):
    """The only one whose query has no points."""
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
                  ("pose_vector.py", "baselines/regressors.py", "baselines/windows.py"))
    return Method(replace(layers, loosening=loosening), solver)


_MAKERS = {"gplvm": _gplvm, "lpca": _lpca, "lpcr": _lpcr, "letter": _letter, "mousas": _mended, "nearest": _nearest,
           "ridge": _ridge, "network": _network}
