"""How good a method is: its errors on takes that it has not seen, and the baselines with the settings that did best."""

from . import metrics, trials
from .held_out import CMU, STRANGERS, foreign, learnt_from, small_of, strangers
from .metrics import angle_error, jitter, position_error
from .performers import performers
from .trials import Outcome
from .tuned_baselines import SETTINGS, baseline

__all__ = [
    "CMU", "SETTINGS", "STRANGERS", "Outcome", "angle_error", "baseline", "foreign", "jitter", "learnt_from", "metrics", "performers", "position_error",
    "small_of", "strangers", "trials",
]
