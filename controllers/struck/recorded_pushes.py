"""How people answer a push with trunk, head and arms: found in recordings, and coefficients fitted to them."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from os import PathLike
from pathlib import Path

import numpy as np

from gambol import assets

from ..body import Clip, anatomy, centre_of_mass, heading_of, human
from ..jump.prior import LEGS, carried

TAKES = (*(f"woody2/wd2_Physics_2_Push0{n}.bvh" for n in (1, 2, 3)), *(f"woody2/wd2_PushBack0{n}.bvh" for n in (1, 2)), "woody2/wd2_PushBackStep00.bvh")
"""Takes of people who are pushed from behind or from before while they stand."""
DEFAULT = assets.path("library", "pushes.npz")
ROWS, SPACED = 19, 0.1
"""So many rows of a response, from the push on, and the time between two [s]."""
MOVES, STILL = 0.25, 0.06
"""A body that was pushed is faster than the first [m/s], and was slower than the second as it began."""
TOP, SMOOTH = 0.8, 0.07
"""Its speed is greatest so soon after that [s]; speeds are means of so long [s]."""
ALONG = 0.45
"""A push ahead or back comes within this angle of it [rad]."""
FADES = 6
"""So many of the last rows fade until the body is carried as before."""


@lru_cache(maxsize=2)
def response(path: str | None = None) -> np.ndarray:
    """Rows (2, ROWS, LEGS) [rad s/m] by which the carriage changes after a push from behind and from before, for each m/s of the mass centre's greatest speed; the shipped ones
    by default."""
    with np.load(path or DEFAULT, allow_pickle=False) as file:
        return file["response"].astype(float)


def pushes(clip: Clip) -> Iterator[tuple[bool, np.ndarray]]:
    """Every push in a clip of somebody who stands: whether from behind, and rows (ROWS, LEGS) as in `response`."""
    step = clip.frame_time
    positions, turned = clip.kinematics()
    flow = np.gradient(centre_of_mass(anatomy(human()), positions, turned)[:, [0, 2]], step, axis=0)
    wide = max(round(SMOOTH / step), 1)
    flow = np.stack([np.convolve(part, np.ones(wide) / wide, "same") for part in flow.T], -1)
    pace, columns = np.hypot(*flow.T), carried(clip.skeleton, clip.rotations, turned)[:, :LEGS]
    rows = np.arange(ROWS) * SPACED / step
    for n in np.flatnonzero(pace >= MOVES):
        if n and pace[n - 1] >= MOVES:
            continue
        slow = np.flatnonzero(pace[:n] <= STILL)
        begin = int(slow[-1]) if len(slow) else -1
        if begin < 0 or begin + rows[-1] >= len(pace):
            continue
        top = begin + int(pace[begin:begin + round(TOP / step)].argmax())
        way = np.arctan2(flow[top, 0], flow[top, 1]) - heading_of(turned[begin, 0][:, 2])
        if abs(np.cos(way)) > np.cos(ALONG):
            found = np.stack([np.interp(begin + rows, np.arange(len(pace)), column) for column in columns.T], -1)
            yield bool(np.cos(way) > 0.0), (found - found[0]) / pace[top]


def fit(folder: str | PathLike[str]) -> tuple[np.ndarray, tuple[int, int]]:
    """The mean response to the pushes of TAKES in a folder, both arms alike, that ends as it began; and how many came from behind and from before."""
    from ..mocap import calibrate, load, retarget  # here: who is struck reads no files

    found: tuple[list[np.ndarray], list[np.ndarray]] = ([], [])
    for take in TAKES:
        source = load(Path(folder) / take)
        for behind, rows in pushes(retarget(source, calibration=calibrate([source]))):
            if behind != ("Back" in take):  # nor how he goes back to his place
                found[0 if behind else 1].append(rows)
    mean = np.stack([np.mean(rows, 0) for rows in found])
    signs = np.array([1.0, -1.0, -1.0, 1.0])
    arms = 0.5 * (mean[..., 3:7] + signs * mean[..., 7:11])
    mean[..., 3:7], mean[..., 7:11] = arms, signs * arms
    return mean * np.clip((ROWS - 1 - np.arange(ROWS)) / FADES, 0.0, 1.0)[:, None], (len(found[0]), len(found[1]))
