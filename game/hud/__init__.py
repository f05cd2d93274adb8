"""Panels over the game: the living control space, plots, quality, settings and time.

They are drawn with Dear ImGui into plain arrays (`game.ink`), with no window and no OpenGL
of their own. Importing this loads ImGui, so whoever may never open a panel imports it late.
"""

from .panels import PANELS, Hud
from .reason import reason

__all__ = ["PANELS", "Hud", "reason"]
