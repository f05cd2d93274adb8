"""Keyboard, mouse and gamepads as wishes.

A pad is a `gambol.game.hosts.PadState`, or None where none is plugged in; pads are a tuple of them by slot.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from .bindings import JOINING, REWOUND, Bindings, Sticks
from .key_names import TRIGGERS
from .wish import Wish, unit_disc

PLAYERS = 2
"""The most players that devices are shared out to."""
PULLED = 0.3
"""From here on a pulled trigger counts as a pressed button."""
MOST_NOTCHES = 10.0
"""The most notches of the wheel that one event may report."""


@dataclass(frozen=True)
class Keyboard:
    """The keys and mouse buttons that are down, by name."""

    down: frozenset[str] = frozenset()

    def press(self, key: str) -> Keyboard:
        """With one key more down."""
        return Keyboard(self.down | {key})

    def release(self, key: str) -> Keyboard:
        """With one key up."""
        return Keyboard(self.down - {key})

    def held(self, action: str, bindings: Bindings) -> bool:
        """Whether any key of an action is down."""
        return not self.down.isdisjoint(bindings.row(action).keys)

    def wish(self, bindings: Bindings) -> Wish:
        """What the held keys ask for; opposite keys cancel out."""
        def axis(plus: str, minus: str) -> float:
            return float(self.held(plus, bindings)) - float(self.held(minus, bindings))
        return Wish(move=unit_disc(axis("right", "left"), axis("forward", "back")),
                    turn=axis("turn_left", "turn_right"), run=float(self.held("run", bindings)),
                    slow=self.held("slow", bindings), strafe=self.held("strafe", bindings),
                    jump=self.held("jump", bindings))


def dead_zone(x: float, y: float, sticks: Sticks) -> tuple[float, float]:
    """A stick's reading within the unit circle: 0 inside the dead zone, rising to 1 where it counts in full.

    Radial, so that the direction stays as it is pushed. A reading that is no number counts as 0.
    """
    length = math.hypot(x, y)
    if not math.isfinite(length) or length <= sticks.dead_zone:
        return 0.0, 0.0
    wanted = _share(length, sticks.dead_zone, sticks)
    return x / length * wanted, y / length * wanted


def trigger(value: float, sticks: Sticks) -> float:
    """A trigger's reading, −1 released … 1 pressed, as 0 … 1 with a dead zone; no number counts as 0."""
    pull = 0.5 * (value + 1.0)
    return _share(pull, sticks.trigger_dead_zone, sticks) if sticks.trigger_dead_zone < pull < math.inf else 0.0


def _share(length: float, inner: float, sticks: Sticks) -> float:
    return min((length - inner) / (sticks.full - inner), 1.0) ** sticks.curve


def pulls(pad: Any, sticks: Sticks) -> dict[str, float]:
    """How far the triggers LT and RT are pulled, 0 … 1."""
    return dict(zip(TRIGGERS, (trigger(pad.left_trigger, sticks), trigger(pad.right_trigger, sticks))))


def buttons_down(pad: Any, sticks: Sticks) -> frozenset[str]:
    """The buttons of a pad that are down; a trigger that is pulled far enough is one."""
    if pad is None:
        return frozenset()
    return pad.buttons | {name for name, pull in pulls(pad, sticks).items() if pull > PULLED}


def pad_held(pad: Any, action: str, bindings: Bindings) -> bool:
    """Whether any button of an action is down."""
    return not buttons_down(pad, bindings.sticks).isdisjoint(bindings.row(action).buttons)


def pad_wish(pad: Any, bindings: Bindings) -> Wish:
    """What a gamepad asks for."""
    if pad is None:
        return Wish()
    sticks = bindings.sticks
    walk, look = (pad.left, pad.right) if sticks.walk == "left" else (pad.right, pad.left)
    move, look = dead_zone(walk[0], -walk[1], sticks), dead_zone(look[0], -look[1], sticks)
    pulled, down = pulls(pad, sticks), buttons_down(pad, sticks)
    def held(action: str) -> bool:
        return not down.isdisjoint(bindings.row(action).buttons)
    def axis(plus: str, minus: str) -> float:
        return float(held(plus)) - float(held(minus))
    move = max(move, unit_disc(axis("right", "left"), axis("forward", "back")), key=lambda v: math.hypot(*v))
    orbit = (look[0] if sticks.invert_x else -look[0], -look[1] if sticks.invert_y else look[1])
    # a trigger that runs does so by degrees
    run = max((pulled.get(name, float(name in pad.buttons)) for name in bindings.row("run").buttons), default=0.0)
    return Wish(move=move, look=(0.0, 0.0) if held("orbit") else look, orbit=orbit if held("orbit") else (0.0, 0.0),
                turn=axis("turn_left", "turn_right"), run=run, slow=held("slow"), strafe=held("strafe"), jump=held("jump"))


def pad_pressed(before: Any, after: Any, bindings: Bindings, mode: str = "") -> tuple[str, ...]:
    """The actions that the buttons gone down between two states of a pad set off.

    A pad that has just been plugged in sets off nothing: what is down then was not pressed here.
    """
    if before is None or after is None:
        return ()
    new = buttons_down(after, bindings.sticks) - buttons_down(before, bindings.sticks)
    return tuple(dict.fromkeys(action for button in sorted(new) for action in bindings.pressed_by(button, "buttons", mode)))


def drivers(pads: Sequence[Any], players: int) -> tuple[tuple[int, ...], ...]:
    """The slots of the pads that drive each player; the keyboard always drives the first one, too.

    Alone one drives with whatever lies at hand. With company the last pads are the others', one each.
    """
    there = tuple(slot for slot, pad in enumerate(pads) if pad is not None)
    others = there[len(there) - min(players - 1, len(there)):]
    first = tuple(slot for slot in there if slot not in others)
    return (first, *((slot,) for slot in others), *((),) * (players - 1 - len(others)))


def player_of(slot: int, pads: Sequence[Any], players: int) -> int:
    """The player whom the pad in a slot drives; 0, the first, for a slot without a pad."""
    return next((player for player, slots in enumerate(drivers(pads, players)) if slot in slots), 0)


def mode_of(slot: int | None, pads: Sequence[Any], players: int, rewound: bool = False) -> str:
    """The mode of the pad in a slot, or of the keyboard (None), which decides what its presses mean.

    While there is room, the keyboard and every pad but the first can bring in another player.
    """
    if rewound:
        return REWOUND
    first = next((i for i, pad in enumerate(pads) if pad is not None), None)
    return JOINING if players < PLAYERS and (slot is None or slot != first) else ""


def wishes(keyboard: Keyboard, pads: Sequence[Any], players: int, bindings: Bindings) -> tuple[Wish, ...]:
    """What the held controls ask for, one wish for each player."""
    asked = []
    for player, slots in enumerate(drivers(pads, players)):
        wish = keyboard.wish(bindings) if player == 0 else Wish()
        for slot in slots:
            wish = wish.merged(pad_wish(pads[slot], bindings))
        asked.append(wish)
    return tuple(asked)


def mouse_wish(dx: float, dy: float, keyboard: Keyboard, bindings: Bindings, captured: bool = False) -> Wish:
    """What a movement of the mouse by parts of the window's height asks for; nothing unless it drags.

    captured: the mouse has no pointer, and every movement turns the camera.
    """
    mouse = bindings.mouse
    if not (math.isfinite(dx) and math.isfinite(dy)):
        return Wish()
    if captured or keyboard.held("orbit", bindings):
        return Wish(drag=(mouse.turn * (dx if mouse.invert_x else -dx), mouse.turn * (-dy if mouse.invert_y else dy)))
    return Wish(pan=(dx, -dy)) if keyboard.held("pan", bindings) else Wish()


def wheel_wish(notches: float) -> Wish:
    """What a turn of the wheel asks for; positive away from the user."""
    return Wish(zoom=min(max(notches, -MOST_NOTCHES), MOST_NOTCHES)) if math.isfinite(notches) else Wish()
