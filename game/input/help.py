"""The help sheet: the table in force, and where the sticks and buttons are right now."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import groupby, zip_longest
from typing import Any

from ..scene import Bar, Dial, Lamp, Pad, Row, Sheet
from .bindings import Binding, Bindings
from .devices import Keyboard, buttons_down, drivers, mode_of, pad_wish, player_of, pulls
from .key_names import button_label, key_label

LEFT = 2
"""How many sections stand on the left."""
BLANK = Row(("",))
LAMPS = (("A", "B", "X", "Y", "LB", "RB", "LS", "RS"), ("UP", "RIGHT", "DOWN", "LEFT", "BACK", "START", "GUIDE"))
"""Rows of lamps."""
LABELS = {"UP": "↑", "RIGHT": "→", "DOWN": "↓", "LEFT": "←", "BACK": "Back", "START": "Start", "GUIDE": "Guide"}


def help_sheet(bindings: Bindings, keyboard: Keyboard = Keyboard(), pads: Sequence[Any] = (),
               players: int = 1, rewound: bool = False) -> Sheet:
    """Everything that keys, mouse and pads do, what is held lit, and every pad that is there.

    pads: by slot, None where there is none.
    """
    lit = _lit(bindings, keyboard, pads, players, rewound)
    sections = [_section(title, rows, i in (0, LEFT), bindings, lit) for i, (title, rows) in enumerate(bindings.sections)]
    left, right = (tuple(line for i, section in enumerate(part) for line in (BLANK,) * (i > 0) + section)
                   for part in (sections[:LEFT], sections[LEFT:]))
    shown = tuple(_pad(slot, pads, players, bindings) for slot, pad in enumerate(pads) if pad is not None)
    waiting = players > 1 and not all(drivers(pads, players)[1:])
    if not shown:
        note = "no pad is plugged in" + (": player 2 waits for one" if waiting else "; plug one in at any time")
    else:
        note = "player 2 waits for a pad" if waiting else ""
    return Sheet("Controls", (left, right), shown, note)


def _lit(bindings: Bindings, keyboard: Keyboard, pads: Sequence[Any], players: int, rewound: bool) -> frozenset[str]:
    """The actions whose keys, buttons or sticks are being used."""
    mode = mode_of(None, pads, players, rewound)
    rows = [row for key in keyboard.down for row in bindings.rows_of(key, "keys", mode)]
    for slot, pad in enumerate(pads):
        if pad is not None:
            mode, wish = mode_of(slot, pads, players, rewound), pad_wish(pad, bindings)
            rows += [row for b in buttons_down(pad, bindings.sticks) for row in bindings.rows_of(b, "buttons", mode)]
            rows += [bindings.row("forward")] * any(wish.move) + [bindings.row("face")] * any(wish.look)
    return frozenset(row.action for row in rows)


def _section(title: str, rows: Iterable[Binding], top: bool, bindings: Bindings, lit: frozenset[str]) -> tuple[Row, ...]:
    lines = [Row((title, "keyboard, mouse", "gamepad") if top else (title,), title=True)]
    for text, group in groupby(rows, key=lambda row: row.help):
        group = tuple(group)
        lines.append(Row((text, _keys(group), _buttons(group, bindings)), any(row.action in lit for row in group)))
    return tuple(lines)


def _keys(group: Sequence[Binding]) -> str:
    # first keys first: W A S D before the arrows
    keys = [key_label(key) for some in zip_longest(*(row.keys for row in group)) for key in some if key]
    return " ".join(dict.fromkeys((["wheel"] if group[0].analog == "wheel" else []) + keys))


def _buttons(group: Sequence[Binding], bindings: Bindings) -> str:
    buttons = " ".join(dict.fromkeys(button_label(button) for row in group for button in row.buttons))
    buttons = buttons.replace("→ cross ", "→ ").replace("← cross ", "← ")
    stick = _stick(group[0], bindings)
    if stick and group[0].action == "orbit":  # the stick looks around while the button is down
        return f"{buttons} + {stick}" if buttons else ""
    return " ".join(filter(None, (buttons, stick)))


def _stick(row: Binding, bindings: Bindings) -> str:
    walk, look = ("left", "right") if bindings.sticks.walk == "left" else ("right", "left")
    return {"walk stick": f"{walk} stick", "look stick": f"{look} stick"}.get(row.analog, "")


def _pad(slot: int, pads: Sequence[Any], players: int, bindings: Bindings) -> Pad:
    pad, sticks = pads[slot], bindings.sticks
    name = pad.name if len(pad.name) <= 30 else pad.name[:29] + "…"
    return Pad(f"{name}: player {player_of(slot, pads, players) + 1}",
               tuple(Dial(_on_dial(*at), sticks.dead_zone, sticks.full) for at in (pad.left, pad.right)),
               tuple(Bar(trigger, pull) for trigger, pull in pulls(pad, sticks).items()),
               tuple(tuple(Lamp(LABELS.get(b, b), b in pad.buttons) for b in row) for row in LAMPS))


def _on_dial(x: float, y: float) -> tuple[float, float]:
    """A stick as it reads, before any dead zone; what is no number is in the middle."""
    if not (math.isfinite(x) and math.isfinite(y)):
        return 0.0, 0.0
    return min(max(x, -1.0), 1.0), min(max(-y, -1.0), 1.0)
