"""Where live points come from: recorded performances, trackers over the network, and how their wearer stands in the room."""

from .osc_stream import HOST, PORT, Stream, read_map, usual_map
from .placing import Standing, placed
from .sources import Recorded

__all__ = [
    "HOST", "PORT", "Recorded", "Standing", "Stream", "placed", "read_map", "usual_map",
]
