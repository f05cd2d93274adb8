"""What a character did over the last seconds, as arrays: the signals that panels plot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gambol.controllers.locomotion import walks

from ..session import SessionState
from ..world import RATE, Character, World
from .on_duty import acting, own

STEPS = 10 * RATE
"""How many steps of the world the plots and the quality meter look back."""


@dataclass(frozen=True, eq=False)
class Signals:
    """N steps of one character, oldest first; the last is the moment looked at. All in its own body's size.

    numbers: (N,) of the steps. asked, blended, achieved: (N, 3) v_f, ω, v_l [m/s, rad/s, m/s]; what
    the hands ask for, or a plan to a goal, what the blended primitives have, how the root moves. phase: (N,) of the gait.
    contacts: (N, 4) bool. NaN where the active controller has no such thing.
    """

    numbers: np.ndarray
    asked: np.ndarray
    blended: np.ndarray
    achieved: np.ndarray
    phase: np.ndarray
    contacts: np.ndarray

    @property
    def seconds(self) -> np.ndarray:
        """(N,) [s], 0 at the moment looked at."""
        return (self.numbers - self.numbers[-1]) / RATE


class Trace:
    """Reads signals off moments; a world is read once, however often it is shown."""

    def __init__(self):
        self.rows: dict[int, tuple[World, np.ndarray]] = {}
        self.who = 0

    def read(self, moments: Sequence[SessionState], who: int = 0) -> Signals:
        """The signals of character `who` up to the last of the moments, of which there is one at least."""
        return self.of(recent(moments), who)

    def of(self, worlds: Sequence[World], who: int = 0) -> Signals:
        """The same of the last STEPS worlds of an unbroken run, oldest first."""
        if who != self.who:
            self.rows, self.who = {}, who
        kept = {}
        for world in tuple(worlds)[-STEPS:]:
            known = self.rows.get(id(world))
            # the world is kept beside its row, so that no other can have its id
            kept[id(world)] = known if known is not None else (world, _row(world, who))
        self.rows = kept
        rows = np.array([row for _, row in kept.values()])
        return Signals(rows[:, 0], rows[:, 1:4], rows[:, 4:7], rows[:, 7:10], rows[:, 10], rows[:, 11:15] > 0.5)


def recent(moments: Sequence[SessionState]) -> list[World]:
    """The worlds of the last STEPS steps, oldest first; those of one unbroken run, each once."""
    worlds: list[World] = []
    for moment in reversed(moments):
        world = moment.after
        if worlds and world is worlds[-1]:
            continue
        if len(worlds) == STEPS or worlds and world.number != worlds[-1].number - 1:
            break  # a reset lies between
        worlds.append(world)
    return worlds[::-1]


def weights(character: Character) -> np.ndarray | None:
    """How much of each of its library's P primitives a character's pose has, (P,); None where it blends none."""
    memory = character.state.memory
    # memory has room for more primitives than there are
    return memory["weights"][:len(character.controller.library.primitives)] if walks(memory) else None


def _row(world: World, who: int) -> np.ndarray:
    whole = world.characters[who]
    character, state = acting(whole), whole.state
    share = weights(character)
    blend, phase = (np.full(3, np.nan), np.nan) if share is None else \
        (share @ character.controller.library.velocities * own(whole), character.state.memory["phase"])
    way = state.going
    asked = whole.intent.velocity if way is None else way.plan.at(way.time)[1]
    return np.concatenate([[world.number], asked, blend, state.velocity, [phase], state.contacts])
