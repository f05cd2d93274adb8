"""Bodies and solids as triangles in the world: what virtual cameras see, and what a tracker poses."""

from .skins import posed_meshes, solid_meshes, surface_of

__all__ = ["posed_meshes", "solid_meshes", "surface_of"]
