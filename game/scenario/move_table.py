"""What a scenario's `moves` may say: where an actor walks, which way it jumps, for how long."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Annotated, Literal

from pydantic import Field, model_validator

from gambol.controllers.contract import Goal, Intent
from gambol.controllers.jump import Jump as JumpController
from gambol.controllers.jump.body import airtime_up
from gambol.controllers.navigation import floor_at

from ..input import Jump, Move
from ..scene import Prop
from .fields import Airtime, Degrees, Length, Pace, Place, Point, Seconds, Table, Velocity


KINDS = ("velocity", "walk_to", "go_to", "path", "stop", "jump_to", "jump", "hops")
"""What a move may be."""

TURNS: dict[str, tuple[Literal["left", "right", "both"], ...]] = {
    "both": ("both",), "left": ("left",), "right": ("right",), "alternate": ("left", "right"), "skip": ("left", "left", "right", "right")}
"""On which feet hops land, one after the other."""
STEP = 0.12
"""Who skips is in the air so long [s] for the step from one foot to the other, on Earth."""


class MoveTable(Table):
    """One move: exactly one of velocity, walk_to, go_to, path, stop, jump_to, jump and hops. Angles in degrees. for: how long [s].

    velocity: the whole speed [m/s], less than 0 backward, turning [rad/s] as fast as somebody can at that speed, and how much of that speed is to the left [m/s]: [0.5, 0, 0.5] is
    straight aside; until: what it has changed to at the end. walk_to: x, z [m], straight there; path: through several; speed: along them [m/s];
    facing: a heading to keep meanwhile. go_to: x, z [m] as people go there, round what stands about, to stand there with a `heading`, by
    default as it comes; arrive: no later than this after the move began [s]. A jump may have a `heading` to land in, too: then nobody turns to
    the place first, and turns in the air.

    jump_to: x, z [m], onto whatever is highest there, or x, y, z. jump: how high [m], straight up. A
    velocity (with its `for`), walk_to or path beside jump_to is its run-up; within: no farther from the landing than this
    [m] it jumps. airtime: [s]; by default of the least effort. aim: so long [s] one crouches before a jump without a run-up.

    hops: how many hops, each off the landing of the one before, up and down what is no higher than 0.4 m, and each so far `ahead` [m] (0: on the spot); airtime: of each. on: both feet, the
    left or the right one, one after the other, the left first, or, to skip, steps and hops in turn, on the left foot, then on the right; the last
    lands on both.
    """

    seconds: Seconds | None = Field(None, alias="for")
    velocity: Velocity | None = None
    until: Velocity | None = None
    walk_to: Point | None = None
    go_to: Point | None = None
    heading: Degrees | None = None
    arrive: Seconds | None = None
    path: Annotated[tuple[Point, ...], Field(min_length=1)] | None = None
    stop: Literal[True] | None = None
    jump_to: Place | None = None
    jump: Annotated[float, Field(gt=0, le=100, allow_inf_nan=False)] | None = None
    airtime: Airtime | None = None
    within: Length | None = None
    hops: Annotated[int, Field(ge=1, le=100)] | None = None
    ahead: Annotated[float, Field(ge=0, le=5, allow_inf_nan=False)] | None = None
    on: Literal["both", "left", "right", "alternate", "skip"] | None = None
    aim: Seconds | None = None
    speed: Pace | None = None
    facing: Degrees | None = None

    @model_validator(mode="after")
    def _one_thing(self):
        kinds = [k for k in KINDS if getattr(self, k) is not None]
        feet = [k for k in kinds if k in ("velocity", "walk_to", "path")]
        if len(kinds) != 1 and not (len(kinds) == 2 and "jump_to" in kinds and feet):
            raise ValueError(f"needs exactly one of {', '.join(KINDS)}, or jump_to with a run-up; "
                             f"has {' and '.join(kinds) or 'none'}")
        walks, jumps = kinds[0] in ("walk_to", "path"), kinds[-1] in ("jump_to", "jump", "hops")
        for name, fits, with_ in (("aim", jumps and not feet, "jump, hops or jump_to without a run-up"),
                                  ("airtime", self.jump_to is not None or self.hops is not None, "jump_to or hops; a jump has its height"),
                                  ("ahead", self.hops is not None, "hops: how far ahead each goes"),
                                  ("on", self.hops is not None, "hops: which feet they are on"),
                                  ("within", self.jump_to is not None and bool(feet), "jump_to and a run-up")):
            if getattr(self, name) is not None and not fits:
                raise ValueError(f"`{name}` goes with {with_}")
        if self.seconds is None and not walks and not (jumps and not feet) and self.go_to is None:
            raise ValueError(f"{kinds[0]} needs `for`, how many seconds it lasts")
        if self.until is not None and kinds[0] != "velocity":
            raise ValueError("`until` goes with velocity: where it has changed to at the end")
        if self.speed is not None and not walks:
            raise ValueError("`speed` goes with walk_to or path; velocity has its own, and who goes to a place walks as people do, or as `arrive` asks")
        if self.facing is not None and kinds[0] == "velocity":
            raise ValueError("`facing` goes with walk_to, path or stop; velocity has its own ω")
        if self.facing is not None and jumps:
            raise ValueError("`facing` goes with walk_to, path or stop; who jumps faces where it goes, or lands with a `heading`")
        if self.facing is not None and self.go_to is not None:
            raise ValueError("`facing` goes with walk_to, path or stop; who goes to a place turns as people do, and stands there with a `heading`")
        if self.heading is not None and self.go_to is None and (not jumps or self.hops is not None):
            raise ValueError("`heading` goes with go_to, jump_to or jump: how one stands there, or lands")
        if self.arrive is not None and self.go_to is None:
            raise ValueError("`arrive` goes with go_to")
        for name in ("velocity", "until"):
            value = getattr(self, name)
            if value is not None and abs(value[2]) > abs(value[0]) + 1e-9:
                raise ValueError(f"{name} is [v_t, ω, v_l] and |v_l| ≤ |v_t|, as v_t is the whole speed; "
                                 f"got v_t = {value[0]:g}, v_l = {value[2]:g}")
        return self

    def moves(self, jumper: JumpController = JumpController(), props: tuple[Prop, ...] = ()) -> tuple[Move, ...]:
        """The same in SI units, for somebody who jumps among props: one move, or one for each hop."""
        made = self.move(jumper, props)
        if made.jump is None or self.hops is None:
            return (made,)
        feet = TURNS[self.on or "both"]
        jumps = [replace(made.jump, aims=made.jump.aims if n == 0 else 0.0, on=feet[n % len(feet)] if n < self.hops - 1 else None)
                 for n in range(self.hops)]
        if self.on == "skip":
            step = STEP * math.sqrt(9.81 / -jumper.gravity[1])
            jumps[:-1:2] = [replace(jump, airtime=step) for jump in jumps[:-1:2]]
        return tuple(replace(made, jump=jump) for jump in jumps)

    def move(self, jumper: JumpController = JumpController(), props: tuple[Prop, ...] = ()) -> Move:
        """The same in SI units, for somebody who jumps among props; of hops the first."""
        points = self.path or ((self.walk_to,) if self.walk_to is not None else ())
        leap, heading = None, None if self.heading is None else math.radians(self.heading)
        if self.jump is not None:
            leap = Jump(airtime=airtime_up(jumper.physique, self.jump, jumper.gravity), aims=self.aim or 0.0, heading=heading)
        elif self.jump_to is not None:
            x, z = self.jump_to[0], self.jump_to[-1]
            y = self.jump_to[1] if len(self.jump_to) == 3 else floor_at(x, z, props)
            leap = Jump((x, y, z), self.airtime, self.within, math.sqrt(9.81 / -jumper.gravity[1]), self.aim or 0.0, heading)
            points = (*points, (x, z)) if points else ()
        elif self.hops is not None:
            leap = Jump(airtime=self.airtime, aims=self.aim or 0.0, hop=self.ahead or 0.0, around=tuple(props))
        return Move(seconds=math.inf if self.seconds is None else self.seconds,
                    velocity=_forward(self.velocity or (0.0, 0.0, 0.0)),
                    until=None if self.until is None else _forward(self.until),
                    points=points, speed=self.speed or 1.2,
                    facing=None if self.facing is None else math.radians(self.facing), jump=leap,
                    goal=None if self.go_to is None else Goal(self.go_to, heading, self.arrive))


def _forward(velocity) -> tuple[float, float, float]:
    """(v_f, ω, v_l) of (v_t, ω, v_l)."""
    forward, turning, left = (float(v) for v in Intent.tangential(*velocity).velocity)
    return forward, turning, left
