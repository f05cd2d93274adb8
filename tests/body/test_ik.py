"""Two bones: the end meets the target, bones keep their lengths, and nothing is ever NaN."""

import numpy as np
import pytest

from gambol.controllers.body import forward_kinematics, human, local_rotations
from gambol.controllers.body.ik import EPSILON, pole_of, two_bone, two_bone_kernel, two_bone_turns

BATCHES = ((), (1,), (3, 1, 2, 1))


@pytest.fixture
def rng():
    return np.random.default_rng(5)


def limb(rng, batch):
    """A bent limb, and a target within its reach."""
    root, mid, end = (rng.normal(size=batch + (3,)) for _ in range(3))
    upper, lower = np.linalg.norm(mid - root, axis=-1), np.linalg.norm(end - mid, axis=-1)
    way = rng.normal(size=batch + (3,))
    way /= np.linalg.norm(way, axis=-1, keepdims=True)
    reach = np.abs(upper - lower) + rng.uniform(0.05, 0.95, batch) * (upper + lower - np.abs(upper - lower))
    return root, mid, end, root + way * reach[..., None], upper, lower


@pytest.mark.parametrize("batch", BATCHES, ids=str)
def test_the_end_meets_a_target_in_reach_and_bones_keep_their_lengths(batch, rng):
    root, mid, end, target, upper, lower = limb(rng, batch)
    new_mid, new_end = two_bone(root, mid, end, target)
    assert new_mid.shape == new_end.shape == batch + (3,)
    np.testing.assert_allclose(new_end, target, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(new_mid - root, axis=-1), upper, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(new_end - new_mid, axis=-1), lower, atol=1e-9)


@pytest.mark.parametrize("batch", BATCHES, ids=str)
def test_a_target_where_the_end_is_changes_nothing(batch, rng):
    root, mid, end, *_ = limb(rng, batch)
    new_mid, new_end = two_bone(root, mid, end, end)
    np.testing.assert_allclose(new_mid, mid, atol=1e-6)
    np.testing.assert_allclose(new_end, end, atol=1e-6)


@pytest.mark.parametrize("batch", BATCHES, ids=str)
def test_the_middle_bends_towards_the_pole(batch, rng):
    root, mid, end, target, *_ = limb(rng, batch)
    pole = rng.normal(size=batch + (3,))
    new_mid, new_end = two_bone(root, mid, end, target, pole)
    bend = pole_of(root, new_mid, new_end)
    wanted = pole_of(root, root + pole, new_end)
    cosine = np.sum(bend * wanted, -1) / np.linalg.norm(bend, axis=-1) / np.linalg.norm(wanted, axis=-1)
    np.testing.assert_allclose(cosine, np.ones(batch), atol=1e-9)


@pytest.mark.parametrize("distance", [0.0, 1e-12, 0.1, 1.7 - 1e-9, 1.7, 2.0, 1e6])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_an_unreachable_target_gives_the_nearest_reach_never_nan(distance, dtype):
    """Bones of 1.0 and 0.7 reach from 0.3 to 1.7."""
    root, mid, end = np.array([[0, 0, 0], [0, -1.0, 0], [0, -1.7, 0]], dtype)
    way = np.array([0.36, -0.48, 0.8], dtype)
    new_mid, new_end = two_bone(root, mid, end, root + way * dtype(distance), np.array([0, 0, 1], dtype))
    assert new_mid.dtype == new_end.dtype == dtype
    assert np.all(np.isfinite(new_mid)) and np.all(np.isfinite(new_end))
    assert np.linalg.norm(new_end) == pytest.approx(np.clip(distance, 0.3, 1.7), abs=3 * EPSILON)
    if distance > 1e-6:
        np.testing.assert_allclose(new_end / np.linalg.norm(new_end), way, atol=1e-5)
    assert np.linalg.norm(new_mid) == pytest.approx(1.0, abs=1e-5)


def test_a_buffer_keeps_the_limb_short_of_straight():
    root, mid, end = np.zeros(3), np.array([0, -0.42, 0.0]), np.array([0, -0.86, 0.0])
    _, new_end = two_bone(root, mid, end, np.array([0, -2.0, 0]), np.array([0, 0, 1.0]), buffer=0.015)
    assert np.linalg.norm(new_end) == pytest.approx(0.845)


@pytest.mark.parametrize("pole", [[0, 0, 0], [0, -1, 0], [0, 3, 0]])
def test_a_pole_that_says_nothing_still_gives_a_bend(pole):
    root, mid, end, target = np.array([[0, 0, 0], [0, -1.0, 0], [0, -2.0, 0], [0, -1.5, 0]])
    new_mid, new_end = two_bone(root, mid, end, target, np.array(pole, float))
    np.testing.assert_allclose(new_end, target, atol=1e-9)
    assert np.linalg.norm(new_mid - root) == pytest.approx(1.0)


def test_it_is_the_same_problem_wherever_the_world_is_turned(rng):
    from sampling import rotations
    turn, shift = rotations("uniform", (), rng), rng.normal(size=3)
    parts = limb(rng, (4,))[:4]
    plain = two_bone(*parts)
    moved = two_bone(*(p @ turn.T + shift for p in parts))
    for a, b in zip(plain, moved):
        np.testing.assert_allclose(a @ turn.T + shift, b, atol=1e-9)


def test_the_turns_put_a_whole_leg_there_and_keep_the_knee_a_hinge(rng):
    """Through forward kinematics: a leg that bends about X goes on bending about X."""
    skeleton = human()
    from gambol.controllers.body.rotations import exp
    hip, knee, foot = (skeleton.index("Left" + n) for n in ("UpLeg", "Leg", "Foot"))
    vectors = np.zeros((40, len(skeleton), 3))
    vectors[:, hip] = rng.normal(size=(40, 3)) * 0.4
    vectors[:, knee, 0] = rng.uniform(0.1, 1.5, 40)
    positions, orientations = forward_kinematics(skeleton, np.array([0, 1.0, 0]), exp(vectors))
    target = positions[:, foot] + rng.normal(size=(40, 3)) * 0.05 + [0, 0.08, 0]
    upper, lower = two_bone_turns(positions[:, hip], positions[:, knee], positions[:, foot], target)
    turned = orientations.copy()
    turned[:, hip] = upper @ turned[:, hip]
    turned[:, knee] = lower @ turned[:, knee]
    local = local_rotations(skeleton, turned)
    reached, _ = forward_kinematics(skeleton, np.array([0, 1.0, 0]), local)
    np.testing.assert_allclose(reached[:, foot], target, atol=1e-9)
    np.testing.assert_allclose(local[:, knee] @ [1.0, 0, 0], np.tile([1.0, 0, 0], (40, 1)), atol=1e-9)
    assert np.all(local[:, knee, 2, 1] > 0)  # bent backward, as knees do


def test_the_kernel_is_what_arrays_get():
    root, target, pole = np.array([0.1, 0.2, 0.3]), np.array([0.4, -0.9, 0.6]), np.array([0, 0.1, 1.0])
    mid, end = np.empty(3), np.empty(3)
    two_bone_kernel(root, 0.8, 0.9, target, pole, 0.0, mid, end)
    start = root + [0, -0.8, 0]
    both = two_bone(root, start, start + [0, -0.9, 0], target, pole)
    np.testing.assert_allclose([mid, end], both, atol=1e-12)


def test_wrong_shapes_are_named():
    with pytest.raises(ValueError, match=r"\(2,\)"):
        two_bone(*np.zeros((4, 2)), np.zeros(2))
