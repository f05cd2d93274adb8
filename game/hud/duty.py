"""Who is at work in a character: panels look through the supervisor at the controller on duty."""

from __future__ import annotations

from dataclasses import replace

from controllers.supervisor import Duty

from ..world import Character


def acting(character: Character) -> Character:
    """The character as the controller on duty has it, with that one's memory; itself without a supervisor."""
    duty = character.state.memory
    if not isinstance(duty, Duty):
        return character
    return replace(character, controller=character.controller.controllers[duty.active],
                   state=replace(character.state, memory=duty.memory))


def why(character: Character) -> str:
    """Why the supervisor chose who is on duty; empty where there is none."""
    duty = character.state.memory
    return duty.why if isinstance(duty, Duty) else ""
