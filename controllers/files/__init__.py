"""What comes from others' disks and programs and what goes there: ordinary files read, whole ones written, words fit to be shown."""

from .arrays import ArraysError, arrays
from .printable import printable
from .safe_files import append, contents, ordinary, reason, whole
from .toml_tables import tables

__all__ = [
    "ArraysError", "append", "arrays", "contents", "ordinary", "printable", "reason", "tables", "whole",
]
