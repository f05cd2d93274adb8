"""Motion as it was captured: our joints where the performer's own are, on a skeleton of their own lengths."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..body import Clip, Skeleton, human
from .calibration import calibrate
from .hinges import hinged
from .retarget import retarget

_TRUNK = "Spine", "Spine1", "Spine2"


@dataclass(frozen=True, eq=False)
class Captured:
    """motion: on our skeleton. skeleton: ours with the performer's own bones [m], as seen from joints that are turned as ours. positions: (T, J, 3) [m] their
    joints. known: (J,) bool, which of ours they have; others lie as on our skeleton of their size, their positions are NaN."""

    motion: Clip
    skeleton: Skeleton
    positions: np.ndarray
    known: np.ndarray


def captured(clips: Sequence[Clip]) -> Captured:
    """The first of some clips of one performer, all of which tell how their skeleton stands to ours (`calibrate`). Trunks of other numbers of
    joints give the nearest of theirs, one maybe twice. ValueError if they are no human's, or of different skeletons."""
    known, skeleton = calibrate(clips), human()
    motion = hinged(retarget(clips[0], calibration=known))
    theirs, _ = clips[0].kinematics()
    _, turned = motion.kinematics()
    sources, trunk = dict(known.roles.limbs), known.roles.trunk
    for share, name in enumerate(_TRUNK, 1):
        if trunk:
            sources[name] = trunk[round(share / len(_TRUNK) * (len(trunk) - 1))]
    if known.roles.neck:
        sources.setdefault("Neck", known.roles.neck[0])
    offsets, there = skeleton.offsets / known.scale, np.zeros(len(skeleton), bool)
    places = np.full((len(theirs), len(skeleton), 3), np.nan)
    for j, name in enumerate(skeleton.names):
        if name in sources and not name.endswith("Toe"):
            places[:, j], there[j] = theirs[:, sources[name]], True
    for j, p in enumerate(skeleton.parents):
        if p >= 0 and there[j] and there[p]:
            offsets[j] = np.einsum("tji,tj->ti", turned[:, p], places[:, j] - places[:, p]).mean(0)
    own = Skeleton(skeleton.names, skeleton.parents, offsets, skeleton.end_parents, skeleton.end_offsets / known.scale)
    return Captured(motion, own, places, there)
