"""The panels together: which are open, where they are, what they are shown and what they ask for."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

from ..explain import Row
from ..hosts import Event
from ..scene import PANELS, Figure, Ink
from ..session import SessionState
from . import legend, plots, quality_meter, sliders, space_panel, time_strip
from .canvas import Canvas
from .ghost import ghost
from .history import Trace
from .toolkit import imgui

MARGIN = 12.0
STRIP = 70.0
LEAST = 60.0
"""No panel is narrower or lower than this, however small the picture [px at 720 lines]."""


class Hud:
    """The panels over a game. No context is made before one of them opens.

    `handle` takes the host's events; `frame` gives the ink to show and the actions that were asked
    for; `ghosts` the figures that play a clip. who: the player whose signals and settings they are.
    """

    def __init__(self):
        self.canvas: Canvas | None = None
        self.open: frozenset[str] = frozenset()
        self.trace, self.meter, self.space = Trace(), quality_meter.Meter(), space_panel.SpacePanel()
        self.who, self.phase = 0, 0.0

    def handle(self, event: Event) -> bool:
        """Take an event; whether a panel has taken it, so that the game should not."""
        return self.canvas is not None and self.canvas.handle(event)

    def frame(self, open: Collection[str], history: Sequence[SessionState], now: SessionState, behind: int, kept: int,
              size: tuple[int, int], seconds: float, told: Sequence[Row] = ()) -> tuple[Ink, list[str]]:
        """The panels named in `open` over a picture of `size` pixels, and the actions their user asks for.

        history: the moments up to the one shown, `behind` steps before `now`; of the `kept` that one
        can go back. seconds: since the last frame. told: the legend of those who follow points. The actions are the game's own ("pause", "step",
        "slowmo", "resume", "NAME_panel", "name=value"), and "look=N": show the moment N steps before now.
        """
        if self.canvas is None:
            self.canvas = Canvas()
        self.open, self.who = frozenset(open), min(self.who, len(now.players) - 1)
        character = history[-1].after.characters[self.who]
        self.meter.frame(seconds)
        signals = self.trace.read(history, self.who) if self.open & {"space", "plots"} else None
        moved = self.canvas.begin(size, seconds)
        places, scale, actions = layout(size, self.canvas.scale), self.canvas.scale, []
        for name in (name for name in PANELS if name in self.open):
            _place(places[name], moved)
            shown, stays = imgui.begin(PANELS[name], True, imgui.WindowFlags_.no_collapse | imgui.WindowFlags_.no_nav)
            if shown and signals is not None and name == "space":
                self.space.draw(character, signals.blended, seconds, scale)
            elif shown and signals is not None and name == "plots":
                plots.draw(signals, scale)
            elif shown and name == "quality":
                self.meter.look(history, self.who, seconds)
                self.meter.draw()
            elif shown and name == "settings":
                actions += sliders.draw(now, self.who, scale)
            imgui.end()
            if not stays:
                actions.append(f"{name}_panel")
        if told:
            left, top, wide, high = places["quality"]
            beside = 380.0 * scale, 190.0 * scale  # in the middle below, at the feet of whom it is about
            _place((left + wide + MARGIN * scale, top + high - beside[1], *beside), moved)
            imgui.begin("reconstruction", None, imgui.WindowFlags_.no_collapse | imgui.WindowFlags_.no_nav)
            legend.draw(told, scale)
            imgui.end()
        _place(places["strip"], moved)
        imgui.begin("time", None, imgui.WindowFlags_.no_title_bar | imgui.WindowFlags_.no_resize
                    | imgui.WindowFlags_.no_scrollbar | imgui.WindowFlags_.no_nav)
        self.who, asked = time_strip.draw(now, history[-1], behind, kept, self.who, scale)
        imgui.end()
        if self.space.chosen is not None and self.space.library is not None:
            self.phase = (self.phase + seconds / self.space.library.primitives[self.space.chosen].period) % 1.0
        return self.canvas.end(), actions + asked

    def ghosts(self, figures: Sequence[Figure], moment: SessionState) -> tuple[Figure, ...]:
        """The figure that plays the chosen primitive beside its character. figures: the moment's own."""
        number, character = self.space.chosen, moment.after.characters[self.who]
        library = character.controller.library
        if number is None or "space" not in self.open or library is not self.space.library:
            return ()
        played = ghost(library, number, self.phase, character.state.ground)
        return (replace(played, body=figures[self.who].body),)

    def release(self) -> None:
        """Give everything back."""
        if self.canvas is not None:
            self.canvas.release()
            self.canvas = None


def layout(size: tuple[int, int], scale: float) -> dict[str, tuple[float, float, float, float]]:
    """Where panels are at first: left, top, width, height [px]. The middle, where the character is,
    stays free as long as the picture is wide enough; the strip is in the middle above, or above all."""
    width, height, gap = size[0] / scale, size[1] / scale, MARGIN
    left, right = min(310.0, 0.3 * width), min(390.0, 0.36 * width)
    between = width - left - right - 4 * gap
    text = 80.0  # where the game's own lines are
    strip = (left + 2 * gap, gap, between, STRIP) if between >= 400.0 else (gap, text, width - 2 * gap, STRIP)
    tops = (text, gap) if between >= 400.0 else (text + STRIP + gap,) * 2
    quality = 212.0
    upper = 0.56 * (height - tops[1] - 2 * gap)
    places = {"settings": (gap, tops[0], left, height - tops[0] - quality - 2 * gap),
              "quality": (gap, height - gap - quality, left, quality),
              "space": (width - right - gap, tops[1], right, upper),
              "plots": (width - right - gap, tops[1] + upper + gap, right, height - tops[1] - upper - 2 * gap),
              "strip": strip}
    return {name: (scale * x, scale * y, scale * max(wide, LEAST), scale * max(high, LEAST))
            for name, (x, y, wide, high) in places.items()}


def _place(place: tuple[float, float, float, float], again: bool) -> None:
    """Put the next window there: at first, and whenever the picture has changed its size."""
    when = imgui.Cond_.always if again else imgui.Cond_.first_use_ever
    imgui.set_next_window_pos(imgui.ImVec2(*place[:2]), when)
    imgui.set_next_window_size(imgui.ImVec2(*place[2:]), when)
