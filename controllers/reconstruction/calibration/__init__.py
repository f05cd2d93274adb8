"""How trackers are worn, and by whom: what a standing pose and some seconds of moving tell of mounts, bones and the floor."""

from .calibration_file import load, save
from .calibration_network import SHIPPED, CalibrationNetwork, learnt
from .moved import BEFORE
from .set_poses import POSES, apart, fitted
from .simulated import FRAMES, STRIDE
from .stood import JOINTS, WORN, Stood
from .wearing_trackers import Wearer, calibratable, stance
from .worn import Calibration, calibrated

__all__ = [
    "BEFORE", "FRAMES", "JOINTS", "POSES", "SHIPPED", "STRIDE", "WORN", "Calibration", "CalibrationNetwork", "Stood", "Wearer", "apart", "calibratable", "calibrated",
    "fitted", "learnt", "load", "save", "stance",
]
