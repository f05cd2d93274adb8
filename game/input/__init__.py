"""Hands: keyboard, mouse, gamepads and script become wishes; a pilot turns wishes into intents.

Devices give a `Wish`, seen from the camera, as a table of `Bindings` says. The pilot gives a
`Command`, in the world. Steering (in `controllers.navigation`) makes it an `Intent`. A script gives
intents at once.
"""

from .bindings import DEFAULT, HOLDING, JOINING, REWOUND, Binding, Bindings, Mouse, Sticks
from .devices import (PLAYERS, Keyboard, dead_zone, drivers, mode_of, mouse_wish, pad_held, pad_pressed, pad_wish,
                      player_of, wheel_wish, wishes)
from .help import help_sheet
from .pilot import Command, Pace, Pilot
from .script import Move, Script
from .wish import Wish

__all__ = ["DEFAULT", "HOLDING", "JOINING", "PLAYERS", "REWOUND", "Binding", "Bindings", "Command", "Keyboard", "Mouse", "Move",
           "Pace", "Pilot", "Script", "Sticks", "Wish", "dead_zone", "drivers", "help_sheet", "mode_of", "mouse_wish",
           "pad_held", "pad_pressed", "pad_wish", "player_of", "wheel_wish", "wishes"]
