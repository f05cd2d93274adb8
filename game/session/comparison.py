"""A comparison: somebody who plays, and beside them bodies that know a few points of theirs and nothing else.

Or hands hold the points: each is pinned to a place, or is not seen. What hands and streams do comes as actions of a
wish, so that a log has all of it: "study=ours lpcr@4" opens, "study=" closes; "pins=hold" takes hold of the points,
"pins=" gives them back; "pin=2:x/y/z" pins one, "pin=2:" hides it, "pins=x/y/z;;x/y/z" does so with all of them. Where
a point is turned, too, as trackers are, a unit quaternion follows its place: x/y/z/i/j/k/w.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from ..input import Wish
from ..world import METHODS, NAMES, SHIPPED, TINTS, Character, Follows, Methods, World, beginning, follower_of
from .settings import SettingError

SETS = ("2", "3", "4", "5", "6")
"""The points that one goes through."""
GHOSTS: tuple[tuple[str, ...], ...] = ((), ("ours",), ("lpcr", "lpca"), ("lpcr",), ("lpca",), ("nearest",))
"""The ghosts that one goes through, but for one that has the body itself."""
ASIDE = 1.4
"""How far to the right of the performer the others are [m]."""
ABREAST = 0.95
"""… nearer where players share the picture, so that all of them is in the performer's part of it; on the left where somebody is
within CROWDED [m] of that."""
CROWDED = 0.8
GHOST = 0.34
"""The opacity of a ghost."""
ACTIONS = frozenset(("study", "pins", "pin"))
"""What comes before the "=" of an action that is about a comparison."""
FAR = 1e3

Place = tuple[float, float, float]
Turn = tuple[float, float, float, float]


@dataclass(frozen=True)
class Comparison:
    """methods: by name; the first one's is the body, the others' are ghosts. points: as `controls.parse` has them.

    beside: from the performer [m]. pins: where hands hold each of the n points [m], None where it is not seen; None
    altogether while the performer has them. turned: how each is turned, None where that is not known; empty where none is.
    """

    methods: tuple[str, ...] = (SHIPPED,)
    points: str = "6"
    beside: Place = (0.0, 0.0, 0.0)
    pins: tuple[Place | None, ...] | None = None
    turned: tuple[Turn | None, ...] = ()

    @property
    def action(self) -> str:
        """The action that opens it."""
        return f"study={' '.join(self.methods)}@{self.points}"

    @property
    def count(self) -> int:
        """How many points there are."""
        from gambol.controllers.reconstruction import control_points as controls  # a game without a study starts without

        return len(controls.SETS.get(self.points, self.points.split(",")))

    @property
    def goals(self) -> np.ndarray | None:
        """The pins as points (n, 3) [m], NaN where one is not seen."""
        return None if self.pins is None else np.array([(math.nan,) * 3 if pin is None else pin for pin in self.pins])

    @property
    def turns(self) -> np.ndarray | None:
        """How the points are turned (n, 3, 3), NaN where that is not known; None where none is."""
        if not any(self.turned):
            return None
        return np.array([np.full((3, 3), math.nan) if turn is None else Rotation.from_quat(turn).as_matrix() for turn in self.turned])

    def more_points(self) -> Comparison:
        """With the next set of points."""
        at = SETS.index(self.points) if self.points in SETS else -1
        return replace(self, points=SETS[(at + 1) % len(SETS)], pins=None, turned=())

    def other_ghosts(self) -> Comparison:
        """With the next ghosts."""
        others = [ghosts for ghosts in GHOSTS if self.methods[0] not in ghosts]
        at = others.index(self.methods[1:]) if self.methods[1:] in others else -1
        return replace(self, methods=(self.methods[0], *others[(at + 1) % len(others)]))


def opened(action: str) -> Comparison | None:
    """The comparison that "study=METHOD METHOD@POINTS" asks for; None for "study=". SettingError for anything else."""
    text = action.partition("=")[2]
    if not text:
        return None
    names, at, points = text.partition("@")
    methods = tuple(names.split())
    if not at or not methods or len(set(methods)) < len(methods) or not set(methods) <= set(METHODS):
        raise SettingError(f"{action}: needs methods of {', '.join(METHODS)}, then @ and points")
    return Comparison(methods, points)


def wanted(ticks: Iterable[Iterable[Wish]]) -> tuple[tuple[str, str], ...]:
    """The methods, name and points, that wishes open comparisons with, so that they can be learnt before."""
    found: dict[tuple[str, str], None] = {}
    for action in (action for wishes in ticks for wish in wishes for action in wish.pressed if action.startswith("study=")):
        with suppress(SettingError):  # told of where it is played
            open_ = opened(action)
            if open_ is not None:
                found |= {(name, open_.points): None for name in open_.methods}
    return tuple(found)


def joined(comparison: Comparison, performer: Character, methods: Methods, before: Mapping[str, Character],
           sharing: Sequence[Character] = ()) -> tuple[Comparison, tuple[Character, ...]]:
    """The comparison beside a performer, and its followers: those from `before`, by name, that go on, and others as they begin.

    sharing: everybody else, where players share the picture. SettingError for points that there are not.
    """
    try:
        learnt = [(name, methods(name, comparison.points)[1]) for name in comparison.methods]
    except ValueError as error:
        raise SettingError(f"{comparison.action}: {error}") from None
    beside = comparison.beside if any(comparison.beside) else _aside(performer, sharing)
    made: list[Character] = []
    for number, (name, points) in enumerate(learnt):
        kept = before.get(NAMES[name])
        if kept is not None and kept.follows is not None and kept.follows.controls.names == points.names:
            made.append(replace(kept, opacity=GHOST if number else 1.0))
            continue
        # where hands hold the points, like the body that they move
        like, aside = (performer, np.array(beside)) if comparison.pins is None or not made else (made[0], np.zeros(3))
        follows = Follows(name, points, performer.name if comparison.pins is None else "", np.array(beside))
        someone = follower_of(performer.controller, name, comparison.points, methods)
        made.append(Character(NAMES[name], someone, beginning(someone, like.state, aside), TINTS[name],
                              follows=follows, opacity=GHOST if number else 1.0))
    return replace(comparison, beside=beside), tuple(made)


def _aside(performer: Character, sharing: Sequence[Character]) -> Place:
    """Where followers stand, from the performer [m]."""
    x, z, heading = (float(v) for v in performer.state.ground)
    right = -math.cos(heading), math.sin(heading)
    if not sharing:
        return ASIDE * right[0], 0.0, ASIDE * right[1]

    def room(side: float) -> float:
        at = x + side * right[0], z + side * right[1]
        return min(min(math.dist(at, one.state.ground[:2]) for one in sharing), CROWDED)
    side = max((ABREAST, -ABREAST), key=room)  # the right one where both are free
    return side * right[0], 0.0, side * right[1]


def pinned(comparison: Comparison, action: str, world: World) -> tuple[Comparison, World]:
    """The comparison and the world after an action "pins=…" or "pin=…"; SettingError for one that says nothing sound."""
    body, follows = next((one, one.follows) for one in world.characters if one.follows is not None)
    name, _, text = action.partition("=")
    count = len(follows.controls)
    if name == "pins" and not text:
        return _given_back(comparison, world, body)
    if name == "pins" and text == "hold":
        pins, turned = tuple(_place(*at) for at in follows.controls.on(*body.joints)), ()
    elif name == "pins":
        places = text.split(";")
        if len(places) != count:
            raise SettingError(f"{action}: needs {count} places with semicolons, one for each point")
        pins, turned = zip(*(_read(action, place) for place in places), strict=True)
    else:
        number, colon, place = text.partition(":")
        if comparison.pins is None or not colon or not (number.isascii() and number.isdecimal()) or len(number) > 9 or int(number) >= count:
            raise SettingError(f"{action}: needs a point's number below {count}, a colon and its place, once points are held")
        one = _read(action, place)
        pins = tuple(one[0] if n == int(number) else pin for n, pin in enumerate(comparison.pins))
        turned = tuple(one[1] if n == int(number) else turn for n, turn in enumerate(comparison.turned or (None,) * count))
    if comparison.pins is None:
        world = replace(world, characters=tuple(
            one if one.follows is None else replace(one, follows=replace(one.follows, performer=""), told=one.told[:0])
            for one in world.characters))
    return replace(comparison, pins=pins, turned=turned if any(turned) else ()), world


def _given_back(comparison: Comparison, world: World, body: Character) -> tuple[Comparison, World]:
    """The points are the performer's again; the bodies stay where they are."""
    if comparison.pins is None:
        return comparison, world
    performer = world.characters[0]
    x, _, z = np.asarray(body.state.pose.root, float) - performer.state.pose.root
    beside = (float(x), 0.0, float(z))
    return replace(comparison, pins=None, turned=(), beside=beside), replace(world, characters=tuple(
        one if one.follows is None else
        replace(one, follows=replace(one.follows, performer=performer.name, beside=np.array(beside)), told=one.told[:0])
        for one in world.characters))


def written(place: np.ndarray, turn: np.ndarray | None = None) -> str:
    """A place (3,) [m] as actions have it, to a tenth of a millimetre, and a turn (3, 3) where it is known; empty for one that is not seen, or so
    far away that nobody can be there."""
    if not (np.abs(np.round(place, 4)) < FAR).all():
        return ""
    quaternion = () if turn is None or not np.isfinite(turn).all() else Rotation.from_matrix(turn).as_quat()
    return "/".join(f"{v:.4f}" for v in (*place, *quaternion))


def _read(action: str, text: str) -> tuple[Place | None, Turn | None]:
    if not text:
        return None, None
    try:
        x, y, z, *quaternion = (float(v) for v in text.split("/"))
    except ValueError:
        x, y, z, quaternion = math.nan, math.nan, math.nan, []
    if not all(abs(v) < FAR for v in (x, y, z)):
        raise SettingError(f"{action}: needs places as x/y/z in metres")
    if not quaternion:
        return _place(x, y, z), None
    if len(quaternion) != 4 or not 0.9 < math.hypot(*quaternion) < 1.1:
        raise SettingError(f"{action}: needs turns as unit quaternions i/j/k/w after the place")
    i, j, k, w = quaternion
    return _place(x, y, z), (i, j, k, w)


def _place(x: float, y: float, z: float) -> Place:
    return float(x), float(y), float(z)
