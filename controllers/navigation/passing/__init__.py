"""How bodies pass closely by what stands about: arms that would brush it are drawn in, and walls hold them up."""

from .arms import drawn_in, drawn_on
from .walls import HEAD, NEAR, STEP, out_kernel, rise_kernel, slow_kernel, walls_of, way_kernel

__all__ = ["HEAD", "NEAR", "STEP", "drawn_in", "drawn_on", "out_kernel", "rise_kernel", "slow_kernel", "walls_of", "way_kernel"]
