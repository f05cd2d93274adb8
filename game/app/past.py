"""The moments of a game, present and past, and which one is shown."""

from __future__ import annotations

from itertools import islice

from ..input import Wish
from ..scene import Camera
from ..session import Look, SessionState, Timeline
from ..world import DT
from .hands import Hands


class History:
    """A timeline, and `look`: how one looks back at it; None while one plays."""

    def __init__(self, first: SessionState):
        self.timeline = Timeline(first)
        self.look: Look | None = None

    @property
    def now(self) -> SessionState:
        """The present moment."""
        return self.timeline.now

    @property
    def behind(self) -> int:
        """How many steps of the world before the present the moment is that is shown."""
        return self.look.behind if self.look else 0

    @property
    def kept(self) -> int:
        """How many steps one can go back."""
        return len(self.timeline.past)

    @property
    def shown(self) -> tuple[SessionState, ...]:
        """The moments of the last half minute, one for each step of the world, up to the one shown."""
        return (*islice(self.timeline.past, self.kept - self.behind), self.at(self.behind))

    def at(self, behind: int) -> SessionState:
        """The moment so many steps back."""
        return self.timeline.past[-behind] if behind else self.now

    def go(self, behind: int) -> None:
        """Look at the moment so many steps back."""
        self.look = (self.look or Look()).to(behind, self.kept)

    def tick(self, hands: Hands, wish: Wish) -> bool:
        """One tick of looking back; whether somebody plays on from here."""
        look = self.look or Look()
        rewinding, pushed = hands.holds("rewind"), hands.pushes(len(self.now.players))
        if pushed and look.rested and not rewinding:
            return True
        look = look.step(rewinding, int(hands.holds("scrub_back")) - int(hands.holds("scrub_on")), pushed, self.kept)
        self.look = look.turned(wish, self.at(look.behind))
        return False

    def seen(self, alpha: float) -> tuple[SessionState, float, tuple[Camera, ...]]:
        """The moment to draw, how far it is between its worlds, and from where each player sees it."""
        if self.look is None:
            return self.now, self.now.fraction(alpha), tuple(player.view(alpha) for player in self.now.players)
        behind, fraction = self.look.at(alpha)
        moment = self.at(behind)
        return moment, fraction, self.look.cameras(moment, fraction, alpha)

    def status(self, hands: Hands) -> tuple[str, ...]:
        """How far back one looks, and what leads on from there, in lines."""
        return (f"{self.behind * DT:.1f} s ago, of {self.kept * DT:.0f} s",
                f"{hands.key('scrub_back')} {hands.key('scrub_on')} back and on, "
                f"{hands.key('resume')} or walking plays on from here")
