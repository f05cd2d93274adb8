"""Footage tracked: somebody's motion from what cameras filmed, and pictures of how well the model lies on them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from gambol.controllers.tracking import Track, Tracker
from gambol.controllers.tracking.segmentation import segmented
from gambol.controllers.tracking.silhouettes import Surface, contour_of, rendered, skinned
from gambol.controllers.tracking.twists import Configuration, posed

from ..footage import Footage, FootageError, seen_in

FOUND, MODEL = (60, 140, 255), (255, 40, 40)
"""Colours of the contour that the segmentation finds, and of the model's."""


def followed(footage: Footage, tracker: Tracker, start: Sequence[Configuration], person: int = 0, masks: bool = False) -> Iterator[Track]:
    """The track after each frame from the third on; start: the poses of the first two. From the second where one alone is known."""
    track = tracker.start(start[-1], start[0])
    for number in range(len(start), footage.frames):
        track = tracker.step(track, seen_in(footage, number, person, masks))
        yield track


def late(tracker: Tracker, tracks: Iterable[Track]) -> Iterator[Configuration]:
    """The pose of each frame of a track, as it looks when so many more were seen as the tracker's settings let it be late."""
    lag, seen, poses = tracker.settings.lag, 0, []
    for seen, track in enumerate(tracks, 1):
        poses = tracker.hindsight(track) if lag else [track.now]
        if seen > lag:
            yield poses[-1 - lag]
    yield from poses[-min(lag, seen):] if lag else ()


def error_of(footage: Footage, surface: Surface, poses: Sequence[Configuration], person: int = 0) -> np.ndarray | None:
    """How far joints are from the truth (T, J) [m]; None where there is none."""
    try:
        true = footage.truth()["joints"][:, person]
    except (FootageError, KeyError, IndexError):
        return None
    at = np.stack([posed(surface.chain, pose)[0] for pose in poses])
    return np.linalg.norm(at - true, axis=-1) if true.shape == at.shape else None


def overlaid(footage: Footage, surface: Surface, number: int, where: Configuration, height: int = 360) -> np.ndarray:
    """All cameras' pictures of a frame side by side (H, W, 3) uint8, with the contour found there, blue, and the model's, red."""
    from PIL import Image

    vertices, row = skinned(surface, *posed(surface.chain, where)[:2]), []
    for lens, one in zip(footage.lenses, seen_in(footage, number)):
        mask = rendered(lens, vertices, surface.triangles).mask
        shown = np.zeros((*mask.shape, 3), np.uint8) if one is None else one[..., None].repeat(3, -1) if one.ndim == 2 else one.copy()
        found = [] if one is None else [(segmented(one, mask).mask, FOUND)]
        for region, colour in (*found, (mask, MODEL)):
            x, y = contour_of(region).pixels.astype(int).T
            shown[y, x] = colour
        row.append(np.asarray(Image.fromarray(shown).resize((max(round(height * lens.size[0] / lens.size[1]), 1), height))))
    return np.concatenate(row, 1)

