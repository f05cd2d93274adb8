"""Characters to wear: any GLB human in, Gambol's own in any size and build, GLB out."""

from . import gltf, materials
from .bind import load
from .fitted_mannequin import Build, BuildError, tailored
from .gltf import CharacterError
from .onto import Rigged, rigged, write_onto
from .write import Actor, Motion, joints_of, write

__all__ = [
    "Actor", "Build", "BuildError", "CharacterError", "Motion", "Rigged", "gltf", "joints_of", "load", "materials", "rigged", "tailored",
    "write", "write_onto",
]
