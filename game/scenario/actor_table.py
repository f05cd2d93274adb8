"""What a scenario's `[[actors]]` may say: who acts, in whose body, from where, and when it is there."""

from __future__ import annotations

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from gambol.controllers.body import STATURE
from gambol.controllers.contract import HARDEST, Strike
from gambol.controllers.jump import Jump as JumpController, Physique, mass_of

from ..input import Script
from ..scene import TINT, Prop
from ..world import RATE, TINTS
from .fields import Colour, Degrees, FileName, Flexibility, Gravity, Mass, Metres, Moment, Seconds, Stature, Strength, Table
from .follows_table import FollowsTable
from .tracks_table import TracksTable
from .move_table import MoveTable

TRACKED = (0.16, 0.30, 0.62)
"""The colour of who tracks, linear RGB."""


class BodyTable(Table):
    """Whose body: height [m], mass [kg], strength and flexibility as shares of an adult's, sex.

    By default the mass goes with the cube of the height.
    """

    height: Stature = STATURE
    mass: Mass | None = None
    strength: Strength = 1.0
    flexibility: Flexibility = 1.0
    sex: Literal["male", "female"] = "male"

    def physique(self) -> Physique:
        """The same for the controllers."""
        mass = mass_of(self.height) if self.mass is None else self.mass
        return Physique(mass, self.height, self.strength, self.flexibility, self.sex)


class StrikeTable(Table):
    """What strikes somebody: at [s] after he has entered; impulse [N·s]; towards: where it pushes him [degrees], 0 along z, 90 along x; height [m] over the floor, his
    chest by default."""

    at: Moment
    impulse: Annotated[float, Field(gt=0, le=HARDEST, allow_inf_nan=False)]
    towards: Degrees
    height: Annotated[float, Field(ge=0, le=3, allow_inf_nan=False)] | None = None

    def strike(self) -> tuple[int, Strike]:
        """In which step of his script, and what."""
        angle = math.radians(self.towards)
        return round(RATE * self.at), Strike((self.impulse * math.sin(angle), self.impulse * math.cos(angle)), self.height)


class ActorTable(Table):
    """Somebody. name: who; files are named after it. tint: red, green, blue, 0 … 1. start: x, z [m], on whatever is highest there, and heading
    [degrees], 0 along z, 90 along x. moves: what he does, one after the other.

    body: an adult by default. gravity: what pulls it down as it jumps [m/s²]; the scenario's by default. follows: whose
    points it follows instead of moves of its own. tracks: whom cameras see, whose motion is tracked. ghost: one sees through it.
    enters, leaves: when it is there [s], from the beginning to the end by default; its moves begin as it enters. group: those of
    the same name walk together, side by side, where actors avoid each other. strikes: what strikes him, and when. Who follows an actor comes and goes with it.
    """

    name: FileName = "A"
    tint: Colour = TINT
    ghost: bool = False
    follows: FollowsTable | None = None
    tracks: TracksTable | None = None
    start: tuple[Metres, Metres, Degrees] = (0.0, 0.0, 0.0)
    body: BodyTable | None = None
    gravity: Gravity | None = None
    enters: Moment = 0.0
    leaves: Seconds | None = None
    group: FileName | None = None
    moves: tuple[MoveTable, ...] = ()
    strikes: tuple[StrikeTable, ...] = ()

    @model_validator(mode="after")
    def _own_will_or_points(self):
        if self.follows is not None and self.tracks is not None:
            raise ValueError("somebody either follows points or tracks; name one of them")
        if self.follows is not None or self.tracks is not None:
            for name in ("start", "body", "gravity", "enters", "leaves", "moves", "strikes"):
                if name in self.model_fields_set:
                    who = "who follows points" if self.tracks is None else "who tracks"
                    raise ValueError(f"{who} has no {name}: that is the performer's")
        if self.leaves is not None and self.leaves <= self.enters:
            raise ValueError(f"`enters` comes before `leaves`; got {self.enters:g} and {self.leaves:g}")
        return self

    @property
    def gone(self) -> float:
        """When it is no longer there [s]."""
        return math.inf if self.leaves is None else self.leaves

    @property
    def colour(self) -> tuple[float, float, float]:
        """Its tint; that of its method where none is given."""
        if "tint" in self.model_fields_set or self.follows is None and self.tracks is None:
            return self.tint
        return TRACKED if self.follows is None else TINTS[self.follows.method]

    def jumper(self, gravity: float) -> JumpController:
        """Its jumps, where the scenario has that gravity."""
        pull = gravity if self.gravity is None else self.gravity
        return JumpController(Physique() if self.body is None else self.body.physique(), np.array([0.0, -pull, 0.0]))

    def script(self, jumper: JumpController = JumpController(), props: tuple[Prop, ...] = ()) -> Script:
        """What it does, among props."""
        moves = tuple(step for move in self.moves for step in move.moves(jumper, props))
        return Script(moves, strikes=tuple(strike.strike() for strike in self.strikes))
