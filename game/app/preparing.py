"""What is compiled beside a game that was never compiled here: walking, then jumping.

Other programs compile it (`gambol.controllers.person.preparing`); the game only loads it. A jump that
is asked for before that is no wish yet: no log has it, so that a replay need not wait.
"""

from __future__ import annotations

import subprocess
import threading
from typing import Any

from gambol.controllers.jump import rehearse
from gambol.controllers.person import preparing

from ..world import jump_of


class Preparing:
    """What a person needs and was never compiled here, in the making.

    walker: whose steps. programs: those that compile it, as `gambol.controllers.person.preparing.begun` gives them.
    """

    def __init__(self, walker: Any, programs: tuple[subprocess.Popen, ...] = ()):
        self.walker, self.programs = walker, programs
        self.loading: threading.Thread | None = None

    @property
    def walks(self) -> bool:
        """Whether a game can begin. What a program has failed to make is made where it is first needed."""
        return self._over("walk")

    @property
    def jumps(self) -> bool:
        """Whether somebody may jump, or be sent to a goal, without halting the game."""
        return self.loading is not None and not self.loading.is_alive()

    @property
    def said(self) -> tuple[str, ...]:
        """What is waited for, in a line; none where it takes no time worth the words."""
        if not self.programs or self.jumps:
            return ()
        return f"Preparing {'jumps' if self.walks else 'to walk, for the first time here'} … {100 * preparing.share():.0f} %",

    def tend(self, controller: Any) -> None:
        """Load the jump beside the game once it is compiled. controller: who jumps, if it can."""
        if self.loading is None and self._over("jump"):
            self.loading = threading.Thread(target=_load, args=(jump_of(controller), self.walker), daemon=True)
            self.loading.start()

    def close(self) -> None:
        """Give up what is not ready; what was compiled so far is kept."""
        for program in self.programs:
            program.terminate()
            program.wait()
        if self.loading is not None:
            self.loading.join(2.0)

    def _over(self, part: str) -> bool:
        return not self.programs or preparing.ready(part, self.walker) or self.programs[0].poll() is not None


def _load(jump: Any, walker: Any) -> None:
    if walker is not None:
        preparing.things(walker)
    if jump is not None:
        rehearse(jump)
    preparing.goals()
