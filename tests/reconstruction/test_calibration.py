"""How trackers are worn: told from standing and moving, whichever way one faces, kept in files, and changed without a leap."""

from functools import lru_cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body import exp, forward_kinematics, yaw
from gambol.controllers.reconstruction.calibration import (
    BEFORE, FRAMES, JOINTS, STRIDE, WORN, CalibrationNetwork, Stood, Wearer, calibratable, calibrated, load, save,
)
from gambol.controllers.reconstruction.calibration.calibration_network import loss
from gambol.controllers.reconstruction.calibration.simulated import TARGETS, numbers, told
from gambol.controllers.reconstruction.calibration.stood import STANCES
from gambol.controllers.reconstruction.control_points import parse
from gambol.controllers.reconstruction.live import StreamError, placed
from gambol.controllers.reconstruction.pose_vector import SKELETON
from test_trackers import strides

ALL = np.ones(len(WORN), bool)
CONTROLS = parse("root,head,lwrist,rwrist,lankle,rankle", SKELETON)


@lru_cache
def shipped():
    return CalibrationNetwork.load()


@lru_cache
def moving(count=400):
    """Joints (T, S, 3) and turns (T, S, 3, 3) of somebody who walks."""
    positions, orientations = forward_kinematics(SKELETON, *strides(count))
    return positions[:, JOINTS], orientations[:, JOINTS]


def shaken(count=400):
    """The same of somebody who shakes all joints as nobody does."""
    time = np.arange(count)[:, None, None] / 60
    swing = 0.5 * np.sin(time * np.linspace(1.0, 3.0, len(SKELETON))[:, None] + np.arange(3))
    swing[:, 0] *= 0.1
    root = np.tile(SKELETON.offsets[0], (count, 1)) + [0.0, 0.01, 0.0]
    positions, orientations = forward_kinematics(SKELETON, root, exp(swing))
    return positions[:, JOINTS], orientations[:, JOINTS]


def worn(rng, joints, turns, off=0.1):
    """What trackers say that sit anyhow."""
    beside = rng.normal(size=(len(WORN), 3))
    beside *= off / np.linalg.norm(beside, axis=-1, keepdims=True)
    return joints + np.einsum("...ij,...j->...i", turns, beside), turns @ exp(rng.normal(size=(len(WORN), 3)))


def pairs(places, turns):
    at = len(places) - 1 - STRIDE * np.arange(FRAMES)
    both = np.stack([at, at - BEFORE], 1)
    return places[both], turns[both]


@given(st.integers(0, 2**32 - 1), st.integers(0, 1))
@settings(max_examples=20, deadline=None)
def test_who_stands_as_asked_tells_all_that_trackers_are_off_by(seed, which):
    """In T-pose or with the arms down, facing anywhere, of any size: no tracker off its joint, and no turn that is not its mount's."""
    rng = np.random.default_rng(seed)
    heading, size = rng.uniform(-3.0, 3.0), rng.uniform(0.7, 1.2)
    mounts = exp(rng.normal(size=(len(WORN), 3)))
    joints, turns = (some[which] for some in STANCES)
    stood = Stood.of(size * (joints @ yaw(heading).T + [0.7, 0.0, -2.0]), yaw(heading) @ turns @ mounts, ALL)
    assert stood.which == which and stood.scale == pytest.approx(1.0 / size, rel=1e-6)
    assert np.allclose(stood.offsets, 0.0, atol=1e-6) and np.allclose(mounts @ stood.mounts, np.eye(3), atol=1e-6)


@given(st.integers(0, 2**32 - 1), st.floats(-3.0, 3.0))
@settings(max_examples=8, deadline=None)
def test_wherever_one_stands_and_faces_the_same_is_told(seed, heading):
    """The whole room turned and moved, whichever way trackers point: the same offsets and bones."""
    joints, turns = (some[0] for some in STANCES)
    places, turned = worn(np.random.default_rng(seed), np.concatenate([joints[None], moving()[0]]), np.concatenate([turns[None], moving()[1]]))
    found = []
    for angle, aside in ((0.0, np.zeros(3)), (heading, np.array([3.0, 0.0, -1.0]))):
        here, there = places @ yaw(angle).T + aside, yaw(angle) @ turned
        found.append(calibrated(shipped(), Stood.of(here[:1], there[:1], ALL[None]), *pairs(here[1:], there[1:])))
    assert np.allclose(found[0].offsets, found[1].offsets, atol=1e-4) and np.allclose(found[0].bones, found[1].bones, atol=1e-4)
    assert found[0].heard == FRAMES


def test_standing_and_then_moving_bring_joints_nearer():
    """On the average of some who wear trackers 10 cm off, arms low."""
    away = []
    down = np.tile(np.eye(3), (len(SKELETON), 1, 1))
    for side, way in (("Left", -1.0), ("Right", 1.0)):
        down[SKELETON.index(side + "Arm")] = exp(np.array([0.0, 0.0, way * 0.1]))
    stance, stood_turns = (some[JOINTS] for some in forward_kinematics(SKELETON, SKELETON.offsets[0], down))
    joints, turns = moving()
    for seed in range(12):
        places, turned = worn(np.random.default_rng(seed), np.concatenate([stance[None], joints]), np.concatenate([stood_turns[None], turns]))
        stood = Stood.of(places[:1], turned[:1], ALL[None])
        for known in (calibrated(shipped(), stood), calibrated(shipped(), stood, *pairs(places[1:], turned[1:]))):
            points, _ = known.joints(places[1:], turned[1:])
            away.append(np.linalg.norm(points / known.stood.scale[0] - joints, axis=-1).mean())
    standing, moved = np.reshape(away, (-1, 2)).mean(0)
    assert standing < 0.07 and moved < 1.05 * standing  # where they sit 10 cm off; a doll's walk tells little


def test_moving_like_nobody_is_not_heard():
    joints, turns = shaken()
    places, turned = worn(np.random.default_rng(0), np.concatenate([STANCES[0][:1], joints]), np.concatenate([STANCES[1][:1], turns]))
    stood = Stood.of(places[:1], turned[:1], ALL[None])
    known, alone = calibrated(shipped(), stood, *pairs(places[1:], turned[1:])), calibrated(shipped(), stood)
    assert known.heard == 0 and np.array_equal(known.offsets, alone.offsets) and np.array_equal(known.bones, alone.bones)


def test_what_lost_trackers_say_while_moving_is_not_heard():
    joints, turned = moving()
    places, turns = worn(np.random.default_rng(3), np.concatenate([STANCES[0][:1], joints]), np.concatenate([STANCES[1][:1], turned]))
    stood, places, turns = Stood.of(places[:1], turns[:1], ALL[None]), places[1:], turns[1:]
    lost, wild = pairs(places, turns), pairs(places, turns)
    for some in (lost, wild):
        some[0][3, 0, 2] = np.nan
        some[1][9, 1, 4] = np.nan
    wild[0][9, 0, 0], wild[1][3, 1, 5] = 1e9, np.eye(3)  # of moments that are left out already
    found, other = calibrated(shipped(), stood, *lost), calibrated(shipped(), stood, *wild)
    assert found.heard == other.heard == FRAMES - 2 and np.isfinite(found.offsets).all()
    assert np.array_equal(found.offsets, other.offsets) and np.array_equal(found.bones, other.bones)


def test_numbers_of_a_calibration_are_told_again():
    rng = np.random.default_rng(1)
    found = rng.normal(size=(4, TARGETS))
    assert np.allclose(numbers(*told(found)), found)


def test_the_loss_has_the_slopes_it_says():
    rng = np.random.default_rng(0)
    found, truth, tells = rng.normal(size=(3, 2 * TARGETS)), rng.normal(size=(3, TARGETS)), rng.random((3, TARGETS)) < 0.7
    slopes = loss(found, truth, tells)[1]
    way = rng.normal(size=found.shape)
    way[:, TARGETS:] = 0.0
    numeric = (loss(found + 1e-6 * way, truth, tells)[0] - loss(found - 1e-6 * way, truth, tells)[0]) / 2e-6
    assert numeric == pytest.approx(float(np.sum(slopes * way)), rel=1e-5)
    assert not slopes[:, :TARGETS][~tells].any() and not slopes[:, TARGETS:][~tells].any()


def wearer(rng):
    joints, turns = (some[0] for some in STANCES)
    places, turned = worn(rng, np.concatenate([joints[None], moving()[0]]), np.concatenate([turns[None], moving()[1]]), 0.05)
    placement = placed(places[0], CONTROLS, turns=turned[0])
    return Wearer.standing(CONTROLS, placement, places[0], turned[0], shipped()), places[1:], turned[1:]


def test_five_seconds_of_moving_are_heard_once_and_nothing_leaps():
    somebody, places, turns = wearer(np.random.default_rng(2))
    before, said, points = somebody.known, somebody.said(CONTROLS.names), []
    assert somebody.moving and "move about" in said and "lwrist" in said
    for place, turn in zip(places, turns, strict=True):
        points.append(somebody(place, turn)[0])
    assert not somebody.moving and somebody.known is not before and "move about" not in somebody.said(CONTROLS.names)
    joints = moving()[0]
    assert np.abs(np.diff(points, axis=0) - np.diff(joints, axis=0)).max() < 0.03


def test_the_next_day_all_is_known(tmp_path):
    somebody, places, turns = wearer(np.random.default_rng(2))
    path = tmp_path / "me.toml"
    save(path, somebody)
    again = load(path, CONTROLS)
    assert not again.moving
    for one, other in zip(somebody(places[7], turns[7]), again(places[7], turns[7]), strict=True):
        assert np.allclose(one, other, atol=1e-3)
    assert again.skeleton.names == SKELETON.names and again.known.height == pytest.approx(somebody.known.height, abs=1e-3)


@pytest.mark.parametrize("size", [0.85, 0.97, 1.0, 1.03, 1.15])
def test_what_was_kept_of_somebody_of_another_size_is_told(tmp_path, size):
    somebody, places, turns = wearer(np.random.default_rng(2))
    save(tmp_path / "me.toml", somebody)
    again = load(tmp_path / "me.toml", CONTROLS)
    for place, turn in zip(size * places, turns, strict=True):
        again(place, turn)
        assert somebody.seems is None
    if abs(size - 1.0) < 0.05:
        assert again.seems is None
    else:
        assert again.seems == pytest.approx(size * somebody.known.height, rel=0.03)


@pytest.mark.parametrize(("line", "instead", "names"), [
    ("[room]", "[hall]", "room"), ("heading =", "heading = true #", "room.heading"), ("size =", "size = 9 #", "room.size"),
    ("LeftArm =", "LeftArm = [1, 2] #", "bones.LeftArm"), ("offset =", "offset = [nan, 0, 0] #", "points.root.offset"),
    ('[points."head"]', '[points."hat"]', "points"), ("shift =", "shift = [[ #", ""),
    ("unsure =", "unsure = -1 #", r"points.root.unsure: needs a number, from 0"), ("LeftArm =", "LeftArm = [-0.14, 0, 0] #", "bones.LeftArm: ends"),
    ("RightLeg =", "RightLeg = [0, 0, 0] #", "bones.RightLeg: ends")])
def test_files_that_are_no_calibration_are_told_of(tmp_path, line, instead, names):
    path = tmp_path / "me.toml"
    save(path, wearer(np.random.default_rng(2))[0])
    path.write_text(path.read_text("utf-8").replace(line, instead), encoding="utf-8")
    with pytest.raises(StreamError, match=rf"me\.toml: {names}"):
        load(path, CONTROLS)
    with pytest.raises(StreamError, match="can't be read"):
        load(tmp_path / "none.toml", CONTROLS)


def test_only_trackers_that_turn_on_known_places_are_calibrated():
    turns = np.tile(np.eye(3), (6, 1, 1))
    assert calibratable(CONTROLS, turns)
    turns[2] = np.nan
    assert not calibratable(CONTROLS, turns)
    assert not calibratable(parse("head,lelbow", SKELETON), np.tile(np.eye(3), (2, 1, 1)))


def test_files_that_are_no_network_are_told_of(tmp_path):
    path = tmp_path / "network.npz"
    path.write_bytes(b"no network")
    with pytest.raises(ValueError, match="network.npz"):
        CalibrationNetwork.load(path)
    shipped().save(path)
    with np.load(path) as file:
        arrays = dict(file)
    np.savez(path, **arrays | {"weights1": np.zeros((3, 3))})
    with pytest.raises(ValueError, match="weights1"):
        CalibrationNetwork.load(path)
