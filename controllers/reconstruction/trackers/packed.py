"""All that samples are drawn by, as plain arrays: so that a machine without Gambol can learn the network (scripts/build/trackers_torch.py)."""

from __future__ import annotations

import numpy as np

from ..database import tracks_of
from ..pose_vector import ANGLES, JOINTS, REFERENCE, SKELETON, WIDTH, mirror
from . import wearing
from .bodies import proportions
from .samples import LEGS, Moments
from .slots import INPUTS, LAGS, SLOTS

_FINE, _COARSE = 1e-4, 5e-4
"""What angles and heights are rounded to [rad, m], and rates [rad/s, m/s]."""


def packed(moments: Moments) -> dict[str, np.ndarray]:
    """Moments' frames without their mirror images, and the body and trackers that samples are drawn with.

    frames: (N, WIDTH) whole numbers of `step` (WIDTH,), as differences of differences, which pack well. track: (N, 3) of each take from the
    origin. behind: (N,) how many sound frames lie before each. good: (M,) those that are learnt from, share: (M,) how often.
    """
    database = moments.database
    frames, tracks, behind, stands = [], [], [], []
    new = np.full(len(database.frames), -1, np.int64)  # where a frame lies in the pack
    count = 0
    for take in database.takes:
        if take.mirrored:
            continue
        span = slice(take.start, take.stop)
        own, sound = np.asarray(database.frames[span], float), database.sound[span]
        number = np.arange(len(own))
        new[span] = count + number
        count += len(own)
        frames.append(own)
        tracks.append(tracks_of(own, 1.0 / database.fps))
        behind.append(number - np.maximum.accumulate(np.where(sound, -1, number)) - 1)
        stands.append(moments.contacts[span])
    step = np.where(np.arange(WIDTH) <= ANGLES, _FINE, _COARSE)
    whole = np.round(np.concatenate(frames) / step).astype(np.int64)
    kept = new[moments.which] >= 0
    share = np.diff(moments.upto, prepend=0.0)[kept]
    columns = mirror(np.arange(WIDTH, dtype=float)[None] + 1.0)[0]
    return {"frames": np.diff(whole, 2, axis=0, prepend=np.zeros((2, WIDTH), np.int64)).astype(np.int32), "step": step,
            "track": np.concatenate(tracks).astype(np.float32), "behind": np.concatenate(behind).astype(np.int32), "stands": np.concatenate(stands),
            "good": new[moments.which[kept]], "share": share, "fps": np.array(database.fps), "lags": LAGS, "inputs": np.array(INPUTS),
            "offsets": SKELETON.offsets, "parents": SKELETON.parents, "reference": REFERENCE, "joints": JOINTS, "slots": SLOTS, "legs": LEGS,
            "mirror_columns": np.abs(columns).astype(np.int64) - 1, "mirror_signs": np.sign(columns),
            "knee": np.array([SKELETON.index("Left" + name) for name in ("Leg", "Foot", "Toe")]), **proportions(), **wearing.sets()}
