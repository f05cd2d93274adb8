"""Ways round what stands about: rounded shapes on the floor, shortest ways past them on either side, a search on a grid."""

from .grid import grid_way
from .shapes import THIN, clear, distance, ends_ground, separation, shapes_of
from .visibility import ways

__all__ = ["THIN", "clear", "distance", "ends_ground", "grid_way", "separation", "shapes_of", "ways"]
