"""Fitting the prior to recorded jumps."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from os import PathLike
from pathlib import Path

import numpy as np

from ...body import Anatomy, Skeleton
from ...files import whole
from .coefficients import ARMS, BETWEEN, ELBOWS, FEATURES, Prior, mirrored
from .recorded import Recorded, jumps

TAKES = ("cmu/02/02_04.amc", *(f"cmu/16/16_{n:02d}.amc" for n in (1, 2, 3, 5, 6, 9)), "cmu/49/49_02.amc", "cmu/49/49_03.amc",
         "cmu/49/49_05.amc", *(f"cmu/127/127_{n}.amc" for n in (21, 25, 26, 27)),
         *(f"woody2/wd2_{name}.bvh" for name in ("Physics_Jump00", "Physics_Jump03", "fast_2foot_hop", "long_broad_jump", "slow_2foot_hop")))
"""Takes of people who jump somewhere, or for the sake of it: no jumping jacks, no scissors, nobody who reaches for something overhead."""
STRIDES = "cmu/09/09_03.amc", "cmu/09/09_09.amc", "cmu/09/09_11.amc"
"""And of a runner whose strides fly for so long that they are found as jumps: between them and leaps lie arms of short leaps."""
LEAPS = 0.35
"""A flight off one foot that is shorter than this [s] is a stride."""
SCALES = np.array([0.1, 0.3, 0.5])
"""What counts as much of airtime [s], distance [m] and pace [m/s]."""
BY_AIRTIME = np.array([1.0, 1.0, 0.0, 0.0])
"""Arms of leaps off one foot are told by airtime only: who flies longer goes farther, as fast."""
RIDGE = 1.0
"""How much slopes are held back: as much as one take that shows nothing."""


def recorded_jumps(folder: str | PathLike[str], skeleton: Skeleton, anatomy: Anatomy, takes: Sequence[str] = (*TAKES, *STRIDES)) -> tuple[list[Recorded], list[str]]:
    """The jumps of takes in a folder, and what is to be said of takes that could not be read."""
    from ...mocap import calibrate, load, retarget  # here: who jumps reads no files

    found, notes = [], []
    for take in takes:
        try:
            source = load(Path(folder) / take)
            clip = replace(retarget(source, calibration=calibrate([source])), name=Path(take).stem)
        except (OSError, ValueError) as error:
            notes.append(str(error) if str(folder) in str(error) else f"{take}: {error}")
            continue
        found += jumps(skeleton, anatomy, clip)
    return found, notes


def fit(found: Sequence[Recorded]) -> Prior:
    """The prior of recorded jumps, and of strides if there are any. ValueError without any off both feet, and any off one."""
    both = [one for one in found if one.single is None]
    runs = [off_the_right(one) for one in found if one.single is not None]
    leaps = [run for run in runs if run.airtime > LEAPS]
    if not both or not leaps:
        raise ValueError(f"a prior takes jumps off both feet and off one, got {len(both)} and {len(leaps)}")
    features, single = told(both), told(runs)
    keys = np.stack([one.keys for one in both])
    two = as_far(regressed(features, keys, weights(both)), features, keys, weights(both))
    one = np.zeros((FEATURES, *two.shape[1:]))
    one[0] = np.average([leap.keys for leap in leaps], axis=0, weights=weights(leaps))
    one[:, :, ARMS] = regressed(single * BY_AIRTIME, np.stack([run.keys[:, ARMS] for run in runs]), weights(runs))
    depth = regressed(features, np.array([one.depth for one in both]), weights(both))
    return Prior(two, one, depth, np.stack([features.min(0), single.min(0)]), np.stack([features.max(0), single.max(0)]),
                 tuple(sorted({one.clip for one in found})))


def off_the_right(one: Recorded) -> Recorded:
    """The same jump off the right foot."""
    return one._replace(keys=mirrored(one.keys)) if one.single == 0 else one


def told(found: Sequence[Recorded]) -> np.ndarray:
    """Their features (N, FEATURES)."""
    return np.array([[1.0, one.airtime, one.far, one.pace] for one in found])


def weights(found: Sequence[Recorded]) -> np.ndarray:
    """How much each counts (N,): who jumps often in one take counts less each time."""
    times = Counter(one.clip for one in found)
    return np.array([times[one.clip] ** -0.5 for one in found])


def regressed(features: np.ndarray, values: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Coefficients (FEATURES, ...) of values (N, ...) by ridge regression over features (N, FEATURES)."""
    middle = np.average(features[:, 1:], axis=0, weights=weight)
    centred = np.column_stack([np.ones(len(features)), (features[:, 1:] - middle) / SCALES])
    square = (centred * weight[:, None]).T @ centred + np.diag([0.0, *[RIDGE] * (FEATURES - 1)])
    slopes = np.linalg.solve(square, (centred * weight[:, None]).T @ values.reshape(len(values), -1))
    slopes[1:] /= SCALES[:, None]
    slopes[0] -= middle @ slopes[1:]
    return slopes.reshape(FEATURES, *values.shape[1:])


def as_far(fitted: np.ndarray, features: np.ndarray, keys: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """The same coefficients (FEATURES, ROWS, COLUMNS) of keys (N, ROWS, COLUMNS), elbows bending as far as in those until they touch down: a mean of people who bend them at different moments bends
    them less than each of them (global variance: Toda and Tokuda 2007). What the mean jump lacks is added to all, or in jumps at the rim of what was recorded they would bend beyond any body's."""
    fitted, until = fitted.copy(), slice(3 * BETWEEN)
    shown, told = (np.average(np.var(values[:, until, ELBOWS], axis=1), axis=0, weights=weight) for values in (keys, np.tensordot(features, fitted, 1)))
    mean = np.tensordot(np.average(features, axis=0, weights=weight), fitted, 1)[until, ELBOWS]
    fitted[0, until, ELBOWS] += ((np.sqrt(shown / told) - 1.0) * (mean - mean.mean(0))).T
    return fitted


def save(prior: Prior, path: str | PathLike[str]) -> None:
    """Write a prior."""
    with whole(Path(path)) as part, open(part, "wb") as file:
        np.savez_compressed(file, two=prior.two.astype(np.float32), one=prior.one.astype(np.float32), depth=prior.depth,
                            least=prior.least, most=prior.most, takes=np.array(prior.takes))
