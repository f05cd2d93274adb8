"""Rigs: anybody's skeleton moves as ours does, whatever its names, axes, units, frames and rest pose."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from gambol.controllers.body import Skeleton, exp, forward_kinematics, human
from gambol.controllers.mocap import NoHuman, Rig

HUMAN = human()
T_POSE, _ = forward_kinematics(HUMAN, HUMAN.offsets[0], np.tile(np.eye(3), (22, 1, 1)))
A_POSE = dict(LeftArm=(0, 0, -50), RightArm=(0, 0, 50), LeftUpLeg=(0, 0, 6), RightUpLeg=(0, 0, -6), LeftFoot=(0, 0, -6), RightFoot=(0, 0, 6))
MIXAMO = tuple(f"mixamorig:{name.replace('Toe', 'ToeBase')}" for name in HUMAN.names)
BENT = "LeftLeg", "RightLeg"


def stood(**angles):
    """Places (22, 3) and orientations (22, 3, 3) of the standard human with some joints turned [degrees], soles on the floor."""
    local = np.tile(np.eye(3), (22, 1, 1))
    for name, angle in angles.items():
        local[HUMAN.index(name)] = Rotation.from_euler("xyz", angle, degrees=True).as_matrix()
    at, turned = forward_kinematics(HUMAN, HUMAN.offsets[0], local)
    return at - [0.0, at[HUMAN.index("LeftFoot"), 1] - T_POSE[HUMAN.index("LeftFoot"), 1], 0.0], turned


def danced(seed, frames=5, size=0.5):
    """Somebody in poses of all kinds: root (T, 3), rotations (T, 22, 3, 3); knees bend as knees do."""
    rng = np.random.default_rng(seed)
    turns = rng.normal(0.0, size, (frames, 22, 3))
    for name in BENT:
        turns[:, HUMAN.index(name)] = rng.uniform(0.1, 1.2, (frames, 1)) * [1.0, 0.0, 0.0]
    return rng.normal(0.0, 2.0, (frames, 3)), exp(turns)


@settings(max_examples=20)
@given(st.integers(0, 9999), st.booleans(), st.sampled_from([1.0, 0.01, 0.0254]), st.sampled_from([0, 90, 180, -30, 45, -137]))
def test_whatever_the_axes_units_frames_and_rest_pose_joints_are_where_ours_are(seed, slanting, metres, facing):
    rng = np.random.default_rng(seed)
    at, turned = stood(**A_POSE) if slanting else stood()
    axes = Rotation.from_rotvec([0.0, np.radians(facing), 0.0]).as_matrix() @ [[1, 0, 0], [0, 0, 1], [0, -1, 0]]  # Z up
    frames = Rotation.random(22, rng=rng).as_matrix()
    rig = Rig.of(MIXAMO, HUMAN.parents, at @ axes / metres, axes.T @ turned @ frames)
    root, rotations = danced(seed)
    moved, (ours, faced) = rig.pose(HUMAN, root, rotations), forward_kinematics(HUMAN, root, rotations)
    assert abs(rig.height - 1.741) < 1e-6 and rig.unit == metres
    assert np.abs(moved.places * metres @ rig.axes.T - ours).max() < 1e-4
    flesh = moved.turned @ np.swapaxes(axes.T @ turned @ frames, -1, -2)  # what each bone's flesh turned by since rest, in its own world
    rest = np.swapaxes(turned, -1, -2)
    for name in ("LeftForeArm", "RightFoot", "Head", "Hips", "LeftUpLeg"):
        j = HUMAN.index(name)
        assert np.abs(rig.axes @ flesh[:, j] @ rig.axes.T - faced[:, j] @ rest[j]).max() < 2e-3, name


def test_local_turns_and_the_hips_are_all_that_it_takes():
    at, turned = stood(**A_POSE)
    rng = np.random.default_rng(3)
    frames = turned @ Rotation.random(22, rng=rng).as_matrix()
    names, parents = ("root", *MIXAMO), np.array([-1, *(HUMAN.parents + 1)])
    rig = Rig.of(names, parents, np.concatenate([[[0.1, 0.0, 0.2]], at]), np.concatenate([Rotation.random(1, rng=rng).as_matrix(), frames]))
    moved, rest = rig.pose(HUMAN, *danced(1)), rig.at_rest()
    places, world = np.empty_like(moved.places), np.empty_like(moved.turned)
    for bone, parent in enumerate(parents):
        still = rest.places[bone] if parent < 0 else rest.turned[parent].T @ (rest.places[bone] - rest.places[parent])
        offset = moved.hips if names[bone].endswith("Hips") else np.broadcast_to(still, (5, 3))
        up = np.tile(np.eye(3), (5, 1, 1)) if parent < 0 else world[:, parent]
        world[:, bone] = up @ moved.local[:, bone]
        places[:, bone] = (0.0 if parent < 0 else places[:, parent]) + np.einsum("tij,tj->ti", up, offset)
    assert np.abs(places - moved.places).max() < 1e-9 and np.abs(world - moved.turned).max() < 1e-9


@pytest.mark.parametrize("spines", [0, 1, 2, 5])
def test_trunks_of_any_number_of_bones_end_as_ours_does(spines):
    """So far as it has any: each bends on by the same share."""
    chain = [f"spine_{k:02}" for k in range(1, spines + 1)]
    lowest, highest = T_POSE[0], T_POSE[HUMAN.index("Spine2")]
    names, parents, at = ["pelvis", *chain], list(range(-1, spines)), [lowest + (highest - lowest) * k / max(spines, 1) for k in range(spines + 1)]
    for j, name in enumerate(HUMAN.names):
        if name in ("Hips", "Spine", "Spine1", "Spine2"):
            continue
        mother = HUMAN.names[HUMAN.parents[j]]
        parents.append(0 if mother == "Hips" else spines if mother == "Spine2" else names.index(mother))
        names.append(name)
        at.append(T_POSE[j])
    rig = Rig.of(names, parents, np.array(at))
    local = np.tile(np.eye(3), (22, 1, 1))
    local[1:4] = exp(np.array([0.3, 0.0, 0.0]))  # three of ours bend by 0.3 each
    turned = rig.pose(HUMAN, HUMAN.offsets[0], local).turned
    bends = [np.linalg.norm(Rotation.from_matrix(turned[k]).as_rotvec()) for k in range(spines + 1)]
    assert np.allclose(bends, np.linspace(0.0, 0.9, spines + 1) if spines else 0.0, atol=1e-6)
    assert np.allclose(turned[names.index("Head")], exp(np.array([0.9, 0.0, 0.0])), atol=1e-6)


def test_what_follows_nobody_stays_on_its_parent():
    """Fingers, twist bones, a root."""
    names, parents = ("root", *HUMAN.names, "thumb", "twist"), np.array([-1, *(HUMAN.parents + 1), HUMAN.index("LeftHand") + 1, HUMAN.index("RightArm") + 1])
    extra = T_POSE[[HUMAN.index("LeftHand"), HUMAN.index("RightArm")]] + [[0.05, 0.0, 0.03], [-0.1, 0.0, 0.0]]
    rig = Rig.of(names, parents, np.concatenate([[[0.0, 0.0, 0.0]], T_POSE, extra]))
    moved, rest = rig.pose(HUMAN, *danced(2)), rig.at_rest()
    for bone in (23, 24):
        mother = parents[bone]
        there = np.einsum("tji,tj->ti", moved.turned[:, mother], moved.places[:, bone] - moved.places[:, mother])
        assert np.allclose(there, rest.places[bone] - rest.places[mother], atol=1e-9)
        assert np.allclose(moved.local[:, bone], np.eye(3), atol=1e-9)
    assert np.allclose(moved.places[:, 0], 0.0) and np.allclose(moved.turned[:, 0], np.eye(3))


def test_soles_of_other_legs_come_down_where_ours_do():
    """Longer shanks, shorter thighs, higher heels, half the size: as far as its hips are lower, everything is nearer to the origin, and ankles are over the same places."""
    scales = {"LeftLeg": 0.85, "RightLeg": 0.85, "LeftFoot": 1.1, "RightFoot": 1.1, "LeftToe": 1.3, "RightToe": 1.3}
    at = T_POSE.copy()
    for j, (name, parent) in enumerate(zip(HUMAN.names, HUMAN.parents)):
        if parent >= 0:
            at[j] = at[parent] + (T_POSE[j] - T_POSE[parent]) * scales.get(name, 1.0)
    at = 0.5 * (at - [0.0, at[HUMAN.index("LeftToe"), 1] - 0.02, 0.0])
    rig = Rig.of(HUMAN.names, HUMAN.parents, at, metres=1.0)
    root, rotations = danced(4, frames=30, size=0.2)
    rotations[:, 0] = np.eye(3)
    ours, faced = forward_kinematics(HUMAN, root, rotations)
    share = rig.height / 1.741
    moved = rig.pose(HUMAN, root, rotations)
    for side in ("Left", "Right"):
        foot = HUMAN.index(side + "Foot")
        sole = moved.places[:, foot] - faced[:, foot, :, 1] * at[foot, 1]
        wanted = share * (ours[:, foot] - faced[:, foot, :, 1] * T_POSE[foot, 1])
        assert np.abs(sole - wanted).max() < 1e-3
    taller = human(rig.height)
    same = rig.pose(taller, root * share, rotations)
    assert np.abs(same.places - moved.places).max() < 1e-6, "of its own height, he is where it is"


def test_poses_have_any_leading_axes():
    rig = Rig.of(HUMAN.names, HUMAN.parents, T_POSE)
    root, rotations = danced(5, frames=6)
    whole, cut = rig.pose(HUMAN, root, rotations), rig.pose(HUMAN, root.reshape(2, 3, 3), rotations.reshape(2, 3, 22, 3, 3))
    one = rig.pose(HUMAN, root[4], rotations[4])
    assert cut.places.shape == (2, 3, 22, 3) and one.local.shape == (22, 3, 3)
    assert np.allclose(cut.places.reshape(6, 22, 3), whole.places, atol=1e-12) and np.allclose(one.local, whole.local[4], atol=1e-12)


def test_bones_of_any_names_are_told_by_parts():
    names = tuple(f"b{k}" for k in range(22))
    with pytest.raises(NoHuman, match="not a human we know"):
        Rig.of(names, HUMAN.parents, T_POSE)
    parts = dict(zip(HUMAN.names, names))
    assert np.allclose(Rig.of(names, HUMAN.parents, T_POSE, parts=parts).pose(HUMAN, *danced(6)).local, Rig.of(HUMAN.names, HUMAN.parents, T_POSE).pose(HUMAN, *danced(6)).local)
    with pytest.raises(ValueError, match="parts: no bone for Hips, LeftArm"):
        Rig.of(names, HUMAN.parents, T_POSE, parts={k: v for k, v in parts.items() if k not in ("Hips", "LeftArm")})
    with pytest.raises(ValueError, match="not Hips: 'b77', Tail: 'b3'"):
        Rig.of(names, HUMAN.parents, T_POSE, parts=parts | {"Tail": "b3", "Hips": "b77"})


def test_what_no_rig_can_be_made_of_is_told():
    for change, said in ((dict(places=T_POSE[:5]), r"22 names need parents \(22,\), places \(22, 3\)"),
                         (dict(places=np.where(np.arange(22)[:, None] == 4, np.nan, T_POSE)), "bone 'Neck' is at no place"),
                         (dict(turned=np.tile(2.0 * np.eye(3), (22, 1, 1))), "its turn is no rotation: take scales"),
                         (dict(turned=np.tile(np.diag([-1.0, 1.0, 1.0]), (22, 1, 1))), "mirrors"),
                         (dict(places=1e5 * T_POSE), "is no human's"), (dict(places=0.0 * T_POSE), "hips and head are in one place"),
                         (dict(places=np.where(np.arange(22)[:, None] == HUMAN.index("LeftLeg"), T_POSE[HUMAN.index("LeftUpLeg")], T_POSE)), "LeftUpLeg has no length: LeftLeg is"),
                         (dict(places=T_POSE * [-1.0, 1.0, 1.0]), "left and right are exchanged"),
                         (dict(parents=np.arange(22)), "parents must come before")):
        given_ = dict(names=HUMAN.names, parents=HUMAN.parents, places=T_POSE) | change
        with pytest.raises(ValueError, match=said):
            Rig.of(**given_)


def test_a_rig_is_a_value_that_prints_in_a_line():
    rig = Rig.of(HUMAN.names, HUMAN.parents, T_POSE)
    assert len(repr(rig)) < 700 and "\n" not in repr(rig) and isinstance(rig.skeleton, Skeleton)
