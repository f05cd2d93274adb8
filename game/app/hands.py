"""What the hands of a game's players hold and press, and what the next tick is asked for."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from ..hosts import PADS, Event, KeyEvent, MouseMove, PadState, Scroll
from ..input import (HOLDING, Bindings, Keyboard, Wish, drivers, key_label, mode_of, mouse_wish, pad_held, pad_pressed,
                     player_of, wheel_wish, wishes)

PUSHED = 0.3
"""How far a stick must be pushed to play on from a past moment."""


class Heard(NamedTuple):
    """What an event says: a wish at once, and the actions pressed. slot: of the pad that pressed them; None for the keyboard."""

    wish: Wish | None = None
    pressed: Sequence[str] = ()
    slot: int | None = None


class Hands:
    """Keyboard, mouse and pads, by a table of bindings. pending: what each player asked for since the last tick. tapped: the keys that went
    down since then: a tap may be over before the next tick looks."""

    def __init__(self, bindings: Bindings):
        self.bindings, self.keyboard = bindings, Keyboard()
        self.pads: list[PadState | None] = [None] * PADS
        self.pending: dict[int, Wish] = {}
        self.tapped: frozenset[str] = frozenset()

    def hear(self, event: Event, players: int, rewound: bool, captured: bool) -> Heard:
        """Take an event; those that mean nothing here are ignored.

        rewound: whether one looks back. captured: whether the mouse steers a flying camera.
        """
        match event:
            case KeyEvent(key, True):
                self.keyboard, self.tapped = self.keyboard.press(key), self.tapped | {key}
                mode = mode_of(None, self.pads, players, rewound)
                return Heard(None, tuple(self.bindings.pressed_by(key, mode=mode)))
            case KeyEvent(key, False):
                self.keyboard = self.keyboard.release(key)
            case MouseMove(dx=dx, dy=dy):
                return Heard(mouse_wish(dx, dy, self.keyboard, self.bindings, captured))
            case Scroll(dy=notches):
                return Heard(wheel_wish(notches))
            case PadState(slot=slot) if 0 <= slot < PADS:
                pad, before = event if event.name else None, self.pads[slot]
                self.pads[slot] = pad
                mode = mode_of(slot, self.pads, players, rewound)
                return Heard(None, tuple(pad_pressed(before, pad, self.bindings, mode)), slot)
        return Heard()

    def player(self, slot: int | None, players: int) -> int:
        """Whose hands hold the pad in a slot, of so many players; the keyboard is the first one's."""
        return 0 if slot is None else player_of(slot, self.pads, players)

    def has_pad(self, players: int) -> bool:
        """Whether the last of so many players has anything to play with."""
        return bool(drivers(self.pads, players)[-1])

    def grabs(self, key: str) -> bool:
        """Whether a key takes hold of points."""
        return any(row.action == "study_grab" for row in self.bindings.rows_of(key, mode=HOLDING))

    def ask(self, wish: Wish, player: int = 0) -> None:
        """Add to what the next tick is asked for."""
        self.pending[player] = self.pending.get(player, Wish()).merged(wish)

    @property
    def asked(self) -> bool:
        """Whether the next tick is to do something that was pressed."""
        return any(wish.pressed for wish in self.pending.values())

    def ticked(self) -> None:
        """What was tapped has had its tick."""
        self.tapped = frozenset()

    @property
    def _keys(self) -> Keyboard:
        return Keyboard(self.keyboard.down | self.tapped)

    def wishes(self, players: int) -> tuple[Wish, ...]:
        """What every player asks for in this tick; what was pressed is asked for once."""
        held = wishes(self._keys, self.pads, players, self.bindings)
        asked_for = tuple(wish.merged(self.pending.get(who, Wish())).rounded() for who, wish in enumerate(held))
        self.pending.clear()
        return asked_for

    def holds(self, action: str) -> bool:
        """Whether anybody holds the key or button of an action, or tapped it since the last tick."""
        return self._keys.held(action, self.bindings) or any(pad_held(pad, action, self.bindings) for pad in self.pads)

    def sends(self, players: int) -> str:
        """With what the first player sends the character somewhere: the "pointer" as long as the key is held, the "middle" of the picture, which
        a stick moves, with a pad's button; "" with neither."""
        if self.keyboard.held("go_to", self.bindings):
            return "pointer"
        return "middle" if any(pad_held(self.pads[slot], "go_to", self.bindings) for slot in drivers(self.pads, players)[0]) else ""

    def pushes(self, players: int) -> bool:
        """Whether anybody asks to move, by other keys than those that scrub."""
        scrubs = {key for action in ("scrub_back", "scrub_on") for key in self.bindings.row(action).keys}
        return any(math.hypot(*wish.move) > PUSHED for wish in wishes(
            Keyboard(self.keyboard.down - scrubs), self.pads, players, self.bindings))

    def key(self, action: str) -> str:
        """What the key of an action is called."""
        keys = self.bindings.row(action).keys
        return key_label(keys[0]) if keys else action.replace("_", " ")
