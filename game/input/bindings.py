"""The one table of keys and buttons: what the devices read is what the help sheet shows.

Keys are named as GLFW names them, without KEY_; buttons are A B X Y LB RB BACK START LS RS and
UP DOWN LEFT RIGHT of the cross; sticks and triggers are named in words and read by `devices`.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby


@dataclass(frozen=True)
class Binding:
    """What does one thing. held: it acts while it is down; else once, when it is pressed.

    help: what the sheet says; neighbours that say the same share a line.
    keys, buttons: any of them does. analog: the stick, trigger or mouse that does it too.
    """

    action: str
    help: str
    keys: tuple[str, ...] = ()
    buttons: tuple[str, ...] = ()
    analog: str = ""
    held: bool = False


_SHOW = "body, skeleton, contacts, trail, path"

BINDINGS = (
    Binding("forward", "walk", ("W", "UP"), analog="left stick", held=True),
    Binding("left", "walk", ("A", "LEFT"), analog="left stick", held=True),
    Binding("back", "walk", ("S", "DOWN"), analog="left stick", held=True),
    Binding("right", "walk", ("D", "RIGHT"), analog="left stick", held=True),
    Binding("run", "run", ("LEFT_SHIFT", "RIGHT_SHIFT"), analog="right trigger", held=True),
    Binding("slow", "walk slowly", ("LEFT_CONTROL", "LEFT_ALT"), ("B",), held=True),
    Binding("turn_left", "turn left, right", ("Q",), ("LEFT",), held=True),
    Binding("turn_right", "turn left, right", ("E",), ("RIGHT",), held=True),
    Binding("strafe", "keep facing the same way", ("F",), analog="left trigger", held=True),
    Binding("strafe_lock", "keep facing, on or off", ("TAB",), ("RB",)),
    Binding("face", "face a direction", analog="right stick"),
    Binding("orbit", "turn the camera", ("LEFT_BUTTON", "RIGHT_BUTTON"), ("LB",), analog="mouse · right stick", held=True),
    Binding("zoom", "camera nearer or farther", analog="mouse wheel"),
    Binding("recentre", "camera behind the character", ("C",), ("RS",)),
    Binding("pause", "pause", ("P",), ("START",)),
    Binding("step", "one step while paused", ("PERIOD",), ("DOWN",)),
    Binding("reset", "start again", ("R",), ("BACK",)),
    Binding("mesh", _SHOW, ("1",)),
    Binding("skeleton", _SHOW, ("2",)),
    Binding("contacts", _SHOW, ("3",)),
    Binding("trail", _SHOW, ("4",)),
    Binding("path", _SHOW, ("5",)),
    Binding("help", "this sheet", ("F1", "H"), ("Y",)),
    Binding("full_screen", "full screen", ("F11",)),
    Binding("quit", "leave", ("ESCAPE",)),
)
"""Every binding, in the order of the help sheet."""

_NAMES = {"LEFT_SHIFT": "Shift", "RIGHT_SHIFT": "", "LEFT_CONTROL": "Ctrl", "LEFT_ALT": "Alt", "TAB": "Tab",
          "SPACE": "Space", "PERIOD": ".", "ESCAPE": "Esc", "UP": "↑", "DOWN": "↓", "LEFT": "←",
          "RIGHT": "→", "LEFT_BUTTON": "drag", "RIGHT_BUTTON": ""}
_BUTTONS = {"LEFT": "cross ←", "RIGHT": "cross →", "UP": "cross ↑", "DOWN": "cross ↓",
            "START": "Start", "BACK": "Back", "RS": "press right stick"}


def binding(action: str) -> Binding:
    """The binding of an action. KeyError, naming it, if there is none."""
    for row in BINDINGS:
        if row.action == action:
            return row
    raise KeyError(action)


def pressed_by(name: str, kind: str = "keys") -> tuple[str, ...]:
    """The actions that pressing a key (or, with kind "buttons", a pad's button) sets off once."""
    return tuple(row.action for row in BINDINGS if not row.held and name in getattr(row, kind))


def help_sheet() -> tuple[str, ...]:
    """The table as lines of text: action, keyboard and mouse, gamepad."""
    rows = [("", "keyboard", "gamepad")]
    for text, group in groupby(BINDINGS, key=lambda row: row.help):
        group = list(group)
        mouse, _, stick = group[0].analog.partition(" · ")
        if not stick and "mouse" not in mouse:
            mouse, stick = "", mouse
        keys = [_NAMES.get(row.keys[i], row.keys[i].capitalize())
                for i in range(2) for row in group if i < len(row.keys)]
        buttons = [_BUTTONS.get(button, button) for row in group for button in row.buttons]
        rows.append((text, " ".join(filter(None, (mouse, *keys))),
                     " + ".join(filter(None, (" ".join(buttons), stick)))))
    widths = [max(len(row[i]) for row in rows) for i in range(3)]
    return tuple("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows)
