"""The game as a person plays it: events in, scenes out. It needs no window; a host gives it one."""

from .app import Play
from .asking import Asked, Asking
from .capture import OUT, Capture, log_file
from .hints import Teacher
from .opening import Opening
from .preparing import Preparing
from .sending import Sending, sure
from .views import filmed, frames

__all__ = [
    "OUT", "Asked", "Asking", "Capture", "Opening", "Play", "Preparing", "Sending", "Teacher", "filmed", "frames", "log_file", "sure",
]
