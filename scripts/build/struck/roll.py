"""Fits how people roll over a shoulder, `assets/library/roll.npz`, to a folder of motion capture. Takes two minutes.

    python scripts/build/struck/roll.py DIR
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

from gambol import assets
from gambol.controllers.body import centre_of_mass, exp, forward_kinematics, log, yaw
from gambol.controllers.files import whole
from gambol.controllers.jump import Physique
from gambol.controllers.jump.motion import ROLL_SPACED, places, tumbled
from gambol.controllers.mocap import calibrate, load, retarget

TAKE = "cmu/127/127_23.amc"
SPAN = 0.95, 2.40
"""From hands on the floor to standing again [s], of a dive over something out of a run."""
ROLLS = 0.85, 1.10
"""It goes forward as it goes over its back [s]."""
STRAIGHT = 1.0, 1.7
"""What it is turned in the end fades in between [s]: it comes up facing as it rolls."""
KEEPS = np.array([0.3, 1.0, 3.0])
"""How much it counts that a joint [rad], the pelvis [rad] or its height [m] changes."""
BELOW, FLOATS = 60.0, 10.0
"""How much it counts that something is below the floor [m], and that nothing touches it."""
HEAD, CLEAR = slice(24, 26), 0.04
"""Which of `places` are the head, and how far over the floor it is kept [m]."""


def above(body: Physique, pitch: float, row: np.ndarray) -> np.ndarray:
    """The pose nearest to a row (3 J + 1,) of rotation vectors, the pelvis's before it is pitched [rad], and its height, that has nothing below the floor, touches it, and spares its head."""
    def lacks(change: np.ndarray) -> np.ndarray:
        new = row + change
        local = tumbled(np.array([pitch]), new[None, :-1].reshape(1, -1, 3))
        over = places(body, *forward_kinematics(body.skeleton, np.array([[0.0, new[-1], 0.0]]), local))[1][0]
        return np.concatenate([KEEPS[0] * change[3:-1], KEEPS[1] * change[:3], KEEPS[2] * change[-1:], BELOW * np.minimum(over, 0.0), BELOW * np.minimum(over[HEAD] - CLEAR, 0.0),
                               [FLOATS * min(abs(over.min()), 0.3)]])
    return row + least_squares(lacks, np.zeros(len(row)), max_nfev=25).x


def roll(body: Physique, folder: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The coefficients: how far (R,) [rad] the pelvis is pitched, all joints' (R, J, 3) [rad] rotation vectors, the pelvis's before that, and where (R, 2) x, z [m] the mass centre is from where it begins."""
    source = load(folder / TAKE)
    clip = retarget(source, calibration=calibrate([source]))
    frames, keys = np.arange(len(clip)) * clip.frame_time, np.arange(SPAN[0], SPAN[1] + 1e-6, ROLL_SPACED)
    centre = centre_of_mass(body.anatomy, *clip.kinematics())
    gone = np.diff(centre[[int(round(time / clip.frame_time)) for time in ROLLS]], axis=0)[0]
    facing = yaw(-np.arctan2(gone[0], gone[2]))
    turned, way = clip.rotations.copy(), centre @ facing.T
    turned[:, 0] = facing @ turned[:, 0]
    pitch = np.unwrap(np.arctan2(turned[:, 0, 2, 1], turned[:, 0, 1, 1]))
    pitch -= 2.0 * np.pi * np.floor(pitch[int(SPAN[0] / clip.frame_time)] / (2.0 * np.pi))
    ends = int(round(SPAN[1] / clip.frame_time))
    across = turned[ends, 0][:, 0]
    drift = float(np.arctan2(-across[2], across[0]))
    share = np.clip((frames - STRAIGHT[0]) / (STRAIGHT[1] - STRAIGHT[0]), 0.0, 1.0)
    turned[:, 0] = yaw(-drift * share**2 * (3.0 - 2.0 * share)) @ turned[:, 0]
    back = np.zeros((len(frames), 3))
    back[:, 0] = -pitch
    turned[:, 0] = exp(back) @ turned[:, 0]
    used = (frames >= SPAN[0] - 1e-6) & (frames <= SPAN[1] + 1e-6)
    hats = np.stack([np.interp(frames, keys, row) for row in np.eye(len(keys))], -1)[used]
    told = np.concatenate([log(turned).reshape(len(turned), -1), clip.root[:, 1:2], way[:, [0, 2]], pitch[:, None]], 1)[used]
    rows = np.linalg.lstsq(hats, told, rcond=None)[0]
    rows, path, pitches = rows[:, :-3], rows[:, -3:-1] - rows[0, -3:-1], rows[:, -1]
    changed = np.stack([above(body, angle, row) for angle, row in zip(pitches, rows)]) - rows
    changed[1:-1] = 0.25 * changed[:-2] + 0.5 * changed[1:-1] + 0.25 * changed[2:]
    return pitches, np.stack([above(body, angle, row) for angle, row in zip(pitches, rows + changed)])[:, :-1].reshape(len(keys), -1, 3), path


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="motion capture, as the fitted take lies in it")
    parser.add_argument("-o", "--out", type=Path, default=assets.path("library", "roll.npz"), help="the file to write")
    given = parser.parse_args()
    pitches, rows, path = roll(Physique(), Path(given.folder))
    with whole(given.out) as part, open(part, "wb") as file:
        np.savez_compressed(file, pitch=pitches.astype(np.float32), rows=rows.astype(np.float32), path=path.astype(np.float32))
    print(f"{len(rows)} rows")
