"""Who is at work in a character: panels look through supervisor and size at the controller on duty."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gambol.controllers.contract import Duty
from gambol.controllers.scaled import Scaled

from ..world import Character


def acting(character: Character) -> Character:
    """The character as the controller on duty has it: with that one's memory, in the size of its library.

    Itself where one controller alone moves it in its own size.
    """
    controller, state, intent = character.controller, character.state, character.intent
    if isinstance(state.memory, Duty):
        controller = controller.parts[state.memory.active]
        state = replace(state, memory=state.memory.memory)
    if isinstance(controller, Scaled):
        state, intent = controller.within(state, intent)
        controller = controller.controller
    return replace(character, controller=controller, state=state, intent=intent)


def own(character: Character) -> np.ndarray:
    """What velocities (v_f, ω, v_l) of the library (3,) are multiplied by to be those of the character's own body."""
    controller = character.controller
    if isinstance(character.state.memory, Duty):
        controller = controller.parts[character.state.memory.active]
    root = controller.factor**0.5 if isinstance(controller, Scaled) else 1.0
    return np.array([root, 1.0 / root, root])


def why(character: Character) -> str:
    """Why the supervisor chose who is on duty; empty where there is none."""
    duty = character.state.memory
    return duty.why if isinstance(duty, Duty) else ""
