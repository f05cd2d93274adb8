"""How bodies pass closely by what stands about: arms that would brush it are drawn in."""

from .arms import drawn_in

__all__ = ["drawn_in"]
