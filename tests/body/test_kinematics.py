"""Forward kinematics against scipy and by hand; poses and clips; the standard human."""

from dataclasses import replace

import numpy as np
import pytest
from sampling import BATCHES, angle, rotations
from scipy.spatial.transform import RigidTransform, Rotation

from gambol.controllers.body import Clip, Skeleton, end_positions, forward_kinematics, human, local_rotations
from gambol.controllers.body.clip import mirror_index
from gambol.controllers.body.human import CONTACT_HEIGHT, HEEL, STATURE


def random_tree(rng, count=9):
    parents = np.array([-1] + [rng.integers(0, j) for j in range(1, count)])
    return Skeleton(tuple(f"j{j}" for j in range(count)), parents, rng.normal(size=(count, 3)),
                    np.array([count - 1, 0]), rng.normal(size=(2, 3)))


def random_clip(rng, frames=7, fps=30.0):
    skeleton = human()
    turns = rng.normal(size=(frames, len(skeleton), 3)) * 0.4
    return Clip("random", skeleton, 1 / fps, rng.normal(size=(frames, 3)),
                Rotation.from_rotvec(turns.reshape(-1, 3)).as_quat().reshape(frames, len(skeleton), 4))


@pytest.fixture
def rng():
    return np.random.default_rng(3)


@pytest.mark.parametrize("batch", BATCHES, ids=str)
def test_kinematics_is_the_composition_of_rigid_transforms(batch, rng):
    skeleton = random_tree(rng)
    root = rng.normal(size=batch + (3,))
    local = rotations("uniform", batch + (len(skeleton),), rng)
    positions, orientations = forward_kinematics(skeleton, root, local)
    assert positions.shape == batch + (9, 3) and orientations.shape == batch + (9, 3, 3)
    for index in np.ndindex(*batch):
        world = []
        for j, parent in enumerate(skeleton.parents):
            at = root[index] if parent < 0 else skeleton.offsets[j]
            step = RigidTransform.from_components(at, Rotation.from_matrix(local[index + (j,)]))
            world.append(step if parent < 0 else world[parent] * step)
            np.testing.assert_allclose(positions[index + (j,)], world[j].translation, atol=1e-12)
            np.testing.assert_allclose(orientations[index + (j,)], world[j].rotation.as_matrix(), atol=1e-12)
    ends = end_positions(skeleton, positions, orientations)
    by_hand = positions[..., 8, :] + orientations[..., 8, :, :] @ skeleton.end_offsets[0]
    np.testing.assert_allclose(ends[..., 0, :], by_hand, atol=1e-12)


def test_local_rotations_invert_kinematics(rng):
    skeleton = random_tree(rng)
    local = rotations("uniform", (3, 1, 2, 1, len(skeleton)), rng)
    np.testing.assert_allclose(local_rotations(skeleton, forward_kinematics(skeleton, np.zeros(3), local)[1]),
                               local, atol=1e-12)


def test_kinematics_in_single_precision_stays_single_and_close(rng):
    skeleton = human()
    local = rotations("tangent", (5, len(skeleton)), rng)
    exact, _ = forward_kinematics(skeleton, np.zeros(3), local)
    single, _ = forward_kinematics(skeleton, np.zeros(3), local.astype(np.float32))
    assert single.dtype == np.float32
    np.testing.assert_allclose(single, exact, atol=2e-6)


def test_kinematics_names_both_shapes_when_they_do_not_fit(rng):
    with pytest.raises(ValueError, match=r"\(4, 3, 3\).*22 joints"):
        forward_kinematics(human(), np.zeros(3), np.zeros((4, 3, 3)))


@pytest.mark.parametrize("parents, message", [([-1, 2, 0], "before their children"), ([-1, -1, 0], "one root"),
                                              ([0, 0, 1], "one root")])
def test_a_skeleton_is_a_tree_in_order(parents, message):
    with pytest.raises(ValueError, match=message):
        Skeleton(("a", "b", "c"), parents, np.zeros((3, 3)), [], np.zeros((0, 3)))


def test_a_skeleton_names_names_that_occur_twice():
    with pytest.raises(ValueError, match="twice: a"):
        Skeleton(("a", "b", "a"), [-1, 0, 0], np.zeros((3, 3)), [], np.zeros((0, 3)))


def test_the_standard_human_stands_on_the_floor_and_is_symmetric():
    skeleton = human()
    count = len(skeleton)
    positions, orientations = forward_kinematics(skeleton, skeleton.offsets[0], np.broadcast_to(np.eye(3), (count, 3, 3)))
    ends = end_positions(skeleton, positions, orientations)
    assert count == 22
    assert ends[:, 1].max() == pytest.approx(STATURE)
    foot = positions[skeleton.index("LeftFoot")]
    for height in (positions[skeleton.index("LeftToe"), 1], ends[skeleton.end_index["LeftToe"], 1], (foot + HEEL)[1]):
        assert height == pytest.approx(CONTACT_HEIGHT)
    swap = mirror_index(skeleton)
    np.testing.assert_array_equal(swap[swap], np.arange(count))
    np.testing.assert_allclose(positions[swap] * [-1, 1, 1], positions, atol=1e-15)
    assert positions[skeleton.index("LeftHand"), 0] > 0


@pytest.mark.parametrize("height", [1.2, 2.0])
def test_a_human_of_another_height_is_the_same_human_scaled(height):
    np.testing.assert_allclose(human(height).offsets, human().scaled(height / STATURE).offsets)


def test_mirror_is_an_involution(rng):
    clip = random_clip(rng)
    twice = clip.mirror().mirror()
    np.testing.assert_allclose(twice.root, clip.root, atol=1e-15)
    assert angle(twice.rotations, clip.rotations) < 1e-7


def test_mirror_mirrors_every_joint(rng):
    clip = random_clip(rng)
    swap = mirror_index(clip.skeleton)
    there, turned = clip.kinematics()
    back, back_turned = clip.mirror().kinematics()
    np.testing.assert_allclose(back, there[:, swap] * [-1, 1, 1], atol=1e-12)
    flip = np.diag([-1.0, 1.0, 1.0])
    np.testing.assert_allclose(back_turned, flip @ turned[:, swap] @ flip, atol=1e-12)


@pytest.mark.parametrize("fps", [30.0, 60.0, 120.0, 45.0, 24.0])
def test_resample_keeps_the_ends(fps, rng):
    clip = random_clip(rng, frames=31)  # one second
    other = clip.resample(fps)
    assert other.frame_time == pytest.approx(1 / fps)
    assert other.duration == pytest.approx(clip.duration)
    for end in (0, -1):
        np.testing.assert_allclose(other.root[end], clip.root[end], atol=1e-9)
        assert angle(other.rotations[end], clip.rotations[end]) < 1e-7


def test_resample_to_the_same_rate_changes_nothing(rng):
    clip = random_clip(rng)
    same = clip.resample(30.0)
    np.testing.assert_allclose(same.root, clip.root, atol=1e-12)
    assert angle(same.rotations, clip.rotations) < 1e-7


def test_smoothly_resampled_a_swing_has_no_corners(rng):
    """Of a pendulum on a way that rises and falls, 24 frames a second: its own frames stay, and what lies between is a tenth as far off as along lines."""
    def swung(fps):
        at = np.arange(round(2 * fps) + 1) / fps
        root = np.stack([np.sin(4 * at), np.cos(3 * at), at], -1)
        turns = Rotation.from_rotvec(np.outer(np.sin(5 * at), [0.3, 0.8, -0.5])).as_quat()
        plain = random_clip(rng, frames=len(at))
        joints = len(plain.skeleton)
        return replace(plain, frame_time=1 / fps, root=root, quaternions=np.repeat(turns[:, None], joints, 1))

    slow, true = swung(24.0), swung(60.0)
    same, smooth, lines = slow.resample(24.0, smooth=True), slow.resample(60.0, smooth=True), slow.resample(60.0)
    np.testing.assert_allclose(same.root, slow.root, atol=1e-12)
    assert angle(same.rotations, slow.rotations) < 1e-7
    assert np.abs(smooth.root - true.root).max() < 0.1 * np.abs(lines.root - true.root).max()
    inner = slice(5, -5)  # nothing tells a spline how it goes on beyond its ends
    assert angle(smooth.rotations[inner], true.rotations[inner]) < 0.1 * angle(lines.rotations[inner], true.rotations[inner])


def test_resample_of_a_single_frame(rng):
    assert len(random_clip(rng, frames=1).resample(60.0)) == 1


def test_slices_are_frames(rng):
    clip = random_clip(rng)
    part = clip.slice(2, 5)
    assert len(part) == 3
    np.testing.assert_array_equal(part.root, clip.root[2:5])
