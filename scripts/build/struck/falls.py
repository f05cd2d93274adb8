"""Fits how people fall over and get up again, `assets/library/falls.npz`, to a folder of motion capture. Takes ten minutes.

    python scripts/build/struck/falls.py DIR
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

from gambol import assets
from gambol.controllers.body import Clip, exp, forward_kinematics, heading_of, log, yaw
from gambol.controllers.files import whole
from gambol.controllers.jump import Physique
from gambol.controllers.jump.motion import places
from gambol.controllers.mocap import calibrate, load, retarget
from gambol.controllers.struck import SPACED

TAKE = "woody2/wd2_falling_down.bvh"
SPANS = (3.1, 7.5), (8.5, 12.9), (13.3, 17.2), (18.1, 21.9)
"""From standing to standing again [s]: four falls, backward, forward, to the left and to the right."""
KEEPS = np.array([0.3, 1.0, 3.0])
"""How much it counts that a joint [rad], the pelvis [rad] or its height [m] changes."""
BELOW, FLOATS = 60.0, 10.0
"""How much it counts that something is below the floor [m], and that nothing touches it."""


def above(body: Physique, row: np.ndarray) -> np.ndarray:
    """The pose nearest to a row (3 J + 1,) of rotation vectors and the pelvis's height that has nothing below the floor and touches it."""
    def lacks(change: np.ndarray) -> np.ndarray:
        new = row + change
        over = places(body, *forward_kinematics(body.skeleton, np.array([[0.0, new[-1], 0.0]]), exp(new[None, :-1].reshape(1, -1, 3))))[1][0]
        return np.concatenate([KEEPS[0] * change[3:-1], KEEPS[1] * change[:3], KEEPS[2] * change[-1:], BELOW * np.minimum(over, 0.0), [FLOATS * min(abs(over.min()), 0.3)]])
    return row + least_squares(lacks, np.zeros(len(row)), max_nfev=25).x


def continued(vectors: np.ndarray) -> np.ndarray:
    """Rotation vectors (T, J, 3) without jumps by a whole turn."""
    out = vectors.copy()
    for n in range(1, len(out)):
        angle = np.linalg.norm(out[n], axis=-1, keepdims=True)
        other = out[n] * (1.0 - 2.0 * np.pi / np.maximum(angle, 1e-6))
        nearer = np.linalg.norm(other - out[n - 1], axis=-1) < np.linalg.norm(out[n] - out[n - 1], axis=-1)
        out[n] = np.where((nearer & (angle[:, 0] > 1e-6))[:, None], other, out[n])
    return out


def fall(body: Physique, clip: Clip, begin: float, end: float) -> np.ndarray:
    """The coefficients (R, J, 3) [rad] of one fall: straight lines between them are nearest to the recorded joints, and in none is anything below the floor."""
    frames, keys = np.arange(len(clip)) * clip.frame_time, np.arange(begin, end + 1e-6, SPACED)
    turned = clip.rotations.copy()
    facing = turned[int(np.abs(frames - begin).argmin()), 0][:, 2]
    turned[:, 0] = yaw(-heading_of(facing)) @ turned[:, 0]
    used = (frames >= begin - SPACED) & (frames <= end + SPACED)
    hats = np.stack([np.interp(frames, keys, row) for row in np.eye(len(keys))], -1)[used]
    told = np.concatenate([continued(log(turned)).reshape(len(turned), -1), clip.root[:, 1:2]], 1)[used]
    rows = np.linalg.lstsq(hats, told, rcond=None)[0]
    changed = np.stack([above(body, row) for row in rows]) - rows
    changed[1:-1] = 0.25 * changed[:-2] + 0.5 * changed[1:-1] + 0.25 * changed[2:]
    return np.stack([above(body, row) for row in rows + changed])[:, :-1].reshape(len(keys), -1, 3)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="motion capture, as the fitted take lies in it")
    parser.add_argument("-o", "--out", type=Path, default=assets.path("library", "falls.npz"), help="the file to write")
    given = parser.parse_args()
    source = load(Path(given.folder) / TAKE)
    recorded = retarget(source, calibration=calibrate([source]))
    found = {f"fall{n}": fall(Physique(), recorded, *span).astype(np.float32) for n, span in enumerate(SPANS)}
    with whole(given.out) as part, open(part, "wb") as file:
        np.savez_compressed(file, **found)  # pyright: ignore[reportArgumentType]
    print(f"{len(found)} falls, {sum(len(rows) for rows in found.values())} rows")
