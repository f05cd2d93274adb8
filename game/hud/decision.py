"""Which controller moves a character, and why it does what it does, in a sentence."""

from __future__ import annotations

from gambol.controllers.locomotion import RUN, walks

from ..world import Character
from .on_duty import acting, own


def family(character: Character) -> str:
    """What a character is at: "walk", "run" or "rest"; "" where its controller knows no such thing."""
    memory = character.state.memory
    if not walks(memory):
        return ""
    return "rest" if memory["settled"] else "run" if memory["family"] == RUN else "walk"


def reason(whole: Character) -> str:
    """Why a character walks, runs or rests: what was asked against where its gaits change, in its own body's size."""
    character, own_speed = acting(whole), float(own(whole)[0])
    gait = family(character)
    if not gait:
        status = character.controller.status(character.state)
        return status.kind + (f": {status.reason}" if status.reason else "")
    s, asked = character.controller.settings, own_speed * float(character.intent.velocity[0])
    reached = own_speed * float(character.state.memory["command"][0])
    run_above, walk_below = own_speed * s.run_above, own_speed * s.walk_below
    if gait == "rest":
        return "rests: nothing is asked of it"
    if gait == "run":
        if reached < walk_below:
            return "runs on until the foot stands that walking begins with"
        if reached <= run_above:
            return f"runs still: {reached:.1f} m/s is not yet below {walk_below:.2f} m/s"
        return f"runs: asked {asked:.1f} m/s is above {run_above:.2f} m/s"
    if run_above == float("inf"):
        return f"walks: asked {asked:.1f} m/s, and its library has no runs"
    if reached > run_above:
        return "walks on until the foot stands that running begins with"
    if asked > run_above:
        return f"speeds up: {reached:.1f} of {asked:.1f} m/s, and runs above {run_above:.2f} m/s"
    if asked > walk_below:
        return f"walks still: {asked:.1f} m/s is not above {run_above:.2f} m/s"
    if not character.intent.velocity.any():
        return "stops: nothing is asked any more"
    return f"walks: asked {asked:.1f} m/s is below {run_above:.2f} m/s"
