"""The one table of keys and buttons: what the devices read is what the help sheet shows.

`Bindings` is a value that is passed to whatever reads a device; `DEFAULT` is what Gambol comes with,
and `gambol.game.input.remap` reads another from a file.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

REWOUND = "rewound"
"""The mode while a past moment is shown."""
JOINING = "joining"
"""The mode of a device that could bring in a second player."""


HOLDING = "holding"
"""The mode while the pointer is over a point that can be held."""


@dataclass(frozen=True)
class Binding:
    """What does one thing. held: it acts while it is down; else once, when it is pressed.

    help: what the sheet says; neighbours that say the same share a line.
    keys, buttons: any of them does. analog: what else does it, "walk stick", "look stick" or
    "wheel". mode: where it acts, in front of what its keys do else.
    """

    action: str
    help: str
    keys: tuple[str, ...] = ()
    buttons: tuple[str, ...] = ()
    held: bool = False
    analog: str = ""
    mode: str = ""

    def can_have(self, kind: str) -> bool:
        """Whether "keys" or "buttons" can do it; some things take a stick, the wheel or the mouse."""
        return self.action not in {"keys": ("face", "zoom"), "buttons": ("face", "zoom", "pan")}[kind]


@dataclass(frozen=True)
class Sticks:
    """How sticks and triggers are read.

    walk: the stick that walks, "left" or "right"; the other one looks. dead_zone, full: where a
    stick starts to count and where it counts in full, as parts of its throw. curve: the exponent
    of what lies between; 1 is linear, 2 finer near the middle. trigger_dead_zone: the same of
    triggers. invert_x, invert_y: of the stick while it turns the camera.
    """

    walk: Literal["left", "right"] = "left"
    dead_zone: float = 0.15
    full: float = 0.95
    curve: float = 1.0
    trigger_dead_zone: float = 0.08
    invert_x: bool = False
    invert_y: bool = False


@dataclass(frozen=True)
class Mouse:
    """How the mouse is read. turn: how far a drag over the window's height turns the camera [rad]."""

    turn: float = 4.0
    invert_x: bool = False
    invert_y: bool = False


@dataclass(frozen=True)
class Bindings:
    """A whole table. sections: title → rows, in the order of the help sheet."""

    sections: tuple[tuple[str, tuple[Binding, ...]], ...]
    sticks: Sticks = Sticks()
    mouse: Mouse = Mouse()

    def __iter__(self) -> Iterator[Binding]:
        return (row for _, rows in self.sections for row in rows)

    @cached_property
    def _by_action(self) -> dict[str, Binding]:
        return {row.action: row for row in self}

    def row(self, action: str) -> Binding:
        """The row of an action. KeyError, naming it, if there is none."""
        return self._by_action[action]

    def rows_of(self, name: str, kind: str = "keys", mode: str = "") -> tuple[Binding, ...]:
        """What a key (or, with kind "buttons", a pad's button) does in a mode.

        What belongs to the mode goes before what the same key does everywhere.
        """
        rows = tuple(row for row in self if name in getattr(row, kind))
        return tuple(row for row in rows if row.mode and row.mode == mode) or tuple(row for row in rows if not row.mode)

    def pressed_by(self, name: str, kind: str = "keys", mode: str = "") -> tuple[str, ...]:
        """The actions that pressing it sets off once."""
        return tuple(row.action for row in self.rows_of(name, kind, mode) if not row.held)


_SHOW = "body, bones, contacts, trail, path"
_JUMPS = "jump, balance, forces"
_PANELS = "space, plots, quality, settings"

DEFAULT = Bindings((
    ("Walk", (
        Binding("forward", "walk", ("W", "UP"), held=True, analog="walk stick"),
        Binding("left", "walk", ("A", "LEFT"), held=True, analog="walk stick"),
        Binding("back", "walk", ("S", "DOWN"), held=True, analog="walk stick"),
        Binding("right", "walk", ("D", "RIGHT"), held=True, analog="walk stick"),
        Binding("run", "run", ("LEFT_SHIFT", "RIGHT_SHIFT"), ("RT",), held=True),
        Binding("slow", "walk slowly", ("LEFT_CONTROL", "LEFT_ALT"), ("B",), held=True),
        Binding("turn_left", "turn, or a jump; flying: down, up", ("Q",), ("LEFT",), held=True),
        Binding("turn_right", "turn, or a jump; flying: down, up", ("E",), ("RIGHT",), held=True),
        Binding("jump", "hold to aim, let go to jump", ("SPACE",), ("A",), held=True),
        Binding("go_to", "go where the pointer is; or click", ("T",), ("LS",), held=True),
        Binding("strafe", "keep facing", ("F",), ("LT",), held=True),
        Binding("strafe_lock", "keep facing, on or off", ("TAB",), ("RB",)),
        Binding("push", "a push from behind you; hard with run", ("M",)),
        Binding("face", "face a direction", analog="look stick"),
        Binding("join", "a second player joins", ("J",), ("START",), mode=JOINING),
    )),
    ("Time", (
        Binding("pause", "pause", ("P",), ("START",)),
        Binding("step", "one step while paused", ("PERIOD",), ("DOWN",)),
        Binding("slowmo", "slow motion", ("K",)),
        Binding("rewind", "rewind", ("BACKSPACE",), ("X",), held=True),
        Binding("scrub_back", "rewound: back, on", ("LEFT",), ("LEFT",), held=True, mode=REWOUND),
        Binding("scrub_on", "rewound: back, on", ("RIGHT",), ("RIGHT",), held=True, mode=REWOUND),
        Binding("resume", "rewound: go on from here", ("ENTER",), ("START",), mode=REWOUND),
        Binding("reset", "start again", ("R",), ("BACK",)),
    )),
    ("Look", (
        Binding("orbit", "turn the camera", ("LEFT_BUTTON", "RIGHT_BUTTON"), ("LB",), held=True, analog="look stick"),
        Binding("pan", "orbiting: push aside", ("MIDDLE_BUTTON",), held=True),
        Binding("zoom", "nearer, farther", analog="wheel"),
        Binding("recentre", "from behind", ("C",), ("RS",)),
        Binding("camera_mode", "follow, orbit, fly", ("V",), ("UP",)),
    )),
    ("Reconstruct", (
        Binding("study", "from a few points, beside", ("X",)),
        Binding("study_points", "2 … 6 points; ghosts", ("N",)),
        Binding("study_ghosts", "2 … 6 points; ghosts", ("G",)),
        Binding("study_hands", "hold the points: drag them", ("B",)),
        Binding("study_grab", "hold the points: drag them", ("LEFT_BUTTON",), held=True, mode=HOLDING),
        Binding("study_hide", "one under the pointer: unseen", ("U",)),
        Binding("penalty", "tracked: jitter penalty; pictures", ("Z",)),
        Binding("cameras", "tracked: jitter penalty; pictures", ("9",)),
    )),
    ("Show and keep", (
        Binding("mesh", _SHOW, ("1",)),
        Binding("skeleton", _SHOW, ("2",)),
        Binding("contacts", _SHOW, ("3",)),
        Binding("trail", _SHOW, ("4",)),
        Binding("path", _SHOW, ("5",)),
        Binding("show_jump", _JUMPS, ("6",)),
        Binding("balance", _JUMPS, ("7",)),
        Binding("forces", _JUMPS, ("8",)),
        Binding("panels", "all panels", ("F2",)),
        Binding("space_panel", _PANELS, ("F3",)),
        Binding("plots_panel", _PANELS, ("F4",)),
        Binding("quality_panel", _PANELS, ("F5",)),
        Binding("settings_panel", _PANELS, ("F6",)),
        Binding("export", "export, film, screenshot", ("F9",)),
        Binding("film", "export, film, screenshot", ("F10",)),
        Binding("screenshot", "export, film, screenshot", ("F12",)),
        Binding("help", "this sheet", ("F1", "H"), ("Y",)),
        Binding("full_screen", "full screen", ("F11",)),
        Binding("quit", "leave", ("ESCAPE",)),
    )),
))
"""What Gambol comes with, in the order of the help sheet."""
