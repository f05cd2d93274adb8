"""What a scenario's `tracks` may say: whom cameras see, which cameras, and what goes wrong with their pictures."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from gambol.controllers.body import Skeleton

from ..world import RATE, Watches, watches_of
from .fields import Point3, Table

Share = Annotated[float, Field(ge=0.0, le=1.0, allow_inf_nan=False)]


class TracksTable(Table):
    """Whom an actor is like, as cameras in a circle see them: the silhouettes of another `actor`.

    cameras, width: how many, and how many pixels wide; fps: frames a second. along: they go along with the performer, or stand
    about the origin. penalty: on jitter. wrong: share of pixels that are wrong; rectangles: in every frame, full or empty;
    corrupted: share of frames that show something else; seed: of that. beside: x, y, z [m] from the performer to the actor.
    """

    actor: str
    cameras: Annotated[int, Field(ge=1, le=16)] = 4
    width: Annotated[int, Field(ge=64, le=1280)] = 320
    fps: Literal[15, 20, 30, 60] = 30
    along: bool = True
    penalty: bool = True
    wrong: Annotated[float, Field(ge=0.0, le=0.4, allow_inf_nan=False)] = 0.0
    rectangles: Annotated[int, Field(ge=0, le=100)] = 0
    corrupted: Share = 0.0
    seed: Annotated[int, Field(ge=0)] = 0
    beside: Point3 = (0.0, 0.0, 0.0)

    def watches(self, skeleton: Skeleton) -> Watches:
        """The same for the world, of a performer with a skeleton."""
        return watches_of(self.actor, skeleton, self.cameras, self.width, every=RATE // self.fps, along=self.along,
                          beside=np.array(self.beside), wrong=self.wrong, rectangles=self.rectangles, corrupted=self.corrupted, seed=self.seed)
