"""Retargeting: onto itself nothing changes, whatever the source's frames, size and names; real feet stand flat."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from gambol.controllers.body import Clip, Skeleton, end_positions, forward_kinematics, human, local_rotations
from gambol.controllers.body.contact import contact_points, detect_contacts, foot_drift, point_speeds
from gambol.controllers.body.ik import two_bone_turns
from gambol.controllers.body.rotations import exp
from gambol.controllers.mocap import load
from gambol.controllers.mocap.calibration import calibrate
from gambol.controllers.mocap.flat_stance import flat_frames
from gambol.controllers.mocap.joint_names import plain, roles
from gambol.controllers.mocap.retarget import retarget

FPS = 60.0


def walk(seconds=4.0, speed=0.9, skeleton=None) -> Clip:
    """A hand-made walk of the standard human: flat feet, bent elbows, everything known."""
    skeleton = skeleton or human()
    time = np.arange(int(seconds * FPS)) / FPS
    root = np.stack([0 * time, 0.94 + 0 * time, speed * time + 0.0], -1)
    vectors = np.zeros((len(time), len(skeleton), 3))
    sway = np.sin(2 * np.pi * time)
    vectors[:, skeleton.index("Hips"), 1] = 0.08 * sway
    vectors[:, skeleton.index("Spine1"), 1] = -0.1 * sway
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        hang = exp(np.array([0.0, 0.0, -1.45 * sign]))
        swing = exp(np.stack([0.35 * sign * sway, 0 * time, 0 * time], -1))
        vectors[:, skeleton.index(side + "Arm")] = Rotation.from_matrix(swing @ hang).as_rotvec()
        vectors[:, skeleton.index(side + "ForeArm"), 1] = -sign * (0.5 + 0.15 * sign * sway)
    positions, world = forward_kinematics(skeleton, root, exp(vectors))
    for side, sign, late in (("Left", 1.0, 0.0), ("Right", -1.0, 0.5)):
        cycles, phase = np.divmod(time + late, 1.0)
        part = np.clip((phase - 0.55) / 0.45, 0, 1)
        ease = part - np.sin(2 * np.pi * part) / (2 * np.pi)
        ankle = np.stack([0.0875 * sign + 0 * time, 0.068 + 0.07 * np.sin(np.pi * part) ** 2,
                          speed * (cycles + ease - late + 0.275)], -1)
        hip, knee, foot, toe = (skeleton.index(side + n) for n in ("UpLeg", "Leg", "Foot", "Toe"))
        upper, lower = two_bone_turns(positions[:, hip], positions[:, knee], positions[:, foot], ankle,
                                      np.array([0.0, 0.0, 1.0]))
        world[:, hip], world[:, knee] = upper @ world[:, hip], lower @ world[:, knee]
        world[:, foot] = world[:, toe] = exp(np.stack([0.5 * np.sin(2 * np.pi * part), 0 * time, 0 * time], -1))
    local = local_rotations(skeleton, world)
    return Clip("walk", skeleton, 1 / FPS, root, Rotation.from_matrix(local).as_quat())


def reframed(clip: Clip, seed=4) -> Clip:
    """The same motion on a skeleton whose joint frames are turned any way: no zero pose to trust."""
    skeleton = clip.skeleton
    turn = Rotation.random(len(skeleton), random_state=seed).as_matrix()
    parents = skeleton.parents
    offsets = skeleton.offsets.copy()
    offsets[1:] = np.einsum("jik,ji->jk", turn[parents[1:]], offsets[1:])
    ends = np.einsum("eik,ei->ek", turn[skeleton.end_parents], skeleton.end_offsets)
    world = clip.kinematics()[1] @ turn
    other = Skeleton(skeleton.names, parents, offsets, skeleton.end_parents, ends)
    return replace(clip, skeleton=other, quaternions=Rotation.from_matrix(local_rotations(other, world)).as_quat())


def renamed(clip: Clip, names: dict[str, str]) -> Clip:
    old = clip.skeleton
    return replace(clip, skeleton=Skeleton(tuple(names.get(n, n) for n in old.names), old.parents, old.offsets,
                                           old.end_parents, old.end_offsets))


@pytest.fixture(scope="module")
def own():
    return walk()


def test_onto_itself_nothing_changes(own):
    there, back = own.kinematics()[0], retarget(own).kinematics()[0]
    np.testing.assert_allclose(back, there, atol=2e-3)


@pytest.mark.parametrize("factor", [0.6, 1.15])
def test_size_is_scaled_away(own, factor):
    small = replace(own, skeleton=own.skeleton.scaled(factor), root=own.root * factor)
    np.testing.assert_allclose(retarget(small).kinematics()[0], retarget(own).kinematics()[0], atol=5e-3)


def test_a_leg_that_was_straight_is_straight(own):
    """Where a fitted skeleton has one bone too long, so that its knee never straightens, ours does as it stands."""
    def knees(positions, skeleton):
        a, b, c = (positions[:, skeleton.index("Left" + n)] for n in ("UpLeg", "Leg", "Foot"))
        u, v = b - a, c - b
        return np.degrees(np.arccos(np.clip((u * v).sum(-1) / np.linalg.norm(u, axis=-1) / np.linalg.norm(v, axis=-1), -1, 1)))
    tall = walk()
    hip, foot = (tall.kinematics()[0][:, own.skeleton.index("Left" + n)] for n in ("UpLeg", "Foot"))
    room = 0.8562 - np.linalg.norm(hip - foot, axis=-1).max()
    tall = replace(tall, root=tall.root + [0.0, room - 0.004, 0.0])  # its legs come to within 4 mm of straight
    theirs = knees(tall.kinematics()[0], tall.skeleton)
    ours = retarget(tall)
    assert knees(ours.kinematics()[0], ours.skeleton).min() < max(theirs.min(), 8.0) + 0.5
    moved = ours.kinematics()[0] - tall.kinematics()[0]
    assert np.abs(moved[:, own.skeleton.index("Hips")]).max() < 0.03


def test_a_zero_pose_along_the_bones_is_read_off_the_motion(own):
    known = calibrate([reframed(own)])
    assert not known.posed
    there, back = own.kinematics(), retarget(reframed(own), calibration=known).kinematics()
    np.testing.assert_allclose(back[0], there[0], atol=0.03)
    limbs = [own.skeleton.index(s + n) for s in ("Left", "Right") for n in ("Arm", "ForeArm", "Hand", "UpLeg", "Leg")]
    turned = np.swapaxes(back[1][:, limbs], -1, -2) @ there[1][:, limbs]
    angles = Rotation.from_matrix(turned.reshape(-1, 3, 3)).magnitude()
    assert np.degrees(angles.max()) < 12.0 and np.degrees(angles.mean()) < 5.0


def test_an_ankle_placed_higher_on_the_foot_makes_no_difference_to_the_soles(own):
    """As in subject 69, whose ankles are 8 cm too high."""
    skeleton = own.skeleton
    offsets = skeleton.offsets.copy()
    lift = np.array([0.0, 0.08, 0.0])
    for side in ("Left", "Right"):
        offsets[skeleton.index(side + "Toe")] -= lift
    root = own.root + lift  # the ankles of a flat foot rise with the body
    moved = retarget(replace(own, skeleton=replace(skeleton, offsets=offsets), root=root))
    positions, world = moved.kinematics()
    points = contact_points(skeleton, positions, world)
    feet = [skeleton.index(side + "Foot") for side in ("Left", "Left", "Right", "Right")]
    standing = (own.kinematics()[1][:, feet, 1, 1] > 1 - 1e-9) & (own.kinematics()[0][:, feet, 1] < 0.0681)
    np.testing.assert_allclose(points[standing][:, 1], 0.02, atol=1e-3)
    np.testing.assert_allclose(positions, own.kinematics()[0], atol=0.05)


def test_two_spine_joints_are_shared_among_three(own):
    skeleton = own.skeleton
    drop = skeleton.index("Spine1")
    keep = [j for j in range(len(skeleton)) if j != drop]
    parents = np.where(skeleton.parents == drop, skeleton.index("Spine"), skeleton.parents)
    offsets = skeleton.offsets.copy()
    offsets[skeleton.index("Spine2")] += offsets[drop]
    fewer = Skeleton(tuple(skeleton.names[j] for j in keep), [keep.index(parents[j]) if parents[j] >= 0 else -1 for j in keep],
                     offsets[keep], [keep.index(p) for p in skeleton.end_parents], skeleton.end_offsets)
    world = own.kinematics()[1]
    clip = replace(own, skeleton=fewer, quaternions=Rotation.from_matrix(local_rotations(fewer, world[:, keep])).as_quat())
    turned = retarget(clip).kinematics()[1]
    np.testing.assert_allclose(turned[:, skeleton.index("Spine2")], world[:, skeleton.index("Spine2")], atol=1e-6)
    a, b, c = (np.arctan2(turned[:, skeleton.index(n), 0, 2], turned[:, skeleton.index(n), 2, 2])
               for n in ("Spine", "Spine1", "Spine2"))
    assert np.all((b - a) * (c - b) >= -1e-9)  # the joint between lies between


@pytest.mark.parametrize("names", [
    {"Hips": "mixamorig:Hips", "LeftUpLeg": "mixamorig:LeftUpLeg", "LeftToe": "mixamorig:LeftToeBase"},
    {"LeftUpLeg": "lfemur", "LeftLeg": "ltibia", "LeftFoot": "lfoot", "LeftToe": "ltoes", "LeftArm": "lhumerus",
     "LeftForeArm": "lradius", "LeftHand": "lhand", "LeftShoulder": "lclavicle", "Head": "head", "Hips": "root"},
    {"LeftUpLeg": "LeftHip", "LeftLeg": "LeftKnee", "LeftFoot": "LeftAnkle", "LeftShoulder": "LeftCollar",
     "LeftArm": "LeftShoulder", "LeftForeArm": "LeftElbow", "LeftHand": "LeftWrist", "Spine": "Chest"},
    {"LeftUpLeg": "thigh.L", "LeftLeg": "shin.L", "LeftFoot": "foot.L", "LeftToe": "toe.L", "LeftArm": "upper_arm.L",
     "LeftForeArm": "forearm.L", "LeftHand": "hand.L", "LeftShoulder": "shoulder.L"},
    {"LeftUpLeg": "L_Hip", "LeftLeg": "L_Knee", "LeftFoot": "L_Ankle", "LeftToe": "L_Foot", "LeftShoulder": "L_Collar",
     "LeftArm": "L_Shoulder", "LeftForeArm": "L_Elbow", "LeftHand": "L_Wrist", "Hips": "Pelvis"},
    {"LeftShoulder": "LeftShoulder1", "LeftToe": "LeftToes"}], ids=["mixamo", "acclaim", "3ds", "blender", "smpl", "woody2"])
def test_other_peoples_names_play_the_same_parts(own, names):
    names |= {k.replace("Left", "Right"): _other_side(v) for k, v in names.items() if k.startswith("Left")}
    assert roles(renamed(own, names).skeleton) == roles(own.skeleton)
    assert roles(own.skeleton).trunk == tuple(own.skeleton.index(n) for n in ("Spine", "Spine1", "Spine2"))


@pytest.mark.parametrize("spelt", ["Character1_{}", "Bob {}", "m_avg_{}", "{}_jnt", "Rig1|Ctrl_{}_bind", "ValveBiped.Bip01_{}"])
def test_what_stands_before_or_after_every_name_is_no_part_of_it(own, spelt):
    assert roles(renamed(own, {name: spelt.format(name) for name in own.skeleton.names}).skeleton) == roles(own.skeleton)


def test_names_with_numbers_are_known(own):
    limbs = {"LeftUpLeg": "upperleg01.L", "LeftLeg": "lowerleg01.L", "LeftArm": "upperarm01.L", "LeftForeArm": "lowerarm01.L", "LeftHand": "wrist.L", "LeftFoot": "foot.L"}
    limbs |= {k.replace("Left", "Right"): _other_side(v) for k, v in limbs.items()} | {"Head": "ValveBiped.Bip01_Head1"}
    assert roles(renamed(own, limbs).skeleton) == roles(own.skeleton)


def test_japanese_names_are_known(own):
    limbs = {"LeftUpLeg": "左足", "LeftLeg": "左ひざ", "LeftFoot": "左足首", "LeftToe": "左つま先", "LeftShoulder": "左肩", "LeftArm": "左腕", "LeftForeArm": "左ひじ", "LeftHand": "左手首"}
    limbs |= {k.replace("Left", "Right"): v.replace("左", "右") for k, v in limbs.items()} | {"Hips": "センター", "Spine": "上半身", "Head": "頭"}
    assert roles(renamed(own, limbs).skeleton) == roles(own.skeleton)


def _other_side(name):
    for left, right in (("Left", "Right"), ("L_", "R_"), (".L", ".R")):
        if left in name:
            return name.replace(left, right)
    return "r" + name[1:]


def test_names_are_read_plainly():
    assert plain("mixamorig:LeftUpLeg") == plain("mixamorig1_LeftUpLeg") == plain("Left_Up Leg") == "leftupleg"


def test_what_is_no_human_is_refused_with_its_names():
    dog = Skeleton(("Hips", "Tail"), [-1, 0], np.zeros((2, 3)), [], np.zeros((0, 3)))
    with pytest.raises(ValueError, match="LeftUpLeg.*Hips, Tail"):
        roles(dog)


@pytest.mark.parametrize(("bone", "end"), [("LeftUpLeg", "LeftLeg"), ("RightLeg", "RightFoot"), ("LeftForeArm", "LeftHand")])
def test_a_bone_of_a_limb_without_a_length_is_refused_by_name(own, bone, end):
    offsets = own.skeleton.offsets.copy()
    offsets[own.skeleton.index(end)] = 0.0
    for change in (lambda clip: clip, reframed):
        legless = change(replace(own, skeleton=replace(own.skeleton, offsets=offsets)))
        with pytest.raises(ValueError, match=f"{bone} has no length: {end} is where it is"):
            retarget(legless)


def test_a_calibration_of_something_else_is_refused(own):
    tall = replace(own, skeleton=own.skeleton.scaled(1.3))
    with pytest.raises(ValueError, match="another skeleton"):
        calibrate([own, tall])
    with pytest.raises(ValueError, match="no clips"):
        calibrate([])


def test_a_single_frame_will_do(own):
    one = retarget(own.slice(10, 11))
    assert len(one) == 1 and np.all(np.isfinite(one.quaternions))


REAL = ["woody2/wd2_WalkForwardNormal00.bvh", "woody2/wd2_spiral_walk01.bvh", "cmu_30fps/69/69_43.bvh",
        "cmu_30fps/69/69_15.bvh", "cmu_bvh/35/35_02.bvh", "cmu/35/35_01.amc", "cmu/16/16_16.amc"]


@pytest.mark.few(4)
@pytest.mark.parametrize("path", REAL)
def test_real_motion_stands_flat_and_bends_the_right_way(shared, path):
    clip = load(shared / "mocap" / path)
    known = calibrate([clip])
    moved = retarget(clip, calibration=known)
    skeleton = moved.skeleton
    positions, orientations = moved.kinematics()
    points = contact_points(skeleton, positions, orientations)
    ends = end_positions(skeleton, positions, orientations)
    theirs, _ = clip.kinematics()
    rotvecs = Rotation.from_quat(moved.quaternions.reshape(-1, 4)).as_rotvec().reshape(len(moved), -1, 3)
    for k, (side, sign) in enumerate((("Left", 1.0), ("Right", -1.0))):
        part = known.roles.limbs
        ankle, ball = (known.scale * theirs[:, part[side + n]] for n in ("Foot", "Toe"))
        flat = flat_frames(ankle, ball, clip.frame_time)
        heights = np.stack([points[flat, 2 * k, 1], points[flat, 2 * k + 1, 1],
                            ends[flat, skeleton.end_index[side + "Toe"], 1]], -1)
        assert np.all(np.abs(np.median(heights, 0) - 0.02) < 0.01)
        assert np.mean(np.abs(heights - 0.02) < 0.01) > 0.8
        # the ankle of a standing foot is as slow as the data's
        here = np.linalg.norm(np.gradient(positions[:, skeleton.index(side + "Foot")], clip.frame_time, axis=0), axis=-1)
        there = np.linalg.norm(np.gradient(ankle, clip.frame_time, axis=0), axis=-1)
        assert np.median(here[flat]) < np.median(there[flat]) + 0.02
        assert np.median(rotvecs[:, skeleton.index(side + "Leg"), 0]) > 0.05  # knees bend back
        elbow = rotvecs[:, skeleton.index(side + "ForeArm"), 1]
        assert np.median(-sign * elbow) > 0.05  # elbows forward
        hips = np.swapaxes(orientations[:, 0], -1, -2)
        hand = np.einsum("tij,tj->ti", hips, positions[:, skeleton.index(side + "Hand")] - positions[:, 0])
        assert np.median(sign * hand[:, 0]) > 0.1  # arms not crossed
    assert np.median(orientations[:, skeleton.index("Head"), 1, 1]) > 0.9  # upright
    ahead = orientations[:, skeleton.index("Head"), :, 2] * orientations[:, 0, :, 2]
    assert np.median(ahead.sum(-1)) > 0.9  # facing as the hips do
    stands = detect_contacts(points[..., 1], point_speeds(points, clip.frame_time))
    assert foot_drift(points, stands).drift.mean() < 0.04
