"""A log that is watched, until somebody walks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..session import Log, SessionState, strayed
from ..world import DT

if TYPE_CHECKING:
    from .hands import Hands


@dataclass(eq=False)
class Watching:
    """A tape as it is played. halted: by a key. strayed: whether it was said that it goes another way."""

    tape: Log
    halted: bool = False
    strayed: bool = False

    def over(self, now: SessionState) -> bool:
        """Whether there is no tick after this moment."""
        return now.number == len(self.tape.ticks)

    def strays(self, now: SessionState) -> bool:
        """Whether it is here, for the first time, that the moment is not the one that was played."""
        before, self.strayed = self.strayed, self.strayed or strayed(self.tape, now)
        return self.strayed and not before

    def status(self, now: SessionState, hands: Hands) -> str:
        """How far it is, in a line."""
        return (f"watching {now.number * DT:.0f} of {self.tape.duration:.0f} s: "
                f"{hands.key('pause')} halts, walking plays on from here")
