"""Who is recorded in a folder: performers' own skeletons, each once, by how their skeletons place joints."""

from __future__ import annotations

from pathlib import Path

from ...body import Skeleton
from ...mocap import MotionFileError, captured, load

FAMILIES = {"cmu": "Acclaim", "cmu_bvh": "cgspeed", "boxing": "SNU", "tennis": "SNU", "woody2": "SNU"}
"""Families of skeletons by the source's folder; others are one each."""
_SOME = 4
"""So many takes tell how somebody's skeleton stands to ours, where they are of one skeleton."""
_FPS = 60.0


def performers(folder: Path) -> dict[str, dict[str, Skeleton]]:
    """Skeletons [m] with our joints, by family and performer: each folder that holds motion files is of one; who has a folder of this name in an earlier
    source is left out, and so is whoever can't be read. ValueError if there is nobody."""
    found: dict[str, dict[str, Skeleton]] = {}
    for place in sorted({path.parent for ending in ("amc", "bvh") for path in folder.rglob(f"*.{ending}")}):
        if any(place.name in family for family in found.values()):
            continue
        paths = sorted(path for path in place.iterdir() if path.suffix in (".amc", ".bvh"))
        some = [paths[k * (len(paths) - 1) // (_SOME - 1)] for k in range(_SOME)]
        for those in (dict.fromkeys(some), some[:1]):
            try:
                clips = [clip.resample(_FPS) if clip.frame_time < 0.99 / _FPS else clip for clip in map(load, those)]
                own = captured(clips).skeleton
            except (MotionFileError, ValueError):
                continue
            source = place.relative_to(folder).parts[0]
            found.setdefault(FAMILIES.get(source, source), {})[place.name] = own
            break
    if not found:
        raise ValueError(f"{folder}: holds no motion files of people")
    return found
