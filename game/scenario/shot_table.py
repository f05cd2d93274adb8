"""What a scenario's `[[shots]]` may say: cameras, captions, what is drawn over, views side by side."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, model_validator

from ..scene import OVERLAYS, Overlays
from .fields import Degrees, Length, Moment, Point3, Table, one_of

Shown = tuple[Annotated[str, one_of(OVERLAYS)], ...]
Names = Annotated[tuple[str, ...], BeforeValidator(lambda v: (v,) if isinstance(v, str) else v), Field(min_length=1)]
Part = tuple[float, float, float, float]
Panel = Literal["space", "plots"]
"""The panels that films show: those that tell of an actor, and ask for no hands."""
_NEEDS = {"follow": (), "orbit": (), "fixed": ("eye",), "dolly": ("path",)}
_TAKES = {"follow": {"actor", "height", "distance", "around", "above", "swing"},
          "orbit": {"actor", "target", "height", "distance", "around", "above", "turn"},
          "fixed": {"eye", "target", "look_at", "height"}, "dolly": {"path", "target", "look_at", "height"}}
_HAVE = set().union(*_TAKES.values())


class CameraTable(Table):
    """One camera: of which kind, how far away (distance [m]), how wide it sees (fov [degrees], from top to bottom).

    follow: an actor, looking `around` degrees to the left of its heading at the cut and from
    `above` degrees over the horizon; with `swing` it comes round behind. orbit: the same, turning by
    `turn` degrees until the cut, round an actor or a `target`. fixed: from `eye`. dolly: along the
    points of `path`. The last two look at `target`, or at the middle of the actors in `look_at`, and stay where they are put.
    What stands between brings a follow nearer, and an orbit without a `distance`; with one it keeps it, and is only moved out of what it would be inside of.
    Actors are looked at `height` metres above the floor.
    """

    kind: Literal["follow", "fixed", "dolly", "orbit"] = "follow"
    actor: str | None = None
    height: Annotated[float, Field(ge=0, le=10)] = 1.0
    distance: Length = 4.5
    around: Degrees = 0.0
    above: Annotated[float, Field(gt=-20, lt=80)] = 12.0
    swing: bool = True
    turn: Degrees = 90.0
    eye: Point3 | None = None
    path: Annotated[tuple[Point3, ...], Field(min_length=2)] | None = None
    target: Point3 | None = None
    look_at: Names | None = None
    fov: Annotated[float, Field(gt=5, lt=120)] = 46.0
    overlays: Shown | None = None

    @model_validator(mode="after")
    def _complete(self):
        article = "an" if self.kind == "orbit" else "a"
        for name in _HAVE - _TAKES[self.kind]:
            if name in self.model_fields_set:
                kinds = " or ".join(kind for kind, takes in _TAKES.items() if name in takes)
                raise ValueError(f"{article} {self.kind} shot has no {name}; that goes with kind = {kinds}")
        for name in _NEEDS[self.kind]:
            if getattr(self, name) is None:
                shape = "[[x, y, z], …]" if name == "path" else "[x, y, z]"
                raise ValueError(f"{article} {self.kind} shot needs {name} = {shape}")
        if self.kind in ("fixed", "dolly") and (self.target is None) == (self.look_at is None):
            raise ValueError(f"a {self.kind} shot needs either target = [x, y, z] or look_at = an actor's name")
        if self.eye is not None and self.eye == self.target:
            raise ValueError("eye and target are the same place: a camera needs somewhere to look")
        if self.kind == "orbit" and self.target is not None and self.actor is not None:
            raise ValueError("an orbit shot goes round an actor or a target, not both")
        return self

    @property
    def names(self) -> tuple[str, ...]:
        """The actors it is about."""
        return (self.look_at or ()) + (() if self.actor is None else (self.actor,))


class ViewTable(CameraTable):
    """One of several cameras that are shown at the same time. title: in its corner. overlays: drawn instead of the shot's own."""

    title: str = ""


class ShotTable(CameraTable):
    """What is seen from `at` seconds on: a camera, or several `views` side by side.

    caption, under: a large line and a smaller one, shown for some seconds. overlays: drawn
    instead of the scenario's own. panels: over the right of the picture, about the actor of its (first) camera.
    """

    at: Moment = 0.0
    caption: str = ""
    under: str = ""
    panels: tuple[Panel, ...] = ()
    views: Annotated[tuple[ViewTable, ...], Field(min_length=2, max_length=9)] | None = None

    @model_validator(mode="after")
    def _one_or_several(self):
        if self.views is not None:
            for name in ("kind", "fov", *sorted(_HAVE)):
                if name in self.model_fields_set:
                    raise ValueError(f"a shot with views has no {name} of its own; give it to its views")
        if self.under and not self.caption:
            raise ValueError("`under` stands under a caption; there is none")
        return self

    @property
    def cameras(self) -> tuple[CameraTable, ...]:
        """Its cameras, one for each view."""
        return (self,) if self.views is None else self.views


def parts(count: int, size: tuple[int, int]) -> tuple[Part, ...]:
    """Where `count` views stand in a picture of `size` pixels: left, top, width, height in parts of it.

    Up to three in a row, more in a grid whose last row is filled; a portrait picture stacks them.
    """
    if size[0] < size[1]:
        return tuple((top, left, height, width) for left, top, width, height in parts(count, (size[1], size[0])))
    columns = count if count <= 3 else math.ceil(math.sqrt(count))
    rows = math.ceil(count / columns)
    made = []
    for row in range(rows):
        inside = min(columns, count - row * columns)
        made += [(i / inside, row / rows, 1.0 / inside, 1.0 / rows) for i in range(inside)]
    return tuple(made)


def overlays(names) -> Overlays:
    """Overlays by name."""
    return Overlays(**{name: name in names for name in OVERLAYS})
