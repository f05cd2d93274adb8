"""What a moment of a session looks like: one scene for each player, side by side."""

from __future__ import annotations

from collections.abc import Sequence

from .scene import Camera, Overlays, Scene
from .session import Moment
from .world import figures


def scenes(moment: Moment, fraction: float, cameras: Sequence[Camera], overlays: Overlays,
           text: Sequence[tuple[str, ...]] = ()) -> tuple[Scene, ...]:
    """One scene for each camera.

    fraction: how far from `moment.before` to `moment.after` (0 … 1). text: for each camera, the
    lines in its corner.
    """
    people, width = figures(moment.before, moment.after, fraction), 1.0 / len(cameras)
    text = tuple(text) or ((),) * len(cameras)
    return tuple(Scene(camera, people, moment.after.props, overlays, lines, part=(i * width, 0.0, width, 1.0))
                 for i, (camera, lines) in enumerate(zip(cameras, text, strict=True)))
