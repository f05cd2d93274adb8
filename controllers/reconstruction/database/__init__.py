"""Motion databases: takes of many people in one memory-mapped file, built from motion capture or from Gambol's own motion,
and a store on disk for what was learnt from them.
"""

from .build_database import actions, build
from .contacts import contacts, standing, tracks_of
from .database import FPS, SUFFIX, Database, DatabaseError, Take, Writer
from .default import default_database
from .store import identity, kept

__all__ = [
    "FPS", "SUFFIX", "Database", "DatabaseError", "Take", "Writer", "actions", "build", "contacts", "default_database", "identity", "kept",
    "standing", "tracks_of",
]
