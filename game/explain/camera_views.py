"""What the cameras see that watch somebody, in the corner of the picture: silhouettes or pictures, contours, and the tracked body's."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ..scene import VERTEX, Ink, Stroke
from ..world import Character, Filmed, World, tracked_vertices, tracking_of

GROUND, BODY, FOUND, MODEL = (18, 20, 24), (120, 124, 132), (70, 150, 255), (255, 64, 48)
"""Colours of what cameras see, of the contour found there, and of the model's."""
SHEET = -15
"""The number of the picture among an ink's sheets; panels' are above 0."""
ASIDE = 0.2
"""So much of a picture is left out on both sides where cameras go along."""
LARGEST = 640
"""Of real films' pictures, so many pixels across at most are shown."""
WIDE, MARGIN, BETWEEN = 0.24, 14.0, 4
"""How wide the pictures are together, over the whole picture's width; from its corner [px at 720 lines]; between them [pixels]."""


def with_cameras(ink: Ink | None, world: World, size: tuple[int, int]) -> Ink | None:
    """Ink with the pictures of whoever is tracked first in the bottom-right corner, for a picture of `size` pixels."""
    shown = next((seen for one in world.characters if (seen := camera_views(one, world)) is not None), None)
    if shown is None:
        return ink
    size = size if ink is None else ink.size
    wide = min(WIDE * size[0], shown.shape[1] * 0.6 * size[1] / shown.shape[0])
    high, gap = wide * shown.shape[0] / shown.shape[1], MARGIN * size[1] / 720.0
    left, top = size[0] - wide - gap, size[1] - high - gap
    corners = np.zeros(4, VERTEX)
    corners["uv"] = [(0, 0), (1, 0), (1, 1), (0, 1)]
    corners["place"] = corners["uv"] * (wide, high) + (left, top)
    corners["tint"] = 255
    sheet = np.concatenate([shown, np.full((*shown.shape[:2], 1), 235, np.uint8)], -1)
    flat = np.array([0, 1, 2, 0, 2, 3], np.uint32)
    if ink is None:
        return Ink(size, corners, flat, (Stroke((0, 0, *size), SHEET, 0, 6),), {SHEET: sheet})
    return replace(ink, vertices=np.concatenate([ink.vertices, corners]), indices=np.concatenate([ink.indices, flat + len(ink.vertices)]),
                   strokes=(*ink.strokes, Stroke((0, 0, *size), SHEET, len(ink.indices), 6)), sheets={**ink.sheets, SHEET: sheet})


def camera_views(tracked: Character, world: World) -> np.ndarray | None:
    """The pictures (H, W, 3) uint8 of those who watch a character's performer, two beside each other; None where nobody does."""
    if isinstance(tracked.controller, Filmed):
        return _beside_each_other([_smaller(one) for one in _filmed(tracked.controller, tracked.state.memory)])
    watches = tracked.watches
    performer = next((one for one in world.characters if watches is not None and one.name == watches.performer), None)
    if watches is None or performer is None:
        return None
    from gambol.controllers.tracking.silhouettes import contour_of, rendered  # a game that nobody watches starts without

    sighting = watches.sighting(*performer.joints, world.number)
    tracking, watching = tracking_of(tracked)
    vertices = None if watching is None else tracked_vertices(tracking, watching, sighting.place)
    made = []
    for lens, mask in zip(watches.lenses, sighting.pictures):
        picture = np.empty((*lens.size[::-1], 3), np.uint8)
        picture[:] = GROUND
        if mask is not None:
            picture[mask] = BODY
            _drawn(picture, contour_of(mask).pixels, FOUND)
        if vertices is not None:
            _drawn(picture, contour_of(rendered(lens, vertices, tracking.tracker.surface.triangles).mask).pixels, MODEL)
        aside = int(ASIDE * picture.shape[1]) if watches.along else 0  # nobody is far from the middle
        made.append(picture[:, aside:picture.shape[1] - aside])
    return _beside_each_other(made)


def _filmed(controller: Filmed, filming) -> Iterator[np.ndarray]:
    """Each camera's picture of the last frame that was seen, with the contour that was found in it and the model's."""
    from gambol.controllers.tracking.silhouettes import contour_of, is_mask, own, rendered, skinned
    from gambol.controllers.tracking.twists import posed

    tracker, where = controller.tracker, filming.watching.track.now
    seen = controller.seen(min(controller.frame(filming.number), controller.footage.frames - 1))
    vertices = skinned(tracker.surface, *posed(tracker.surface.chain, where)[:2])
    for lens, one, found in zip(tracker.lenses, seen, tracker.masks(seen, where)):
        picture = np.full((*lens.size[::-1], 3), GROUND, np.uint8)
        if one is not None:
            picture[:] = np.where(own(one)[..., None], BODY, GROUND) if is_mask(one) else one if one.ndim == 3 else one[..., None]
            _drawn(picture, contour_of(found).pixels, FOUND)
        _drawn(picture, contour_of(rendered(lens, vertices, tracker.surface.triangles).mask).pixels, MODEL)
        yield picture


def _smaller(picture: np.ndarray) -> np.ndarray:
    """Every so manieth pixel of a large picture."""
    return picture[::(step := -(-picture.shape[1] // LARGEST)), ::step]


def _beside_each_other(made: list[np.ndarray]) -> np.ndarray:
    """Pictures (H, W, 3) as one, two in a row."""
    height, width = max(one.shape[0] for one in made), max(one.shape[1] for one in made)
    across, down = (2, (len(made) + 1) // 2) if len(made) > 1 else (1, 1)
    sheet = np.zeros((down * (height + BETWEEN) - BETWEEN, across * (width + BETWEEN) - BETWEEN, 3), np.uint8)
    for k, one in enumerate(made):
        y, x = k // across * (height + BETWEEN), k % across * (width + BETWEEN)
        sheet[y:y + one.shape[0], x:x + one.shape[1]] = one
    return sheet


def _drawn(picture: np.ndarray, pixels: np.ndarray, colour: tuple[int, int, int]) -> None:
    x, y = pixels.astype(int).T
    picture[y, x] = colour
