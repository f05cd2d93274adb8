"""A frame as plain data: what the world shows and the renderer draws. Scenes of figures and props, draw lists of panels, the
help sheet.
"""

from .draw_list import PANELS, VERTEX, Ink, Stroke
from .help_sheet import Bar, Dial, Lamp, Pad, Row, Sheet
from .scene import (OVERLAYS, TINT, Arrow, Box, Camera, Caption, Dot, Figure, Goal, Hint, Line, Overlays, Patch, Pillar,
                    Prop, Scene, Sketch)

__all__ = [
    "OVERLAYS", "PANELS", "TINT", "VERTEX", "Arrow", "Bar", "Box", "Camera", "Caption", "Dial", "Dot", "Figure", "Goal",
    "Hint", "Ink", "Lamp", "Line", "Overlays", "Pad", "Patch", "Pillar", "Prop", "Row", "Scene", "Sheet", "Sketch",
    "Stroke",
]
