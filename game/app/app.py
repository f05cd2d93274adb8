"""The game as a host runs it: events in, seconds in, scenes out. It needs no window.

What is played is a value that only wishes move (see `gambol.game.session.tick`); they are all that
the log keeps (see `gambol.game.app.recordings`). Here is what is only looked at: overlays, panels, help, and where
one is while looking back.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import islice
from typing import Any

import numpy as np

from ..explain import broken, rows
from ..hosts import PADS, Event, KeyEvent, MouseMove, PadState, Scroll
from ..input import (DEFAULT, HOLDING, Bindings, Keyboard, Wish, drivers, help_sheet, jumping, key_label, mode_of,
                     mouse_wish, pad_held, pad_pressed, player_of, wheel_wish, wishes)
from ..scene import OVERLAYS, PANELS, Camera, Overlays, Scene
from ..session import (ACTIONS, Log, LogWriter, Look, SessionState, Timeline, begin, comparison, opening, refused,
                       settings, strayed)
from ..world import DT, FixedStep, Methods, World
from .capture import Capture
from .held_points import HeldPoints
from .hints import Teacher
from .preparing import Preparing
from .recordings import Recordings
from .views import Previews, previews, scenes

SHOWS = {"show_jump" if name == "jump" else name: name for name in OVERLAYS}
"""What shows an overlay and takes it away again: called as it is, but for the jump, which is jumped by its name."""
SHOWN_SPEED = 0.03
"""Below this speed [m/s] or [rad/s] a character is said to stand."""
PUSHED = 0.3
"""How far a stick must be pushed to play on from a past moment."""


class Play:
    """The game as an app: `handle` events, `tick` seconds, draw `scene`, until `done`.

    moment: the one that is shown, present or past; history: the last half minute up to it.
    look: how one looks back; None while one plays. panels: what is shown of `PANELS`. kept: what
    is kept of it all. tape: a log that is watched, until somebody walks. clock, held: the time that was
    dropped, and spent in help, past or halt [s]. held_points: what pointer and stream do with the points of a comparison.
    preparing: what is compiled meanwhile; None where everything is.
    teacher: who shows hints; None shows none.
    """

    def __init__(self, controller: Any, players: int = 1, world: World | None = None, bindings: Bindings = DEFAULT,
                 log: LogWriter | None = None, capture: Capture | None = None, tape: Log | None = None,
                 learnt: Methods | None = None, stream: Any = None, preparing: Preparing | None = None,
                 teacher: Teacher | None = None):
        self.timeline = Timeline(opening(controller, players, learnt) if world is None else
                                 begin(world, players, learnt))
        self.bindings, self.kept, self.tape, self.teacher = bindings, Recordings(log, capture), tape, teacher
        self.overlays, self.panels = Overlays(path=True, jump=True, points=True, errors=True), frozenset()
        self.held_points = HeldPoints(self.now.methods, stream)
        self.preparing, self.refused = preparing, False
        self.done = self.helping = self.full_screen = self.wants_picture = self.halted = self.strayed = False
        self.keyboard, self.pads = Keyboard(), [None] * PADS
        self.pending: dict[int, Wish] = {}
        self.clock, self.held = FixedStep(), 0.0
        self.hud: Any = None
        self.undrawn = 0.0  # seconds since panels were drawn
        self.look: Look | None = None
        self.previews: Previews = ()  # the jumps that are aimed at, as they were drawn last

    # --- what is shown

    @property
    def now(self) -> SessionState:
        """The present moment."""
        return self.timeline.now

    @property
    def moment(self) -> SessionState:
        """The moment that is shown."""
        return self._back(self.look.behind if self.look else 0)

    @property
    def history(self) -> tuple[SessionState, ...]:
        """The moments of the last half minute, one for each step of the world, up to the one shown."""
        past, behind = self.timeline.past, self.look.behind if self.look else 0
        return (*islice(past, len(past) - behind), self._back(behind))

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
        return self.now.players[0].camera.flown and not (self.look or self.helping or self.panels)

    def _back(self, steps: int) -> SessionState:
        return self.timeline.past[-steps] if steps else self.now

    # --- what happens

    def handle(self, event: Event) -> None:
        """Take one event from the host; those that mean nothing here are ignored."""
        if self.teacher is not None:
            self.teacher.heard(event)
        if self.panels and self.hud is not None and self.hud.handle(event):
            return
        rewound = self.look is not None
        if not (rewound or self.tape or self.helping) and self._reached(event):
            return
        match event:
            case KeyEvent(key, True):
                self.keyboard = self.keyboard.press(key)
                if any(row.action == "jump" for row in self.bindings.rows_of(key)):
                    self._wish(Wish(jump=True))  # a tap may be over before the next tick looks
                for action in self.bindings.pressed_by(key, mode=mode_of(None, self.pads, self.players, rewound)):
                    self.do(action)
            case KeyEvent(key, False):
                self.keyboard = self.keyboard.release(key)
            case MouseMove(dx=dx, dy=dy):
                self._wish(mouse_wish(dx, dy, self.keyboard, self.bindings, self.mouse_captured))
            case Scroll(dy=notches):
                self._wish(wheel_wish(notches))
            case PadState(slot=slot) if 0 <= slot < PADS:
                pad, before = event if event.name else None, self.pads[slot]
                self.pads[slot] = pad
                mode = mode_of(slot, self.pads, self.players, rewound)
                for action in pad_pressed(before, pad, self.bindings, mode):
                    self.do(action, player_of(slot, self.pads, self.players))

    def open(self, wanted: comparison.Comparison) -> None:
        """Open a comparison; what it needs is learnt first, if it was not yet."""
        asked, said = self.held_points.open(wanted)
        self._ask(asked, 0) if asked else self.kept.say(said)

    def _reached(self, event: Event) -> bool:
        """Take an event that is about a point under the pointer; whether it was."""
        match event:
            case MouseMove(x, y, dx, dy):
                return self.held_points.move(x, y, dx, dy, self.keyboard.held("run", self.bindings))
            case Scroll(dy=notches):
                return self.held_points.scroll(notches)
            case KeyEvent(key, pressed) if any(row.action == "study_grab" for row in self.bindings.rows_of(key, mode=HOLDING)):
                return self.held_points.grab(self.now) if pressed else self.held_points.let_go()
        return False

    def do(self, action: str, player: int = 0) -> None:
        """Do what pressing the key or button of an action does, or set "name=value"."""
        if action in SHOWS:
            shown = SHOWS[action]
            self.overlays = replace(self.overlays, **{shown: not getattr(self.overlays, shown)})
        elif action == "panels":
            self.panels = frozenset() if self.panels else frozenset(PANELS)
        elif action.removesuffix("_panel") in PANELS and action.endswith("_panel"):
            self.panels ^= {action.removesuffix("_panel")}
        elif action.startswith("look="):
            behind = int(action.removeprefix("look="))
            self.look = (self.look or Look()).to(behind, len(self.timeline.past))
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
            self.kept.film(self.now, self._overlays())
        elif action == "export":
            self.kept.motion(self.history)
        elif action in ACTIONS or "=" in action or action == "resume":
            self._ask(action, player)

    def _ask(self, action: str, player: int) -> None:
        """Something that the next tick is to do, unless one looks back or watches."""
        if "=" in action and action.partition("=")[0] not in comparison.ACTIONS:
            try:
                settings.read(action)
            except settings.SettingError as error:
                return self.kept.say(str(error))
        if self.look is not None:
            self._ask_past(self.look, action, player)
        elif self.tape is not None and action in ("pause", "resume"):
            self.halted = not self.halted
        elif self.tape is not None:
            self.kept.say("this is a log: walk to play on from here")
        elif action != "resume":
            self._wish(Wish(pressed=(action,)), player)

    def _ask_past(self, look: Look, action: str, player: int) -> None:
        if action == "step":
            self.look = look.to(look.behind - 1, len(self.timeline.past))
        elif action in ("resume", "pause", "reset"):
            self._resume(look)
            if action != "resume":
                self._wish(Wish(pressed=(action,)), player)
        else:
            self.kept.say(f"this is the past: {self._key('resume')} plays on from here")

    def _wish(self, wish: Wish, player: int = 0) -> None:
        """Add to what the next tick is asked for, unless the help holds everything."""
        if not self.helping:
            self.pending[player] = self.pending.get(player, Wish()).merged(wish)

    def tick(self, seconds: float) -> None:
        """Let `seconds` of real time pass, in whole ticks."""
        seconds = seconds if 0.0 <= seconds < math.inf else 0.0
        self.undrawn = self.undrawn + seconds if self.panels else 0.0
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
        asked = any(wish.pressed for wish in self.pending.values())
        if self.look is None and not asked and self.timeline.past and self._holds("rewind"):
            self.look = Look()
        if not (asked or self.look or self.tape):  # what is pressed may change whose the points are
            for action in self.held_points.actions(self.now, self.now.number * DT):
                self._wish(Wish(pressed=(action,)))
        asked_for = self._wishes()
        if self.look is not None:
            self._look(self.look, asked_for[0])
        elif self.tape is None:
            self._advance(asked_for)
        elif self._pushed():
            self._take_over("you play on from here")
        elif not self.halted and self.jumps:  # a log may jump at once
            self._play_back(self.tape)

    def _advance(self, asked_for: tuple[Wish, ...]) -> None:
        before = self.now
        self.timeline.advance(asked_for)
        self.kept.add(asked_for)
        count = len(self.now.players)
        if count > len(before.players) and not drivers(self.pads, count)[-1]:
            self.kept.say(f"player {count} waits for a gamepad: plug one in")
        for line in refused(before, self.now):
            for part in broken(line):
                self.kept.say(part)

    def _play_back(self, tape: Log) -> None:
        """One tick of a log that is watched."""
        if self.now.number == len(tape.ticks):
            return self._take_over("the log ends here; you play on")
        try:
            self._advance(tape.ticks[self.now.number])
        except ValueError as error:
            return self._take_over(f"the log can't be played further: {error}")
        if strayed(tape, self.now) and not self.strayed:
            self.strayed = True
            self.kept.say("from here on it is not what was played: another version of Gambol walks another way")

    def _take_over(self, why: str) -> None:
        self.tape, self.halted = None, False
        self.kept.say(why)

    def _wishes(self) -> tuple[Wish, ...]:
        """What every player asks for in this tick; what was pressed is asked for once."""
        held = wishes(self.keyboard, self.pads, self.players, self.bindings)
        asked_for = tuple(wish.merged(self.pending.get(who, Wish())).rounded() for who, wish in enumerate(held))
        self.pending.clear()
        return asked_for if self.jumps else self._grounded(asked_for)

    def _grounded(self, asked_for: tuple[Wish, ...]) -> tuple[Wish, ...]:
        """The wishes without jumps, which nobody can make yet; whoever asks is told so."""
        asked = any(wish.jump for wish in asked_for)
        if asked and not self.refused:
            self.kept.say("no jump yet: it is being prepared")
        self.refused = asked
        return tuple(replace(wish, jump=False) for wish in asked_for)

    # --- looking back

    def _holds(self, action: str) -> bool:
        return self.keyboard.held(action, self.bindings) or any(
            pad_held(pad, action, self.bindings) for pad in self.pads)

    def _pushed(self) -> bool:
        """Whether anybody asks to move, by other keys than those that scrub."""
        scrubs = {key for action in ("scrub_back", "scrub_on") for key in self.bindings.row(action).keys}
        return any(math.hypot(*wish.move) > PUSHED for wish in wishes(
            Keyboard(self.keyboard.down - scrubs), self.pads, self.players, self.bindings))

    def _look(self, look: Look, wish: Wish) -> None:
        """One tick of looking back."""
        rewinding, pushed = self._holds("rewind"), self._pushed()
        if pushed and look.rested and not rewinding:
            return self._resume(look)
        look = look.step(rewinding, int(self._holds("scrub_back")) - int(self._holds("scrub_on")), pushed,
                         len(self.timeline.past))
        self.look = look.turned(wish, self._back(look.behind))

    def _resume(self, look: Look) -> None:
        """Play on from the moment that is shown; what came after it is forgotten."""
        self.look = None
        if look.behind:
            self.tape, self.halted = None, False
            self._wish(Wish(pressed=(f"back={look.behind}",)))
        elif self.now.paused:
            self._wish(Wish(pressed=("pause",)))

    # --- the picture

    def take(self, pixels: np.ndarray) -> None:
        """Keep the picture (H, W, 3 or 4) that was asked for by `wants_picture`."""
        self.wants_picture = False
        self.kept.picture(pixels)

    def close(self) -> None:
        """Write the rest of the log; a film that was begun ends here."""
        self.kept.close(self.now, self._overlays())
        if self.hud is not None:
            self.hud.release()
            self.hud = None
        self.held_points.close()

    def _overlays(self) -> list[str]:
        return [name for name in OVERLAYS if getattr(self.overlays, name)]

    def scene(self, size: tuple[int, int]) -> Scene | tuple[Scene, ...]:
        """What to draw now, one scene for each player; size: of the frame in pixels."""
        moment, fraction, cameras = self._shown(self.clock.alpha)
        self.previews = previews(moment, self.previews)
        views = scenes(moment, fraction, cameras, self.overlays, self._texts(moment), self.previews)
        self.held_points.look(cameras[0], size[0] / (len(views) * size[1]))
        views = (replace(views[0], figures=self.held_points.marked(views[0].figures, moment)), *views[1:])
        if self.helping:
            sheet = help_sheet(self.bindings, self.keyboard, self.pads, self.players)
            views = tuple(replace(view, text=()) for view in views)
            views = (replace(views[0], sheet=sheet), *views[1:])
        elif self.wants_picture:  # nothing is written on a screenshot
            views = tuple(replace(view, text=()) for view in views)
        elif self.teacher is not None and self._taught:
            views = (replace(views[0], hint=self.teacher.hint()), *views[1:])
        if self.panels and not self.helping:
            views = (self._with_panels(views[0], size), *views[1:])
        elif self.overlays.errors and not self.helping and (lines := rows(moment.after)):
            views = (replace(views[0], ink=self.held_points.legend(lines, size, moment.comparison)), *views[1:])
        return views[0] if len(views) == 1 else views

    def _with_panels(self, view: Scene, size: tuple[int, int]) -> Scene:
        """The first player's view under the open panels, whose buttons and sliders are obeyed."""
        if self.hud is None:
            from ..hud import Hud  # loads ImGui, for those only who open a panel

            self.hud = Hud()
        seconds, self.undrawn = self.undrawn, 0.0
        moment, behind = self.moment, self.look.behind if self.look else 0
        told = rows(moment.after) if self.overlays.errors else ()
        ink, actions = self.hud.frame(self.panels, self.history, self.now, behind, len(self.timeline.past), size, seconds, told)
        for action in actions:
            self.do(action, self.hud.who)
        # the strip tells of looking back, pause and slow motion
        text = (view.text[0], *self.kept.notices) if view.text else ()
        return replace(view, ink=ink, text=text, figures=view.figures + self.hud.ghosts(view.figures, moment))

    @property
    def _taught(self) -> bool:
        """Whether somebody plays whom hints could help: nobody looks back or watches."""
        return self.look is None and self.tape is None

    def _shown(self, alpha: float) -> tuple[SessionState, float, tuple[Camera, ...]]:
        """The moment to draw, how far it is between its worlds, and from where each player sees it."""
        if self.look is not None:
            behind, fraction = self.look.at(alpha)
            moment = self._back(behind)
            return moment, fraction, self.look.cameras(moment, fraction, alpha)
        alpha = 1.0 if self.halted else alpha
        return self.now, self.now.fraction(alpha), tuple(player.view(alpha) for player in self.now.players)

    def _texts(self, moment: SessionState) -> tuple[tuple[str, ...], ...]:
        """The lines in each player's corner; what concerns all stands in the first one's."""
        own = [(self._moving(moment, who),) for who in range(len(moment.players))]
        lines = []
        if self.look is not None:
            lines += [f"{self.look.behind * DT:.1f} s ago, of {len(self.timeline.past) * DT:.0f} s",
                      f"{self._key('scrub_back')} {self._key('scrub_on')} back and on, "
                      f"{self._key('resume')} or walking plays on from here"]
        elif self.tape is not None:
            lines.append(f"watching {self.now.number * DT:.0f} of {self.tape.duration:.0f} s: "
                         f"{self._key('pause')} halts, walking plays on from here")
        elif moment.paused:
            lines.append(f"paused: {self._key('pause')} goes on, {self._key('step')} makes one step")
        if moment.slow > 1:
            lines.append(f"slow motion 1/{moment.slow}")
        if self.preparing is not None:
            lines += self.preparing.said
        told = (*lines, *self.held_points.status(moment, self._key), *self.kept.status(self.now), *self.kept.notices, f"{self._key('help')} help")
        return ((*own[0], *told), *own[1:])

    def _moving(self, moment: SessionState, who: int) -> str:
        if jumping(moment.after.characters[who].state) is not None:
            return "jumping"
        v_f, omega, v_l = moment.after.characters[who].state.velocity
        if math.hypot(v_f, v_l) < SHOWN_SPEED and abs(omega) < SHOWN_SPEED:
            moving = "standing"
        else:
            moving = f"{math.hypot(v_f, v_l):.1f} m/s" + (f"   turning {omega:+.1f} rad/s" if abs(omega) > 0.2 else "")
        return moving + ("   facing held" if moment.players[who].pilot.facing is not None else "")

    def _key(self, action: str) -> str:
        keys = self.bindings.row(action).keys
        return key_label(keys[0]) if keys else action.replace("_", " ")
