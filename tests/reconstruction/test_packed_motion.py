"""What the network is learnt from elsewhere: motion packed as arrays, samples drawn from them by PyTorch, weights taken back."""

import importlib
from pathlib import Path

import numpy as np
import pytest

from gambol.controllers.files import ArraysError
from gambol.controllers.reconstruction import SKELETON
from gambol.controllers.reconstruction.baselines import backward, forward
from gambol.controllers.reconstruction.database import Database
from gambol.controllers.reconstruction.database.database import Writer
from gambol.controllers.reconstruction.ours import seen_from
from gambol.controllers.reconstruction.pose_vector import REFERENCE, YAW_RATE, encode
from gambol.controllers.reconstruction.trackers import FIRST, INPUTS, LAGS, LEGS, SLOTS, Learner, Moments, bodies, learning, legs, moments_kernel, packed
from gambol.controllers.reconstruction.trackers.layers import shares
from gambol.controllers.reconstruction.trackers.learning import loss
from gambol.controllers.reconstruction.trackers.samples import Batch
from gambol.controllers.reconstruction.trackers.slots import views_kernel
from gambol.controllers.reconstruction.trackers.wearing import Worn, worn
from dolls import strides

DT = 1 / 60


@pytest.fixture(scope="module")
def moments(tmp_path_factory):
    """Of two walks, with mirror images; a frame of one is not sound."""
    path = tmp_path_factory.mktemp("walks") / "walks.gambolmotion"
    with Writer(path) as writer:
        for number, pace in enumerate((0.8, 1.4)):
            frames, _ = encode(*strides(pace=pace), DT)
            sound = np.ones(len(frames), bool)
            sound[20] = number == 0
            writer.add(f"walk {number}", f"doll {number}", "walk", frames, sound)
    return Moments.of(Database.open(path))


def test_a_pack_holds_the_motion_and_its_mirror_image(moments):
    pack, database = packed(moments), moments.database
    frames = np.cumsum(np.cumsum(pack["frames"], 0), 0) * pack["step"]
    plain = np.concatenate([np.arange(take.start, take.stop) for take in database.takes if not take.mirrored])
    images = np.concatenate([np.arange(take.start, take.stop) for take in database.takes if take.mirrored])
    np.testing.assert_allclose(frames, database.frames[plain], atol=3e-4)
    np.testing.assert_allclose(frames[:, pack["mirror_columns"]] * pack["mirror_signs"], database.frames[images], atol=3e-4)
    first = database.takes[0].stop - database.takes[0].start
    assert pack["behind"][:3].tolist() == [0, 1, 2] and pack["behind"][first + 21:first + 23].tolist() == [0, 1]
    assert first + 20 not in pack["good"] and len(pack["good"]) == len(plain) - 1
    assert np.isclose(2 * pack["share"].sum(), 1.0)


def test_layers_that_add_have_the_slopes_they_say():
    """Against differences, with parts left out."""
    rng = np.random.default_rng(0)
    sizes = (5, 7, 7, 7, 3)
    weights = [rng.normal(size=(a, b)) for a, b in zip(sizes[:-1], sizes[1:], strict=True)]
    biases = [rng.normal(size=b) for b in sizes[1:]]
    x, pull, kept = rng.normal(size=(4, 5)), rng.normal(size=(4, 3)), shares((4, 7), 3, 0.3, rng)

    def total():
        return float((forward(weights, biases, x, True, kept)[0] * pull).sum())

    _, seen, own = forward(weights, biases, x, True, kept)
    slopes = backward(weights, seen, own, pull, True, kept)
    for value, slope in zip([*weights, *biases], slopes, strict=True):
        at = tuple(rng.integers(0, size) for size in value.shape)
        value[at] += 1e-6
        more = total()
        value[at] -= 2e-6
        assert np.isclose((more - total()) / 2e-6, slope[at], rtol=1e-4, atol=1e-6)
        value[at] += 1e-6


def test_weights_learnt_elsewhere_are_taken(moments, tmp_path, monkeypatch):
    """And the network tells how far off they are; those of other widths are not taken."""
    monkeypatch.setattr(learning, "_JUDGED", 512)
    learner, path = Learner(moments, 4, 0, (16, 16, 16)), tmp_path / "weights.npz"
    values = [np.random.default_rng(1).normal(0, 0.1, value.shape) for value in learner.values]
    np.savez(path, outs=learner.outs, learnt=2048, **{f"weights{i}": v for i, v in enumerate(values[:4])}, **{f"biases{i}": v for i, v in enumerate(values[4:])})
    learner.take(path)
    made = learner.network()
    assert made.learnt == 4 and made.added and all(np.allclose(a, b) for a, b in zip((*made.weights, *made.biases), values, strict=True))
    with pytest.raises(ArraysError, match=r"weights.npz: is of other widths"):
        Learner(moments, 4, 0, (17, 17, 17)).take(path)


def test_pytorch_draws_and_judges_the_same(moments, monkeypatch):
    """The samples of given moments, bodies and trackers, and the loss with its slopes, are those that are drawn and judged here."""
    torch = pytest.importorskip("torch", reason="PyTorch learns the network on a graphics card; nothing else needs it")
    monkeypatch.syspath_prepend(Path(__file__).parents[2] / "scripts" / "build")
    theirs, elsewhere = importlib.import_module("_torch_samples"), importlib.import_module("trackers_torch")
    pack, count = packed(moments), 64
    body = theirs.Body(pack, "cpu")
    motion, dice = theirs.Motion(pack, body), theirs.Dice(torch.Generator().manual_seed(0), "cpu")
    chosen = np.random.default_rng(0).choice(len(pack["good"]), count)
    people, wearing = theirs.bodies(body, count, dice), theirs.worn(body, count, dice)
    found = theirs.sample(body, motion, motion.good[torch.tensor(chosen)], people, wearing)

    database, plain = moments.database, np.flatnonzero(_plain(moments))
    at, first, people = moments.which[plain][chosen].astype(np.int64), moments.first[plain][chosen].astype(np.int64), people.numpy().astype(float)
    shape = count, len(LAGS), len(SLOTS)
    places, turns, there, truth = np.empty((*shape, 3)), np.empty((*shape, 3, 3)), np.empty(shape[:2], bool), np.empty((count, 63))
    moments_kernel(database.frames, database.sound, at, first, DT, LAGS, SLOTS, people, legs(people) / float(legs(SKELETON.offsets)), SKELETON.offsets,
                   SKELETON.parents, REFERENCE, FIRST, LEGS, truth, places, turns, there)
    told = Worn(*(part.numpy() for part in wearing)).among(there)
    places, turns = told.spoilt(places, turns)
    given = np.zeros((count, 3))
    given[:, 2] = told.heading - database.frames[at, YAW_RATE] * DT
    inputs, ground = np.empty((count, INPUTS), np.float32), np.empty((count, 3))
    views_kernel(places, turns, told.placed, told.turned, people, SKELETON.offsets, LAGS, DT, given, inputs, ground)
    truth = seen_from(ground, truth, np.zeros(3))
    np.testing.assert_allclose(found.inputs, inputs, atol=0.03)  # changes of rounded places over a thirtieth of a second
    np.testing.assert_allclose(found.truth, truth, atol=1e-3)

    poses = torch.tensor(truth + 0.2 * np.random.default_rng(1).normal(size=truth.shape), dtype=torch.float32, requires_grad=True)
    total = elsewhere.loss(body, poses, torch.zeros(count, 4), found)
    total.backward()
    mine, slopes = loss(np.concatenate([poses.detach().numpy(), np.zeros((count, 4))], -1), Batch(inputs, found.truth.numpy().astype(float), moments.contacts[at], people))
    assert np.isclose(total.item(), mine, rtol=1e-4)
    np.testing.assert_allclose(poses.grad.numpy(), slopes[:, :63], atol=1e-5)


def test_pytorch_draws_bodies_and_trackers_as_often(moments, monkeypatch):
    """How far bodies differ, how often trackers are worn, turn and are known, and how ill they sit: as they are drawn here."""
    torch = pytest.importorskip("torch", reason="PyTorch learns the network on a graphics card; nothing else needs it")
    monkeypatch.syspath_prepend(Path(__file__).parents[2] / "scripts" / "build")
    theirs, count, rng = importlib.import_module("_torch_samples"), 20_000, np.random.default_rng(0)
    body, dice = theirs.Body(packed(moments), "cpu"), theirs.Dice(torch.Generator().manual_seed(0), "cpu")
    mine, own = worn(count, rng), [np.asarray(part) for part in theirs.worn(body, count, dice)]
    for a, b in ((mine.placed, own[0]), (mine.turned, own[1])):
        np.testing.assert_allclose(a.mean(0), b.mean(0), atol=0.02)
    for a, b in ((mine.moved, own[2]), (mine.off, own[3]), (mine.spun[..., 0, 1], own[4][..., 0, 1]), (mine.heading, own[5])):
        assert np.isclose(np.std(a), np.std(b), rtol=0.05) and np.isclose(np.mean(np.abs(a) < 1e-9), np.mean(np.abs(b) < 1e-9), atol=0.02)
    np.testing.assert_allclose(bodies(count, rng).std(0), np.asarray(theirs.bodies(body, count, dice)).std(0), rtol=0.05, atol=1e-4)


def _plain(moments):
    """Which moments are of no mirror image."""
    image = np.zeros(len(moments.database.frames), bool)
    for take in moments.database.takes:
        image[take.start:take.stop] = take.mirrored
    return ~image[moments.which]
