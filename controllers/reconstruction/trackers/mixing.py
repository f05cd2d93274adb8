"""Bodies that move as nobody was recorded: trunk and arms each as they were at another moment, over hips and legs as they were.

In recordings, what legs do tells much of how arms are held; in life far less. A network learnt on a few people's motion takes the one from
the other where trackers on hips, head and hands tell better. From such bodies it learns to listen to those.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..database import Database
from ..pose_vector import JOINTS, SKELETON
from .slots import LAGS, PLACES

PARTS = (("Spine", "Spine1", "Spine2", "Neck", "Head"),
         *(tuple(side + joint for joint in ("Shoulder", "Arm", "ForeArm", "Hand")) for side in ("Left", "Right")))
"""What moves together: the trunk, and each arm."""
APART = 0.6
"""How often each of them is another moment's, where a body is mixed."""
TOLD = ("Hips", "Head", "LeftHand", "RightHand")
"""Where trackers must be, so that parts can be told apart; others have to be guessed from each other."""
BACK = int(LAGS[-1]) + 1
"""So many frames are seen of a moment."""
_PARTS = tuple(np.concatenate([3 * list(JOINTS).index(SKELETON.index(name)) + np.arange(3) for name in names]) for names in PARTS)
_TOLD = [PLACES.index(name) for name in TOLD]


def told(placed: np.ndarray) -> np.ndarray:
    """Of which (B,) bool trackers placed at each lag (B, L, S) the parts of a body are told apart."""
    return placed[..., _TOLD].any(-2).all(-1)


def columns() -> dict[str, np.ndarray]:
    """What bodies are mixed by: which columns of a pose (P, C) the parts are, the last one repeated, and the trackers that are needed."""
    most = max(map(len, _PARTS))
    return {"mixed_parts": np.stack([np.pad(part, (0, most - len(part)), mode="edge") for part in _PARTS]), "mixed_told": np.array(_TOLD)}


def mixed(database: Database, at: np.ndarray, first: np.ndarray, which: np.ndarray, other: Callable[[], tuple[np.ndarray, np.ndarray]],
          rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The last `BACK` frames of moments at (B,) of takes that begin at first (B,): frames (B · BACK, D), whether they are sound, and the
    moments' numbers and beginnings among them. which: (B,) bool, whose parts are other moments', that `other` draws as many of.
    """
    frames, sound = _last(database, at, first)
    for part in _PARTS:
        there, begun = other()
        taken = np.flatnonzero(which & (rng.random(len(at)) < APART) & (there - BACK + 1 >= begun))
        own, good = _last(database, there[taken], begun[taken])
        frames[taken[:, None], :, part] = np.moveaxis(own[:, :, part], -1, 1)
        sound[taken] &= good
    begun = BACK * np.arange(len(at))
    return frames.reshape(-1, frames.shape[-1]), sound.reshape(-1), begun + BACK - 1, begun


def _last(database, at, first):
    """The last frames (B, BACK, D) and whether they are sound: those before a take are not."""
    which = at[:, None] + np.arange(1 - BACK, 1)
    inside = which >= first[:, None]
    which = np.maximum(which, first[:, None])
    return database.frames[which], database.sound[which] & inside
