"""How trackers are worn, and by whom: what a standing pose and some seconds of moving tell of mounts, bones and the floor."""

from .set_learning import SetLearner
from .set_network import SHIPPED, SetNetwork
from .simulated import BEFORE, FRAMES, STRIDE
from .stood import JOINTS, WORN, Stood
from .worn import Calibration, calibrated

__all__ = ["BEFORE", "FRAMES", "JOINTS", "SHIPPED", "STRIDE", "WORN", "Calibration", "SetLearner", "SetNetwork", "Stood", "calibrated"]
