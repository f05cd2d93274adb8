"""What leaves the program: films and pictures, motion for other programs, strips of poses, and a gallery of all scenarios."""

from . import export
from .export import Take, checked, chosen, sampled, takes, write, write_onto
from .gallery import PAGE, make, plan, write_page
from .pose_strip import strip
from .recorder import recorder

__all__ = [
    "PAGE", "Take", "checked", "chosen", "export", "make", "plan", "recorder", "sampled", "strip", "takes", "write", "write_onto", "write_page",
]
