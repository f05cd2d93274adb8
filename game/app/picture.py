"""A game and its picture: all that there is to it, and what is drawn of it."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any

from ..explain import broken, on_the_way, rows, with_cameras
from ..input import DEFAULT, Bindings, help_sheet
from ..scene import Scene
from ..session import Log, LogWriter, SessionState, begin, opening, unpenalised
from ..world import Filmed, FixedStep, Methods, Recorded, World
from .capture import Capture
from .hands import Hands
from .held_points import HeldPoints
from .hints import Teacher
from .past import History
from .pointing import Pointing
from .preparing import Preparing
from .recordings import Recordings
from .sending import Sending
from .showing import Showing, moving
from .views import Previews, previews, scenes
from .watching import Watching


class Game:
    """What is played, what is kept of it, and how it looks.

    moment: the one that is shown, present or past; past: all that are kept. hands: what players hold and press. showing:
    overlays and panels.
    kept: what is kept of it all. watching: a log, until somebody walks. clock, held: the time that was dropped, and spent
    in help, past or halt [s]. held_points: what pointer and stream do with the points of a comparison. preparing: what
    is compiled meanwhile; None where everything is. teacher: who shows hints; None shows none. sending: who hears of every
    frame; None where nobody does.
    """

    def __init__(self, controller: Any, players: int = 1, world: World | None = None, bindings: Bindings = DEFAULT,
                 log: LogWriter | None = None, capture: Capture | None = None, tape: Log | None = None,
                 learnt: Methods | None = None, stream: Any = None, preparing: Preparing | None = None,
                 teacher: Teacher | None = None, sending: Sending | None = None):
        self.past = History(opening(controller, players, learnt) if world is None else begin(world, players, learnt))
        self.hands, self.showing, self.kept = Hands(bindings), Showing(), Recordings(log, capture)
        self.watching = None if tape is None else Watching(tape)
        self.held_points, self.pointing = HeldPoints(self.now.methods, stream), Pointing()
        self.preparing, self.teacher, self.sending, self.refused = preparing, teacher, sending, False
        self.done = self.helping = self.full_screen = self.wants_picture = False
        self.page = 0  # of the help
        self.clock, self.held = FixedStep(), 0.0
        self.crew = ThreadPoolExecutor(1, "preview")  # no frame waits for what is found out about jumps
        self.previews: Previews = ()  # the jumps that are aimed at, as they were drawn last

    @property
    def now(self) -> SessionState:
        """The present moment."""
        return self.past.now

    @property
    def moment(self) -> SessionState:
        """The moment that is shown."""
        return self.past.at(self.past.behind)

    @property
    def jumps(self) -> bool:
        """Whether a jump would not halt the game."""
        return self.preparing is None or self.preparing.jumps

    @property
    def players(self) -> int:
        """How many play."""
        return len(self.now.players)

    @property
    def mouse_captured(self) -> bool:
        """Whether the mouse steers a flying camera, and nothing needs a pointer."""
        return self.now.players[0].camera.flown and not (self.past.look or self.helping or self.showing.panels)

    def do(self, action: str, player: int = 0) -> None:
        """Do what a button of a panel is about; whoever plays says what that is."""
        raise NotImplementedError

    def scene(self, size: tuple[int, int]) -> Scene | tuple[Scene, ...]:
        """What to draw now, one scene for each player; size: of the frame in pixels."""
        halted = self.watching is not None and self.watching.halted
        moment, fraction, cameras = self.past.seen(1.0 if halted and self.past.look is None else self.clock.alpha)
        self.previews = previews(moment, self.previews, self.crew)
        views = scenes(moment, fraction, cameras, self.showing.overlays, self._texts(moment), self.previews)
        for one in (self.held_points, self.pointing):
            one.look(cameras[0], size[0] / (len(views) * size[1]))
        views = (replace(views[0], figures=self.held_points.marked(views[0].figures, moment)), *views[1:])
        if self.helping:
            sheet = replace(help_sheet(self.hands.bindings, self.hands.keyboard, self.hands.pads, self.players), page=self.page)
            views = tuple(replace(view, text=()) for view in views)
            views = (replace(views[0], sheet=sheet), *views[1:])
        elif self.wants_picture:  # nothing is written on a screenshot
            views = tuple(replace(view, text=()) for view in views)
        elif self.teacher is not None and self._taught:
            views = (replace(views[0], hint=self.teacher.hint()), *views[1:])
        if self.showing.panels and not self.helping:
            first, actions, who = self.showing.panelled(
                views[0], self.past.shown, self.now, self.past.behind, self.past.kept, size, self.kept.notices)
            for action in actions:
                self.do(action, who)
            views = (first, *views[1:])
        elif self.showing.overlays.errors and not self.helping and (lines := rows(moment.after)):
            # in the part of whom it is about
            legend = self.held_points.legend(lines, (round(views[0].part[2] * size[0]), size[1]), moment.comparison)
            views = (replace(views[0], ink=replace(legend, size=size), taken=legend.corner()), *views[1:])
        if self.showing.overlays.cameras and not self.helping:
            views = (replace(views[0], ink=with_cameras(views[0].ink, moment.after, size)), *views[1:])
        return views[0] if len(views) == 1 else views

    @property
    def _points(self) -> bool:
        """Whether the first player can be sent to the pointer; a captured mouse points nowhere."""
        return self.jumps and not (self.mouse_captured or self.now.paused)

    @property
    def _taught(self) -> bool:
        """Whether somebody plays whom hints could help: nobody looks back, or watches a log, a recording or somebody in footage."""
        return self.past.look is None and self.watching is None and not isinstance(self.now.after.characters[0].controller, (Filmed, Recorded))

    def _texts(self, moment: SessionState) -> tuple[tuple[str, ...], ...]:
        """The lines in each player's corner; what concerns all stands in the first one's."""
        own = [(moving(moment, who), *(part for line in on_the_way(moment.after.characters[who].state) for part in broken(line)))
               for who in range(len(moment.players))]
        lines = []
        if self.past.look is not None:
            lines += self.past.status(self.hands)
        elif self.watching is not None:
            lines.append(self.watching.status(self.now, self.hands))
        elif moment.paused:
            lines.append(f"paused: {self.hands.key('pause')} goes on, {self.hands.key('step')} makes one step")
        if moment.slow > 1:
            lines.append(f"slow motion 1/{moment.slow}")
        if unpenalised(moment.after):
            lines.append(f"tracked without the penalty on jitter: {self.hands.key('penalty')} brings it back")
        if self.preparing is not None:
            lines += self.preparing.said
        told = (*lines, *self.held_points.status(moment, self.hands.key), *self.kept.status(self.now), *self.kept.notices)
        what, *where = own[0]
        return ((what, f"{self.hands.key('help')} help", *where, *told), *own[1:])  # what comes and goes moves neither of the first two
