"""The studio: calibrated cameras film a scenario, and beside the pictures lies the truth; and people are tracked in them."""

from .following import clicked_pose, error_of, first_poses, followed, overlaid, person_in, seen_in, settled
from .footage import Footage, FootageError, begun, read_footage
from .importing import imported
from .lens_warp import LensWarp
from .sensor import Sensor, read_sensor
from .shooting import Plan, shoot
from .truth import COCO, Stage, Truth, coco_points, seen_by

__all__ = [
    "COCO", "Footage", "FootageError", "LensWarp", "Plan", "Sensor", "Stage", "Truth", "begun", "clicked_pose", "coco_points", "error_of", "first_poses",
    "followed", "imported", "overlaid", "person_in", "read_footage", "read_sensor", "seen_by", "seen_in", "settled", "shoot",
]
