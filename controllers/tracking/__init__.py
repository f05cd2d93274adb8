"""Motion capture without markers, from several cameras: Rosenhahn et al. 2007, "Online smoothing for markerless motion
capture". What is known of a camera, what a body looks like in it, and the pose that fits.
"""

from .controller import Tracking, Watching
from .tracker import Track, Tracker, TrackerSettings

__all__ = ["Track", "Tracker", "TrackerSettings", "Tracking", "Watching"]
