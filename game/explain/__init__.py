"""What is drawn to understand a motion: the arc of a jump that is aimed at, balance and forces, points and what they are
missed by; and how good a motion is, in figures.
"""

from .jump import broken, explained
from .jump_preview import Preview, preview
from .points import RADIUS, Row, pointed, rows
from .quality import Quality, quality_of

__all__ = [
    "RADIUS", "Preview", "Quality", "Row", "broken", "explained", "pointed", "preview", "quality_of", "rows",
]
