"""Characters to wear: any GLB human in, Gambol's own in any size and build, GLB out."""

from . import gltf, materials
from .bind import load
from .fitted_mannequin import Build, BuildError, tailored
from .gltf import CharacterError
from .write import Actor, Motion, joints_of, write

__all__ = [
    "Actor", "Build", "BuildError", "CharacterError", "Motion", "gltf", "joints_of", "load", "materials", "tailored",
    "write",
]
