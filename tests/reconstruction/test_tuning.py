"""Somebody's own network: learnt on from their own motion, held near what it was, the same after it was cut off."""

import sys
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from gambol.controllers.files import ArraysError
from gambol.controllers.reconstruction.database import Database
from gambol.controllers.reconstruction.database.database import Writer
from gambol.controllers.reconstruction.pose_vector import encode
from gambol.controllers.reconstruction.trackers import PLACES, Moments, Network, Tuner, learning
from gambol.game import cli
from gambol.game.world import SHIPPED, methods, usual

sys.path.insert(0, str(Path(__file__).parent))
from test_trackers import strides  # noqa: E402

BATCHES, SIZE = 12, 128


@lru_cache
def shipped():
    return Network.load()


def written(path, fps=60.0):
    """A database of one take."""
    with Writer(path, fps) as writer:
        frames, _ = encode(*strides(), 1 / fps)
        writer.add("own/doll", "doll", "walk", frames, np.ones(len(frames), bool))
    return path


@pytest.fixture(scope="module")
def own(tmp_path_factory):
    """The file of a database of one's own motion, and its moments."""
    path = written(tmp_path_factory.mktemp("own") / "own.gambolmotion")
    return path, Moments.of(Database.open(path))


@pytest.fixture(autouse=True)
def few(monkeypatch):
    """Samples by which a network is scaled and told its errors."""
    monkeypatch.setattr(learning, "_JUDGED", 512)


def taught(moments, share=1.0, batches=BATCHES):
    tuner = Tuner(shipped(), moments, BATCHES, share=share, size=SIZE)
    for _ in range(batches):
        tuner.step()
    return tuner


def test_it_errs_less_on_what_it_learns_from(own):
    tuner = Tuner(shipped(), own[1], BATCHES, size=SIZE)
    losses = [tuner.step() for _ in range(BATCHES)]
    assert np.mean(losses[-4:]) < 0.9 * np.mean(losses[:3])


def test_nothing_of_it_is_the_network_as_it_was(own):
    tuner = taught(own[1], share=0.0, batches=2)
    for found, was in zip(tuner.used(), [*shipped().weights, *shipped().biases], strict=True):
        assert np.array_equal(found, was)


def test_half_of_it_lies_halfway(own):
    whole, half = (taught(own[1], share, 2).used()[0] for share in (1.0, 0.5))
    assert np.allclose(half - shipped().weights[0], 0.5 * (whole - shipped().weights[0]), atol=1e-6)


def test_cut_off_it_goes_on_the_same(own, tmp_path):
    whole, part = taught(own[1], batches=4), taught(own[1], batches=2)
    part.save(tmp_path / "own-learning.npz")
    again = Tuner(shipped(), own[1], BATCHES, share=1.0, size=SIZE)
    again.resume(tmp_path / "own-learning.npz")
    for _ in range(2):
        again.step()
    assert all(np.array_equal(a, b) for a, b in zip(again.used(), whole.used(), strict=True))
    with pytest.raises(ArraysError, match="other motion"):
        Tuner(shipped(), own[1], BATCHES + 1, size=SIZE).resume(tmp_path / "own-learning.npz")
    (tmp_path / "own-learning.npz").write_bytes(b"nothing")
    with pytest.raises(ArraysError, match="is no checkpoint"):
        again.resume(tmp_path / "own-learning.npz")


def test_the_command_teaches_and_the_network_is_taken(own, tmp_path):
    """It is no surer than of half of what it was, and bends no joint less."""
    out = tmp_path / "mine.npz"
    done = CliRunner().invoke(cli.app, ["database", "tune", str(own[0]), "-o", str(out), "--batches", "10", "--share", "0.01"])
    assert done.exit_code == 0, done.output
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mine.npz"]
    assert usual("4", out, True) == SHIPPED and usual("4", own[0]) == "ours" and usual("4", own[0], True) == "turning"
    network = methods(out)(SHIPPED, "4")[0].network
    every = np.ones(len(PLACES), bool)
    assert network.learnt == 10 and not np.array_equal(network.weights[0], shipped().weights[0])
    assert (np.diagonal(network.spread(every, every)) > 0.49 * np.diagonal(shipped().spread(every, every))).all()
    assert (network.lower <= shipped().lower + 1e-6).all() and (network.upper >= shipped().upper - 1e-6).all()


def test_what_can_be_wrong_is_told_in_a_line(own, tmp_path):
    slow, broken = written(tmp_path / "slow.gambolmotion", 30.0), tmp_path / "broken.npz"
    broken.write_bytes(b"nothing")
    for arguments, words in ((["database", "tune", slow], "has 30 frames a second"), (["database", "tune", own[0], "--network", broken], "is no network of trackers"),
                             (["database", "tune", own[0], "-o", tmp_path / "mine.bin"], "ends in .npz"),
                             (["reconstruct", "none.bvh", "--network", broken], "broken.npz: is no network of trackers"),
                             (["play", "--network", broken], "broken.npz: is no network of trackers"), (["play", "--network", own[0]], "is no .npz file"),
                             (["play", "--network", broken, "--replay", "some.gambol"], "a log says which network")):
        done = CliRunner().invoke(cli.app, [str(one) for one in arguments])
        assert done.exit_code == 2 and words in done.output and "Traceback" not in done.output
    shipped().save(tmp_path / "good.npz")
    done = CliRunner().invoke(cli.app, ["reconstruct", "none.bvh", "--network", str(tmp_path / "good.npz"), "--method", "lpcr"])
    assert done.exit_code == 2 and "goes with --method trackers" in done.output
