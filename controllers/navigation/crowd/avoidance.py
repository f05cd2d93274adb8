"""Velocities by which N walkers keep out of each other's way and of what stands about.

ORCA's walkers change their velocity at once, people's legs take it up as a critically damped spring does. Whoever wishes for w
from now on is at p + v L + w (t − L) before long, with L = 2 / y the spring's lag: so half-planes are laid for p + v L.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree  # pyright: ignore[reportAttributeAccessIssue]  # compiled, and without hints

from ...compiled import kernel
from ..routes import distance, shapes_of
from .linear_program import half_plane, nearest, nearest_to_all


class Manners(NamedTuple):
    """How walkers avoid each other. Times in seconds, lengths in metres.

    horizon: no collision may come for so long; soon: who are too near part within this. halflife: of the spring by which legs
    take up a wish. aside: what each leaves between bodies beside their radii, swing: and more as his arms swing, at a walk; wall: beside what stands about; brake: how
    long it takes to come as near to that. hurry: who avoids others goes this much faster than he wishes at most; stir: who wishes for less goes
    this fast at most [m/s]. right: how far beside head-on [sine] people still pass on the right,
    and first: likewise where they cross, lest both dither. sight: what lies farther off the way one looks than
    this [rad] is not seen, unless it is nearer than `felt`. see: nobody farther is looked at, and of those the `most` nearest.
    still: who wishes for less than about this [m/s] leaves it to others to go round him. differ: by how much
    people differ in giving way, told from their numbers, so that no two wait for each other for ever; below 1.
    """

    horizon: float = 2.2
    soon: float = 0.5
    halflife: float = 0.22
    aside: float = 0.08
    swing: float = 0.07
    wall: float = 0.10
    brake: float = 0.4
    hurry: float = 1.15
    stir: float = 0.4
    right: float = 0.2
    first: float = 0.03
    sight: float = math.radians(100.0)
    felt: float = 0.7
    see: float = 6.0
    most: int = 12
    still: float = 0.3
    differ: float = 0.5


def lag(halflife: float) -> float:
    """How long [s] a critically damped spring of a half-life [s] stays behind a wish: 2 / y with y = 2 ln 2 / half-life."""
    return halflife / math.log(2.0)


def avoid(places, velocities, wishes, radii, around: Sequence[Any] = (), headings=None, manners: Manners = Manners()) -> np.ndarray:
    """The velocities (N, 2) along x and z [m/s] nearest to the wishes by which nobody runs into anybody or anything.

    places: (N, 2) x, z [m]. velocities, wishes: (N, 2) [m/s], as they move and as they would. radii: (N,) of their bodies [m]. around: what
    stands about, boxes and pillars. headings: (N,) where they look [rad]; by default the way they go. Each takes his share of
    every change: none who does not see the other, little who stands. Where no velocity does, the one that comes nearest to it.
    ValueError unless all is finite and of these shapes.
    """
    places, velocities, wishes = (np.ascontiguousarray(a, float) for a in (places, velocities, wishes))
    count = len(places)
    radii = np.ascontiguousarray(np.broadcast_to(np.asarray(radii, float), count))
    for name, value in (("places", places), ("velocities", velocities), ("wishes", wishes)):
        if value.shape != (count, 2) or not np.isfinite(value).all():
            raise ValueError(f"{name} must be finite ({count}, 2), one x and z for each walker; got shape {value.shape}")
    if not (np.isfinite(radii) & (radii > 0.0)).all():
        raise ValueError(f"radii must be finite and above 0 m; got {radii!r}")
    if headings is None:
        going = np.where(np.linalg.norm(velocities, axis=1, keepdims=True) > 0.1, velocities, wishes)
        headings = np.arctan2(going[:, 0], going[:, 1])
    headings = np.ascontiguousarray(headings, float)
    if headings.shape != (count,) or not np.isfinite(headings).all():
        raise ValueError(f"headings must be finite ({count},) [rad]; got shape {headings.shape}")
    out = np.empty((count, 2))
    if count:
        most = min(manners.most, count - 1) + 1
        near = cKDTree(places).query(places, k=np.arange(1, most + 1), distance_upper_bound=manners.see)[1]
        _avoid(places, velocities, wishes, radii, headings, near, shapes_of(around), lag(manners.halflife), manners, out)
    return out


@kernel
def _avoid(places, velocities, wishes, radii, headings, near, shapes, late, manners, out):
    """What `avoid` gives, of every walker in turn. near: (N, K) who is nearest, himself among them, N for nobody."""
    count = places.shape[0]
    planes = np.empty((near.shape[1] + shapes.shape[0], 4))
    other, best, slope = np.empty_like(planes), np.empty(2), np.empty(3)
    for i in range(count):
        vx, vz = velocities[i, 0], velocities[i, 1]
        speed = math.hypot(wishes[i, 0], wishes[i, 1])
        fastest = max(manners.hurry * speed, manners.stir)
        own = min(math.hypot(vx, vz), 1.0)
        hard = 0
        for k in range(shapes.shape[0]):  # whoever keeps behind the line at its nearest place does not touch what is convex
            room = distance(places[i, 0], places[i, 1], shapes[k], slope) - radii[i] - manners.wall
            room += late * (vx * slope[0] + vz * slope[1])
            if room < fastest * manners.brake:
                planes[hard, 2], planes[hard, 3] = slope[0], slope[1]
                least = min(-room / manners.brake, 0.5 * manners.stir)
                planes[hard, 0], planes[hard, 1] = least * slope[0], least * slope[1]
                hard += 1
        number = hard
        for k in range(near.shape[1]):
            j = near[i, k]
            if j == count or j == i:
                continue
            mine, yours = _care(i, j, places, wishes, headings, manners), _care(j, i, places, wishes, headings, manners)
            if mine == 0.0:
                continue
            apart = radii[i] + radii[j] + 2.0 * manners.aside + manners.swing * (own + min(math.hypot(velocities[j, 0], velocities[j, 1]), 1.0))
            px, pz = _meeting(places[j, 0] - places[i, 0], places[j, 1] - places[i, 1], late * (velocities[j, 0] - vx), late * (velocities[j, 1] - vz), apart)
            if px == 0.0 and pz == 0.0:
                px = 1e-3 if i < j else -1e-3
            facing = vx * velocities[j, 0] + vz * velocities[j, 1] < 0.0
            half_plane(px, pz, vx - velocities[j, 0], vz - velocities[j, 1], apart, manners.horizon,
                       manners.soon, mine / (mine + yours), manners.right if facing else manners.first, planes[number])
            planes[number, 0] += vx
            planes[number, 1] += vz
            number += 1
        kept = nearest(planes, number, fastest, wishes[i, 0], wishes[i, 1], False, best)
        if kept < number:
            nearest_to_all(planes, hard if kept >= hard else 0, number, kept, fastest, other, best)
        out[i, 0], out[i, 1] = best[0], best[1]


@kernel
def _meeting(px, pz, dx, dz, apart):
    """Where (px, pz) is [m] once both have taken up their wishes, (dx, dz) later; on the way there, if they come too near before."""
    square = dx * dx + dz * dz
    t = min(max(-(px * dx + pz * dz) / square, 0.0), 1.0) if square > 0.0 else 1.0
    qx, qz = px + t * dx, pz + t * dz
    near = math.hypot(qx, qz)
    if near > apart:
        return px + dx, pz + dz
    if near < 0.3 * apart:  # the side they would pass on says little: away from where the other is
        far = math.hypot(px, pz)
        return (px * near / far, pz * near / far) if far > 0.0 else (0.0, 0.0)
    return qx, qz


@kernel
def _care(i, j, places, wishes, headings, manners):
    """How much i cares about j: not at all where he does not see him, little where he wishes to stand."""
    dx, dz = places[j, 0] - places[i, 0], places[j, 1] - places[i, 1]
    far = math.hypot(dx, dz)
    if far > manners.felt and math.sin(headings[i]) * dx + math.cos(headings[i]) * dz < math.cos(manners.sight) * far:
        return 0.0
    speed = math.hypot(wishes[i, 0], wishes[i, 1])
    temper = 1.0 + manners.differ * (2.0 * ((0.6180339887498949 * (i + 1)) % 1.0) - 1.0)
    return temper * (0.1 + speed / (speed + manners.still))
