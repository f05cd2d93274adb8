"""Hands: keyboard, mouse, gamepads and script become wishes; a pilot turns wishes into intents.

Devices give a `Wish`, seen from the camera, as a table of `Bindings` says. The pilot gives a
`Command`, in the world. Steering (in `gambol.controllers.navigation`) makes it an `Intent`. A script gives
intents at once.
"""

from .aim import FARTHEST, Aim
from .aimed import BACK, MOVING, NEAR, PATIENCE
from .bindings import DEFAULT, HOLDING, JOINING, REWOUND, Binding, Bindings, Mouse, Sticks
from .devices import (PLAYERS, Keyboard, dead_zone, drivers, mode_of, mouse_wish, pad_held, pad_pressed, pad_wish,
                      player_of, wheel_wish, wishes)
from .help import help_sheet
from .key_names import MOUSE, PAD_BUTTONS, button_label, key_label
from .making import aloft, jumping, landing, leaving
from .moves import Jump, Move
from .on_top import at_hand
from .pilot import STEERING, Command, Pace, Pilot
from .remap import as_toml, load, shared, user_file
from .run_up import AHEAD, BRAKES, RUNS, THINKS, WAITED, RunUp, braked, last_chance, leaps, ring
from .script import Script
from .straight_ahead import agility, before, cramped, even_ahead, headlong, onto, rises
from .wish import STEPS, Wish, in_view, push

__all__ = [
    "AHEAD", "BACK", "BRAKES", "DEFAULT", "HOLDING", "JOINING", "MOUSE", "MOVING", "PAD_BUTTONS", "PLAYERS", "REWOUND", "STEERING", "STEPS", "THINKS", "WAITED", "Aim", "Binding",
    "Bindings", "Command", "FARTHEST", "Jump", "Keyboard", "Mouse", "Move", "NEAR", "PATIENCE", "RUNS", "Pace", "Pilot", "RunUp", "Script", "Sticks", "Wish", "agility", "aloft", "as_toml", "at_hand",
    "before", "braked", "button_label", "cramped", "dead_zone", "drivers", "even_ahead", "headlong", "help_sheet", "in_view", "jumping", "key_label", "landing", "last_chance", "leaps", "leaving", "load", "mode_of", "mouse_wish",
    "onto", "pad_held", "pad_pressed", "pad_wish", "player_of", "push", "ring", "rises", "shared", "user_file", "wheel_wish", "wishes",
]
