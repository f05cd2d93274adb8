"""A skeleton of one's own that moves as ours does: other names, axes, units, proportions and rest poses.

Each of its bones takes over how one of ours is turned in the world, on top of how it stands at rest itself; trunks and necks of more or fewer bones share theirs
out. Legs then reach for where our ankles are, by two-bone inverse kinematics, so that a foot that stands still stands still. It is `retarget` the other way round.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from ..body import STATURE, Skeleton, brief, exp, forward_kinematics, local_rotations, log, two_bone_turns
from .calibration import SIDES, has_limbs
from .joint_names import Roles, carriers, plain, roles
from .t_pose import HUMAN, REST, complete, to_t_pose, upright
from .units_and_axes import unit_of

_TRUNK, _NECK = ("Hips", "Spine", "Spine1", "Spine2"), ("Spine2", "Neck", "Head")
_LEG = "UpLeg", "Leg", "Foot"
HIPS = "hips", "hip", "pelvis"
HIGHEST = 0.3
"""An ankle at rest is no higher than this share of its leg's length over the sole."""


@dataclass(frozen=True, eq=False)
class Moved:
    """A rig in a pose, or in poses (...), in its own axes and units.

    local: (..., N, 3, 3) how each bone is turned in its parent's frame, the root's in the world. hips: (..., 3) where the hips are in their parent's frame (in the world, if
    they are the root); every other bone stays where it is in its parent's. places, turned: (..., N, 3), (..., N, 3, 3) all of them in the world.
    """

    __repr__ = brief

    local: np.ndarray
    hips: np.ndarray
    places: np.ndarray
    turned: np.ndarray


@dataclass(frozen=True, eq=False)
class Rig:
    """Somebody else's skeleton at rest, and which of our joints its bones follow; made by `Rig.of`.

    skeleton: its N bones in metres, Y up, facing +Z, each in the frame that it has at rest. rest: (N, 3, 3) how they are turned there. axes: (3, 3) what brings its own
    world there. unit: metres in one of its own units. roles: which bone plays which part. carry: (N, 3, 3) what brings each from rest into T-pose.
    driven: (D,) bones that follow ours, each one that is `share` (D,) of the way from joint low to joint high (D,). sole: how high its ankles are over the floor [m].
    """

    __repr__ = brief

    skeleton: Skeleton
    rest: np.ndarray
    axes: np.ndarray
    unit: float
    roles: Roles
    carry: np.ndarray
    driven: np.ndarray
    low: np.ndarray
    high: np.ndarray
    share: np.ndarray
    sole: float

    @classmethod
    def of(cls, names: Sequence[str], parents: np.ndarray, places: np.ndarray, turned: np.ndarray | None = None, *, parts: Mapping[str, str] | None = None,
           metres: float | None = None) -> Rig:
        """A rig of bones at rest: of which names, on which parents (N,), at which places (N, 3), and how turned (N, 3, 3), both in the world; not at all by default.

        Parents come before their children, one root first, whose parent is -1. The rest pose may be a T-pose, an A-pose or another with legs and arms about straight, facing
        anywhere. parts: a bone's name by that of our joint (`LeftArm`, …), where its own does not tell (`roles` does those of Mixamo, VRM, Unreal, Blender and others).
        metres: in one unit; by default what makes the leg a human's. Its soles are taken to be at 0, or under its toes where that can't be; `on_floor` knows better.
        ValueError, saying what is wrong, where no human can be made of it.
        """
        if isinstance(names, str) or not hasattr(names, "__len__") or not all(isinstance(name, str) for name in names):
            raise ValueError(f"names are bones' names, one for each; got {names!r}")
        if not all(isinstance(parent, int | np.integer) for parent in np.atleast_1d(np.asarray(parents, object)).ravel()):
            raise ValueError("parents are numbers of bones, -1 of the root")
        if metres is not None and not (isinstance(metres, float | int | np.floating | np.integer) and 0.0 < metres < np.inf):
            raise ValueError(f"metres, in one unit, is a number above zero, not {metres!r}")
        places = np.asarray(places, float)
        count = len(names)
        turned = np.tile(np.eye(3), (count, 1, 1)) if turned is None else np.asarray(turned, float)
        if places.shape != (count, 3) or turned.shape != (count, 3, 3) or len(parents) != count:
            raise ValueError(f"{count} names need parents ({count},), places ({count}, 3) and turns ({count}, 3, 3); they are {np.shape(parents)}, {places.shape}, {turned.shape}")
        wrong = ~(np.isfinite(places).all(-1) & (np.abs(np.swapaxes(turned, -1, -2) @ turned - np.eye(3)).max((-1, -2)) < 1e-3) & (np.linalg.det(turned) > 0.0))
        if wrong.any():
            raise ValueError(f"bone {names[int(np.argmax(wrong))]!r} is at no place, or its turn is no rotation: take scales and mirrors out of it")
        empty = Skeleton(tuple(names), np.asarray(parents), np.zeros((count, 3)), np.zeros(0, int), np.zeros((0, 3)))
        known = _given(empty, parts) if parts else _told(empty)
        at = {name: places[k] for name, k in known.limbs.items() if name in HUMAN}
        if known.trunk:
            at["Spine2"] = places[known.trunk[-1]]
        axes = upright(at)
        has_limbs(known, places, names)
        legs = _length(at, str)
        unit = unit_of(legs) if metres is None else float(metres)
        standing = unit * places @ axes.T
        sole = np.mean([standing[known.limbs[s + "Foot"], 1] for s in SIDES])
        if not 0.0 < sole < HIGHEST * unit * legs:
            sole = _sole(standing, known, unit * legs)
        turns = to_t_pose(complete({name: unit * axes @ place for name, place in at.items()}))
        carry, follows = np.tile(np.eye(3), (count, 1, 1)), {}
        for chain, ours in ((known.trunk, _TRUNK), (known.neck, _NECK)):
            for i, bone in enumerate(chain, 1):
                place = i / len(chain) * (len(ours) - 1)
                step = min(int(place + 1e-9), len(ours) - 2)
                follows[bone] = HUMAN.index(ours[step]), HUMAN.index(ours[step + 1]), place - step
        for name, bone in known.limbs.items():
            if name in HUMAN and bone not in follows:
                follows[bone] = HUMAN.index(name), HUMAN.index(name), 0.0
                carry[bone] = turns[HUMAN.index(name)]
        driven = np.array(sorted(follows))
        low, high, share = (np.array([follows[bone][i] for bone in driven]) for i in range(3))
        rest = axes @ turned
        offsets = standing - np.where(empty.parents[:, None] < 0, 0.0, standing[empty.parents])
        offsets[1:] = np.einsum("nji,nj->ni", rest[empty.parents[1:]], offsets[1:])
        skeleton = Skeleton(empty.names, empty.parents, offsets, np.zeros(0, int), np.zeros((0, 3)))
        return cls(skeleton, rest, axes, unit, known, carry, driven, low.astype(int), high.astype(int), share.astype(float), float(sole))

    def on_floor(self, height: float) -> Rig:
        """The same rig, whose soles at rest are that high, in its own unit; itself, where no ankle can be so high over them."""
        sole = float(np.mean([self._standing[self.roles.limbs[s + "Foot"], 1] for s in SIDES])) - self.unit * height
        return replace(self, sole=sole) if 0.0 < sole < HIGHEST * self._legs else self

    @cached_property
    def height(self) -> float:
        """How tall [m] the standard human is whose hips are as high: of `Physique(height)`, somebody goes as far with each step as this rig does."""
        return float(STATURE * (self._legs + self.sole) / (_length(REST, HUMAN.index) + REST[HUMAN.index("LeftFoot"), 1]))

    def pose(self, skeleton: Skeleton, root: np.ndarray, rotations: np.ndarray) -> Moved:
        """This rig as it stands as somebody of ours does: his skeleton, and his pose's root (..., 3) [m] and rotations (..., 22, 3, 3).

        All places are as many times as far from the origin as this rig is taller than he is: nobody slides. Make him of `height`, and they are where his are.
        """
        at, turned = forward_kinematics(skeleton, np.asarray(root, float), np.asarray(rotations, float))
        tall = skeleton.offsets[skeleton.index("LeftUpLeg"), 1] + skeleton.offsets[0, 1]
        ankle = tall - _length_of(skeleton)
        at = at * ((self._legs + self.sole) / tall)
        lower = self.sole - ankle * (self._legs + self.sole) / tall  # the sole, not the ankle, has to be where his is
        theirs = _part_way(turned[..., self.low, :, :], turned[..., self.high, :, :], self.share) @ (self.carry @ self.rest)[self.driven]
        world = self._all(theirs)
        middle = 0.5 * (at[..., HUMAN.index("LeftUpLeg"), :] + at[..., HUMAN.index("RightUpLeg"), :])
        places = self._placed(world, middle)
        for side in SIDES:
            hip, knee, foot = (HUMAN.index(side + part) for part in _LEG)
            a, b, c = (self.roles.limbs[side + part] for part in _LEG)
            target = at[..., foot, :] + turned[..., foot, :, 1] * lower
            line, bend = places[..., c, :] - places[..., a, :], at[..., knee, :] - at[..., hip, :]
            along = np.sum(bend * line, -1, keepdims=True) / np.maximum(np.sum(line * line, -1, keepdims=True), 1e-12)
            pole = bend - along * line + 0.02 * turned[..., hip, :, 2]
            upper, lower_ = two_bone_turns(places[..., a, :], places[..., b, :], places[..., c, :], target, pole)
            for bone, turn in ((a, upper), (b, lower_)):
                k = int(np.searchsorted(self.driven, bone))
                theirs[..., k, :, :] = turn @ theirs[..., k, :, :]
        world = self._all(theirs)
        places = self._placed(world, middle)
        return self._own(world, places)

    def at_rest(self) -> Moved:
        """This rig at rest."""
        return self._own(self.rest, self._standing)

    @property
    def _hips(self) -> int:
        return self.roles.limbs["Hips"]

    @cached_property
    def _legs(self) -> float:
        return _length(self._standing, self.roles.limbs.__getitem__)

    @cached_property
    def _standing(self) -> np.ndarray:
        return forward_kinematics(self.skeleton, self.skeleton.offsets[0], local_rotations(self.skeleton, self.rest))[0]

    @cached_property
    def _anchors(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """For each bone the nearest driven one above it or itself (N,), as an index into `driven` or -1; how it is turned in that one's frame (N, 3, 3); and whether the hips carry it."""
        anchor, carried = np.full(len(self.skeleton), -1), np.zeros(len(self.skeleton), bool)
        for bone, parent in enumerate(self.skeleton.parents):
            own = np.flatnonzero(self.driven == bone)
            anchor[bone] = own[0] if len(own) else anchor[parent] if parent >= 0 else -1
            carried[bone] = bone == self._hips or parent >= 0 and carried[parent]
        frames = np.where((anchor >= 0)[:, None, None], self.rest[self.driven[anchor]], np.eye(3))
        return anchor, np.swapaxes(frames, -1, -2) @ self.rest, carried

    def _all(self, theirs: np.ndarray) -> np.ndarray:
        """How all bones (..., N, 3, 3) are turned in the world, of those that are driven (..., D, 3, 3)."""
        anchor, inside, _ = self._anchors
        return np.where((anchor >= 0)[:, None, None], theirs[..., anchor, :, :], np.eye(3)) @ inside

    def _placed(self, world: np.ndarray, middle: np.ndarray) -> np.ndarray:
        """Where all bones (..., N, 3) [m] are, those that the hips carry so that the middle between both hips' joints is there (..., 3)."""
        at, _ = forward_kinematics(self.skeleton, self.skeleton.offsets[0], local_rotations(self.skeleton, world))
        found = 0.5 * (at[..., self.roles.limbs["LeftUpLeg"], :] + at[..., self.roles.limbs["RightUpLeg"], :])
        return at + np.where(self._anchors[2][:, None], (middle - found)[..., None, :], 0.0)

    def _own(self, world: np.ndarray, places: np.ndarray) -> Moved:
        """In the rig's own axes and unit."""
        turned, at = self.axes.T @ world, places @ self.axes / self.unit
        parent = self.skeleton.parents[self._hips]
        hips = at[..., self._hips, :]
        if parent >= 0:
            hips = np.einsum("...ji,...j->...i", turned[..., parent, :, :], hips - at[..., parent, :])
        return Moved(local_rotations(self.skeleton, turned), hips, at, turned)


def _told(skeleton: Skeleton) -> Roles:
    """The roles of bones by their names; where the hips' does not tell, they are what carries both legs and the trunk."""
    known = roles(skeleton)
    if plain(skeleton.names[known.limbs["Hips"]]) in HIPS:
        return known
    hips = carriers(skeleton)[-1]
    return Roles(known.limbs | {"Hips": hips}, tuple(bone for bone in known.trunk if bone > hips), known.neck)


def _given(skeleton: Skeleton, parts: Mapping[str, str]) -> Roles:
    """The roles of bones that are named by our joints' names. ValueError where one is missing, or there is none of that name."""
    wrong = [f"{ours}: {name!r}" for ours, name in parts.items() if ours not in HUMAN or name not in skeleton]
    if wrong:
        raise ValueError(f"parts: our joints' names and bones' own are wanted, not {', '.join(wrong)}")
    missing = [name for name in ("Hips", "Head", *(s + p for s in SIDES for p in (*_LEG, "Arm", "ForeArm"))) if name not in parts]
    if missing:
        raise ValueError(f"parts: no bone for {', '.join(missing)}")
    number = {ours: skeleton.index(name) for ours, name in parts.items()}
    return Roles({name: k for name, k in number.items() if name not in _TRUNK[1:] and name != "Neck"},
                 tuple(number[name] for name in _TRUNK[1:] if name in number), tuple(number[name] for name in _NECK[1:] if name in number))


def _sole(standing: np.ndarray, known: Roles, legs: float) -> float:
    """How high ankles are over the soles [m] of somebody who does not stand on his world's floor: as high as over the toes, and a standard human's toes over the floor."""
    size = legs / _length(REST, HUMAN.index)
    toes = [standing[known.limbs[s + "Foot"], 1] - standing[known.limbs[s + "Toe"], 1] for s in SIDES if s + "Toe" in known.limbs]
    return float(np.mean(toes) + size * REST[HUMAN.index("LeftToe"), 1]) if toes else size * float(REST[HUMAN.index("LeftFoot"), 1])


def _length(places: Any, index: Callable[[str], Any]) -> float:
    """Mean length [m] of thigh and shank together, of places (3,) by an index of our joint's name."""
    return float(np.mean([np.linalg.norm(places[index(s + a)] - places[index(s + b)]) for s in SIDES for a, b in zip(_LEG, _LEG[1:])]) * 2)


def _length_of(skeleton: Skeleton) -> float:
    return float(np.mean([np.linalg.norm(skeleton.offsets[skeleton.index(s + part)]) for s in SIDES for part in _LEG[1:]]) * 2)


def _part_way(a: np.ndarray, b: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Rotations (..., D, 3, 3), each its share (D,) of the way from a to b."""
    out = np.where((share < 0.5)[:, None, None], a, b)
    some = np.flatnonzero((share > 1e-9) & (share < 1.0 - 1e-9))
    if len(some):
        first = a[..., some, :, :]
        out[..., some, :, :] = first @ exp(share[some, None] * log(np.swapaxes(first, -1, -2) @ b[..., some, :, :]))
    return out
