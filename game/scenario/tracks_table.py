"""What a scenario's `tracks` may say: whom cameras see, which cameras, and what goes wrong with their pictures."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator, Field, model_validator

from gambol.controllers.body import Skeleton

from ..world import RATE, Filmed, Watches, watches_of
from .fields import Point3, Table, beside_the_file

Share = Annotated[float, Field(ge=0.0, le=1.0, allow_inf_nan=False)]


class TracksTable(Table):
    """Whom an actor is like: another `actor`, as cameras in a circle see their silhouettes, or somebody in a folder of `footage`.

    person: whom of the footage, the first by default; start: a motion file of their first poses, or a .toml file of where joints
    are seen, the truth's by default; masks: follow its masks instead of pictures. They stand where they were filmed.
    cameras, width: how many, and how many pixels wide; fps: frames a second. along: they go along with the performer, or stand
    about the origin. penalty: on jitter. wrong: share of pixels that are wrong; rectangles: in every frame, full or empty;
    corrupted: share of frames that show something else; seed: of that. beside: x, y, z [m] from the performer to the actor.
    """

    actor: str | None = None
    footage: Annotated[str, AfterValidator(beside_the_file)] | None = None
    person: str | None = None
    start: Annotated[str, AfterValidator(beside_the_file)] | None = None
    masks: bool = False
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

    @model_validator(mode="after")
    def _one_performer(self):
        if (self.actor is None) == (self.footage is None):
            raise ValueError('needs either actor = "…", another actor, or footage = "…", a folder')
        of_footage, given = {"person", "start", "masks"}, self.model_fields_set - {"actor", "footage", "beside"}
        for name in sorted(given - of_footage if self.actor is None else given & of_footage):
            raise ValueError(f"{name} goes with {'an actor' if self.actor is None else 'footage'}")
        if self.footage is not None:
            from ..footage import person_in, read_footage  # a scenario without any starts without

            person_in(read_footage(self.footage), self.person)  # says what is wrong with it
        return self

    def filmed(self, walker: Any) -> Filmed:
        """Who was filmed. walker: what walks for those who follow them. FootageError, MotionFileError, ClickError."""
        assert self.footage is not None  # one of the two is given, see `_one_performer`
        return Filmed.load(self.footage, walker, self.person, None if self.start is None else Path(self.start), self.masks)

    def watches(self, skeleton: Skeleton) -> Watches:
        """The same for the world, of a performer with a skeleton."""
        assert self.actor is not None
        return watches_of(self.actor, skeleton, self.cameras, self.width, every=RATE // self.fps, along=self.along,
                          beside=np.array(self.beside), wrong=self.wrong, rectangles=self.rectangles, corrupted=self.corrupted, seed=self.seed)
