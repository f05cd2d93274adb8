"""The first minute of play: short hints, one at a time, each gone as soon as what it tells of was done.

What was done follows from the moments that are played (`doing`), which hint is shown from what was done (`Hints.step`).
Neither wishes nor worlds know of hints, so a log plays again without them.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

from gambol.controllers.files import whole

from ..files import toml
from ..hosts import Event, KeyEvent, PadState
from ..input import MOUSE, Bindings, button_label, jumping, key_label, pad_wish
from ..scene import Box, Hint
from ..session import SessionState

ORDER = ("walk", "run", "jump", "course", "study")
"""The hints, in the order in which they come."""
NEEDS = {"walk": 1.5, "run": 1.0}
"""How long something must have been done before its hint goes [s]; at once where nothing stands here."""
LASTS = {"run": 40.0, "jump": 40.0, "course": 14.0, "study": 14.0}
"""How long a hint stands that nobody follows [s]."""
FADE, PAUSE = 0.6, 0.9
"""How long a hint takes to come and to go, and how long none stands between two [s]."""
SLOWEST, FASTER = 0.3, 1.3
"""From this speed [m/s] on somebody walks, and from so many times a walk's pace on runs."""
NEAR = 1.6
"""Whoever is so near to the middle of something to jump onto [m] has found it."""
STEP = 1.2
"""What is no higher than this [m] can be jumped onto."""
FILE = "hints.toml"


@dataclass(frozen=True)
class Hints:
    """What was done so far, and the hint that stands there.

    spent: how long each was being done [s]. name: of the hint, "" for none. opacity: 0 … 1. time: for how long it has
    stood, or since none does [s].
    """

    done: frozenset[str] = frozenset()
    spent: tuple[tuple[str, float], ...] = ()
    name: str = ""
    opacity: float = 0.0
    time: float = 0.0

    def step(self, now: Collection[str], seconds: float, early: Collection[str] = ()) -> Hints:
        """`seconds` later, while all that is in `now` was being done. early: what nobody is taught yet."""
        spent = dict(self.spent)
        spent |= {name: spent.get(name, 0.0) + seconds for name in now if name in ORDER}
        done = self.done | {name for name, time in spent.items() if time >= NEEDS.get(name, 0.0)}
        later = replace(self, done=done, spent=tuple(spent.items()), time=self.time + seconds)
        if not self.name:
            left = [name for name in ORDER if name not in done and name not in early]
            return replace(later, name=left[0], time=0.0) if left and later.time >= PAUSE else later
        if self.name not in done and self.time < LASTS.get(self.name, math.inf):
            return replace(later, opacity=min(self.opacity + seconds / FADE, 1.0))
        faded = self.opacity - seconds / FADE
        if faded > 0.0:
            return replace(later, opacity=faded)
        return replace(later, done=done | {self.name}, name="", opacity=0.0, time=0.0)


def doing(moment: SessionState) -> frozenset[str]:
    """What of `ORDER` the first player is at, in the moment that is played."""
    character, pace = moment.after.characters[0], moment.players[0].pilot.pace
    state, found = character.state, set()
    speed = math.hypot(state.velocity[0], state.velocity[2])
    if jumping(state) is not None:
        found.add("jump")
    elif speed > SLOWEST:
        found |= {"walk", "run"} if speed > FASTER * pace.walk else {"walk"}  # who runs can walk
    way = course(moment)
    if way is None or math.hypot(*way) < NEAR:
        found.add("course")  # nothing to find, or found
    if moment.comparison is not None:
        found.add("study")
    return frozenset(found)


def course(moment: SessionState) -> tuple[float, float] | None:
    """The way x, z [m] from the first player to the nearest thing to jump onto; None where there is none."""
    x, z = moment.after.characters[0].state.ground[:2]
    ways = [(prop.centre[0] - float(x), prop.centre[2] - float(z)) for prop in moment.after.props
            if isinstance(prop, Box) and prop.centre[1] + 0.5 * prop.size[1] < STEP]
    return min(ways, key=lambda way: math.hypot(*way), default=None)


def whither(moment: SessionState) -> str:
    """Where the course is, as the first player sees it."""
    way = course(moment)
    if way is None:
        return ""
    left = math.degrees(math.remainder(math.atan2(*way) - moment.players[0].camera.yaw, math.tau))
    side = "to your left" if left > 0.0 else "to your right"
    return "behind you" if abs(left) > 120.0 else side if abs(left) > 60.0 else f"ahead, {side}" if abs(left) > 20.0 else "ahead"


def worded(name: str, bindings: Bindings, pad: bool, where: str = "ahead") -> tuple[tuple[str, bool], ...]:
    """A hint in words, and keys or buttons (True) among them as they are bound; none where nothing is bound to it.

    pad: for somebody who plays with a gamepad. where: the course is, in words.
    """
    if name == "course":
        return ((f"something to jump onto stands {where}", False),)
    if name == "walk":
        rows = [bindings.row(action) for action in ("forward", "left", "back", "right")]
        caps = [f"{bindings.sticks.walk} stick"] if pad else [key_label(row.keys[0]) for row in rows if row.keys]
    else:
        row = bindings.row(name)
        keys = [key_label(key) for key in row.keys if key not in MOUSE]
        buttons = [button_label(button) for button in row.buttons]
        caps = ((buttons or keys) if pad else (keys or buttons))[:1]
    before, after = {"walk": ("", "to walk"), "run": ("hold", "as you walk, to run"), "jump": ("hold", "to aim, let go to jump"),
                     "study": ("", "puts a body beside you that knows six points on yours")}[name]
    words = (((before, False),) if before else ()) + tuple((cap, True) for cap in caps) + ((after, False),)
    return words if caps else ()


@dataclass(eq=False)
class Teacher:
    """Shows the hints of a game, and remembers in a file what was done, where it can. file: None remembers nothing."""

    bindings: Bindings
    file: Path | None = None
    hints: Hints = field(default_factory=Hints)
    pad: bool = False
    where: str = "ahead"

    @staticmethod
    def ready(bindings: Bindings, afresh: bool = False, file: Path | None = None) -> Teacher:
        """For who has these bindings; what was done in earlier games, by `file`, is not told again unless `afresh`."""
        from ..input import user_file  # loads what reads bindings files, for those only who play

        file = user_file().with_name(FILE) if file is None else file
        unbound = {name for name in ORDER if not worded(name, bindings, False)}
        return Teacher(bindings, file, Hints(frozenset(unbound | (set() if afresh else remembered(file)))))

    def heard(self, event: Event) -> None:
        """Tell which hands play from an event."""
        match event:
            case KeyEvent(_, True):
                self.pad = False
            case PadState(name=name) if name and (event.buttons or any(pad_wish(event, self.bindings).move)):
                self.pad = True

    def tick(self, moment: SessionState, seconds: float, jumps: bool = True) -> None:
        """`seconds` of play have led to a moment. jumps: whether anybody can jump yet, and is taught to."""
        self.where = whither(moment)
        before, self.hints = self.hints.done, self.hints.step(doing(moment), seconds, () if jumps else ("jump", "course"))
        if self.file is not None and self.hints.done != before:
            remember(self.file, self.hints.done)

    def hint(self) -> Hint | None:
        """What to show now."""
        if not self.hints.name or self.hints.opacity <= 0.0:
            return None
        return Hint(worded(self.hints.name, self.bindings, self.pad, self.where), self.hints.opacity)


def remembered(file: Path) -> frozenset[str]:
    """What a file says was done; nothing where there is none, or none that can be read."""
    try:
        done = toml.read(file, ValueError).get("done", ())
    except ValueError:
        return frozenset()
    return frozenset(name for name in ORDER if name in done) if isinstance(done, list) else frozenset()


def remember(file: Path, done: Collection[str]) -> None:
    """Write what was done into a file; where that can't be, one is told again another time."""
    words = ", ".join(f'"{name}"' for name in ORDER if name in done)
    with suppress(OSError):
        if not file.is_absolute():  # of somebody who has no home
            return
        file.parent.mkdir(parents=True, exist_ok=True)
        with whole(file) as part:
            part.write_text(f"# What Gambol need not teach again; delete this file to be told anew.\ndone = [{words}]\n", "utf-8")
