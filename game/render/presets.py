"""How much work a frame may cost."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Preset:
    """What the renderer spends.

    samples: per pixel for antialiasing; 0 for none. shadow_size: texels along a side of the shadow map.
    shadow_taps: 1 or 9 reads of it per pixel. softness: reach of those taps on the ground [m].
    near: figures nearer than this to the camera [m] get the fine mesh, the others the coarse one.
    """

    name: str
    samples: int
    shadow_size: int
    shadow_taps: int
    softness: float
    near: float

    def __post_init__(self):
        if self.shadow_taps not in (1, 9):
            raise ValueError(f"shadow_taps must be 1 or 9, got {self.shadow_taps}")


FULL = Preset("full", samples=4, shadow_size=2048, shadow_taps=9, softness=0.009, near=9.0)
FAST = Preset("fast", samples=0, shadow_size=1024, shadow_taps=1, softness=0.0, near=4.0)
PRESETS = {p.name: p for p in (FULL, FAST)}


def preset(name: str | Preset) -> Preset:
    """A preset by its name. ValueError, listing the names, if there is none."""
    if isinstance(name, Preset):
        return name
    if name not in PRESETS:
        raise ValueError(f"no preset is called {name!r}; there are {', '.join(PRESETS)}")
    return PRESETS[name]
