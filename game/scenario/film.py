"""A scenario as it runs: the worlds between which each frame lies, and the scenes that film it.

Time is frame / fps; simulation and cameras keep the simulation's own rate, so another frame rate
films the same motion from the same places.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, TypeVar

from gambol.controllers.contract import Intent
from gambol.controllers.jump import GRAVITY
from gambol.controllers.navigation import floor_at
from gambol.controllers.person import built
from gambol.controllers.supervisor import Supervisor

from ..camera import between, seen_past
from ..explain import broken, explained, led, pointed, rows, stepping, with_cameras
from ..input import Script
from ..scene import Caption, Overlays, Scene
from ..session import GHOST
from ..world import DT, RATE, Character, Filmed, Recorded, World, avoiding, beginning, figures, follower_of, methods, stopped, tracked_of
from .actor_table import ActorTable
from .camera_operator import Operator
from .scenario import Scenario
from .shot_table import ShotTable, overlays, parts

TITLE = (0.4, 3.4)
CAPTION = (0.4, 4.4)
"""When a title or caption comes and when it is gone again [s], counted from the start or the cut."""
FADE = 0.5
"""How long coming and going take [s]."""
REFUSED = 4.0
"""How long the overlay of jumps says why one was not made [s]."""
PLOTTED = 10 * RATE
"""So many steps back the plots over a film show."""
EARTH = float(GRAVITY[1])

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Frame:
    """One frame of a run: it shows the moment `alpha` (0 … 1) of the way from `before` to `after`.

    refused: the jumps that were not made so far, and why; of the last frame also which moves never began.
    """

    number: int
    time: float
    before: World
    after: World
    alpha: float
    refused: tuple[str, ...] = ()


def opening(scenario: Scenario, controller: Any) -> World:
    """The world before the first step, every actor under the same controller, each in its own body.

    Who plays a clip stands behind the actors. Followers' methods are learnt if they were not yet.
    """
    props, cast = scenario.stage(), {}
    for actor in scenario.actors:
        if actor.follows is None and actor.tracks is None:
            someone, jumper = controller, actor.jumper(scenario.gravity)
            if actor.body is not None or jumper.gravity[1] != EARTH:
                someone = built(controller, jumper.physique, jumper.gravity)
            if not someone.parts and any(move.go_to is not None for move in actor.moves):
                someone = Supervisor({"locomotion": someone})  # which plans the way
            x, z, heading = actor.start
            state = someone.start(ground=(x, z, math.radians(heading)), floor=floor_at(x, z, props))
            cast[actor.name] = Character(actor.name, someone, tint=actor.tint, state=state, opacity=_opacity(actor),
                                         enters=actor.enters, leaves=actor.gone)
    for actor in scenario.actors:
        if actor.tracks is not None and actor.tracks.footage is not None:
            someone = actor.tracks.filmed(controller)
            cast[actor.name] = Character(actor.name, someone, tint=actor.colour, opacity=_opacity(actor), state=someone.start(beside=actor.tracks.beside))
        elif actor.tracks is not None and actor.tracks.actor is not None:
            performer = cast[actor.tracks.actor]
            watches = actor.tracks.watches(performer.controller.skeleton)
            someone = tracked_of(performer.controller, watches, RATE, actor.tracks.penalty)
            cast[actor.name] = Character(actor.name, someone, tint=actor.colour, opacity=_opacity(actor), watches=watches,
                                         state=beginning(someone, performer.state, watches.beside), enters=performer.enters, leaves=performer.leaves)
    clips = {table.performer: table for _, table in scenario.followers if table.clip is not None}
    for name, table in clips.items():
        assert table.clip is not None  # see above
        someone = Recorded.load(table.clip, controller, table.reading())
        cast[name] = Character(name, someone, state=someone.start())
    for actor, table in scenario.followers:
        performer, follows = cast[table.performer], table.follows()
        someone = follower_of(performer.controller, table.method, table.points, methods(scenario.database))
        state = beginning(someone, performer.state, follows.beside)
        cast[actor.name] = Character(actor.name, someone, tint=actor.colour, state=state, follows=follows, opacity=_opacity(actor),
                                     enters=performer.enters, leaves=performer.leaves)
    order = [actor.name for actor in scenario.actors] + list(clips)
    return World(tuple(cast[name] for name in order), props)


def _opacity(actor: ActorTable) -> float:
    return GHOST if actor.ghost else 1.0


@dataclass(frozen=True, eq=False)
class Act:
    """A world of a run, and where every actor is in its script."""

    world: World
    scripts: tuple[Script, ...]

    @property
    def refused(self) -> tuple[str, ...]:
        """The jumps that were not made and places that were not reached so far, and why: a line for each."""
        return tuple(f"{character.name}: {why}" for character, script in zip(self.world.characters, self.scripts)
                     for why in script.refused)


def ended(scenario: Scenario, act: Act) -> tuple[str, ...]:
    """What a run has refused by its last frame, which moves never had their turn, and which pictures somebody was followed without."""
    from ..footage import lost_frames  # slow to load, for those only who follow footage

    filmed = [character.controller.footage for character in act.world.characters if isinstance(character.controller, Filmed)]
    lines = [line for footage in filmed for line in lost_frames(footage)]
    for character, script in zip(act.world.characters, act.scripts):
        left = sum(move.runs or move.jump is not None or move.goal is not None for move in script.moves[script.index + 1:])
        if left:
            lines.append(f"{character.name}: the film is over after {scenario.duration:g} s, before {left} of {len(script.moves)} moves begin")
    return (*act.refused, *lines)


def acts(scenario: Scenario, controller: Any) -> Iterator[Act]:
    """The run before the first step and after every one, without end."""
    world, props = opening(scenario, controller), scenario.stage()
    names = [actor.group for actor in scenario.actors]
    groups = [-1 if name is None else names.index(name) for name in names] + [-1] * (len(world.characters) - len(names))
    scripts = tuple(actor.script(actor.jumper(scenario.gravity), props) for actor in scenario.actors)
    scripts += (Script(()),) * (len(world.characters) - len(scripts))
    while True:
        yield Act(world, scripts)
        moves = [script.step(character.state, DT) if character.there(world.number) else (script, Intent())
                 for script, character in zip(scripts, world.characters)]
        moves = [script.held(character.controller, character.state, intent, props, DT) for (script, intent), character in zip(moves, world.characters)]
        scripts = tuple(script for script, _ in moves)
        intents = [intent if script.leaps else stopped(character.state, intent, props)
                   for (script, intent), character in zip(moves, world.characters)]
        ways = [script.wished(character.state) for script, character in zip(scripts, world.characters)]
        world, intents = avoiding(world, intents, ways, groups) if scenario.avoid else (world, intents)
        world = world.step(intents)


def worlds(scenario: Scenario, controller: Any) -> Iterator[World]:
    """The world before the first step and after every one, without end."""
    return (act.world for act in acts(scenario, controller))


def run(scenario: Scenario, controller: Any) -> Iterator[Frame]:
    """Every frame of a scenario, in order."""
    for number, before, after, alpha in _sampled(acts(scenario, controller), scenario):
        refused = before.refused if number < scenario.frames - 1 else ended(scenario, before)
        yield Frame(number, float(number / scenario.fps), before.world, after.world, alpha, refused)


def scenes(scenario: Scenario, controller: Any, shown: Overlays | None = None
           ) -> Iterator[tuple[Frame, tuple[Scene, ...]]]:
    """Every frame with the scenes that film it, one for each view.

    shown: replaces the overlays of the scenario and all its shots.
    """
    told: dict[str, float] = {}
    filmed: Any = None
    lately: deque[World] = deque(maxlen=PLOTTED if any(shot.panels for shot in scenario.shots) else 1)
    for number, (first, old), (second, new), alpha in _sampled(_kept(takes(scenario, controller), lately), scenario):
        before, after = first.world, second.world
        frame = Frame(number, float(number / scenario.fps), before, after, alpha, first.refused if number < scenario.frames - 1 else ended(scenario, first))
        for line in first.refused:
            told.setdefault(line, frame.time)
        why = tuple(part for line, since in told.items() if frame.time < since + REFUSED for part in broken(line))
        held = new.crew if new.shot is old.shot else old.crew  # nothing lies between two shots
        cameras = [between(a, b, alpha) for a, b in zip(old.crew, held)]
        drawn = figures(before, after, alpha)
        caption, made = _caption(scenario, old.shot, frame.time), []
        places = parts(len(cameras), scenario.size)
        lowest = max(top for _, top, _, _ in places)
        for operator, camera, part in zip(old.crew, cameras, places):
            table = operator.table
            names = next(o for o in (table.overlays, old.shot.overlays, scenario.overlays) if o is not None)
            corner = part[0] == 0.0 and part[1] == lowest
            title, over = getattr(table, "title", ""), overlays(names) if shown is None else shown
            text = ((title,) if title else ()) + (why if over.jump and not made else ())
            people = pointed(explained(drawn, before, after, alpha, over), before, after, alpha, over)
            people = stepping(led(people, after, over), after, over)
            if table.kind == "follow":
                people = seen_past(people, camera, operator.watched)
            made.append(Scene(camera, people, after.props, over, text, caption=caption if corner else None, part=part))
        lines = rows(before) if any(scene.overlays.errors for scene in made) else ()
        if lines or old.shot.panels:
            if filmed is None:
                from ..hud import Filmed  # loads ImGui, for those only who show panels or errors

                filmed = Filmed(scenario.size)
            about = old.crew[0].watched[0]
            made[0] = replace(made[0], ink=filmed.ink(old.shot.panels, lately, about, lines, float(1 / scenario.fps)))
        if made[0].overlays.cameras:
            made[0] = replace(made[0], ink=with_cameras(made[0].ink, before, scenario.size))
        yield frame, tuple(made)
    if filmed is not None:
        filmed.release()


@dataclass(frozen=True, eq=False)
class Take:
    """A shot being made, and who holds its cameras."""

    shot: ShotTable
    crew: tuple[Operator, ...]


def takes(scenario: Scenario, controller: Any) -> Iterator[tuple[Act, Take]]:
    """Every act of a scenario with the take that films it, without end."""
    take = None
    cuts = [round(shot.at * RATE) for shot in scenario.shots]
    ends = [shot.at for shot in scenario.shots[1:]] + [scenario.duration]
    for act in acts(scenario, controller):
        world = act.world
        i = [i for i, cut in enumerate(cuts) if cut <= world.number][-1]
        shot = scenario.shots[i]
        if take is None or take.shot is not shot:
            take = Take(shot, tuple(Operator.ready(table, world, ends[i]) for table in shot.cameras))
        else:
            take = replace(take, crew=tuple(operator.step(world) for operator in take.crew))
        yield act, take


def _sampled(ticks: Iterator[T], scenario: Scenario) -> Iterator[tuple[int, T, T, float]]:
    """Number, the ticks before and after, and the way between them of every frame of a film."""
    before, after, reached = next(ticks), next(ticks), 0
    for number in range(scenario.frames):
        # in fractions, so that no frame rate drifts
        wanted, rest = divmod(number * RATE, scenario.fps)
        while reached < wanted:
            before, after, reached = after, next(ticks), reached + 1
        yield number, before, after, float(rest / scenario.fps)


def _kept(ticks: Iterator[tuple[Act, Take]], worlds: deque[World]) -> Iterator[tuple[Act, Take]]:
    """The same ticks, their worlds kept as they come."""
    for act, take in ticks:
        worlds.append(act.world)
        yield act, take


def _caption(scenario: Scenario, shot: ShotTable, time: float) -> Caption | None:
    """The title while it is there, else the shot's caption."""
    opening = Caption(scenario.title, scenario.under, _fade(time, *TITLE))
    if opening.opacity > 0.0:
        return opening
    start = max(shot.at, TITLE[1] - CAPTION[0])
    following = min([s.at for s in scenario.shots if s.at > shot.at], default=scenario.duration)
    opacity = _fade(time, start + CAPTION[0], min(start + CAPTION[1], following))
    return Caption(shot.caption, shot.under, opacity) if shot.caption and opacity > 0.0 else None


def _fade(time: float, comes: float, goes: float) -> float:
    return min(max(min(time - comes, goes - time) / FADE, 0.0), 1.0)
