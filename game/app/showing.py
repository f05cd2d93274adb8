"""What is shown beside the world and changes nothing in it: overlays, panels, and the words in the corner."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from ..explain import rows
from ..input import jumping
from ..scene import OVERLAYS, PANELS, Overlays, Scene
from ..session import SessionState
from ..world import Filmed

if TYPE_CHECKING:  # ImGui is loaded for those only who open a panel
    from ..hud import Hud

SHOWS = {"show_jump" if name == "jump" else name: name for name in OVERLAYS}
"""What shows an overlay and takes it away again: called as it is, but for the jump, which is jumped by its name."""
SHOWN_SPEED = 0.03
"""Below this speed [m/s] or [rad/s] a character is said to stand."""


class Showing:
    """Which overlays are drawn and which panels are open. hud: the panels, once one was opened. undrawn: [s] since they were
    drawn."""

    def __init__(self):
        self.overlays, self.panels = Overlays(path=True, jump=True, points=True, errors=True, cameras=True), frozenset()
        self.hud: Hud | None = None
        self.undrawn = 0.0

    @property
    def names(self) -> list[str]:
        """The overlays that are drawn."""
        return [name for name in OVERLAYS if getattr(self.overlays, name)]

    def toggled(self, action: str) -> bool:
        """Show or hide what an action is about; whether it is about anything here."""
        panel = action.removesuffix("_panel")
        if action in SHOWS:
            self.overlays = replace(self.overlays, **{SHOWS[action]: not getattr(self.overlays, SHOWS[action])})
        elif action == "panels":
            self.panels = frozenset() if self.panels else frozenset(PANELS)
        elif panel in PANELS and panel != action:
            self.panels ^= {panel}
        else:
            return False
        return True

    def tick(self, seconds: float) -> None:
        """So many seconds have passed."""
        self.undrawn = self.undrawn + seconds if self.panels else 0.0

    def panelled(self, view: Scene, history: tuple[SessionState, ...], now: SessionState, behind: int, past: int,
                 size: tuple[int, int], notices: tuple[str, ...]) -> tuple[Scene, tuple[str, ...], int]:
        """The first player's view under the open panels; what their buttons and sliders ask for, and for which player.

        history: the moments up to the one shown, `behind` steps before `now`, of `past` that are kept.
        """
        if self.hud is None:
            from ..hud import Hud

            self.hud = Hud()
        seconds, self.undrawn = self.undrawn, 0.0
        moment = history[-1]
        told = rows(moment.after) if self.overlays.errors else ()
        ink, actions = self.hud.frame(self.panels, history, now, behind, past, size, seconds, told)
        # the strip tells of looking back, pause and slow motion; there is room for one line more above the panels
        small = (f"no room here for {', '.join(self.hud.left_out)}",) if self.hud.left_out else ()
        text = (view.text[0], *(small + notices)[-1:]) if view.text else ()
        figures = view.figures + self.hud.ghosts(view.figures, moment)
        hint = None if view.hint is None else replace(view.hint, room=self.hud.beside)
        return replace(view, ink=ink, text=text, figures=figures, hint=hint, taken=self.hud.taken), tuple(actions), self.hud.who

    def close(self) -> None:
        """No panel is opened any more."""
        if self.hud is not None:
            self.hud.release()
            self.hud = None


def moving(moment: SessionState, who: int) -> str:
    """What a player is at, in words."""
    one = moment.after.characters[who]
    if jumping(one.state) is not None:
        return "jumping"
    if isinstance(one.controller, Filmed) and one.controller.status(one.state).kind == "done":
        return "the film is over"
    v_f, omega, v_l = moment.after.characters[who].state.velocity
    if math.hypot(v_f, v_l) < SHOWN_SPEED and abs(omega) < SHOWN_SPEED:
        words = "standing"
    else:
        words = f"{math.hypot(v_f, v_l):.1f} m/s" + (f"   turning {omega:+.1f} rad/s" if abs(omega) > 0.2 else "")
    return words + ("   facing held" if moment.players[who].pilot.facing is not None else "")
