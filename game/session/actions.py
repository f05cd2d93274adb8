"""What pressing something does to a moment: pause, reset, a second player, settings, comparisons."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from gambol.controllers.contract import Goal

from ..camera import Follow, cycled
from ..input import Aim, Pilot, Script
from ..world import Character, World, walker_of
from . import comparison, settings, tracking
from .comparison import Comparison
from .passers import peopled
from .state import TINTS, SessionState, Player, newcomer, owners

SLOWER = (1, 2, 4, 10)
"""Slow motion: how many ticks one step of the world takes."""
ACTIONS = frozenset(("pause", "step", "slowmo", "reset", "join", "strafe_lock", "recentre", "camera_mode", "track", "penalty", "push"))
"""What `done` does of a wish's `pressed`, beside "back=N", settings, "name=value", where to go, `goal_of`, how many passers-by there are, `peopled`, and `comparison.ACTIONS`."""


def done(moment: SessionState, who: int, action: str) -> SessionState:
    """The moment once `action` is done; what means nothing here changes nothing."""
    name, equals, _ = action.partition("=")
    player = moment.players[who]
    if name in comparison.ACTIONS:
        return _compared(moment, action)
    if name == "crowd":
        return peopled(moment, action)
    if name == "goto":
        return _with(moment, who, replace(player, goal=goal_of(action)))
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
    if name == "track":
        return tracking.tracked(moment)
    if name == "penalty":
        return tracking.otherwise(moment)
    if name == "strafe_lock":
        return _with(moment, who, replace(player, pilot=player.pilot.toggled()))
    if name == "push":
        return _with(moment, who, replace(player, pushed=True))
    character = moment.after.characters[who]
    ground = character.state.ground
    if name == "recentre":
        return _with(moment, who, replace(player, camera=player.camera.recentred(float(ground[2]))))
    if name == "camera_mode":
        return _with(moment, who, replace(player, camera=cycled(player.camera, ground, character.level)))
    return moment


def goal_of(action: str) -> Goal | None:
    """Where "goto=x/z" [m] sends a character, "goto=x/z/heading" [degrees] to stand there so; "goto=" sends it nowhere.
    SettingError for what is no place."""
    text = action.partition("=")[2]
    if not text:
        return None
    try:
        numbers = [float(part) for part in text.split("/")]
        if len(numbers) not in (2, 3):
            raise ValueError("two or three numbers")
        return Goal(tuple(numbers[:2]), math.radians(numbers[2]) if len(numbers) == 3 else None)
    except ValueError as error:
        raise settings.SettingError(f"{action}: needs x/z [m] or x/z/heading [degrees]; {error}") from None


def _with(moment: SessionState, who: int, player: Player) -> SessionState:
    return replace(moment, players=moment.players[:who] + (player,) + moment.players[who + 1:])


def _reset(moment: SessionState) -> SessionState:
    """The opening again; what was tuned stays so."""
    world = replace(moment.opening, characters=tuple(
        replace(first, controller=now.controller)
        for first, now in zip(moment.opening.characters, moment.after.characters)))
    players = []
    for old, character in zip(moment.players, world.characters):
        camera = Follow.behind(character.state.ground, old.camera.settings, level=character.level)
        players.append(replace(old, pilot=Pilot(pace=old.pilot.pace), camera=camera, last=camera, aim=Aim(), goal=None, pushed=False))
    passers = tuple(Script(script.moves, strikes=script.strikes) for script in moment.passers)
    return _comparing(replace(moment, before=world, after=world, players=tuple(players), phase=0, passers=passers),
                     None if moment.comparison is None else replace(moment.comparison, pins=None, turned=()))


def _compared(moment: SessionState, action: str) -> SessionState:
    """The moment with a comparison opened or closed, or its points held otherwise. SettingError for what can't be."""
    if action.startswith("study="):
        wanted, now = comparison.opened(action), moment.comparison
        if wanted is not None and now is not None:
            wanted = replace(wanted, beside=now.beside)
            if wanted.points == now.points:
                wanted = replace(wanted, pins=now.pins, turned=now.turned)
        return _comparing(moment, wanted, {one.name: one for one in moment.after.characters if one.follows is not None})
    if moment.comparison is None:
        raise settings.SettingError(f"{action}: no comparison is open")
    now, after = comparison.pinned(moment.comparison, action, moment.after)
    return replace(moment, comparison=now, after=after)


def _comparing(moment: SessionState, wanted: Comparison | None, kept: Mapping[str, Character] = {}) -> SessionState:
    """The moment with another comparison, or none. Followers that were not `kept` begin as the first player stands and moves."""
    followers: tuple[Character, ...] = ()
    if wanted is not None:
        first, *others = (one for one in moment.after.characters if one.follows is None)
        wanted, followers = comparison.joined(wanted, first, moment.methods, kept, others if len(moment.players) > 1 else ())
    def among(world: World) -> World:
        return replace(world, characters=tuple(c for c in world.characters if c.follows is None) + followers)
    return replace(moment, before=among(moment.before), after=among(moment.after), comparison=wanted)


def _joined(moment: SessionState) -> SessionState:
    """One player more, beside the first; no more than there are tints. Bodies made of points that stand there go to the other side."""
    count, controller = len(moment.players), walker_of(moment.after.characters[0].controller)
    if count >= len(TINTS):
        return moment
    def add(world: World) -> World:
        first = world.characters[0]
        late = newcomer(controller, count, first.state.ground, float(first.state.floor), world.props)
        return replace(world, characters=world.characters[:count] + (late,) + world.characters[count:])
    after = add(moment.after)
    late = after.characters[count]
    before = replace(moment.before, characters=moment.before.characters[:count] + (late,)
                     + moment.before.characters[count:])
    moment = replace(moment, before=before, after=after, opening=add(moment.opening), players=(*moment.players, Player.behind(late)))
    open_ = moment.comparison
    return moment if open_ is None or open_.pins is not None else _comparing(moment, replace(open_, beside=(0.0, 0.0, 0.0)))


def _tuned(moment: SessionState, who: int, action: str) -> SessionState:
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
