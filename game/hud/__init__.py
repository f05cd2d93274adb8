"""Panels over the game: the living control space, plots, quality, settings and time.

They are drawn with Dear ImGui into plain arrays (`gambol.game.scene.draw_list`), with no window and no OpenGL
of their own. Importing this loads ImGui, so whoever may never open a panel imports it late.
"""

from . import legend, plots, quality_meter, sliders, space_panel, style, time_strip
from .decision import reason
from .filmed import Filmed
from .legend import Legend
from .panels import Hud

__all__ = [
    "Filmed", "Hud", "Legend", "legend", "plots", "quality_meter", "reason", "sliders", "space_panel", "style",
    "time_strip",
]
