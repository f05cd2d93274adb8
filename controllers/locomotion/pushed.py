"""Who is pushed while he walks or runs, no harder than his own next steps take in: he goes on from the velocity that the push gives him.

Walkers and runners set each foot down anew anyway. The push moves the capture point x + v/ω by Δv/ω, 0.3 of Δv in metres: up to a third of a step or so the coming
footholds, planned with the body's way, are where they need to be. From there on the command goes back to the wish as fast as legs push.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ..contract import CharacterState
from .first_stride import END
from .memory import RUN

WALKING, RUNNING = (0.8, 0.8, 0.7), (1.6, 1.4, 0.8)
"""So much faster ahead, back and aside [m/s] a push may make a walker and a runner, in the size that the library is of. Chosen: a walker's from less than a third of a step; a runner's ahead
and back, that soles slide by less than 0.3 m/s and joints turn by less than 36 rad/s (unpushed 23), aside from what people catch who stand; no pushed runner was recorded."""
SLOWEST, LEAST = 0.5, 0.25
"""Slower than the first [m/s] nobody walks on through a push, nor who would go slower ahead than the second after it."""


def pushed(state: CharacterState, change: np.ndarray) -> CharacterState | None:
    """The state of one character, which this room's controller moves, with a velocity that a push has changed by (2,) x, z [m/s] in the world; None where that is more than the
    next steps take in, or he shifts his weight to set off, stops, turns on the spot or stands."""
    memory = state.memory
    if memory.ndim or memory["settled"] or memory["waits"] or memory["stop"] > 0.0 or memory["onset"] > END or memory["turn"] != 0.0:
        return None
    c, s = math.cos(float(memory["ground"][2])), math.sin(float(memory["ground"][2]))
    x, z = (float(part) for part in change)
    ahead, left = s * x + c * z, c * x - s * z
    v_f, v_l = float(memory["command"][0]), float(memory["command"][2])
    most = RUNNING if memory["family"] == RUN else WALKING
    over = math.hypot(ahead / (most[0] if ahead > 0.0 else most[1]), left / most[2])
    if not over <= 1.0 or math.hypot(v_f, v_l) < SLOWEST or (ahead < 0.0 and v_f + ahead < LEAST):
        return None
    memory, gained = memory.copy(), np.array([ahead, 0.0, left])
    memory["command"] += gained
    memory["velocity"] += gained
    memory["went"] += change
    return replace(state, velocity=np.asarray(state.velocity, float) + gained, memory=memory)
