"""Drawing: a scene of plain data becomes a picture, on OpenGL 3.3 core.

`Renderer(context, size, preset).draw(scene)` draws into its own framebuffer; `read` gives the
pixels, `blit` shows them elsewhere. Importing this package touches no GL; hosts make the context.
"""

from .presets import FAST, FULL, PRESETS, Preset, preset
from .renderer import Renderer

__all__ = ["FAST", "FULL", "PRESETS", "Preset", "Renderer", "preset"]
