"""What leaves the program: films and pictures, motion for other programs, strips of poses, and a gallery of all scenarios."""

from . import export
from .export import Take, checked, sampled, takes, write
from .gallery import PAGE, make, plan, write_page
from .pose_strip import strip
from .recorder import recorder

__all__ = [
    "PAGE", "Take", "checked", "export", "make", "plan", "recorder", "sampled", "strip", "takes", "write", "write_page",
]
