"""Characters to wear: any GLB human in, Gambol's own in any size and build, GLB out."""

from .bind import load
from .gltf import CharacterError

__all__ = ["CharacterError", "load"]
