"""How who rolls tips over his feet: they stand until hands do, the arms give way, and the shoulders come down where the hands were."""

from __future__ import annotations

import numpy as np

from ...body import centre_of_mass, forward_kinematics, local_rotations, two_bone, two_bone_turns, yaw
from ..body import FLEX, Physique, hermite, stand_kernel, turns, vectors
from .plan import Plan

TIPS = 0.40
"""From the lowest point of the landing to the upper back [s]."""
LETS_GO = 0.35, 0.75
"""Feet stand until the first of this share of that time, and are let go until the second."""
REACHES, YIELDS = (0.0, 0.5), (0.5, 1.0)
"""Hands come to the floor between the first two of these shares of it, and arms are as recorded again between the last two."""
OVER, WIDE, PALM, TIP = 0.4, 0.30, 0.04, 0.03
"""Hands stand where shoulders are after this share of it, so far to either side [m]; wrists and finger tips so far over the floor [m], at standard height."""
INWARD = np.radians(110.0)
"""Fingers point ahead, and inward: turned from where they point with arms stretched out [rad]."""
FLARE = 0.5
"""Elbows go aside by so much of an arm's length as they bend: the body comes down between them."""
TUCKS = np.radians(38.0)
"""Half-way neck and head are bent by so much more each [rad]: nobody rolls over his head."""
ELBOW, RAISES = 0.05, 6
"""Elbows come no nearer to the floor than this [m], at standard height; so many times they are turned up to that end."""
ARM = "Arm", "ForeArm", "Hand"


def tipped(physique: Physique, made: Plan, n: int, after: tuple[np.ndarray, np.ndarray], meets: np.ndarray, heading: float, lift: np.ndarray,
           step: float) -> tuple[np.ndarray, np.ndarray]:
    """From the n-th moment of a landing on: joints' rotations (M, J, 3, 3) and the mass centre (M, 3) [m], moments a step [s] apart.

    after: the same (K, J, 3, 3), (K, 3) of what follows, which the mass centre meets as fast as (3,) [m/s]. lift: (M, 1) [m] how much higher than on the straight way it goes.
    """
    ends, count = after[0][0], len(lift)
    last, floor = count * step, float(made.feet[0, 1] - physique.tables.sole)
    times = np.arange(count) * step
    centres = hermite(np.array([0.0, last]), np.stack([made.centres[n], after[1][0]]), np.stack([made.velocities[n], meets]), times) + lift * [0.0, 1.0, 0.0]
    rate = vectors(after[0][1] @ np.swapaxes(ends, -1, -2)) / step
    rates = vectors(made.local[n] @ np.swapaxes(made.local[n - 1], -1, -2)) / (made.times[n] - made.times[n - 1]), rate
    off = vectors(made.local[n] @ np.swapaxes(ends, -1, -2))
    free = turns(hermite(np.array([0.0, last]), np.stack([off, 0.0 * off]), np.stack(rates), times)) @ ends
    share = times / last
    for name in ("Neck", "Head"):
        free[:, physique.skeleton.index(name)] @= turns((TUCKS * _risen(share, 0.1, 0.5) * (1.0 - _risen(share, 0.75, 1.0)))[:, None] * [1.0, 0.0, 0.0])
    local = free.copy()
    places = None
    for _ in range(3):  # arms weigh something, so that hips go where these do not
        positions, turned = forward_kinematics(physique.skeleton, np.zeros((count, 3)), local)
        roots = centres - centre_of_mass(physique.anatomy, positions, turned)
        if places is None:
            places = _hands(physique, roots[:, None] + positions, heading, floor, int(OVER * count))
        _reach(physique, roots, free, local, places, heading, floor, share)
        _stand(physique, made, n, centres, share, free, local)
    return local, centres


def _risen(share: np.ndarray, begins: float, ends: float) -> np.ndarray:
    """0 until a share, 1 from another on, smoothly."""
    rise = np.clip((share - begins) / (ends - begins), 0.0, 1.0)
    return rise * rise * (3.0 - 2.0 * rise)


def _hands(physique: Physique, positions: np.ndarray, heading: float, floor: float, when: int) -> np.ndarray:
    """Where wrists (2, 3) [m] stand of a body whose joints go along (N, J, 3)."""
    middle = positions[when, [physique.skeleton.index(side + "Arm") for side in ("Left", "Right")]].mean(0)
    beside = yaw(heading) @ np.array([[WIDE, -WIDE], [0.0, 0.0], [0.0, 0.0]])
    places = middle + physique.size * beside.T
    places[:, 1] = floor + PALM * physique.size
    return places


def _reach(physique: Physique, roots: np.ndarray, free: np.ndarray, local: np.ndarray, places: np.ndarray, heading: float, floor: float, share: np.ndarray) -> None:
    """Write arms (N, J, 3, 3) whose hands come to places (2, 3), over the floor, and stand there, until they are as of the free ones."""
    stood = _risen(share, *REACHES) * (1.0 - _risen(share, *YIELDS))
    skeleton, size = physique.skeleton, physique.size
    positions, turned = forward_kinematics(skeleton, roots, free)
    world = turned.copy()
    for side, name in ((1.0, "Left"), (-1.0, "Right")):
        arm, elbow, hand = (skeleton.index(name + part) for part in ARM)
        shoulder, bend, wrist = (positions[:, joint] for joint in (arm, elbow, hand))
        flat = yaw(heading - side * INWARD)
        world[:, hand] = turned[:, hand] @ turns(stood[:, None] * vectors(np.swapaxes(turned[:, hand], -1, -2) @ flat))
        tip = (world[:, hand] @ skeleton.end_offsets[skeleton.end_index[name + "Hand"]])[:, 1]
        target = wrist + stood[:, None] * (places[0 if side > 0.0 else 1] - wrist)
        target[:, 1] = np.maximum(target[:, 1], floor + size * np.maximum(PALM, TIP - tip / size))
        pole = bend - shoulder + (FLARE * size * stood)[:, None] * (yaw(heading) @ np.array([side, 0.5, 0.0]))
        for _ in range(RAISES):  # the arm gives way aside and up where the floor is
            low = floor + ELBOW * size - two_bone(shoulder, bend, wrist, target, pole)[0][:, 1]
            pole[:, 1] += np.maximum(low, 0.0)
        upper, lower = two_bone_turns(shoulder, bend, wrist, target, pole)
        world[:, arm], world[:, elbow] = upper @ turned[:, arm], lower @ turned[:, elbow]
    parts = [skeleton.index(side + part) for side in ("Left", "Right") for part in ARM]
    local[:, parts] = local_rotations(skeleton, world)[:, parts]


def _stand(physique: Physique, made: Plan, n: int, centres: np.ndarray, share: np.ndarray, free: np.ndarray, local: np.ndarray) -> None:
    """Write the legs (M, J, 3, 3) of who tips over, `share` (M,) of it done, his mass centre at (M, 3): over his feet until they are as of the free ones."""
    skeleton, feet, root = physique.skeleton, np.ones((2, 6)), made.roots[n].copy()
    positions, turned, legs = np.empty((len(skeleton), 3)), np.empty((len(skeleton), 3, 3)), (physique.tables.hip[:, None] + np.arange(4)).ravel()
    for centre, freed, own, posed in zip(centres, _risen(share, *LETS_GO), free, local):
        blend = own[legs]
        posed[legs] = blend
        if freed == 1.0:
            continue
        feet[:, :5] = made.feet
        feet[:, 4] = 0.0
        stand_kernel(physique.tables, centre, feet, FLEX * physique.flexibility, root, posed, positions, turned)
        posed[legs] = blend @ turns((1.0 - freed) * vectors(np.swapaxes(blend, -1, -2) @ posed[legs]))
