"""Other ways to rid a tracked motion of jitter, after each frame or after the fact: what the penalty is measured against."""

from .smoothers import KalmanFilter, OneEuro, savitzky_golay, smoothed

__all__ = ["KalmanFilter", "OneEuro", "savitzky_golay", "smoothed"]
