"""A body's skin: a mesh that hangs on a chain's joints, and on helpers that spread twist along limbs, as dual quaternions."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...body import quaternion_kernel
from ...compiled import kernel
from ..twists import Chain


@dataclass(frozen=True, eq=False)
class Surface:
    """A closed mesh on a chain of J joints. Bones are the joints, then H helpers.

    vertices: (V, 3) [m] at T-pose. triangles: (T, 3), counter-clockwise from outside. bones, weights: (V, 4), weights
    summing to 1. rest: (J, 3) [m] the joints at T-pose. carriers: (H,) the joint that each helper sits at. hands: (H,)
    whose twist it takes over; -1 for one that leaves its own joint's twist out. twists: (H, 3) about which axis.
    """

    chain: Chain
    vertices: np.ndarray
    triangles: np.ndarray
    bones: np.ndarray
    weights: np.ndarray
    rest: np.ndarray
    carriers: np.ndarray
    hands: np.ndarray
    twists: np.ndarray

    def __post_init__(self):
        count = len(self.chain.skeleton) + len(self.carriers)
        if self.bones.min(initial=0) < 0 or self.bones.max(initial=0) >= count or self.triangles.max(initial=0) >= len(self.vertices):
            raise ValueError(f"a surface of {len(self.vertices)} vertices on {count} bones names others")
        for name, kind in (("vertices", float), ("triangles", np.int32), ("bones", np.int32), ("weights", float), ("rest", float),
                           ("carriers", np.int64), ("hands", np.int64), ("twists", float)):
            object.__setattr__(self, name, np.ascontiguousarray(getattr(self, name), kind))

    @cached_property
    def shares(self) -> np.ndarray:
        """How far each vertex goes along with each degree of freedom (V, D), 0 … 1."""
        chain, joints = self.chain, len(self.chain.skeleton)
        moves = np.zeros((joints + len(self.carriers), len(chain)))
        moves[:joints] = chain.moved
        for h, (carrier, hand, axis) in enumerate(zip(self.carriers, self.hands, self.twists)):
            along = np.abs(chain.axes @ axis) > 0.9
            moves[joints + h] = chain.moved[carrier]
            moves[joints + h, along & (chain.joints == (carrier if hand < 0 else hand))] = hand >= 0
        return np.einsum("vk,vkd->vd", self.weights, moves[self.bones])

    @cached_property
    def scratch(self) -> tuple[np.ndarray, np.ndarray]:
        """Room for the bones' motions and the posed vertices."""
        return np.empty((len(self.chain.skeleton) + len(self.carriers), 8)), np.empty_like(self.vertices)


def skinned(surface: Surface, positions: np.ndarray, orientations: np.ndarray) -> np.ndarray:
    """Where the vertices (V, 3) [m] are for joints at (J, 3) [m] with orientations (J, 3, 3)."""
    motions, out = np.empty((len(positions) + len(surface.carriers), 8)), np.empty_like(surface.vertices)
    motion_kernel(surface.chain.skeleton.parents, surface.rest, surface.carriers, surface.hands, surface.twists, positions, orientations, motions)
    skin_kernel(surface.vertices, surface.bones, surface.weights, motions, out)
    return out


@kernel(nogil=True)
def _quaternion(m, q):
    """Write the unit quaternion (x, y, z, w) of a rotation (3, 3)."""
    quaternion_kernel(m, q)
    size = math.sqrt(q[0] ** 2 + q[1] ** 2 + q[2] ** 2 + q[3] ** 2)
    for i in range(4):
        q[i] /= size


@kernel(nogil=True)
def _times(a, b, out):
    """Write the quaternion product: first b, then a. `out` is neither of them."""
    out[0] = a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1]
    out[1] = a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0]
    out[2] = a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3]
    out[3] = a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]


@kernel(nogil=True)
def _relative(a, b, out):
    """Write a⁻¹ b of unit quaternions."""
    c = np.array([-a[0], -a[1], -a[2], a[3]])
    _times(c, b, out)


@kernel(nogil=True)
def _twist(q, axis, out):
    """Write the part of a unit quaternion that turns about an axis; half a turn of pure swing has none."""
    along = q[0] * axis[0] + q[1] * axis[1] + q[2] * axis[2]
    size = math.sqrt(along * along + q[3] * q[3])
    for i in range(3):
        out[i] = along * axis[i] / size if size > 1e-6 else 0.0
    out[3] = q[3] / size if size > 1e-6 else 1.0


@kernel(nogil=True)
def motion_kernel(parents, rest, carriers, hands, twists, positions, orientations, out):
    """Write the dual quaternions (J + H, 8), real part then dual, that carry the skin from T-pose."""
    joints = len(parents)
    local, turned, back = np.empty(4), np.empty(4), np.empty(4)
    for b in range(joints + len(carriers)):
        real, at = out[b, :4], b
        if b < joints:
            _quaternion(orientations[b], real)
        else:
            h = b - joints
            at = carriers[h]
            if hands[h] < 0:
                _relative(out[parents[at], :4], out[at, :4], local)
                _twist(local, twists[h], turned)
                back[0], back[1], back[2], back[3] = -turned[0], -turned[1], -turned[2], turned[3]
                _times(out[at, :4], back, real)
            else:
                _relative(out[at, :4], out[hands[h], :4], local)
                _twist(local, twists[h], turned)
                _times(out[at, :4], turned, real)
        x, y, z, w = real[0], real[1], real[2], real[3]
        a, c, d = rest[at, 0], rest[at, 1], rest[at, 2]
        u, v, s = y * d - z * c + w * a, z * a - x * d + w * c, x * c - y * a + w * d
        tx = positions[at, 0] - (a + 2.0 * (y * s - z * v))
        ty = positions[at, 1] - (c + 2.0 * (z * u - x * s))
        tz = positions[at, 2] - (d + 2.0 * (x * v - y * u))
        out[b, 4] = 0.5 * (tx * w + ty * z - tz * y)
        out[b, 5] = 0.5 * (ty * w + tz * x - tx * z)
        out[b, 6] = 0.5 * (tz * w + tx * y - ty * x)
        out[b, 7] = -0.5 * (tx * x + ty * y + tz * z)


@kernel(fastmath=True)
def skin_kernel(vertices, bones, weights, motions, out):
    """Write where vertices (V, 3) [m] go under dual quaternions (B, 8) blended by weights (V, 4)."""
    q = np.empty(8)
    for i in range(len(vertices)):
        first = bones[i, 0]
        for c in range(8):
            q[c] = 0.0
        for k in range(4):
            weight = weights[i, k]
            if weight == 0.0:
                continue
            b = bones[i, k]
            side = (motions[b, 0] * motions[first, 0] + motions[b, 1] * motions[first, 1] + motions[b, 2] * motions[first, 2]
                    + motions[b, 3] * motions[first, 3])
            if side < 0.0:
                weight = -weight
            for c in range(8):
                q[c] += weight * motions[b, c]
        scale = 1.0 / math.sqrt(q[0] ** 2 + q[1] ** 2 + q[2] ** 2 + q[3] ** 2)
        for c in range(8):
            q[c] *= scale
        x, y, z, w, e, f, g, h = q[0], q[1], q[2], q[3], q[4], q[5], q[6], q[7]
        a, b_, c_ = vertices[i, 0], vertices[i, 1], vertices[i, 2]
        u, v, s = y * c_ - z * b_ + w * a, z * a - x * c_ + w * b_, x * b_ - y * a + w * c_
        out[i, 0] = a + 2.0 * (y * s - z * v) + 2.0 * (w * e - h * x + y * g - z * f)
        out[i, 1] = b_ + 2.0 * (z * u - x * s) + 2.0 * (w * f - h * y + z * e - x * g)
        out[i, 2] = c_ + 2.0 * (x * v - y * u) + 2.0 * (w * g - h * z + x * f - y * e)
