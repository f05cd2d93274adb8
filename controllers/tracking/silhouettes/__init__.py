"""What a body looks like from cameras: its skin in a pose, the pixels that it covers, and their contour."""

from .contours import Contour, contour_kernel, contour_of, extent_of
from .masks import HIDDEN, hidden, is_mask, of_person, own
from .rasteriser import View, raster_kernel, redrawn, rendered
from .shape import shaped
from .surface import Surface, skin_kernel, skinned

__all__ = [
    "HIDDEN", "Contour", "Surface", "View", "contour_kernel", "contour_of", "extent_of", "hidden", "is_mask", "of_person", "own", "raster_kernel", "redrawn", "rendered",
    "shaped", "skin_kernel", "skinned",
]
