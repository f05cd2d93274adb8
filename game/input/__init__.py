"""Hands: keyboard, gamepad and script become wishes; a pilot turns wishes into intents.

Keyboard and gamepad give a `Wish`, seen from the camera. The pilot gives a `Command`, in the
world. Steering (in `controllers.navigation`) makes it an `Intent`. A script gives intents at once.
"""

from .bindings import BINDINGS, Binding, help_sheet
from .devices import Keyboard, dead_zone, pad_pressed, pad_wish
from .pilot import Command, Pace, Pilot
from .script import Move, Script
from .wish import Wish

__all__ = ["BINDINGS", "Binding", "Command", "Keyboard", "Move", "Pace", "Pilot", "Script", "Wish",
           "dead_zone", "help_sheet", "pad_pressed", "pad_wish"]
