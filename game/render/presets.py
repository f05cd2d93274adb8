"""How much work a frame may cost."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Preset:
    """What the renderer spends.

    samples: per pixel for antialiasing; 0 for none. shadow_size: texels along a side of the figures' shadow map.
    floor_taps, body_taps: 1, 4 or 16 reads of it per pixel; 16 make shadows softer the farther they fall.
    detail: the pixels that a metre must measure for the fine mesh, and for the middle one.
    """

    name: str
    samples: int
    shadow_size: int
    floor_taps: int
    body_taps: int
    detail: tuple[float, float]

    def __post_init__(self):
        for taps in (self.floor_taps, self.body_taps):
            if taps not in (1, 4, 16):
                raise ValueError(f"shadow taps must be 1, 4 or 16, got {taps}")


FULL = Preset("full", samples=4, shadow_size=2048, floor_taps=16, body_taps=4, detail=(320.0, 140.0))
FAST = Preset("fast", samples=0, shadow_size=1024, floor_taps=1, body_taps=1, detail=(600.0, 200.0))
PRESETS = {p.name: p for p in (FULL, FAST)}


def preset(name: str | Preset) -> Preset:
    """A preset by its name. ValueError, listing the names, if there is none."""
    if isinstance(name, Preset):
        return name
    if name not in PRESETS:
        raise ValueError(f"no preset is called {name!r}; there are {', '.join(PRESETS)}")
    return PRESETS[name]
