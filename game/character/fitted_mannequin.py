"""The mannequin in any size and build, and around anybody's skeleton.

The standard mannequin is deformed as a whole: every joint's flesh is scaled about its joint, along
the bone by how much longer the bone is, across it by the build; skin weights blend the scalings as
they blend motions. Where the paint lies is remembered, so that it stays on knees and elbows.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gambol.controllers.body import STATURE, Skeleton, between
from gambol.controllers.mocap import has_limbs, roles, zero_positions

from ..render import Body, Mesh, mannequin, skin
from .surface import smooth

_NAMES, _PARENTS = skin.STANDARD.names, skin.STANDARD.parents
_SIDES = ("Left", "Right")
_LIMIT = 1.5
"""How far lengths of one skeleton may be from the standard's proportions; beyond they are taken to be faulty."""


class BuildError(ValueError):
    """A body that can't be made, and what could be."""


@dataclass(frozen=True)
class Build:
    """How somebody is built.

    height: [m]. weight: −1 slim … 0 … 1 heavy. child: 0 grown up … 1 about six years old.
    shoulders, hips: widths over the standard's.
    """

    height: float = STATURE
    weight: float = 0.0
    child: float = 0.0
    shoulders: float = 1.0
    hips: float = 1.0

    def __post_init__(self) -> None:
        for name, low, high in (("height", 0.5, 3.0), ("weight", -1.0, 1.0), ("child", 0.0, 1.0),
                                ("shoulders", 0.7, 1.5), ("hips", 0.7, 1.5)):
            if not low <= getattr(self, name) <= high:
                raise BuildError(f"{name} {getattr(self, name):g}: needs a number from {low:g} to {high:g}")


def tailored(build: Build, skeleton: Skeleton | None = None, name: str = "Mannequin") -> Body:
    """The mannequin of a build, around the bones of any human skeleton (its zero pose may be any).

    ValueError if the skeleton is no human, or a bone of its limbs has no length.
    """
    lengths = _lengths(build, np.ones(len(_NAMES)) if skeleton is None else proportions(skeleton))
    body = _around(build, lengths)
    crown = body.levels[0].positions[:, 1].max()
    return _scaled(replace(body, name=name), build.height / crown)


def proportions(skeleton: Skeleton) -> np.ndarray:
    """How long (22,) the bones to our joints are in a skeleton over the standard's; its mean leg is 1."""
    part, at = roles(skeleton), zero_positions(skeleton)
    has_limbs(part, at, skeleton.names)
    out, limbs = np.full(len(_NAMES), np.nan), part.limbs

    def apart(place, *joints):
        """How far the middles of two groups of joints are apart in some places."""
        return np.linalg.norm(np.mean([place(n) for n in joints[0]], 0) - np.mean([place(n) for n in joints[1]], 0))

    def ratio(*joints):
        """The same of the skeleton over the standard human's."""
        return apart(lambda n: at[limbs[n]], *joints) / apart(lambda n: skin.REST[_NAMES.index(n)], *joints)
    for side in _SIDES:
        for joint, parent in (("Leg", "UpLeg"), ("Foot", "Leg"), ("Toe", "Foot"), ("ForeArm", "Arm"), ("Hand", "ForeArm")):
            if side + joint in limbs:
                out[_NAMES.index(side + joint)] = ratio([side + joint], [side + parent])
        # where clavicles and hips begin differs from rig to rig: their widths do not
        out[[_NAMES.index(side + n) for n in ("Shoulder", "Arm")]] = ratio(["LeftArm"], ["RightArm"])
        out[_NAMES.index(side + "UpLeg")] = ratio(["LeftUpLeg"], ["RightUpLeg"])
    out[[_NAMES.index(n) for n in ("Spine", "Spine1", "Spine2")]] = ratio(["LeftArm", "RightArm"], ["LeftUpLeg", "RightUpLeg"])
    legs = [_NAMES.index(side + n) for side in _SIDES for n in ("Leg", "Foot")]
    whole = out[legs].mean()
    out = np.where(np.isnan(out), whole, out) / whole
    for j, joint in enumerate(_NAMES):  # both sides alike, as the mannequin is
        if joint.startswith("Left"):
            other = _NAMES.index(joint.replace("Left", "Right"))
            out[[j, other]] = 0.5 * (out[j] + out[other])
    return np.clip(out, 1.0 / _LIMIT, _LIMIT)


def _lengths(build: Build, own: np.ndarray) -> np.ndarray:
    """Lengths (22, 3) of the bones to our joints over the standard's, by axis of the T-pose."""
    c, out = build.child, np.repeat(own[:, None], 3, 1)
    for j, name in enumerate(_NAMES):
        part = name.removeprefix("Left").removeprefix("Right")
        if part in ("Leg", "Foot"):
            out[j] *= 1.0 - 0.14 * c
        elif part in ("ForeArm", "Hand"):
            out[j] *= 1.0 - 0.10 * c
        elif part == "UpLeg":
            out[j, 0] *= build.hips * (1.0 + 0.05 * build.weight) * (1.0 - 0.08 * c)
        elif part in ("Shoulder", "Arm"):
            out[j, 0] *= build.shoulders * (1.0 + 0.04 * build.weight) * (1.0 - 0.14 * c)
        elif part in ("Neck", "Head"):
            out[j] *= 1.0 + 0.04 * c
        elif part == "Toe":
            out[j] *= 1.0 - 0.06 * c
    return out


def _girths(build: Build, lengths: np.ndarray) -> np.ndarray:
    """How much each joint's flesh grows (22, 3), by axis of the T-pose."""
    w, c, out = build.weight, build.child, np.ones((len(_NAMES), 3))
    by_name = dict(zip(_NAMES, lengths))
    for j, name in enumerate(_NAMES):
        side = next((s for s in _SIDES if name.startswith(s)), "")
        part = name.removeprefix(side)
        if part == "UpLeg":
            out[j] = 1 + 0.17 * w, by_name[side + "Leg"][1], 1 + 0.17 * w
        elif part == "Leg":
            out[j] = 1 + 0.12 * w, by_name[side + "Foot"][1], 1 + 0.12 * w
        elif part in ("Foot", "Toe"):
            out[j] = 1 + 0.06 * w, 1.0, by_name[side + "Toe"][2]
        elif part == "Arm":
            out[j] = by_name[side + "ForeArm"][0], 1 + 0.16 * w, 1 + 0.16 * w
        elif part == "ForeArm":
            out[j] = by_name[side + "Hand"][0], 1 + 0.12 * w, 1 + 0.12 * w
        elif part == "Hand":
            out[j] = 1.0 - 0.08 * c, (1.0 + 0.08 * w) * (1 - 0.05 * c), (1.0 + 0.07 * w) * (1 - 0.05 * c)
        elif part == "Head":
            out[j] = (1.0 + 0.03 * w) * (1 + 0.26 * c), 1 + 0.22 * c, (1.0 + 0.02 * w) * (1 + 0.26 * c)
        elif part == "Neck":
            out[j] = 1 + 0.12 * w, by_name["Head"][1], 1 + 0.12 * w
        elif part == "Hips":
            out[j] = build.hips * (1 + 0.13 * w), by_name["Spine"][1], 1 + 0.14 * w
        elif part in ("Spine", "Spine1"):
            out[j] = 0.5 * (build.hips + build.shoulders) * (1 + 0.17 * w) * (1 - 0.02 * c), by_name["Spine2"][1], 1 + 0.18 * w
        else:  # the chest, and the clavicles on it
            out[j] = build.shoulders * (1 + 0.08 * w) * (1 - 0.10 * c), by_name["Spine2"][1], 1 + 0.12 * w
        if c and part in ("UpLeg", "Leg", "Arm", "ForeArm"):  # a child's limbs are shorter, not thinner
            out[j] *= 1.0 - 0.05 * c * (out[j] == out[j].max())
    return out


def _around(build: Build, lengths: np.ndarray) -> Body:
    joints = skin.REST.copy()
    for j, parent in enumerate(_PARENTS[1:], 1):
        joints[j] = joints[parent] + (skin.REST[j] - skin.REST[parent]) * lengths[j]
    girths = _girths(build, lengths)
    levels = tuple(_moulded(mesh, joints, girths, build.weight) for mesh in mannequin().levels)
    floor = np.array([0.0, levels[0].positions[:, 1].min(), 0.0])
    return Body("", tuple(replace(m, positions=(m.positions - floor).astype(np.float32)) for m in levels), joints - floor)


def _moulded(mesh: Mesh, joints: np.ndarray, girths: np.ndarray, weight: float) -> Mesh:
    at = _padded(mesh.positions.astype(float), weight)
    out = np.zeros_like(at)
    for k in range(4):
        bone = skin.AT[mesh.joints[:, k]]
        out += mesh.weights[:, k, None] * ((at - skin.REST[bone]) * girths[bone] + joints[bone])
    # normals turn as the triangles around them do
    turn = between(smooth(mesh.positions.astype(float), mesh.triangles), smooth(out, mesh.triangles))
    normals = np.einsum("vij,vj->vi", turn, mesh.normals)
    return replace(mesh, positions=out.astype(np.float32), normals=normals.astype(np.float32))


def _padded(at: np.ndarray, weight: float) -> np.ndarray:
    """What weight adds where it shows: belly, flanks, seat and cheeks (what it takes away, a third as much)."""
    amount = weight if weight > 0 else weight / 3
    x, y, z = at.T

    def bump(middle, radii):
        return np.exp(-np.sum(((at - middle) / radii) ** 2, 1))
    trunk = np.clip((0.24 - np.abs(x)) / 0.06, 0.0, 1.0)
    belly = bump([0.0, 1.085, 0.10], [0.17, 0.13, 0.14]) * trunk
    chest = bump([0.0, 1.32, 0.12], [0.17, 0.08, 0.10]) * trunk
    flank = np.exp(-((y - 1.06) / 0.10) ** 2) * trunk
    seat = bump([0.0, 0.93, -0.12], [0.16, 0.10, 0.10])
    chin = bump([0.0, 1.535, 0.06], [0.06, 0.04, 0.06])
    out = at.copy()
    out[:, 2] += amount * (0.085 * belly + 0.02 * chest - 0.03 * seat)
    out[:, 0] += amount * 0.035 * flank * np.tanh(x / 0.06)
    out[:, 1] -= amount * (0.02 * belly + 0.012 * chin)
    return out


def _scaled(body: Body, factor: float) -> Body:
    return replace(body, joints=body.joints * factor, levels=tuple(
        replace(mesh, positions=mesh.positions * np.float32(factor)) for mesh in body.levels))
