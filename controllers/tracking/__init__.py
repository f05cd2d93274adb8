"""Motion capture without markers, from several cameras: Rosenhahn et al. 2007, "Online smoothing for markerless motion
capture". What is known of a camera, what a body looks like in it, and the pose that fits.
"""

from .clicks import ClickError, clicked, exchanged, read_clicks
from .controller import Tracking, Watching
from .shape_fit import Shape, fitted_shape
from .tracker import Track, Tracker, TrackerSettings

__all__ = [
    "ClickError", "Shape", "Track", "Tracker", "TrackerSettings", "Tracking", "Watching", "clicked", "exchanged", "fitted_shape", "read_clicks",
]
