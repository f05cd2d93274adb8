"""What leaves the program: films and pictures, motion for other programs, strips of poses, and a gallery of all scenarios."""

from . import export
from .coding import GIF_RATE
from .export import Take, checked, chosen, rig_in, sampled, suffix_onto, takes, write, write_onto
from .gallery import PAGE, make, plan, write_page
from .pose_strip import strip
from .recorder import recorder

__all__ = [
    "GIF_RATE", "PAGE", "Take", "checked", "chosen", "export", "make", "plan", "recorder", "rig_in", "sampled", "strip", "suffix_onto", "takes", "write", "write_onto", "write_page",
]
