"""A session: the one function that takes what is played a tick further, and the moments that were.

A `gambol.game.session.state.SessionState` is all there is sixty times a second: worlds, and for each player pilot and camera.
`advance` gives the next one from what the hands wish. It knows no clock and no window, so the
window, a film of a log and the tests play the same game, to the bit.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from gambol.controllers.contract import CharacterState, Intent, Leap, but
from gambol.controllers.navigation import in_world, slide
from gambol.controllers.navigation.thinking import Thought

from ..explain import Preview, preview
from ..input import BACK, BRAKES, FARTHEST, MOVING, NEAR, PATIENCE, RUNS, THINKS, WAITED, Aim, Command, RunUp, Wish, agility, aloft, at_hand, before, braked, cramped, even_ahead, headlong, in_view, landing, last_chance, leaps, leaving, onto, push, ring, rises
from ..scene import Prop
from ..world import DT, RATE, Character, ground_between, jump_of, stopped
from . import settings
from .actions import done
from .passers import asked, polite
from .state import SessionState, Player

KEPT = 30 * RATE
"""How many steps of the world one can go back ..."""
GOES_BACK, GLIDES, LITTLE, STANDS = 0.5, 0.3, 0.03, (0.2, 0.45)
"""So fast goes back who is too near to what he would leap onto [m/s], until he comes far enough as he stops, in so long [s], to so much [m]; slower than the fourths [m/s] he stands, the
second if he goes to his ring: he leaps as he comes to rest, but not with his feet a stride apart."""
STRAIGHT = 0.9
"""He goes to it with so much of his speed."""
CAST = 8
"""... with so many characters; with more, fewer."""


def advance(moment: SessionState, wishes: Sequence[Wish], past: Sequence[SessionState] = ()) -> SessionState:
    """The moment a sixtieth of a second later; one wish for each player, in order.

    First what was pressed is done, then the world moves, then the cameras. Everything stays as it
    was while it is paused, but for the cameras. past: earlier moments, the newest last, for "back=N".
    SettingError for a setting or a value that there is not.
    """
    if len(wishes) != len(moment.players):
        raise ValueError(f"{len(moment.players)} players need as many wishes, got {len(wishes)}")
    number, stepped, back = moment.number + 1, False, backward(wishes, past)
    if back:  # the world starts from there at once, however slowly it goes
        moment = but(past[-back], paused=False, slow=moment.slow, phase=moment.slow - 1)
    for who, wish in enumerate(wishes[:len(moment.players)]):
        for action in wish.pressed:
            moment = done(moment, who, action)
            stepped = stepped or action == "step"
    wishes = tuple(wishes) + (Wish(),) * (len(moment.players) - len(wishes))  # for one who has just joined
    moment = but(moment, number=number,
                 players=tuple(but(player, last=player.camera) for player in moment.players))
    if moment.paused:
        moment = _stepped(moment, wishes) if stepped else moment
    elif moment.phase + 1 < moment.slow:
        moment = but(moment, phase=moment.phase + 1)
    else:
        moment = _stepped(moment, wishes)
    return but(moment, players=tuple(_filmed(moment, who, wish, stepped) for who, wish in zip(
        range(len(moment.players)), wishes)))


def _stepped(moment: SessionState, wishes: Sequence[Wish]) -> SessionState:
    """One step of the world."""
    players, intents = [], []
    for player, character, wish in zip(moment.players, moment.after.characters, wishes):
        state = character.state
        if player.camera.flown:  # the sticks fly the camera
            wish = Wish()
        jump = jump_of(character.controller)
        stands = state if jump is None else landing(jump, state)  # in the air one aims from where one will land
        held = but(wish, strafe=wish.strafe or player.pilot.locked)
        back = _back(player, character, stands, moment.after.props)
        farthest = math.inf if jump is None or not held.jump else FARTHEST * jump.about()
        even = (held.jump or player.aim.wants) and even_ahead(state, moment.after.props)
        held_up = player.run_up.halt is not None and np.hypot(state.velocity[0], state.velocity[2]) < MOVING
        leaves = leaving(state)
        ahead = None if not held.jump or player.aim.wants or leaves else (onto if held_up else at_hand)(state, in_view(held.move, player.camera.yaw), moment.after.props)
        aim = player.aim.step(held, player.camera.yaw, stands, leaves, DT, aloft(state), back is not None, farthest, even, state, ahead) if jump is not None else player.aim
        if aim.stands:
            wish = but(wish, move=(0.0, 0.0), look=(0.0, 0.0), turn=0.0)
        pilot, command = player.pilot.command(wish, player.camera.yaw, float(state.ground[2]), DT)
        camera = player.camera.turned(command.swing * DT) if command.swing else player.camera
        goal = None if math.hypot(*wish.move) > 0.0 or wish.turn or aim.stands or wish.jump else player.goal  # hands take over at once
        players.append(but(player, pilot=pilot, camera=camera, aim=aim, goal=goal, pushed=False))
        props = moment.after.props
        facing = aim.facing(stands, props, back is not None)
        command = but(command, facing=command.facing if facing is None else facing)
        x, z = in_world(state.ground, state.velocity)
        if aim.takes_off and (aim.rests or command.velocity[0] * x + command.velocity[1] * z < BACK * math.hypot(*command.velocity) * math.hypot(x, z)):  # else he would brake until no foot sends him to the ring
            command = but(command, velocity=(float(x), float(z)))
        run_up = _run_up(player, character, command, aim, props)
        if run_up is None:
            run_up, command = _led(character, command, props)
        known = run_up or RunUp()
        players[-1] = but(players[-1], run_up=known)
        # how long it can be in the air is not asked before somebody aims: on a first start that is still being compiled
        leap, ready = (None, None) if jump is None or not aim.wants or leaves or back is not None else (ask(stands, props, -float(jump.gravity[1]), jump.longest, jump.about) for ask in (aim.asked, aim.readied))
        command = command if known.leap is None else but(command, velocity=known.velocity)
        command = command if back is None or not aim.stands else but(command, velocity=back)
        intent = replace(known.heeded(state, command.intent(state, player.steering)), leap=known.off or leap, goal=goal,
                         aim=known.leap or (ready if known.thought is None else Leap(ring(state, props))),
                         strike=push(player.camera.yaw, wish) if player.pushed else None)
        intents.append(intent if aim.moving or run_up is not None else stopped(state, intent, props))  # a run-up may go at what it leaps onto
    passers, theirs = asked(moment)
    intents += theirs
    held, turns = (None, None) if moment.comparison is None else (moment.comparison.goals, moment.comparison.turns)
    intents += [Intent() if one.follows is None else Intent(points=held, turns=turns) for one in moment.after.characters[len(intents):]]
    world, intents = polite(moment, intents)
    return but(moment, before=moment.after, after=world.step(intents), players=tuple(players), phase=0, passers=passers)


def _back(player: Player, character: Character, stands: CharacterState, props: Sequence[Prop]) -> tuple[float, float] | None:
    """With which velocity (2,) [m/s] somebody goes back who aims from a stand at what he is too near to, until he stands; None of everybody else."""
    aim = player.aim
    far = math.hypot(*aim.offset)
    if not aim.stands or far < NEAR or leaving(character.state) or aloft(character.state):
        return None
    x, z = (-GOES_BACK * part / far for part in aim.offset)
    lacks = cramped(character.controller, stands, [float(stands.ground[k]) + aim.offset[k] for k in (0, 1)], props, aim.backs)
    goes = float(np.hypot(character.state.velocity[0], character.state.velocity[2]))
    if lacks > max(GLIDES * goes, LITTLE):
        return x, z
    vx, vz = in_world(character.state.ground, character.state.velocity)
    to_it = bool(vx * x + vz * z < -STRAIGHT * GOES_BACK * goes)
    return (0.0, 0.0) if (aim.place is not None or aim.led) and goes > STANDS[to_it] else None


def _run_up(player: Player, character: Character, command: Command, aim: Aim, props: Sequence[Prop]) -> RunUp | None:
    """What is known of the run-up of somebody who aims at a run, or has let go: goes on as he does if his leap will go off, or until he can just still leap over
    what is ahead, and else comes to rest before it. None of who does neither."""
    if not (aim.moving and aim.wants) or leaving(character.state):
        return None
    known, state, controller, jump = player.run_up, character.state, character.controller, jump_of(character.controller)
    onward = known.onward(command.velocity)
    if onward is not None:
        return onward
    if known.free > 1:
        return RunUp(known.free - 1)
    velocity, halt = command.velocity, before(controller, state, command.velocity, props)
    released, runs = not aim.aiming, math.hypot(*velocity) > RUNS
    same = not known.turned(velocity) and aim.waiting != PATIENCE

    def near(share: float, more: float) -> bool:
        return before(controller, state, velocity, props, share, more) is not None or runs and rises(controller, state, velocity, props, share, more)
    if known.thought is not None and same:
        return known.known(near(WAITED, 0.0), halt)
    if jump is None or halt is None and not (runs and near(1.0, THINKS * math.hypot(*velocity))):
        return RunUp(0, halt)
    if not released and not runs:
        return RunUp(0, halt)
    if known.free != 0 and same:
        return but(known, free=-1, halt=halt, leap=None)
    # what comes of it is thought of once, and only where something is ahead
    gravity, longest, most = -float(jump.gravity[1]), jump.longest, round(aim.waiting / DT)

    def asks(now: CharacterState) -> Intent:
        return replace(command.intent(now, player.steering), leap=aim.asked(now, props, gravity, longest) if released else None)

    brakes = RunUp(-1, known.halt, velocity=velocity)

    def think(ask: Callable[[], None]) -> RunUp:
        later, since = (state, 0) if brakes.halt is None else (braked(controller, state, brakes, asks, props, DT), BRAKES)
        if released and (number := leaps(controller, later, asks, props, DT, most - since, ask)[0]):
            return RunUp(number + since)
        found = last_chance(controller, later, velocity, asks, props, DT, ask) if runs else None
        return RunUp(-1) if found is None else but(found, free=found.free + since)
    return but(brakes, thought=Thought(think, DT)).known(near(WAITED, 0.0), halt)


def _led(character: Character, command: Command, props: Sequence[Prop]) -> tuple[RunUp | None, Command]:
    """What somebody who neither aims nor has let go does of what hands ask: he goes along what is in his way, but who goes straight at it comes to rest before it."""
    state, controller = character.state, character.controller
    velocity = tuple(slide(state.ground[:2], command.velocity, float(state.floor), props, agility(controller)))
    halt = None if velocity == command.velocity else headlong(controller, state, command.velocity, props)
    return (None, but(command, velocity=velocity)) if halt is None else (RunUp(0, halt), command)


def refused(before: SessionState, after: SessionState, seen: Sequence[Preview | None] = ()) -> tuple[str, ...]:
    """Why jumps that players had asked for were given up in the last step: a line for each. seen: what they saw of them, where that was drawn; else that is found out now."""
    lines = []
    for i, (old, new, was, now) in enumerate(zip(before.players, after.players, before.after.characters, after.after.characters)):
        if old.aim.waiting > 0.0 and new.aim == Aim() and not leaving(now.state) and now is not was:
            drawn = seen[i] if i < len(seen) else preview(was, old.aim, before.after.about(i), sweeps=False)
            why = drawn.why if drawn is not None else ""
            lines.append(f"no jump: {why or was.state.refused or 'no foot stood ready'}")
    return tuple(lines)


def _filmed(moment: SessionState, who: int, wish: Wish, stepped: bool) -> Player:
    """A player whose camera is a tick further, after the character."""
    first, second = moment.before.characters[who], moment.after.characters[who]
    old, new, part = first.state, second.state, moment.fraction(1.0)
    still = moment.paused and not stepped
    velocity = np.zeros(2) if still else in_world(new.ground, new.velocity) / moment.slow
    player = moment.players[who]
    return but(player, camera=player.camera.aimed(player.aim.looked, DT).step(
        ground_between(old, new, part), velocity, wish, DT, moment.after.props,
        first.level + part * (second.level - first.level)))


@dataclass(eq=False)
class Timeline:
    """The present moment and those of the last half minute, one for each step of the world.

    past: earlier moments, the newest last. Ticks in which the world stood still only change the
    present, so that a long pause doesn't push out what one would go back to.
    """

    now: SessionState
    past: deque[SessionState] = field(default_factory=lambda: deque(maxlen=KEPT))

    def advance(self, wishes: Sequence[Wish]) -> None:
        """One tick on. A "back=N" forgets what came after the moment that it returns to."""
        moment = advance(self.now, wishes, self.past)
        back = backward(wishes, self.past)
        for _ in range(back - 1):
            self.past.pop()
        if not back and moment.after.characters[0].state is not self.now.after.characters[0].state:
            self.past.append(self.now)
        while len(self.past) * max(len(moment.after.characters), CAST) > KEPT * CAST:
            self.past.popleft()
        self.now = moment


def backward(wishes: Sequence[Wish], past: Sequence[SessionState]) -> int:
    """How many steps of the world the wishes of a tick go back, at most to the oldest of `past`.

    SettingError for a "back=" without a whole number from 1.
    """
    back = 0
    for action in (action for wish in wishes for action in wish.pressed if action.startswith("back=")):
        text = action.removeprefix("back=")
        if not (text.isascii() and text.isdecimal() and len(text) < 10) or int(text) < 1:
            raise settings.SettingError(f"{action}: needs a whole number of steps, from 1")
        back = int(text)
    return min(back, len(past))
