"""The game as a host runs it: events in, seconds in, scenes out. It needs no window.

What is played is a value that only wishes move (see `gambol.game.session.tick`); they are all that
the log keeps (see `gambol.game.app.recordings`). Here is what is only looked at: overlays, panels, help, and where
one is while looking back.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from ..explain import broken, on_the_way, rows, with_cameras
from ..hosts import Event, KeyEvent, MouseMove, Scroll
from ..input import DEFAULT, Bindings, Wish, help_sheet
from ..scene import Scene
from ..session import ACTIONS, Log, LogWriter, SessionState, begin, comparison, opening, refused, settings
from ..world import DT, FixedStep, Methods, World
from .capture import Capture
from .hands import Hands
from .past import History
from .pointing import CLICKED, Pointing
from .held_points import HeldPoints
from .hints import Teacher
from .preparing import Preparing
from .recordings import Recordings
from .showing import Showing, moving
from .views import Previews, previews, scenes
from .watching import Watching

class Play:
    """The game as an app: `handle` events, `tick` seconds, draw `scene`, until `done`.

    moment: the one that is shown, present or past; past: all that are kept. hands: what players hold and press. showing:
    overlays and panels.
    kept: what is kept of it all. watching: a log, until somebody walks. clock, held: the time that was dropped, and spent
    in help, past or halt [s]. held_points: what pointer and stream do with the points of a comparison. preparing: what
    is compiled meanwhile; None where everything is. teacher: who shows hints; None shows none.
    """

    def __init__(self, controller: Any, players: int = 1, world: World | None = None, bindings: Bindings = DEFAULT,
                 log: LogWriter | None = None, capture: Capture | None = None, tape: Log | None = None,
                 learnt: Methods | None = None, stream: Any = None, preparing: Preparing | None = None,
                 teacher: Teacher | None = None):
        self.past = History(opening(controller, players, learnt) if world is None else begin(world, players, learnt))
        self.hands, self.showing, self.kept = Hands(bindings), Showing(), Recordings(log, capture)
        self.watching = None if tape is None else Watching(tape)
        self.held_points, self.pointing = HeldPoints(self.now.methods, stream), Pointing()
        self.preparing, self.teacher, self.refused = preparing, teacher, False
        self.done = self.helping = self.full_screen = self.wants_picture = False
        self.clock, self.held = FixedStep(), 0.0
        self.previews: Previews = ()  # the jumps that are aimed at, as they were drawn last

    # --- what is shown

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

    # --- what happens

    def handle(self, event: Event) -> None:
        """Take one event from the host; those that mean nothing here are ignored."""
        if self.teacher is not None:
            self.teacher.heard(event)
        if self.showing.panels and self.showing.hud is not None and self.showing.hud.handle(event):
            return
        rewound = self.past.look is not None
        if not (rewound or self.watching or self.helping) and self._reached(event):
            return
        heard = self.hands.hear(event, self.players, rewound, self.mouse_captured)
        if heard.wish is not None:
            self._wish(heard.wish)
        for action in heard.pressed:
            self.do(action, self.hands.player(heard.slot, self.players))

    def open(self, wanted: comparison.Comparison) -> None:
        """Open a comparison; what it needs is learnt first, if it was not yet."""
        asked, said = self.held_points.open(wanted)
        self._ask(asked, 0) if asked else self.kept.say(said)

    def _reached(self, event: Event) -> bool:
        """Take an event that is about a point under the pointer; whether it was."""
        match event:
            case MouseMove(x, y, dx, dy):
                self.pointing.move(x, y)
                return self.held_points.move(x, y, dx, dy, self.hands.keyboard.held("run", self.hands.bindings))
            case Scroll(dy=notches):
                return self.pointing.scroll(notches) or self.held_points.scroll(notches)
            case KeyEvent(key, pressed):
                if key == CLICKED and not self.held_points.holds(self.now):
                    self.pointing.button(pressed)
                return self.hands.grabs(key) and (self.held_points.grab(self.now) if pressed else self.held_points.let_go())
        return False

    def do(self, action: str, player: int = 0) -> None:
        """Do what pressing the key or button of an action does, or set "name=value"."""
        if self.showing.toggled(action):
            pass
        elif action.startswith("look="):
            self.past.go(int(action.removeprefix("look=")))
        elif action == "help":
            self.helping = not self.helping
        elif action == "full_screen":
            self.full_screen = not self.full_screen
        elif action == "quit" and not self.helping and self.held_points.holds(self.now):
            self.do("study_hands")
        elif action == "quit":
            self.done, self.helping = not self.helping, False
        elif action.startswith("study_") or action == "study":
            asked, said = self.held_points.asked(action, self.now)
            self._ask(asked, 0) if asked else self.kept.say(said)
        elif action == "screenshot":
            self.wants_picture = True
        elif action == "film":
            self.kept.film(self.now, self.showing.names)
        elif action == "export":
            self.kept.motion(self.past.shown)
        elif action in ACTIONS or "=" in action or action == "resume":
            self._ask(action, player)

    def _ask(self, action: str, player: int) -> None:
        """Something that the next tick is to do, unless one looks back or watches."""
        if "=" in action and action.partition("=")[0] not in {*comparison.ACTIONS, "goto"}:
            try:
                settings.read(action)
            except settings.SettingError as error:
                return self.kept.say(str(error))
        if self.past.look is not None:
            self._ask_past(action, player)
        elif self.watching is not None and action in ("pause", "resume"):
            self.watching.halted = not self.watching.halted
        elif self.watching is not None:
            self.kept.say("this is a log: walk to play on from here")
        elif action != "resume":
            self._wish(Wish(pressed=(action,)), player)

    def _ask_past(self, action: str, player: int) -> None:
        if action == "step":
            self.past.go(self.past.behind - 1)
        elif action in ("resume", "pause", "reset"):
            self._resume()
            if action != "resume":
                self._wish(Wish(pressed=(action,)), player)
        else:
            self.kept.say(f"this is the past: {self.hands.key('resume')} plays on from here")

    def _wish(self, wish: Wish, player: int = 0) -> None:
        """Add to what the next tick is asked for, unless the help holds everything."""
        if not self.helping:
            self.hands.ask(wish, player)

    def tick(self, seconds: float) -> None:
        """Let `seconds` of real time pass, in whole ticks."""
        seconds = seconds if 0.0 <= seconds < math.inf else 0.0
        self.showing.tick(seconds)
        self.kept.tend(seconds)
        if self.preparing is not None:
            self.preparing.tend(self.now.after.characters[0].controller)
        if due := self.held_points.learnt():
            self._ask(due, 0) if not due.startswith("!") else self.kept.say(due[1:])
        if self.helping:
            self.held += seconds
        else:
            due, self.clock = self.clock.add(seconds)
            number = self.now.number
            for _ in range(due):
                self._tick()
            self.held += (due - (self.now.number - number)) * DT
            if self.teacher is not None and self._taught and not self.now.paused:
                self.teacher.tick(self.now, seconds)
        self.kept.save_sometimes(seconds, self.now)

    def _tick(self) -> None:
        asked = self.hands.asked
        if self.past.look is None and not asked and self.past.kept and self.hands.holds("rewind"):
            self.past.go(0)
        if not (asked or self.past.look or self.watching):  # what is pressed may change whose the points are
            for action in (*self.held_points.actions(self.now, self.now.number * DT), *self.pointing.actions(self.now, self._points, self.hands.keyboard.held("go_to", self.hands.bindings))):
                self._wish(Wish(pressed=(action,)))
        asked_for = self.hands.wishes(self.players)
        asked_for = asked_for if self.jumps else self._grounded(asked_for)
        if self.past.look is not None:
            if self.past.tick(self.hands, asked_for[0]):
                self._resume()
        elif self.watching is None:
            self._advance(asked_for)
        elif self.hands.pushes(self.players):
            self._take_over("you play on from here")
        elif not self.watching.halted and self.jumps:  # a log may jump at once
            self._play_back(self.watching)

    def _advance(self, asked_for: tuple[Wish, ...]) -> None:
        before = self.now
        self.past.timeline.advance(asked_for)
        self.kept.add(asked_for)
        count = len(self.now.players)
        if count > len(before.players) and not self.hands.has_pad(count):
            self.kept.say(f"player {count} waits for a gamepad: plug one in")
        for line in refused(before, self.now):
            for part in broken(line):
                self.kept.say(part)

    def _play_back(self, watching: Watching) -> None:
        """One tick of a log that is watched."""
        if watching.over(self.now):
            return self._take_over("the log ends here; you play on")
        try:
            self._advance(watching.tape.ticks[self.now.number])
        except ValueError as error:
            return self._take_over(f"the log can't be played further: {error}")
        if watching.strays(self.now):
            self.kept.say("from here on it is not what was played: another version of Gambol walks another way")

    def _take_over(self, why: str) -> None:
        self.watching = None
        self.kept.say(why)

    def _grounded(self, asked_for: tuple[Wish, ...]) -> tuple[Wish, ...]:
        """The wishes without jumps, which nobody can make yet; whoever asks is told so."""
        asked = any(wish.jump for wish in asked_for)
        if asked and not self.refused:
            self.kept.say("no jump yet: it is being prepared")
        self.refused = asked
        return tuple(replace(wish, jump=False) for wish in asked_for)

    def _resume(self) -> None:
        """Play on from the moment that is shown; what came after it is forgotten."""
        behind, self.past.look = self.past.behind, None
        if behind:
            self.watching = None
            self._wish(Wish(pressed=(f"back={behind}",)))
        elif self.now.paused:
            self._wish(Wish(pressed=("pause",)))

    # --- the picture

    def take(self, pixels: np.ndarray) -> None:
        """Keep the picture (H, W, 3 or 4) that was asked for by `wants_picture`."""
        self.wants_picture = False
        self.kept.picture(pixels)

    def close(self) -> None:
        """Write the rest of the log; a film that was begun ends here."""
        self.kept.close(self.now, self.showing.names)
        self.showing.close()
        self.held_points.close()

    def scene(self, size: tuple[int, int]) -> Scene | tuple[Scene, ...]:
        """What to draw now, one scene for each player; size: of the frame in pixels."""
        halted = self.watching is not None and self.watching.halted
        moment, fraction, cameras = self.past.seen(1.0 if halted and self.past.look is None else self.clock.alpha)
        self.previews = previews(moment, self.previews)
        views = scenes(moment, fraction, cameras, self.showing.overlays, self._texts(moment), self.previews)
        for one in (self.held_points, self.pointing):
            one.look(cameras[0], size[0] / (len(views) * size[1]))
        views = (replace(views[0], figures=self.held_points.marked(views[0].figures, moment)), *views[1:])
        if self.helping:
            sheet = help_sheet(self.hands.bindings, self.hands.keyboard, self.hands.pads, self.players)
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
            views = (replace(views[0], ink=self.held_points.legend(lines, size, moment.comparison)), *views[1:])
        if self.showing.overlays.cameras and not self.helping:
            views = (replace(views[0], ink=with_cameras(views[0].ink, moment.after, size)), *views[1:])
        return views[0] if len(views) == 1 else views

    @property
    def _points(self) -> bool:
        """Whether the first player can be sent to the pointer; a captured mouse points nowhere."""
        return self.jumps and not (self.mouse_captured or self.now.paused)

    @property
    def _taught(self) -> bool:
        """Whether somebody plays whom hints could help: nobody looks back or watches."""
        return self.past.look is None and self.watching is None

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
        if self.preparing is not None:
            lines += self.preparing.said
        told = (*lines, *self.held_points.status(moment, self.hands.key), *self.kept.status(self.now), *self.kept.notices, f"{self.hands.key('help')} help")
        return ((*own[0], *told), *own[1:])
