"""Looking back: how far, how fast, and from where. Nothing of it is logged or changes what was played."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..input import Wish
from ..scene import Camera
from ..world import DT
from .state import SessionState, Player

HELD = 18
"""Ticks after which a scrub key that is held goes on by itself."""


@dataclass(frozen=True, eq=False)
class Look:
    """Where one is while looking back.

    behind: how many steps of the world back; last: the same a tick ago. scrubbed: ticks that a
    scrub key has been down. rested: whether the sticks have been let go since; only then a push
    plays on. viewer: a camera turned by hand about the past; None for the one that was there.
    """

    behind: int = 0
    last: int = 0
    scrubbed: int = 0
    rested: bool = False
    viewer: Player | None = None

    def to(self, behind: int, kept: int) -> Look:
        """The view of another moment, of so many that are kept."""
        return replace(self, behind=min(max(behind, 0), kept))

    def step(self, rewinding: bool, direction: int, pushed: bool, kept: int) -> Look:
        """A tick further. direction: of the scrub keys, 1 back. pushed: whether a stick asks to move."""
        look = replace(self, last=self.behind, rested=self.rested or not pushed,
                       scrubbed=self.scrubbed + 1 if direction and not rewinding else 0)
        if rewinding:
            return look.to(self.behind + 1, kept)
        once = look.scrubbed == 1 or look.scrubbed > HELD
        return look.to(self.behind + direction * once, kept)

    def at(self, alpha: float) -> tuple[int, float]:
        """What to draw `alpha` of the way through the tick: how many steps back, and how far (0 … 1)
        between the two worlds of that moment."""
        where = self.last + alpha * (self.behind - self.last)
        return int(where), 1.0 - (where - int(where))

    def turned(self, wish: Wish, moment: SessionState) -> Look:
        """The camera turned, zoomed or pushed about `moment`, the one that is shown."""
        if self.viewer is None and not wish.zoom and wish.drag == wish.orbit == wish.pan == (0.0, 0.0):
            return self
        player = self.viewer or moment.players[0]
        camera = player.camera.step(moment.after.characters[0].state.ground, np.zeros(2), Wish(
            orbit=wish.orbit, drag=wish.drag, zoom=wish.zoom, pan=wish.pan), DT, moment.after.props)
        return replace(self, viewer=replace(player, last=player.camera, camera=camera))

    def cameras(self, moment: SessionState, fraction: float, alpha: float) -> tuple[Camera, ...]:
        """Each player's camera at a past moment; the first one's as it was turned since."""
        first = self.viewer.view(alpha) if self.viewer else moment.players[0].view(fraction)
        return (first, *(player.view(fraction) for player in moment.players[1:]))
