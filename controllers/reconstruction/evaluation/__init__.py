"""How good a method is: its errors on takes that it has not seen, and the baselines with the settings that did best."""

from . import metrics, trials
from .metrics import angle_error, jitter, position_error
from .trials import Outcome
from .tuned_baselines import SETTINGS, baseline

__all__ = [
    "SETTINGS", "Outcome", "angle_error", "baseline", "jitter", "metrics", "position_error", "trials",
]
