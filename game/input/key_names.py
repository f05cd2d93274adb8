"""What keys and buttons are called: in the table, in a bindings file and on the help sheet.

Keys are named as GLFW names them, without KEY_: by where they lie on a US keyboard, whatever is
printed on them. Mouse buttons are keys too.
"""

from __future__ import annotations

import string

MOUSE = frozenset(f"{side}_BUTTON" for side in ("LEFT", "RIGHT", "MIDDLE"))
KEYS = MOUSE | frozenset(string.ascii_uppercase) | frozenset(string.digits) | frozenset(
    f"F{i}" for i in range(1, 26)) | frozenset(f"KP_{i}" for i in range(10)) | frozenset(
    f"{side}_{key}" for side in ("LEFT", "RIGHT") for key in ("SHIFT", "CONTROL", "ALT", "SUPER", "BRACKET")) | frozenset("""
    SPACE APOSTROPHE COMMA MINUS PERIOD SLASH SEMICOLON EQUAL BACKSLASH GRAVE_ACCENT WORLD_1 WORLD_2
    ESCAPE ENTER TAB BACKSPACE INSERT DELETE UP DOWN LEFT RIGHT PAGE_UP PAGE_DOWN HOME END
    CAPS_LOCK SCROLL_LOCK NUM_LOCK PRINT_SCREEN PAUSE MENU
    KP_ADD KP_SUBTRACT KP_MULTIPLY KP_DIVIDE KP_DECIMAL KP_EQUAL KP_ENTER""".split())
"""Every key and mouse button."""

PAD_BUTTONS = ("A", "B", "X", "Y", "LB", "RB", "BACK", "START", "GUIDE", "LS", "RS", "UP", "RIGHT", "DOWN", "LEFT")
"""A pad's buttons in GLFW's order; LS and RS are the sticks pressed in, UP … LEFT the cross."""
TRIGGERS = ("LT", "RT")
"""The triggers, which count as buttons where they are pulled far enough."""
BUTTONS = frozenset(PAD_BUTTONS + TRIGGERS)
KINDS = {"keys": KEYS, "buttons": BUTTONS}
"""The tables of a bindings file that give names, and the names that there are."""

_ARROWS = {"UP": "↑", "DOWN": "↓", "LEFT": "←", "RIGHT": "→"}
_KEYS = _ARROWS | {
    "LEFT_SHIFT": "Shift", "RIGHT_SHIFT": "Shift", "LEFT_CONTROL": "Ctrl", "RIGHT_CONTROL": "Ctrl", "LEFT_ALT": "Alt",
    "ESCAPE": "Esc", "PERIOD": "Period", "COMMA": ",", "SLASH": "/", "SEMICOLON": ";", "APOSTROPHE": "'", "MINUS": "-",
    "EQUAL": "=", "BACKSLASH": "\\", "GRAVE_ACCENT": "`", "LEFT_BRACKET": "[", "RIGHT_BRACKET": "]",
    "LEFT_BUTTON": "drag", "RIGHT_BUTTON": "drag", "MIDDLE_BUTTON": "drag with wheel"}
_BUTTONS = {name: f"cross {arrow}" for name, arrow in _ARROWS.items()} | {
    "START": "Start", "BACK": "Back", "GUIDE": "Guide", "LS": "press left stick", "RS": "press right stick"}


def key_label(key: str) -> str:
    """What the help sheet calls a key."""
    return _KEYS.get(key) or (key if key[1:].isdecimal() else key.replace("KP_", "keypad ").replace("_", " ").capitalize())


def button_label(button: str) -> str:
    """What the help sheet calls a pad's button."""
    return _BUTTONS.get(button, button)
