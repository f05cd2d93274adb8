"""The contact detector on feet whose contacts are known."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from gambol.controllers.body import end_positions, forward_kinematics, human
from gambol.controllers.body.contact import (HEIGHT_GATE, WALK_SPEEDS, contact_height, contact_points, detect_contacts,
                                             feet_apart, foot_drift, point_speeds)


@pytest.mark.parametrize("batch", [(), (1,), (3, 1, 2, 1)], ids=str)
@pytest.mark.parametrize("height", [1.741, 1.5])
def test_in_the_t_pose_heels_and_balls_are_at_contact_height(batch, height):
    skeleton = human(height)
    local = np.broadcast_to(np.eye(3), batch + (len(skeleton), 3, 3))
    points = contact_points(skeleton, *forward_kinematics(skeleton, skeleton.offsets[0], local))
    assert points.shape == batch + (4, 3)
    np.testing.assert_allclose(points[..., 1], contact_height(skeleton), atol=1e-12)
    assert np.all(points[..., :2, 0] > 0) and np.all(points[..., 2:, 0] < 0)
    assert np.all(points[..., [1, 3], 2] > points[..., [0, 2], 2])


def steps(frames=200, dt=0.01, lift=0.1, speed=1.2):
    """Four points that stand half of each second and swing the other half, two by two."""
    time = np.arange(frames) * dt
    points = np.zeros((frames, 4, 3))
    truth = np.zeros((frames, 4), bool)
    for k in range(4):
        phase = (time + 0.5 * (k >= 2)) % 1.0
        truth[:, k] = phase < 0.5
        swing = np.clip((phase - 0.5) / 0.5, 0, 1)
        points[:, k, 1] = 0.02 + lift * np.sin(np.pi * swing) * (phase >= 0.5)
        points[:, k, 2] = speed * (np.floor(time + 0.5 * (k >= 2)) + swing - np.sin(2 * np.pi * swing) / (2 * np.pi))
    return points, truth, dt


def test_it_finds_the_stances_of_a_plain_walk():
    points, truth, dt = steps()
    found = detect_contacts(points[..., 1], point_speeds(points, dt))
    assert np.mean(found == truth) > 0.9
    stances = foot_drift(points, found)
    assert len(stances) >= 8
    assert stances.drift.max() < 0.03


def test_nothing_stands_in_the_air_and_nothing_fast_stands():
    still = np.zeros((10, 4))
    assert not detect_contacts(np.full((10, 4), HEIGHT_GATE * 1.01), still).any()
    assert not detect_contacts(np.full((10, 4), 0.02), np.broadcast_to(WALK_SPEEDS * 1.01, (10, 4))).any()
    assert detect_contacts(np.full((10, 4), 0.02), still).all()
    assert detect_contacts(np.full((10, 4), 0.02), np.full((10, 4), 0.9), running=True).all()


def test_hysteresis_bridges_a_flicker_around_the_limit():
    speeds = np.tile(WALK_SPEEDS, (20, 1)) * np.where(np.arange(20) % 2, 1.1, 0.9)[:, None]
    heights = np.full((20, 4), 0.02)
    held = detect_contacts(heights, speeds)
    assert held.all()
    assert not detect_contacts(heights, speeds, release=1.0)[1::2].any()


def test_short_stretches_are_dropped():
    speeds = np.full((20, 4), 5.0)
    speeds[5:7] = 0.0
    speeds[15:] = 0.0
    found = detect_contacts(np.full((20, 4), 0.02), speeds, shortest=3)
    assert not found[:15].any() and found[15:].all()


def test_batches_are_detected_each_by_itself():
    points, _, dt = steps()
    both = np.stack([points, points + [0, 1.0, 0]], 1)
    found = detect_contacts(both[..., 1], point_speeds(both, dt))
    np.testing.assert_array_equal(found[:, 0], detect_contacts(points[..., 1], point_speeds(points, dt)))
    assert not found[:, 1].any()


def test_drift_is_the_farthest_stray_on_the_ground():
    points = np.zeros((10, 4, 3))
    points[:, 1, 0] = [0, 0, 0, 0.01, 0.03, 0.02, 0.0, 5.0, 5.0, 5.0]
    points[:, 1, 1] = np.arange(10)  # height is no drift
    contacts = np.zeros((10, 4), bool)
    contacts[2:7, 1] = True
    contacts[8:, 1] = True
    stances = foot_drift(points, contacts)
    np.testing.assert_array_equal(stances.point, [1, 1])
    np.testing.assert_array_equal(stances.start, [2, 8])
    np.testing.assert_array_equal(stances.stop, [7, 10])
    np.testing.assert_allclose(stances.drift, [0.03, 0.0])


def test_no_contact_no_stance():
    assert len(foot_drift(np.zeros((5, 4, 3)), np.zeros((5, 4), bool))) == 0


def test_shapes_that_do_not_fit_are_named():
    with pytest.raises(ValueError, match=r"\(5, 3\)"):
        detect_contacts(np.zeros((5, 3)), np.zeros((5, 3)))


def test_feet_apart_is_the_nearest_of_many_points():
    """Centre lines sampled densely agree, and lines that cross are no distance apart."""
    skeleton, rng = human(), np.random.default_rng(2)
    local = Rotation.from_rotvec(rng.normal(size=(200, len(skeleton), 3)) * 0.3).as_matrix()
    positions, orientations = forward_kinematics(skeleton, np.zeros((200, 3)), local)
    heels = contact_points(skeleton, positions, orientations)[:, [0, 2]]
    ends = end_positions(skeleton, positions, orientations)
    toes = np.stack([ends[:, skeleton.end_index[side + "Toe"]] for side in ("Left", "Right")], 1)
    share = np.linspace(0, 1, 150)[:, None]
    lines = (heels[:, :, None] + share * (toes - heels)[:, :, None])[..., [0, 2]]
    gap = np.linalg.norm(lines[:, 0, :, None] - lines[:, 1, None], axis=-1).min((1, 2))
    found = feet_apart(skeleton, positions, orientations)
    np.testing.assert_allclose(found, gap, atol=2.5e-3)
    assert (found == 0).any() and (found > 0.02).any()
