"""Truong 2010: gait cycles → Fourier library → control space → blending → footing → controller."""

from .controller import DEFAULT_LIBRARY, Locomotion
from .library import Library, LibraryError, Primitive
from .memory import Settings

__all__ = ["DEFAULT_LIBRARY", "Library", "LibraryError", "Locomotion", "Primitive", "Settings"]
