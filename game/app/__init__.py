"""The game as a person plays it: events in, scenes out. It needs no window; a host gives it one."""

from .app import Play
from .capture import OUT, Capture, log_file
from .views import filmed, frames

__all__ = [
    "OUT", "Capture", "Play", "filmed", "frames", "log_file",
]
