"""A calibrated camera's picture by way of the renderer's plain pinhole: drawn a little wider, then bent as the lens bends it."""

from __future__ import annotations

import numpy as np

from gambol.controllers.compiled import kernel
from gambol.controllers.tracking.cameras import Lens

from ..scene import Camera

MARGIN = 1.01
WIDEST = 3.0
"""How far from the axis a lens may see, over the distance ahead: 72°. Beyond, a plain pinhole has no picture."""


class LensWarp:
    """What is to be drawn for a lens, and how its picture is made of that.

    camera: of the renderer. size: of its picture, pixels. ValueError for a lens too wide to be drawn.
    """

    def __init__(self, lens: Lens):
        width, height = lens.size
        grid = np.stack(np.meshgrid(np.arange(width), np.arange(height)), -1).astype(float)
        ahead = lens.directions(grid) @ lens.rotation.T
        if ahead[..., 2].min() < 1.0 / np.hypot(1.0, WIDEST):
            raise ValueError(f"camera {lens.name}: sees more than {np.degrees(np.arctan(WIDEST)):.0f}° aside, which a pinhole can't draw; "
                             "take a longer focal length or less distortion")
        place = ahead[..., :2] / ahead[..., 2:]
        reach = np.abs(place).max((0, 1)) * MARGIN
        focal = float(max(lens.matrix[0, 0], lens.matrix[1, 1]))
        self.size = int(np.ceil(2 * focal * reach[0])), int(np.ceil(2 * focal * reach[1]))
        if max(self.size) > 8192:
            raise ValueError(f"camera {lens.name}: needs a picture of {self.size[0]} × {self.size[1]} pixels to be bent; 8192 at most")
        eye = lens.eye
        self.camera = Camera(eye, eye + lens.rotation[2], -lens.rotation[1], float(2 * np.arctan(0.5 * self.size[1] / focal)))
        self._at = place * focal + 0.5 * (np.array(self.size) - 1.0)
        self._out = np.empty((height, width, 3), np.uint8)

    def bent(self, picture: np.ndarray) -> np.ndarray:
        """The lens's picture (H, W, 3) uint8 of the renderer's (h, w, 3 or 4)."""
        warp_kernel(picture, self._at, self._out)
        return self._out.copy()


@kernel
def warp_kernel(picture, at, out):
    """Write the picture (H, W, 3) uint8 whose pixels are at places (H, W, 2) of another one, between four of its pixels."""
    height, width = picture.shape[0], picture.shape[1]
    for y in range(out.shape[0]):
        for x in range(out.shape[1]):
            u, v = min(max(at[y, x, 0], 0.0), width - 1.001), min(max(at[y, x, 1], 0.0), height - 1.001)
            a, b = int(u), int(v)
            f, g = u - a, v - b
            for c in range(3):
                value = ((1 - g) * ((1 - f) * picture[b, a, c] + f * picture[b, a + 1, c])
                         + g * ((1 - f) * picture[b + 1, a, c] + f * picture[b + 1, a + 1, c]))
                out[y, x, c] = np.uint8(value + 0.5)
