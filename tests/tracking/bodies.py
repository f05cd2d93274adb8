"""A simple body to track, cameras around it, and what they see; and rays cast by themselves, to judge the rasteriser by."""

from functools import cache

import numpy as np

from gambol.controllers.tracking.cameras import ring
from gambol.controllers.tracking.silhouettes import Surface, rendered, skinned
from gambol.controllers.tracking.twists import Configuration, chain_of, posed

SIDES = 10


@cache
def stick_body(freedom="paper"):
    """A human of tubes, one on each bone, closed at both ends."""
    chain = chain_of(freedom=freedom)
    skeleton = chain.skeleton
    rest = np.zeros((len(skeleton), 3))
    for j, parent in enumerate(skeleton.parents):
        rest[j] = skeleton.offsets[j] + (rest[parent] if parent >= 0 else 0.0)
    ends = [(p, rest[p] + o) for p, o in zip(skeleton.end_parents, skeleton.end_offsets)]
    bones = [(p, rest[j]) for j, p in enumerate(skeleton.parents) if p >= 0] + ends
    vertices, triangles, owners = [], [], []
    for joint, end in bones:
        radius = 0.11 if skeleton.names[joint] in ("Hips", "Spine", "Spine1", "Spine2") else 0.045
        at, faces = tube(rest[joint], end, radius)
        triangles.append(faces + sum(map(len, vertices)))
        vertices.append(at)
        owners += [joint] * len(at)
    bones4, weights = np.zeros((len(owners), 4), int), np.zeros((len(owners), 4))
    bones4[:, 0], weights[:, 0] = owners, 1.0
    return Surface(chain, np.concatenate(vertices), np.concatenate(triangles), bones4, weights, rest,
                   np.zeros(0, int), np.zeros(0, int), np.zeros((0, 3)))


def tube(a, b, radius):
    """A closed tube from a to b: vertices and triangles, counter-clockwise from outside."""
    along = (b - a) / np.linalg.norm(b - a)
    one = np.cross(along, np.eye(3)[np.abs(along).argmin()])
    one /= np.linalg.norm(one)
    two = np.cross(along, one)
    angles = 2 * np.pi * np.arange(SIDES) / SIDES
    ring_ = radius * (np.cos(angles)[:, None] * one + np.sin(angles)[:, None] * two)
    at = np.concatenate([a + ring_, b + ring_, [a - along * radius, b + along * radius]])
    k = np.arange(SIDES)
    n = (k + 1) % SIDES
    faces = np.concatenate([np.stack([k, n, n + SIDES], 1), np.stack([k, n + SIDES, k + SIDES], 1),
                            np.stack([n, k, np.full(SIDES, 2 * SIDES)], 1), np.stack([k + SIDES, n + SIDES, np.full(SIDES, 2 * SIDES + 1)], 1)])
    return at, faces


def cameras(width=96):
    return ring(4, 3.6, 1.5, (0.0, 0.95, 0.0), (width, width), 0.62)


def masks(surface, where, lenses):
    positions, orientations, _ = posed(surface.chain, where)
    vertices = skinned(surface, positions, orientations)
    return [rendered(lens, vertices, surface.triangles).mask for lens in lenses]


def stride(chain, time):
    """Somebody who walks on the spot, arms down and swinging, at a time [s]."""
    where = chain.rest()
    angles, swing = where.angles.copy(), np.sin(2 * np.pi * time)
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        angles[chain.names.index(f"{side}UpLeg.x")] = -0.35 * sign * swing - 0.1
        angles[chain.names.index(f"{side}Leg.x")] = 0.45 + 0.3 * sign * swing
        angles[chain.names.index(f"{side}Arm.z")] = -1.05 * sign
        angles[chain.names.index(f"{side}Arm.y")] = 0.5 * swing - 0.2 * sign
        angles[chain.names.index(f"{side}ForeArm.y")] = -0.7 * sign
    root = where.root.copy()
    root[:3, 3] += [0.05 * swing, 0.02 * np.cos(4 * np.pi * time) - 0.05, 0.1 * time]
    return Configuration(root, angles)


def ray_cast(lens, vertices, triangles):
    """Depth (H, W) [m] by rays through all triangles (Möller and Trumbore 1997), infinite for nothing."""
    width, height = lens.size
    grid = np.stack(np.meshgrid(np.arange(width), np.arange(height)), -1).astype(float)
    rays = lens.directions(grid).reshape(-1, 3)
    best = np.full(len(rays), np.inf)
    for a, b, c in vertices[triangles]:
        e, f = b - a, c - a
        p = np.cross(rays, f)
        det = p @ e
        with np.errstate(divide="ignore", invalid="ignore"):
            u = ((lens.eye - a) * p).sum(1) / det
            q = np.cross(lens.eye - a, e)
            v, far = rays @ q / det, f @ q / det
            best = np.where((u >= 0) & (v >= 0) & (u + v <= 1) & (far > 0), np.minimum(best, far), best)
    return (best * (rays @ lens.rotation[2])).reshape(height, width)
