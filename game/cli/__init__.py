"""The command line: ``gambol play``, ``render``, ``library``, ``scenarios`` and more, a module for each group.

A user's mistake gets one clear line and exit code 2; a machine without a display exits with 3.
Everything heavy is imported where it is used, so that help comes at once.
"""

import os
import signal
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy: threads cost small matrices far more than they save

from . import play, films, filming, motion, library, jumps, database, reconstruct, navigate  # noqa: E402, in the order of the help
from .base import app, learn, pixels_of, unswept  # noqa: E402

__all__ = ["app", "database", "filming", "films", "jumps", "learn", "library", "main", "motion", "navigate", "pixels_of", "play",
           "reconstruct", "unswept"]


def main() -> None:
    """The `gambol` command. Ended from outside it goes as programs do that end by themselves, and what it began ends with it."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    app()
