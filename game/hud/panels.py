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

MARGIN, STRIP, QUALITY = 12.0, 70.0, 212.0
TOLD = 380.0, 190.0
COLUMN, LEAST, STRIP_LEAST, SHARED = 230.0, 120.0, 330.0, 180.0
"""No column of panels is narrower than this, no panel lower and no strip shorter [px at 720 lines]: of less nothing can be used. Those that
share a column evenly are not lower than SHARED."""
HINTS = 0.86
"""Hints stand below this part of the picture's height."""
Place = tuple[float, float, float, float]
"""Left, top, width, height [px]."""


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
        self.placed: dict[str, Place] = {}  # where each was put last
        self.drawn: dict[str, Place] = {}  # where each is, moved by whoever plays
        self.size = (1, 1)

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
        self.canvas.begin(size, seconds)
        scale, actions, asked = self.canvas.scale, [], []
        places, self.size, self.drawn = layout(size, scale, self.open, bool(told)), size, {}
        for name in (name for name in PANELS if name in places):
            self._place(name, places[name])
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
            self._end(name)
            if not stays:
                actions.append(f"{name}_panel")
        if "told" in places:
            self._place("told", places["told"])
            imgui.begin("reconstruction", None, imgui.WindowFlags_.no_collapse | imgui.WindowFlags_.no_nav)
            legend.draw(told, scale)
            self._end("told")
        if "strip" in places:
            self._place("strip", places["strip"])
            imgui.begin("time", None, imgui.WindowFlags_.no_title_bar | imgui.WindowFlags_.no_resize
                        | imgui.WindowFlags_.no_scrollbar | imgui.WindowFlags_.no_nav)
            self.who, asked = time_strip.draw(now, history[-1], behind, kept, self.who, scale)
            self._end("strip")
        if self.space.chosen is not None and self.space.library is not None:
            self.phase = (self.phase + seconds / self.space.library.primitives[self.space.chosen].period) % 1.0
        return self.canvas.end(), actions + asked

    @property
    def left_out(self) -> tuple[str, ...]:
        """The panels that are open and have no room, as their title bars would call them."""
        return tuple(title for name, title in PANELS.items() if name in self.open and name not in self.drawn)

    @property
    def taken(self) -> tuple[float, float]:
        """Width and height [px] of what the strip takes of the top right of the picture, if it is beside the game's own lines."""
        left, top, _, high = self.drawn.get("strip", (0.0, 0.0, 0.0, 0.0))
        return (self.size[0] - left, top + high) if left > 0.25 * self.size[0] else (0.0, 0.0)

    @property
    def beside(self) -> tuple[float, float]:
        """Where the panels leave the most room for a hint, from and to, in parts of the picture's width."""
        low = sorted((x, x + wide) for x, y, wide, high in self.drawn.values() if y + high > HINTS * self.size[1])
        free, reached = (0.0, 0.0), 0.0
        for start, end in [*low, (self.size[0], self.size[0])]:
            free = max(free, (reached, start), key=lambda span: span[1] - span[0])
            reached = max(reached, end)
        return free[0] / self.size[0], free[1] / self.size[0]

    def _place(self, name: str, place: Place) -> None:
        """Put the next window there: at first, and whenever its place has become another."""
        when = imgui.Cond_.first_use_ever if self.placed.get(name) == place else imgui.Cond_.always
        self.placed[name] = place
        imgui.set_next_window_pos(imgui.ImVec2(*place[:2]), when)
        imgui.set_next_window_size(imgui.ImVec2(*place[2:]), when)

    def _end(self, name: str) -> None:
        at, size = imgui.get_window_pos(), imgui.get_window_size()
        self.drawn[name] = at.x, at.y, size.x, size.y
        imgui.end()

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


def layout(size: tuple[int, int], scale: float, open: Collection[str] = PANELS, told: bool = False) -> dict[str, Place]:
    """Where the panels that are open are at first, and the strip, "strip", and the legend, "told", where there is one.

    The middle, where the character is, stays free as long as the picture is wide enough; the strip is in the middle above, or
    above all. What has no room is left out, the most important last.
    """
    width, height, gap = size[0] / scale, size[1] / scale, MARGIN
    left, right = min(310.0, 0.3 * width), min(390.0, 0.36 * width)
    columns = [("settings", "quality"), ("space", "plots")]
    if left < COLUMN:
        left, right, columns = max(COLUMN, min(310.0, 0.6 * width)), 0.0, [sum(columns, ())] if width >= COLUMN + 2 * gap else []
    between = width - left - right - 4 * gap
    text = 80.0  # where the game's own lines are
    wide = between >= 400.0 and len(columns) > 1
    places = {"strip": (left + 2 * gap, gap, between, STRIP) if wide else (gap, text, width - 2 * gap, STRIP)}
    if min(places["strip"][2] - STRIP_LEAST, height - text - STRIP) < 0.0:
        del places["strip"]
    tops = (text, gap) if wide else (text + (STRIP + gap if places else 0.0),) * 2
    for names, across, top, column in zip(columns, (gap, width - right - gap), tops, (left, right)):
        for name, below, high in _stacked(names, open, height - top - gap):
            places[name] = across, top + below, column, high
    if told and between >= TOLD[0] and height - TOLD[1] - gap >= text + STRIP + gap:
        places["told"] = left + 2 * gap, height - gap - TOLD[1], *TOLD  # in the middle below, at the feet of whom it is about
    return {name: (scale * x, scale * y, scale * wide, scale * high) for name, (x, y, wide, high) in places.items()}


def _stacked(names: Sequence[str], open: Collection[str], room: float) -> list[tuple[str, float, float]]:
    """The panels of a column so high that are shown, the most important first: each with how far down it begins and its height."""
    full = {"settings": (0.0, room - QUALITY - MARGIN), "quality": (room - QUALITY, QUALITY),
            "space": (0.0, 0.56 * (room - MARGIN)), "plots": (0.56 * (room - MARGIN) + MARGIN, 0.44 * (room - MARGIN))}
    lowest = min(full[name][1] for name in names)
    # where each has its place, whichever others are open, and where both are that have just enough room
    if len(names) == 2 and (lowest >= SHARED or lowest >= LEAST and set(names) <= set(open)):
        return [(name, *full[name]) for name in names if name in open]
    shown = [name for name in names if name in open][:max(int((room + MARGIN) / (SHARED + MARGIN)), int(room >= LEAST))]
    high = (room + MARGIN) / max(len(shown), 1) - MARGIN
    return [(name, number * (high + MARGIN), high) for number, name in enumerate(shown)]
