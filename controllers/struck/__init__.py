"""Who is struck: a linear inverted pendulum, caught by steps to its capture point (Pratt 2006, Koolen 2012), or a fall and getting up."""

from .capture import DROPS, FALLS, STEPS, SWAYS
from .controller import Recovering, Struck, rehearse
from .flesh import flesh, flesh_of
from .recorded_falls import SPACED
from .recorded_pushes import TAKES, fit
from .recovery import Recovery

__all__ = ["DROPS", "FALLS", "SPACED", "STEPS", "SWAYS", "TAKES", "Recovering", "Recovery", "Struck", "fit", "flesh", "flesh_of", "rehearse"]
