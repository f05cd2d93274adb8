"""What is played, as a value: a moment of a session, and the first one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from gambol.controllers.contract import Goal
from gambol.controllers.navigation import Steering, clearance, floor_at

from ..camera import Follow, PlayerCamera, between
from ..input import STEERING, Aim, Pilot, RunUp, Script
from ..scene import TINT, Camera, Figure, Prop
from ..world import COURSE, Character, Methods, World, figures, methods
from . import settings
from .comparison import Comparison

APART = 1.2
"""How far from one another players start [m]."""
STEP, ROOM = 0.2, 0.25
"""Who starts beside somebody stands no more than a step higher [m], so far from whatever stands there [m] …"""
BODY = np.array([[0.0, height, 0.0] for height in (0.3, 0.8, 1.3, 1.8)])
"""… all the way up."""
TINTS = (TINT, (0.20, 0.46, 0.72))
"""What tells the players apart."""


@dataclass(frozen=True, eq=False)
class Player:
    """One pair of hands: its pilot, how it steers, where it aims, its camera now and (`last`) a tick ago. goal: where its character
    is sent, until the hands ask for something else. pushed: its character is pushed in the next step. run_up: what is known of a leap that is wanted
    at a run."""

    pilot: Pilot
    camera: PlayerCamera
    last: PlayerCamera
    steering: Steering = STEERING
    aim: Aim = Aim()
    goal: Goal | None = None
    pushed: bool = False
    run_up: RunUp = RunUp()

    @staticmethod
    def behind(character: Character) -> Player:
        """Fresh hands, and a camera at rest behind a character."""
        camera = Follow.behind(character.state.ground, level=character.level)
        return Player(Pilot(), camera, camera)

    def view(self, alpha: float) -> Camera:
        """The camera to draw with, `alpha` (0 … 1) of the way through the last tick."""
        return between(self.last, self.camera, alpha)


@dataclass(frozen=True, eq=False)
class SessionState:
    """All of a session after a tick.

    before, after: the worlds that the last step of the simulation led from and to; player i moves
    character i. opening: the world that a reset returns to. number: ticks since the session began,
    whatever became of the world meanwhile. slow: ticks that a step of the world takes. phase: those
    made since the last step. comparison: what is reconstructed of the first player, by characters that come last in the
    worlds; methods: where what they need is learnt. passers: what passers-by do, whose characters come after the players.
    """

    before: World
    after: World
    players: tuple[Player, ...]
    opening: World
    number: int = 0
    paused: bool = False
    slow: int = 1
    phase: int = 0
    comparison: Comparison | None = None
    methods: Methods = field(default_factory=methods)
    passers: tuple[Script, ...] = ()

    def fraction(self, alpha: float) -> float:
        """How far from `before` to `after` the world is, `alpha` of the way through the last tick."""
        return 1.0 if self.paused else min((self.phase + alpha) / self.slow, 1.0)

    def figures(self, alpha: float) -> tuple[Figure, ...]:
        """What to draw of the characters."""
        return figures(self.before, self.after, self.fraction(alpha))

    def setting(self, name: str, player: int = 0) -> float | None:
        """What a player's setting stands at; None where the controller has no such thing."""
        return settings.value(owners(self, player), name)


def opening(controller: Any, players: int = 1, learnt: Methods | None = None) -> SessionState:
    """The first moment: so many players side by side, with a course to jump on to their left.

    learnt: the methods of its comparisons; those over Gambol's own motion by default.
    """
    return begin(World(tuple(newcomer(controller, n, np.zeros(3)) for n in range(players)), COURSE), players, learnt)


def begin(world: World, players: int = 1, learnt: Methods | None = None) -> SessionState:
    """The first moment in a world, whose first characters the players move."""
    return SessionState(world, world, tuple(Player.behind(c) for c in world.characters[:players]), world,
                  methods=methods() if learnt is None else learnt)


def newcomer(controller: Any, number: int, ground: np.ndarray, level: float = 0.0, props: Sequence[Prop] = ()) -> Character:
    """Player `number`, to the right of the first, who stands at `ground` on a floor at `level` [m]; where something stands there to his left,
    or farther away, as props leave room."""
    heading = float(ground[2])
    for side in APART * number * np.array([1.0, -1.0, 2.0, -2.0, 3.0, -3.0]):
        x, z = float(ground[0] - side * np.cos(heading)), float(ground[1] + side * np.sin(heading))
        floor = floor_at(x, z, props, level + STEP)
        body = np.array([x, floor, z]) + BODY
        if (clearance(body, props) > ROOM).all():
            break
    return Character(f"Player {number + 1}", controller, tint=TINTS[number], state=controller.start((x, z, heading), floor))


def owners(moment: SessionState, who: int) -> dict[str, Any]:
    """Whose settings player `who` tunes, by the owner's name; None where there is no such owner."""
    player = moment.players[who]
    return {"locomotion": moment.after.characters[who].controller.settings,
            "steering": player.steering, "pace": player.pilot.pace, "camera": player.camera.settings}
