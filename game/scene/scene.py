"""What a frame shows: plain data between the world that makes it and the renderer that draws it."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from .draw_list import Ink
from .help_sheet import Sheet


TINT = (0.75, 0.42, 0.22)
"""Whoever has no tint of their own has this, linear RGB."""


@dataclass(frozen=True, eq=False)
class Camera:
    """A pinhole camera. eye, target, up: (3,) [m] in the world. fov: vertical field of view [rad]."""

    eye: np.ndarray
    target: np.ndarray
    up: np.ndarray = field(default_factory=lambda: np.array([0.0, 1.0, 0.0]))
    fov: float = 0.8


@dataclass(frozen=True, eq=False)
class Line:
    """A line to explain with. layer: the overlay that it belongs to. points: (N, 3) [m]. width: [m].

    opacity: of its first and its last point. flat: it lies instead of facing the camera. through:
    bodies don't hide it.
    """

    layer: str
    points: np.ndarray
    tint: tuple[float, float, float]
    width: float = 0.02
    opacity: tuple[float, float] = (1.0, 1.0)
    dashed: bool = False
    flat: bool = False
    through: bool = False


@dataclass(frozen=True, eq=False)
class Arrow:
    """An arrow in front of everything, from `start` (3,) as far as `along` (3,) [m]."""

    layer: str
    start: np.ndarray
    along: np.ndarray
    tint: tuple[float, float, float]
    width: float = 0.03


@dataclass(frozen=True, eq=False)
class Dot:
    """A disc that faces the camera, or lies flat. quartered: the sign of a centre of mass. look: "ball" for a small
    sphere, "ring" for a hollow one."""

    layer: str
    place: np.ndarray
    tint: tuple[float, float, float]
    radius: float = 0.03
    flat: bool = False
    quartered: bool = False
    through: bool = False
    look: str = "disc"
    opacity: float = 1.0


@dataclass(frozen=True, eq=False)
class Patch:
    """A filled convex polygon, corners (N, 3) [m]."""

    layer: str
    corners: np.ndarray
    tint: tuple[float, float, float]
    opacity: float = 0.3
    through: bool = False


Sketch = Line | Arrow | Dot | Patch


@dataclass(frozen=True, eq=False)
class Figure:
    """One character to draw.

    positions, orientations: (J, 3) [m], (J, 3, 3) world transforms of the standard human's joints.
    tint: (3,) linear RGB. contacts: (4,) bool, left heel, left ball, right heel, right ball.
    trail, path: (N, 3), (M, 3) [m] where the character was and where it is predicted to go.
    body: what it wears (`gambol.game.render.mesh.Body`); None for Gambol's mannequin. sketches: what
    explains its motion, each in a layer of its own. opacity: less than 1 for a ghost, which casts no shadow; 0 for
    somebody of whom nothing is seen, sketches neither. cover: less than 1 for a body that stands in a camera's way and
    is seen through; unlike a ghost it keeps its colours and its shadow.
    """

    positions: np.ndarray
    orientations: np.ndarray
    tint: tuple[float, float, float] = TINT
    contacts: np.ndarray = field(default_factory=lambda: np.zeros(4, bool))
    trail: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    path: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    body: Any = None
    sketches: tuple[Sketch, ...] = ()
    opacity: float = 1.0
    cover: float = 1.0


@dataclass(frozen=True)
class Box:
    """A solid box on the stage (walls, platforms, steps): centre [m], full size [m], heading [rad].

    slope: how it rises along its own z, metres a metre: a ramp is a box whose top and bottom are pushed aslant.
    """

    centre: tuple[float, float, float]
    size: tuple[float, float, float]
    heading: float = 0.0
    tint: tuple[float, float, float] = (0.36, 0.37, 0.40)
    slope: float = 0.0


@dataclass(frozen=True)
class Pillar:
    """A solid upright cylinder: the middle of its foot [m], radius [m], height [m]."""

    foot: tuple[float, float, float]
    radius: float = 0.25
    height: float = 2.5
    tint: tuple[float, float, float] = (0.36, 0.37, 0.40)


@dataclass(frozen=True)
class Goal:
    """A place to reach, which nothing bumps into: a ring on the floor (or a platform) and a faint column of light."""

    place: tuple[float, float, float]
    radius: float = 0.4
    tint: tuple[float, float, float] = (0.95, 0.62, 0.15)


Prop = Box | Pillar | Goal


@dataclass(frozen=True)
class Caption:
    """The title of a film or a shot: a large line, a smaller one under it. opacity: 0 … 1."""

    text: str
    under: str = ""
    opacity: float = 1.0


@dataclass(frozen=True)
class Hint:
    """A line in the middle below that teaches. parts: words, and names of keys (True) among them. opacity: 0 … 1. room: from where
    to where there is room for it, in parts of the picture's width."""

    parts: tuple[tuple[str, bool], ...]
    opacity: float = 1.0
    room: tuple[float, float] = (0.0, 1.0)


@dataclass(frozen=True)
class Overlays:
    """What to draw beside the bodies."""

    mesh: bool = True
    skeleton: bool = False
    contacts: bool = False
    trail: bool = False
    path: bool = False
    jump: bool = False
    balance: bool = False
    forces: bool = False
    points: bool = False
    errors: bool = False
    cameras: bool = False


OVERLAYS = tuple(part.name for part in fields(Overlays))
"""The overlays by name."""


@dataclass(frozen=True, eq=False)
class Scene:
    """All of one frame, or of one part of it where several views stand side by side.

    text: lines for the top-left corner, which keep off what lies over the top-right one: taken, its width and height [px]. sheet: the help sheet, in the middle of the whole picture.
    hint: in the middle below, of the whole picture. ink: panels, over the whole picture.
    part: left, top, width, height of where it is shown, in parts of the picture.
    """

    camera: Camera
    figures: tuple[Figure, ...] = ()
    props: tuple[Prop, ...] = ()
    overlays: Overlays = Overlays()
    text: tuple[str, ...] = ()
    caption: Caption | None = None
    sheet: Sheet | None = None
    hint: Hint | None = None
    ink: Ink | None = None
    part: tuple[float, float, float, float] = (0.0, 0.0, 1.0, 1.0)
    taken: tuple[float, float] = (0.0, 0.0)
