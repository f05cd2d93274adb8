"""A contour that a camera saw, as rays."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..cameras import Lens
from ..silhouettes import Contour, contour_of


@dataclass(frozen=True, eq=False)
class Observed:
    """What a frame of one camera says. mask: (H, W) bool. contour: N pixels of it. directions: (N, 3) their rays in the world.

    across: (N, 3) unit, square to the rays, outwards over the contour. pixel: (N,) how far one pixel is at a metre [m].
    hidden: (H, W) bool where others are, and nobody can tell; None for nowhere.
    """

    lens: Lens
    mask: np.ndarray
    contour: Contour
    directions: np.ndarray
    across: np.ndarray
    pixel: np.ndarray
    hidden: np.ndarray | None = None

    @cached_property
    def edge(self) -> np.ndarray:
        """The contour's pixels and normals (N, 4)."""
        return np.concatenate([self.contour.pixels, self.contour.normals], 1)

    def within(self, box: tuple[float, float, float, float]) -> Observed:
        """What of it lies within left, top, right, bottom pixels: nobody is elsewhere."""
        at = self.contour.pixels
        near = (at[:, 0] >= box[0]) & (at[:, 1] >= box[1]) & (at[:, 0] <= box[2]) & (at[:, 1] <= box[3])
        return Observed(self.lens, self.mask, Contour(at[near], self.contour.normals[near]), self.directions[near],
                        self.across[near], self.pixel[near], self.hidden)


def observed(lens: Lens, mask: np.ndarray, hidden: np.ndarray | None = None) -> Observed:
    """A mask (H, W) bool as rays. ValueError for one of another size than the camera's pictures.

    hidden: (H, W) bool where others are, if anywhere. Where they cut the mask there is no contour.
    """
    if mask.shape != lens.size[::-1]:
        raise ValueError(f"{lens.name}: a mask of {mask.shape[1]} × {mask.shape[0]} pixels, but its pictures have "
                         f"{lens.size[0]} × {lens.size[1]}")
    contour = contour_of(mask) if hidden is None else _beside(contour_of(mask | hidden), mask)
    pixels, normals = contour.pixels, contour.normals
    around = lens.directions(np.concatenate([pixels, pixels + normals, pixels - normals]))
    directions, out, back = np.split(around, 3)
    step = 0.5 * (out - back)
    step -= directions * np.sum(step * directions, -1, keepdims=True)
    size = np.linalg.norm(step, axis=-1)
    return Observed(lens, mask, contour, directions, step / np.maximum(size, 1e-12)[:, None], size, hidden)


def _beside(contour: Contour, mask: np.ndarray) -> Contour:
    """What of a contour lies in a mask (H, W) bool."""
    x, y = contour.pixels.astype(int).T
    inside = mask[y, x]
    return Contour(contour.pixels[inside], contour.normals[inside])
