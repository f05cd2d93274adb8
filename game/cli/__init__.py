"""The command line: ``gambol play``, ``render``, ``library``, ``scenarios`` and more, a module for each group.

A user's mistake gets one clear line and exit code 2; a machine without a display exits with 3.
Everything heavy is imported where it is used, so that help comes at once.
"""

from . import play, films, motion, library, database, reconstruct  # in the order of the help
from .base import app

__all__ = ["app", "database", "films", "library", "main", "motion", "play", "reconstruct"]


def main() -> None:
    """The `gambol` command."""
    app()
