"""Other people's motion on Gambol's own skeleton.

Orientations are carried over joint by joint through constant corrections (`calibration`), the
way of the hips and of both ankles is scaled by the ratio of leg lengths, and two-bone inverse
kinematics puts our ankles there: a foot that stood still in the data still stands still. What
differs between two bodies is taken up by the hips' height, so that a leg that was straight is
straight again: a few millimetres are ten degrees of the knee.
"""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

from ..body import (Clip, Skeleton, between, contact_height, exp, forward_kinematics, human, local_rotations, log,
                    two_bone_turns)
from .calibration import SIDES, Calibration, calibrate, leg_stretch, place_feet
from .flat_stance import flat_frames, foot_points

_TRUNK = ("Spine", "Spine1", "Spine2")
_NECK = ("Neck", "Head")
_STRAIGHTEST, _SOFT = 0.999, 0.0012
"""No leg is stretched beyond about this share of its length, since no knee moves smoothly there."""
_NEAR = 0.012
"""A leg has a say in the hips' height while it is less than about this share short of straight …"""
_SLACK = 0.02
"""… and where neither is, the hips stay where they are, the firmer the larger this is."""
_CALM = 0.04
"""The hips' height is changed no more quickly than a bell of this standard deviation [s]."""
_MOST_SHIFT = 0.03  # m


def retarget(clip: Clip, skeleton: Skeleton | None = None, *, calibration: Calibration | None = None) -> Clip:
    """The same motion on another human skeleton with our joint names, feet on the floor y = 0.

    clip: any human skeleton, metres, Y up. skeleton: the standard human by default.
    calibration: from `calibrate`; by default from this clip alone, which serves where the foot
    stands flat in it. ValueError if the clip's skeleton is no human, or not the calibrated one.
    """
    if not isinstance(clip, Clip):
        raise ValueError(f"what is retargeted is a Clip, as load gives it; got a {type(clip).__name__}")
    skeleton = skeleton or human()
    known = calibration or calibrate([clip], skeleton)
    if len(known.corrections) != len(clip.skeleton):
        raise ValueError(f"{clip.name}: {len(clip.skeleton)} joints, but the calibration is of "
                         f"{len(known.corrections)}")
    positions, orientations = clip.kinematics()
    ours = _carry_over(skeleton, known, orientations)
    hips = skeleton.index("Hips")
    between_hips = (skeleton.offsets[skeleton.index("LeftUpLeg")] + skeleton.offsets[skeleton.index("RightUpLeg")]) / 2
    middle, ankles = place_feet(skeleton, known, positions, orientations)
    root = middle - ours[:, hips] @ between_hips
    root[:, 1] += _stretch_shift(clip, skeleton, known, positions, root, ours, ankles)
    for k, side in enumerate(SIDES):
        _place_ankle(skeleton, side, root, ours, ankles[:, k])
    root[:, 1] += _floor_shift(clip, skeleton, known, positions, orientations, root, ours)
    _bend_toes(skeleton, root, ours)
    local = local_rotations(skeleton, ours)
    return Clip(clip.name, skeleton, clip.frame_time, root, Rotation.from_matrix(local).as_quat())


def _carry_over(skeleton, known, orientations):
    """Our world orientations (T, J, 3, 3) from theirs; a missing joint goes with its parent."""
    theirs = orientations @ known.corrections
    part = known.roles
    given = {name: theirs[:, part.limbs[name]] for name in skeleton.names if name in part.limbs}
    chest = theirs[:, part.trunk[-1]] if part.trunk else given["Hips"]
    given |= _share(_TRUNK, [given["Hips"], *(theirs[:, j] for j in part.trunk)])
    given |= _share(_NECK, [chest, *(theirs[:, j] for j in part.neck)])
    for side in SIDES:
        if side + "Shoulder" in given:
            given[side + "Shoulder"] = _part_way(chest, given[side + "Shoulder"], known.clavicles)
    ours = np.empty((len(orientations), len(skeleton), 3, 3))
    for j, name in enumerate(skeleton.names):
        ours[:, j] = given[name] if name in given else ours[:, skeleton.parents[j]]
    return ours


def _share(names, chain):
    """A chain of source orientations spread over our joints: the last keeps the last one."""
    shared = {}
    for i, name in enumerate(names, 1):
        place = i / len(names) * (len(chain) - 1)
        low = min(int(np.floor(place + 1e-9)), len(chain) - 1)
        high = min(low + 1, len(chain) - 1)
        shared[name] = _part_way(chain[low], chain[high], place - low)
    return shared


def _part_way(a, b, share):
    """Rotations (..., 3, 3) on the way from a to b: 0 is a, 1 is b."""
    return a @ exp(share * log(np.swapaxes(a, -1, -2) @ b))


def _stretch_shift(clip, skeleton, known, positions, root, ours, ankles):
    """How far to lift the hips (T,) [m] so that legs near full stretch are stretched as theirs were."""
    at, _ = forward_kinematics(skeleton, root, local_rotations(skeleton, ours))
    pull, say = np.zeros(len(clip)), np.full(len(clip), _SLACK)
    for k, side in enumerate(SIDES):
        hip, knee, foot = (skeleton.index(side + n) for n in ("UpLeg", "Leg", "Foot"))
        length = np.linalg.norm(skeleton.offsets[knee]) + np.linalg.norm(skeleton.offsets[foot])
        stretch = leg_stretch(positions, known.roles, side) / known.reach[k]
        wanted = (stretch - _SOFT * np.logaddexp(0.0, (stretch - _STRAIGHTEST) / _SOFT)) * length
        leg = at[:, hip] - ankles[:, k]
        distance = np.linalg.norm(leg, axis=-1)
        upright = leg[:, 1] / np.maximum(distance, 1e-9)
        weight = np.exp((stretch - 1.0) / _NEAR) * np.maximum(upright, 0.0)
        pull += weight * upright * (wanted - distance)
        say += weight * upright**2
    shift = gaussian_filter1d(pull / say, _CALM / clip.frame_time, mode="nearest")
    return np.clip(shift, -_MOST_SHIFT, _MOST_SHIFT)


def _place_ankle(skeleton, side, root, ours, ankle):
    """Turn thigh and shank (in `ours`, in place) so that the ankle comes to `ankle` (T, 3) [m]."""
    positions, _ = forward_kinematics(skeleton, root, local_rotations(skeleton, ours))
    hip, knee, foot = (skeleton.index(side + name) for name in ("UpLeg", "Leg", "Foot"))
    # the knee points where the data bends it; a straight leg takes the thigh's own forward axis
    line = positions[:, foot] - positions[:, hip]
    bend = positions[:, knee] - positions[:, hip]
    along = np.sum(bend * line, -1, keepdims=True) / np.sum(line * line, -1, keepdims=True)
    pole = bend - along * line + 0.02 * ours[:, hip, :, 2]
    upper, lower = two_bone_turns(positions[:, hip], positions[:, knee], positions[:, foot], ankle, pole)
    ours[:, hip] = upper @ ours[:, hip]
    ours[:, knee] = lower @ ours[:, knee]


def _bend_toes(skeleton, root, ours):
    """Turn toes (in `ours`, in place) that point into the floor along it: most data has them stiff."""
    positions, _ = forward_kinematics(skeleton, root, local_rotations(skeleton, ours))
    rest = contact_height(skeleton)
    for side in SIDES:
        toe = skeleton.index(side + "Toe")
        bone = skeleton.end_offsets[skeleton.end_index[side + "Toe"]]
        length = np.linalg.norm(bone)
        points = ours[:, toe] @ (bone / length)
        # a ball that is itself below the floor keeps its toes level
        least = np.clip((rest - positions[:, toe, 1]) / length, -1.0, 0.0)
        low = (points[:, 1] < least) & (np.hypot(points[:, 0], points[:, 2]) > 1e-6)
        ground = points[low][:, [0, 2]]
        ground *= np.sqrt(1 - least[low] ** 2)[:, None] / np.linalg.norm(ground, axis=-1, keepdims=True)
        level = np.stack([ground[:, 0], least[low], ground[:, 1]], -1)
        ours[low, toe] = between(points[low], level) @ ours[low, toe]


def _floor_shift(clip, skeleton, known, positions, orientations, root, ours):
    """How far to lift the clip [m] so that the balls of flat feet are at their contact height."""
    at, _ = forward_kinematics(skeleton, root, local_rotations(skeleton, ours))
    heights = []
    for side in SIDES:
        theirs = foot_points(clip.skeleton, known.roles, side, positions, orientations)
        ankle, ball = (known.scale * p for p in theirs)
        flat = flat_frames(ankle, ball, clip.frame_time)
        heights.append(at[flat, skeleton.index(side + "Toe"), 1])
    return contact_height(skeleton) - np.median(np.concatenate(heights))
