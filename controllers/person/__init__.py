"""A person: everything that one body can do, under one supervisor; and `preparing`, which compiles what that takes."""

from . import preparing
from .person import built, person, rehearse

__all__ = [
    "built", "person", "preparing", "rehearse",
]
