"""How trackers are worn, and by whom: what a standing pose and some seconds of moving tell of mounts, bones and the floor."""

from .calibration_file import load, save
from .calibration_network import SHIPPED, CalibrationNetwork, learnt
from .likely_bones import SHIPPED as BONES
from .likely_bones import LikelyBones
from .likely_bones import load as load_bones
from .likely_bones import save as save_bones
from .moved import BEFORE
from .set_poses import POSES, apart, fitted
from .simulated import FRAMES, STRIDE
from .stood import JOINTS, WORN, Stood
from .wearing_trackers import Wearer, calibratable, stance
from .worn import Calibration, calibrated

__all__ = [
    "BEFORE", "BONES", "FRAMES", "JOINTS", "POSES", "SHIPPED", "STRIDE", "WORN", "Calibration", "CalibrationNetwork", "LikelyBones", "Stood", "Wearer", "apart", "calibratable", "calibrated",
    "fitted", "learnt", "load", "load_bones", "save", "save_bones", "stance",
]
