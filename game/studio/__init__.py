"""The studio: calibrated cameras film a scenario, and beside the pictures lies the truth, for whoever tracks people in them."""

from .footage import Footage, FootageError, begun, read_footage
from .lens_warp import LensWarp
from .sensor import Sensor, read_sensor
from .shooting import Plan, shoot
from .skins import surface_of
from .truth import COCO, Stage, Truth, coco_points, seen_by

__all__ = [
    "COCO", "Footage", "FootageError", "LensWarp", "Plan", "Sensor", "Stage", "Truth", "begun", "coco_points", "read_footage",
    "read_sensor", "seen_by", "shoot", "surface_of",
]
