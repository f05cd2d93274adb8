"""What the network for trackers learns by: its samples, its loss, its files."""

import numpy as np
import pytest

from gambol.controllers.reconstruction import SKELETON
from gambol.controllers.reconstruction.database import Database, standing
from gambol.controllers.reconstruction.database.database import Writer
from gambol.controllers.reconstruction.pose_vector import encode
from gambol.controllers.reconstruction.trackers import INPUTS, PLACES, Learner, Moments, Network, bodies, judged
from gambol.controllers.reconstruction.trackers import learning
from gambol.controllers.reconstruction.trackers.learning import _STANDARD, MEAN, UNSURE, adam_kernel, loss
from gambol.controllers.reconstruction.trackers.network import OUTPUTS
from gambol.controllers.reconstruction.trackers.wearing import exactly
from dolls import shipped, strides

DT = 1 / 60


@pytest.fixture(scope="module")
def known(tmp_path_factory):
    """A small database of walks, at several paces."""
    path = tmp_path_factory.mktemp("walks") / "walks.gambolmotion"
    with Writer(path) as writer:
        for number, pace in enumerate((0.8, 1.1, 1.4)):
            frames, _ = encode(*strides(pace=pace), DT)
            writer.add(f"walk {number}", f"doll {number}", "walk", frames, np.ones(len(frames), bool))
    return Database.open(path)


def test_the_loss_has_the_slopes_it_says(known):
    batch = Moments.of(known).draw(3, 0, 5)
    rng = np.random.default_rng(0)
    found = np.concatenate([batch.truth + 0.1 * rng.normal(size=batch.truth.shape), rng.normal(size=(3, 4))], -1)
    _, slopes = loss(found, batch)
    for b, d in [(0, 3), (1, 20), (2, 57), (0, 58), (1, 60), (2, 62), (1, OUTPUTS - 1)]:
        step = np.zeros_like(found)
        step[b, d] = 1e-6
        assert np.isclose((loss(found + step, batch)[0] - loss(found - step, batch)[0]) / 2e-6, slopes[b, d], rtol=1e-3, atol=1e-6)


def test_truth_is_where_the_trackers_of_each_body_are(known):
    """What is drawn without noise has its trackers on the joints of the pose that is to be found, in that body."""
    batch = Moments.of(known).draw(64, 0, 1)
    newest = batch.inputs[:, 5 * 0:3]
    placed = batch.inputs[:, 3] == 1.0
    fresh = placed & (batch.inputs[:, 4] == 0.0)
    assert fresh.any()
    hips = np.stack([batch.truth[:, -1], batch.truth[:, 57]], -1)  # leftward, height
    assert np.median(np.abs(newest[fresh, 0] * 0.4 - hips[fresh, 0])) < 0.01
    assert np.median(np.abs(newest[fresh, 1] * 0.4 + 0.9 - hips[fresh, 1])) < 0.01


def test_learning_goes_on_from_a_checkpoint_the_same(known, tmp_path):
    moments = Moments.of(known)
    whole = Learner(moments, 4, 3, (24,), 16)
    whole.learn(tmp_path / "whole.npz", 4)
    first = Learner(moments, 4, 3, (24,), 16)
    first.step()
    first.step()
    first.save(tmp_path / "first.npz")
    second = Learner(moments, 4, 3, (24,), 16)
    second.resume(tmp_path / "first.npz")
    second.learn(tmp_path / "second.npz", 4)
    assert all(np.array_equal(a, b) for a, b in zip(whole.means, second.means, strict=True))
    with pytest.raises(ValueError, match="another seed, batch size or width"):
        Learner(moments, 4, 4, (24,), 16).resume(tmp_path / "first.npz")


def test_it_is_adam_and_the_mean_of_what_it_learnt():
    """Kingma & Ba 2015, algorithm 1, and the running mean of its values, which is what ships."""
    random, rate = np.random.default_rng(3), 1e-3
    value = random.standard_normal(7).astype(np.float32)
    first, second, mean = np.zeros(7, np.float32), np.zeros(7, np.float32), value.copy()
    theirs, m, v, left = value.astype(float), np.zeros(7), np.zeros(7), value.astype(float)
    for t in range(1, 30):
        slope = random.standard_normal(7).astype(np.float32)
        adam_kernel(value, slope, first, second, np.float32(rate / (1.0 - 0.9 ** t)), np.float32(1.0 / (1.0 - 0.999 ** t)), mean)
        m, v = 0.9 * m + 0.1 * slope, 0.999 * v + 0.001 * slope.astype(float) ** 2
        theirs = theirs - rate * m / (1.0 - 0.9 ** t) / (np.sqrt(v / (1.0 - 0.999 ** t)) + 1e-8)
        left = MEAN * left + (1.0 - MEAN) * theirs
    np.testing.assert_allclose(value, theirs, rtol=1e-4)
    np.testing.assert_allclose(mean, left, rtol=1e-4)
    assert 1e-4 < np.abs(mean - value).max() < np.abs(value).max()


def test_it_learns(known):
    learner = Learner(Moments.of(known), 120, 0, (32,), 64)
    losses = [learner.step() for _ in range(120)]
    assert np.mean(losses[-20:]) < 0.8 * np.mean(losses[:20])


def test_feet_on_the_floor_stand():
    """And no others: of one who stays upright, then hangs in the air."""
    root = np.zeros((40, 3))
    root[:, 1] = SKELETON.offsets[0, 1]
    root[20:, 1] += 0.3
    frames, _ = encode(root, np.broadcast_to(np.eye(3), (40, len(SKELETON), 3, 3)), DT)
    stands = standing(frames, False, 60.0)
    assert stands[:18].all() and not stands[20:].any()


def test_one_sample_is_found_as_in_a_batch():
    inputs = np.random.default_rng(0).normal(size=(3, INPUTS)).astype(np.float32)
    poses, soles = shipped().predict(inputs)
    for b in range(3):
        pose, sole = shipped().predict(inputs[b])
        assert np.allclose(pose, poses[b], atol=1e-3) and np.allclose(sole, soles[b], atol=1e-3)


def test_files_that_are_no_network_are_told_of(tmp_path):
    path = tmp_path / "network.npz"
    for content in (b"", b"PK nothing"):
        path.write_bytes(content)
        with pytest.raises(ValueError, match="network.npz"):
            Network.load(path)
    with pytest.raises(ValueError, match="can't be read"):
        Network.load(tmp_path / "none.npz")
    made = shipped()
    Network((made.weights[0][:-1], *made.weights[1:]), made.biases, made.outs, made.kinds, made.factors, made.rests, made.lower,
            made.upper).save(path)
    with pytest.raises(ValueError, match=r"weights0 of shape .*, expected"):
        Network.load(path)
    Network(made.weights, made.biases, made.outs * np.nan, made.kinds, made.factors, made.rests, made.lower, made.upper).save(path)
    with pytest.raises(ValueError, match="not finite"):
        Network.load(path)


def test_bodies_are_symmetric_and_the_same_from_the_same_seed():
    made = bodies(50, np.random.default_rng(1))
    left, right = SKELETON.index("LeftLeg"), SKELETON.index("RightLeg")
    assert np.array_equal(made, bodies(50, np.random.default_rng(1)))
    assert np.allclose(np.linalg.norm(made[:, left], axis=-1), np.linalg.norm(made[:, right], axis=-1))
    assert np.linalg.norm(made[:, left], axis=-1).std() > 0.01


def test_how_far_off_it_is_is_told_of_errors_as_they_are_and_half_of_what_they_have_to_do_with_each_other(known, monkeypatch):
    """Variances are those of its errors on what it is judged on, covariances half of them; of few samples as of many."""
    count, moments, every = 256, Moments.of(known), np.ones(len(PLACES), bool)
    monkeypatch.setattr(learning, "_JUDGED", count)
    found = judged(shipped(), moments)
    batch = moments.draw(count, 0, _STANDARD + 1, exactly(count, every, every))
    errors = shipped().predict(batch.inputs)[0] - batch.truth
    covariance, told = errors.T @ errors / len(errors), found.spread(every, every)
    np.testing.assert_allclose(np.diagonal(told), np.diagonal(covariance), rtol=1e-4, atol=1e-9)
    apart = ~np.eye(len(told), dtype=bool)
    np.testing.assert_allclose(told[apart], UNSURE * covariance[apart], rtol=1e-3, atol=1e-8)
    assert all(np.array_equal(a, b) for a, b in zip(found.weights, shipped().weights, strict=True))
