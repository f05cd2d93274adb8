"""What is drawn to understand a motion: the arc of a jump that is aimed at, balance and forces, points and what they are
missed by; the way to a goal; coming footholds; and how good a motion is, in figures.
"""

from .camera_views import camera_views, with_cameras
from .footholds import stepping
from .jump import broken, explained
from .jump_preview import AT_ONCE, NO, Preview, preview
from .jump_sketches import ghosts
from .points import RADIUS, Row, pointed, rows
from .quality import Quality, quality_of
from .way import led, on_the_way

__all__ = [
    "AT_ONCE", "NO", "RADIUS", "Preview", "Quality", "Row", "broken", "camera_views", "explained", "ghosts", "led", "on_the_way", "pointed", "preview", "quality_of", "rows",
    "stepping", "with_cameras",
]
