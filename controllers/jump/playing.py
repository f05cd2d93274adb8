"""Playing a plan, a step at a time: pose, ground frame and contacts as it has them, and what comes in the body's way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..body import Pose, Skeleton
from ..contract import CharacterState
from ..navigation.passing import drawn_in
from .asking import Searches
from .body import along
from .motion import between_kernel, fall, struck
from .starting import Jumping, standing

RISEN = 0.45
"""So long after touch-down [s] a jumper has risen far enough to walk on."""
SHIFTS = 8.0
"""Rate [1/s] with which the ground frame comes under the centre of mass, from where it was."""
DRAWN = 0.58, 0.15
"""Who falls draws his arms in beside what he falls past, in the first time [s]; who has landed before something, in the second."""
MOST_HITS = 3
"""A body that still touches something after so many hits slips by."""


def played(jump: Searches, state: CharacterState, around: Sequence[Any], dt: float) -> tuple[CharacterState, Pose]:
    """The state and the pose of who plays a plan dt seconds later, among boxes and pillars around."""
    jumping: Jumping = state.memory
    made, time = jumping.plan, min(jumping.time + dt, jumping.plan.duration)
    pose = made.at(time)
    n = int(np.clip(np.searchsorted(made.times, time), 0, len(made.times) - 1))
    landed = time >= made.touch_down
    floor = float(made.feet[:, 1].mean() - jump.physique.tables.sole) if landed else float(state.floor)
    centre, (vx, _, vz) = made.moving(time)
    turned = made.path.heading + float(made.path.turned(time))
    ground = np.array([*centre[[0, 2]], turned]) + jumping.shift * (1.0 + SHIFTS * time) * np.exp(-SHIFTS * time)
    under = ground.copy()
    if time > made.take_off and made.path.lands is None and not made.rolls:  # from under the mass centre to where the ground frame of one who stands so is
        share = min((time - made.take_off) / (made.touch_down + RISEN - made.take_off), 1.0)
        ground[:2] += share**2 * (3.0 - 2.0 * share) * (standing(jump.physique, made) - centre[[0, 2]])
    heading = float(ground[2])
    c, s = np.cos(heading), np.sin(heading)
    velocity = np.array([s * vx + c * vz, 0.0, c * vx - s * vz])
    after = replace(state, ground=ground, velocity=velocity, pose=pose, contacts=made.contacts[n].copy(),
                    memory=replace(jumping, time=time, stood=np.array([*ground, floor])), floor=floor)
    if made.take_off < time < made.touch_down and around and jumping.hits < MOST_HITS:
        after = _hit(jump, after, around, dt)
    if jumping.fault or landed:  # a leap's sweep saw to its arms, but who has landed goes on to what he would stop before
        pose = arms_in(jump.physique.skeleton, pose, under, around, time / DRAWN[0] if jumping.fault else (time - made.touch_down) / DRAWN[1])
        after = replace(after, pose=pose)
    return after, pose


def arms_in(skeleton: Skeleton, pose: Pose, ground: np.ndarray, around: Sequence[Any], share: float) -> Pose:
    """A pose with its arms drawn in beside what stands about, wholly from a share of 1 on."""
    if not around:
        return pose
    near, share = drawn_in(skeleton, pose, ground, around), min(share, 1.0)
    root, local = np.empty(3), np.empty_like(pose.rotations)
    between_kernel(pose.root, near.root, pose.rotations, near.rotations, share**2 * (3.0 - 2.0 * share), root, local)
    return Pose(root, local)


def _hit(jump: Searches, state: CharacterState, around: Sequence[Any], dt: float) -> CharacterState:
    """The state as it is if it strikes nothing in the air, else at the beginning of a fall."""
    jumping: Jumping = state.memory
    made, time = jumping.plan, jumping.time
    flown, way = time - made.take_off, made.path
    velocity = way.velocity + flown * jump.gravity
    hit = struck(jump.physique.skeleton, state.pose, along(way.leave, way.velocity, flown, jump.gravity), velocity, around)
    if hit is None:
        return state
    before = max(time - dt, 0.0)
    start = jump.start_of(replace(state, previous=made.at(before), elapsed=time - before))
    fallen = fall(jump.physique, replace(start, velocity=velocity), hit, around, jump.gravity)
    return replace(state, memory=Jumping.begun(fallen, state, jumping.asked, hit.reason, jumping.hits + 1))
