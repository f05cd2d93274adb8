"""What films show over the picture: panels about one actor, and the legend of those who follow points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..explain import Row
from ..scene import PANELS, Ink
from ..world import Character, World
from . import legend, plots
from .canvas import Canvas
from .history import Signals, Trace
from .panels import layout
from .space_panel import SpacePanel
from .toolkit import imgui

BARE = (imgui.WindowFlags_.no_collapse | imgui.WindowFlags_.no_resize | imgui.WindowFlags_.no_scrollbar
        | imgui.WindowFlags_.no_nav | imgui.WindowFlags_.no_inputs)
TURNS = 0.15
"""How fast the control space turns [rad/s], so that its depth is seen."""


class Filmed:
    """Draws what one film shows, frame after frame: what a panel remembers follows from those before."""

    def __init__(self, size: tuple[int, int]):
        self.size, self.canvas = size, Canvas()
        self.trace, self.space = Trace(), SpacePanel()

    def ink(self, panels: Sequence[str], worlds: Sequence[World], who: int, rows: Sequence[Row], seconds: float) -> Ink:
        """One frame: the named panels about character `who`, and the legend where it has rows.

        worlds: of an unbroken run, oldest first, up to the one shown. seconds: since the frame before.
        """
        self.canvas.begin(self.size, seconds)
        scale = self.canvas.scale
        if panels:
            self._panels(panels, self.trace.of(worlds, who), worlds[-1].characters[who], seconds)
        if rows:
            legend.window(rows, self.size, scale, left=bool(panels))
        return self.canvas.end()

    def _panels(self, panels: Sequence[str], signals: Signals, character: Character, seconds: float) -> None:
        scale = self.canvas.scale
        places = layout(self.size, scale, panels)
        for name in (name for name in panels if name in places):
            left, top, width, height = places[name]
            imgui.set_next_window_pos(imgui.ImVec2(left, top), imgui.Cond_.always)
            imgui.set_next_window_size(imgui.ImVec2(width, height), imgui.Cond_.always)
            imgui.begin(PANELS[name], None, BARE)
            if name == "space":
                self.space.orbit = replace(self.space.orbit, yaw=self.space.orbit.yaw + TURNS * seconds)
                self.space.draw(character, signals.blended, seconds, scale)
            else:
                plots.draw(signals, scale)
            imgui.end()

    def release(self) -> None:
        """Give everything back."""
        self.canvas.release()
