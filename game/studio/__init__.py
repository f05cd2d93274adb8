"""The studio: calibrated cameras film a scenario, and beside the pictures lies the truth; and people are tracked in them."""

from .following import error_of, followed, late, overlaid
from .importing import imported
from .lens_warp import LensWarp
from .sensor import Sensor, read_sensor
from .shooting import Plan, shoot
from .truth import COCO, Stage, Truth, coco_points, seen_by

__all__ = [
    "COCO", "LensWarp", "Plan", "Sensor", "Stage", "Truth", "coco_points", "error_of", "followed", "imported", "late", "overlaid", "read_sensor",
    "seen_by", "shoot",
]
