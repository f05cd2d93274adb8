"""A session: what is played, as a value, and the one function that takes it a tick further.

A `Moment` is all there is sixty times a second: worlds, and for each player pilot and camera.
`advance` gives the next one from what the hands wish. It knows no clock and no window, so the
window, a film of a log and the tests play the same game, to the bit.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from controllers.contract import Intent
from controllers.navigation import Steering, in_world, slide

from . import settings, study
from .aiming import preview
from .camera import Follow, PlayerCamera, between, cycled
from .input.aim import Aim
from .input.pilot import STEERING, Pilot
from .input.script import jumping
from .input.wish import Wish
from .methods import Methods, methods
from .scene import TINT, Camera, Figure
from .stage import COURSE
from .study import Study
from .sway import jump_of
from .world import DT, RATE, Character, World, figures, ground_between

KEPT = 30 * RATE
"""How many steps of the world one can go back."""
SLOWER = (1, 2, 4, 10)
"""Slow motion: how many ticks one step of the world takes."""
APART = 1.2
"""How far from one another players start [m]."""
TINTS = (TINT, (0.20, 0.46, 0.72))
"""What tells the players apart."""
ACTIONS = frozenset(("pause", "step", "slowmo", "reset", "join", "strafe_lock", "recentre", "camera_mode"))
"""What `advance` does of a wish's `pressed`, beside "back=N", settings, "name=value", and `study.ACTIONS`."""


@dataclass(frozen=True, eq=False)
class Player:
    """One pair of hands: its pilot, how it steers, where it aims, its camera now and (`last`) a tick ago."""

    pilot: Pilot
    camera: PlayerCamera
    last: PlayerCamera
    steering: Steering = STEERING
    aim: Aim = Aim()

    @staticmethod
    def behind(character: Character) -> Player:
        """Fresh hands, and a camera at rest behind a character."""
        camera = Follow.behind(character.state.ground, level=character.level)
        return Player(Pilot(), camera, camera)

    def view(self, alpha: float) -> Camera:
        """The camera to draw with, `alpha` (0 … 1) of the way through the last tick."""
        return between(self.last, self.camera, alpha)


@dataclass(frozen=True, eq=False)
class Moment:
    """All of a session after a tick.

    before, after: the worlds that the last step of the simulation led from and to; player i moves
    character i. opening: the world that a reset returns to. number: ticks since the session began,
    whatever became of the world meanwhile. slow: ticks that a step of the world takes. phase: those
    made since the last step. study: what is reconstructed of the first player, by characters that come last in the
    worlds; methods: where what they need is learnt.
    """

    before: World
    after: World
    players: tuple[Player, ...]
    opening: World
    number: int = 0
    paused: bool = False
    slow: int = 1
    phase: int = 0
    study: Study | None = None
    methods: Methods = field(default_factory=methods)

    def fraction(self, alpha: float) -> float:
        """How far from `before` to `after` the world is, `alpha` of the way through the last tick."""
        return 1.0 if self.paused else min((self.phase + alpha) / self.slow, 1.0)

    def figures(self, alpha: float) -> tuple[Figure, ...]:
        """What to draw of the characters."""
        return figures(self.before, self.after, self.fraction(alpha))

    def setting(self, name: str, player: int = 0) -> float | None:
        """What a player's setting stands at; None where the controller has no such thing."""
        return settings.value(owners(self, player), name)


def opening(controller: Any, players: int = 1, learnt: Methods | None = None) -> Moment:
    """The first moment: so many players side by side, with a course to jump on to their left.

    learnt: the methods of its studies; those over Gambol's own motion by default.
    """
    return begin(World(tuple(_newcomer(controller, n, np.zeros(3)) for n in range(players)), COURSE), players, learnt)


def begin(world: World, players: int = 1, learnt: Methods | None = None) -> Moment:
    """The first moment in a world, whose first characters the players move."""
    return Moment(world, world, tuple(Player.behind(c) for c in world.characters[:players]), world,
                  methods=methods() if learnt is None else learnt)


def advance(moment: Moment, wishes: Sequence[Wish], past: Sequence[Moment] = ()) -> Moment:
    """The moment a sixtieth of a second later; one wish for each player, in order.

    First what was pressed is done, then the world moves, then the cameras. Everything stays as it
    was while it is paused, but for the cameras. past: earlier moments, the newest last, for "back=N".
    SettingError for a setting or a value that there is not.
    """
    if len(wishes) != len(moment.players):
        raise ValueError(f"{len(moment.players)} players need as many wishes, got {len(wishes)}")
    number, stepped, back = moment.number + 1, False, backward(wishes, past)
    if back:  # the world starts from there at once, however slowly it goes
        moment = replace(past[-back], paused=False, slow=moment.slow, phase=moment.slow - 1)
    for who, wish in enumerate(wishes[:len(moment.players)]):
        for action in wish.pressed:
            moment = _done(moment, who, action)
            stepped = stepped or action == "step"
    wishes = tuple(wishes) + (Wish(),) * (len(moment.players) - len(wishes))  # for one who has just joined
    moment = replace(moment, number=number,
                     players=tuple(replace(player, last=player.camera) for player in moment.players))
    if moment.paused:
        moment = _stepped(moment, wishes) if stepped else moment
    elif moment.phase + 1 < moment.slow:
        moment = replace(moment, phase=moment.phase + 1)
    else:
        moment = _stepped(moment, wishes)
    return replace(moment, players=tuple(_filmed(moment, who, wish, stepped) for who, wish in zip(
        range(len(moment.players)), wishes)))


def _stepped(moment: Moment, wishes: Sequence[Wish]) -> Moment:
    """One step of the world."""
    players, intents = [], []
    for player, character, wish in zip(moment.players, moment.after.characters, wishes):
        state = character.state
        if player.camera.flown:  # the sticks fly the camera
            wish = Wish()
        jump = jump_of(character.controller)
        aim = player.aim.step(wish, player.camera.yaw, state, jumping(state) is not None, DT) if jump is not None else player.aim
        if aim.stands:
            wish = replace(wish, move=(0.0, 0.0), look=(0.0, 0.0))
        pilot, command = player.pilot.command(wish, player.camera.yaw, float(state.ground[2]), DT)
        camera = player.camera.turned(command.swing * DT) if command.swing else player.camera
        players.append(replace(player, pilot=pilot, camera=camera, aim=aim))
        props = moment.after.props
        command = replace(command, facing=command.facing if aim.facing is None else aim.facing, velocity=tuple(
            slide(state.ground[:2], command.velocity, float(state.floor), props)))
        leap = None if jump is None else aim.asked(state, props, -float(jump.gravity[1]))
        intents.append(replace(command.intent(state, player.steering), leap=leap))
    held = None if moment.study is None else moment.study.goals
    intents += [Intent() if one.follows is None else Intent(points=held) for one in moment.after.characters[len(intents):]]
    return replace(moment, before=moment.after, after=moment.after.step(intents), players=tuple(players), phase=0)


def refused(before: Moment, after: Moment) -> tuple[str, ...]:
    """Why jumps that players had asked for were given up in the last step: a line for each."""
    lines = []
    for old, new, was, now in zip(before.players, after.players, before.after.characters, after.after.characters):
        if old.aim.waiting > 0.0 and new.aim == Aim() and jumping(now.state) is None and now is not was:
            seen = preview(was, old.aim, before.after.props)
            why = seen.why if seen is not None else ""
            lines.append(f"no jump: {why or getattr(was.state.memory, 'refused', '') or 'no foot stood ready'}")
    return tuple(lines)


def _filmed(moment: Moment, who: int, wish: Wish, stepped: bool) -> Player:
    """A player whose camera is a tick further, after the character."""
    first, second = moment.before.characters[who], moment.after.characters[who]
    old, new, part = first.state, second.state, moment.fraction(1.0)
    still = moment.paused and not stepped
    velocity = np.zeros(2) if still else in_world(new.ground, new.velocity) / moment.slow
    player = moment.players[who]
    return replace(player, camera=player.camera.aimed(player.aim.looked, DT).step(
        ground_between(old, new, part), velocity, wish, DT, moment.after.props,
        first.level + part * (second.level - first.level)))


def _done(moment: Moment, who: int, action: str) -> Moment:
    """The moment once `action` is done; what means nothing here changes nothing."""
    name, equals, _ = action.partition("=")
    player = moment.players[who]
    if name in study.ACTIONS:
        return _studied(moment, action)
    if equals and name != "back":
        return _tuned(moment, who, action)
    if name == "pause":
        return replace(moment, paused=not moment.paused, phase=moment.slow - 1)
    if name == "slowmo":
        slow = SLOWER[(SLOWER.index(moment.slow) + 1) % len(SLOWER)]
        return replace(moment, slow=slow, phase=slow - 1)
    if name == "reset":
        return _reset(moment)
    if name == "join":
        return _joined(moment)
    if name == "strafe_lock":
        return _with(moment, who, replace(player, pilot=player.pilot.toggled()))
    character = moment.after.characters[who]
    ground = character.state.ground
    if name == "recentre":
        return _with(moment, who, replace(player, camera=player.camera.recentred(float(ground[2]))))
    if name == "camera_mode":
        return _with(moment, who, replace(player, camera=cycled(player.camera, ground, character.level)))
    return moment


def _with(moment: Moment, who: int, player: Player) -> Moment:
    return replace(moment, players=moment.players[:who] + (player,) + moment.players[who + 1:])


def _reset(moment: Moment) -> Moment:
    """The opening again; what was tuned stays so."""
    world = replace(moment.opening, characters=tuple(
        replace(first, controller=now.controller)
        for first, now in zip(moment.opening.characters, moment.after.characters)))
    players = []
    for old, character in zip(moment.players, world.characters):
        camera = Follow.behind(character.state.ground, old.camera.settings, level=character.level)
        players.append(replace(old, pilot=Pilot(pace=old.pilot.pace), camera=camera, last=camera, aim=Aim()))
    return _studying(replace(moment, before=world, after=world, players=tuple(players), phase=0),
                     None if moment.study is None else replace(moment.study, pins=None))


def _studied(moment: Moment, action: str) -> Moment:
    """The moment with a study opened or closed, or its points held otherwise. SettingError for what can't be."""
    if action.startswith("study="):
        wanted, now = study.opened(action), moment.study
        if wanted is not None and now is not None:
            wanted = replace(wanted, beside=now.beside, pins=now.pins if wanted.points == now.points else None)
        return _studying(moment, wanted, {one.name: one for one in moment.after.characters if one.follows is not None})
    if moment.study is None:
        raise settings.SettingError(f"{action}: no study is open")
    now, after = study.pinned(moment.study, action, moment.after)
    return replace(moment, study=now, after=after)


def _studying(moment: Moment, wanted: Study | None, kept: Mapping[str, Character] = {}) -> Moment:
    """The moment with another study, or none. Followers that were not `kept` begin as the first player stands and moves."""
    followers: tuple[Character, ...] = ()
    if wanted is not None:
        wanted, followers = study.joined(wanted, moment.after.characters[0], moment.methods, kept)
    def among(world: World) -> World:
        return replace(world, characters=tuple(c for c in world.characters if c.follows is None) + followers)
    return replace(moment, before=among(moment.before), after=among(moment.after), study=wanted)


def _joined(moment: Moment) -> Moment:
    """One player more, beside the first; no more than there are tints."""
    count, controller = len(moment.players), moment.after.characters[0].controller
    if count >= len(TINTS):
        return moment
    def add(world: World) -> World:
        newcomer = _newcomer(controller, count, world.characters[0].state.ground)
        return replace(world, characters=world.characters[:count] + (newcomer,) + world.characters[count:])
    after = add(moment.after)
    newcomer = after.characters[count]
    before = replace(moment.before, characters=moment.before.characters[:count] + (newcomer,)
                     + moment.before.characters[count:])
    return replace(moment, before=before, after=after, opening=add(moment.opening),
                   players=(*moment.players, Player.behind(newcomer)))


def _newcomer(controller: Any, number: int, ground: np.ndarray) -> Character:
    """Player `number`, to the right of the first, who stands at `ground`."""
    x, z, heading = (float(v) for v in ground)
    side = APART * number
    return Character(f"Player {number + 1}", controller, tint=TINTS[number], state=controller.start(
        ground=(x - side * np.cos(heading), z + side * np.sin(heading), heading)))


def owners(moment: Moment, who: int) -> dict[str, Any]:
    """Whose settings player `who` tunes, by the owner's name; None where there is no such owner."""
    player = moment.players[who]
    return {"locomotion": getattr(moment.after.characters[who].controller, "settings", None),
            "steering": player.steering, "pace": player.pilot.pace, "camera": player.camera.settings}


def _tuned(moment: Moment, who: int, action: str) -> Moment:
    """The moment under another setting of one player."""
    owner, new = settings.changed(owners(moment, who), action)
    player, people = moment.players[who], moment.after.characters
    if owner == "locomotion":
        if new is None:
            return moment
        person = replace(people[who], controller=people[who].controller.tuned(new))
        return replace(moment, after=replace(moment.after, characters=people[:who] + (person,) + people[who + 1:]))
    if owner == "steering":
        return _with(moment, who, replace(player, steering=new))
    if owner == "pace":
        return _with(moment, who, replace(player, pilot=replace(player.pilot, pace=new)))
    return _with(moment, who, replace(player, camera=replace(player.camera, settings=new)))


@dataclass(eq=False)
class Timeline:
    """The present moment and those of the last half minute, one for each step of the world.

    past: earlier moments, the newest last. Ticks in which the world stood still only change the
    present, so that a long pause doesn't push out what one would go back to.
    """

    now: Moment
    past: deque[Moment] = field(default_factory=lambda: deque(maxlen=KEPT))

    def advance(self, wishes: Sequence[Wish]) -> None:
        """One tick on. A "back=N" forgets what came after the moment that it returns to."""
        moment = advance(self.now, wishes, self.past)
        back = backward(wishes, self.past)
        for _ in range(back - 1):
            self.past.pop()
        if not back and moment.after.characters[0].state is not self.now.after.characters[0].state:
            self.past.append(self.now)
        self.now = moment


def backward(wishes: Sequence[Wish], past: Sequence[Moment]) -> int:
    """How many steps of the world the wishes of a tick go back, at most to the oldest of `past`.

    SettingError for a "back=" without a whole number from 1.
    """
    back = 0
    for action in (action for wish in wishes for action in wish.pressed if action.startswith("back=")):
        text = action.removeprefix("back=")
        if not text.isdecimal() or int(text) < 1:
            raise settings.SettingError(f"{action}: needs a whole number of steps, from 1")
        back = int(text)
    return min(back, len(past))
