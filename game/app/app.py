"""The game as a host runs it: events in, seconds in, scenes out. It needs no window.

What is played is a value that only wishes move (see `gambol.game.session.tick`); they are all that
the log keeps (see `gambol.game.app.recordings`). What is only looked at, overlays, panels, help, and where
one is while looking back, is the picture's matter.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ..explain import broken
from ..hosts import Event, KeyEvent, MouseMove, Scroll
from ..input import Wish
from ..session import ACTIONS, comparison, refused, settings
from ..world import DT
from .picture import Game
from .pointing import CLICKED
from .watching import Watching


PAGES = {"DOWN": 1, "PAGE_DOWN": 1, "UP": -1, "PAGE_UP": -1}
"""By how many pages these keys leaf through the help where it has several."""


def _turns(event: Event) -> int:
    """By how many pages an event leafs through the help."""
    match event:
        case KeyEvent(key, True):
            return PAGES.get(key, 0)
        case Scroll(dy=notches) if notches and math.isfinite(notches):
            return -int(math.copysign(1, notches))
    return 0


class Play(Game):
    """The game as an app: `handle` events, `tick` seconds, draw `scene`, until `done`."""

    # --- what happens

    def handle(self, event: Event) -> None:
        """Take one event from the host; those that mean nothing here are ignored."""
        if self.teacher is not None:
            self.teacher.heard(event)
        if self.showing.panels and self.showing.hud is not None and self.showing.hud.handle(event):
            return
        if self.helping:
            self.page += _turns(event)
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
        self._answer(asked, said)

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
            self.helping, self.page = not self.helping, 0
        elif action == "full_screen":
            self.full_screen = not self.full_screen
        elif action == "quit" and not self.helping and self.held_points.holds(self.now):
            self.do("study_hands")
        elif action == "quit":
            self.done, self.helping = not self.helping, False
        elif action.startswith("study_") or action == "study":
            asked, said = self.held_points.asked(action, self.now)
            self._answer(asked, said)
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
        if "=" in action and action.partition("=")[0] not in {*comparison.ACTIONS, "goto", "crowd"}:
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

    def _answer(self, asked: str, said: str) -> None:
        """Do what an action came to, or tell it."""
        if asked:
            self._ask(asked, 0)
        elif said:
            self.kept.say(said)

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
            if self.preparing.jumps:
                self.held_points.ahead()
        if due := self.held_points.learnt():
            self._ask(due, 0) if not due.startswith("!") else self.kept.say(due[1:])
        if self.helping:
            self.held += seconds
            self.hands.ticked()
        else:
            due, self.clock = self.clock.add(seconds)
            number = self.now.number
            for _ in range(due):
                self._tick()
            self.held += (due - (self.now.number - number)) * DT
            if self.teacher is not None and self._taught and not self.now.paused:
                self.teacher.tick(self.now, seconds, self.jumps)
        if self.sending is not None:
            self.sending.send(self.now.after)
        self.kept.save_sometimes(seconds, self.now)

    def _tick(self) -> None:
        asked = self.hands.asked
        if self.past.look is None and not asked and self.past.kept and self.hands.holds("rewind"):
            self.past.go(0)
        if not (asked or self.past.look or self.watching):  # what is pressed may change whose the points are
            for action in (*self.held_points.actions(self.now, self.now.number * DT), *self.pointing.actions(self.now, self._points, self.hands.sends(self.players))):
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
        self.hands.ticked()

    def _advance(self, asked_for: tuple[Wish, ...]) -> None:
        before = self.now
        self.past.timeline.advance(asked_for)
        self.kept.add(asked_for)
        count = len(self.now.players)
        if count > len(before.players) and not self.hands.has_pad(count):
            self.kept.say(f"player {count} waits for a gamepad: plug one in")
        for line in refused(before, self.now, self.previews):
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
        """The wishes without jumps and pushes, which nobody can make or answer yet; whoever asks is told so."""
        asked = any(wish.jump for wish in asked_for)
        if asked and not self.refused:
            self.kept.say("no jump yet: it is being prepared")
        if any("push" in wish.pressed for wish in asked_for):
            self.kept.say("no push yet: how bodies answer it is being prepared")
        self.refused = asked
        return tuple(replace(wish, jump=False, pressed=tuple(action for action in wish.pressed if action != "push")) for wish in asked_for)

    def _resume(self) -> None:
        """Play on from the moment that is shown; what came after it is forgotten."""
        behind, self.past.look = self.past.behind, None
        if behind:
            self.watching = None
            self._wish(Wish(pressed=(f"back={behind}",)))
        elif self.now.paused:
            self._wish(Wish(pressed=("pause",)))

    # --- what is kept

    def take(self, pixels: np.ndarray) -> None:
        """Keep the picture (H, W, 3 or 4) that was asked for by `wants_picture`."""
        self.wants_picture = False
        self.kept.picture(pixels)

    def close(self) -> None:
        """Write the rest of the log; a film that was begun ends here."""
        self.kept.close(self.now, self.showing.names)
        self.showing.close()
        self.held_points.close()
        if self.sending is not None:
            self.sending.close()
