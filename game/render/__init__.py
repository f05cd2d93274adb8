"""Drawing: a scene of plain data becomes a picture, on OpenGL 3.3 core.

`Renderer(context, size, preset).draw(scene)` draws into its own framebuffer; `read` gives the
pixels, `blit` shows them elsewhere. Importing this package touches no GL; hosts make the context.
"""

from . import gl, occlusion, skin, view
from .girth import ARMS
from .mesh import LEVELS, Body, Mesh, mannequin, pack
from .presets import FAST, FULL, PRESETS, Preset, preset
from .renderer import Renderer
from .skin import NAMES
from .view import NEAR, look_at, scale_of
from .wear import dressed, leg_length, size_of, worn

__all__ = [
    "ARMS", "FAST", "FULL", "LEVELS", "NAMES", "NEAR", "PRESETS", "Body", "Mesh", "Preset", "Renderer", "dressed", "gl", "leg_length",
    "look_at", "mannequin", "occlusion", "pack", "preset", "scale_of", "size_of", "skin", "view", "worn",
]
