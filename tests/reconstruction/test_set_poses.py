"""What set poses tell of trackers that are worn anyhow, and how somebody is asked for them."""

import numpy as np
import pytest
from test_calibration import CONTROLS, worn
from typer.testing import CliRunner

from gambol.controllers.body import contact_height, exp, forward_kinematics, yaw
from gambol.controllers.reconstruction import SKELETON
from gambol.controllers.reconstruction.calibration import (JOINTS, POSES, WORN, CalibrationNetwork, Stood, calibrated, fitted, load_bones,
                                                           stance)
from gambol.controllers.reconstruction.calibration.pose_fit import PoseFit
from gambol.controllers.reconstruction.live import placed
from gambol.game import cli
from gambol.game.cli import set_poses

ASKED = np.array(list(POSES.values()))
ALL = np.ones(len(WORN), bool)
OFF = 0.1


def stood_in(rng, off=0.0, poses=ASKED):
    """Joints (K, S, 3) and turns (K, S, 3, 3) of a standard body in poses that are off by so many degrees, the toes on the floor."""
    rotations = poses @ exp(np.radians(off) * rng.normal(size=(*poses.shape[:2], 3)))
    rotations[:, 0] = yaw(0.3 + 0.1 * rng.normal(size=len(poses)))
    for foot, toe in ((SKELETON.index(side + "Foot"), SKELETON.index(side + "Toe")) for side in ("Left", "Right")):
        rotations[:, foot], rotations[:, toe] = poses[:, foot], np.eye(3)
    positions, orientations = forward_kinematics(SKELETON, np.zeros((len(poses), 3)), rotations)
    toes = positions[:, [SKELETON.index(side + "Toe") for side in ("Left", "Right")], 1]
    positions[..., 1] += (contact_height(SKELETON) - toes.min(-1))[:, None]
    return positions[:, JOINTS], orientations[:, JOINTS]


def away(known, places, turns, joints):
    """How far [m] joints are told from where they are, on the average; the body's own size and floor beside."""
    found = known.joints(places, turns)[0] / known.stood.scale[0] + [0.0, known.floor, 0.0]
    return float(np.linalg.norm(found - joints, axis=-1).mean())


def told(seed, off, network=None):
    """How far joints of other poses are told from where they are, after standing alone and after all poses."""
    rng = np.random.default_rng(seed)
    joints, orientations = stood_in(rng, off)
    other = stood_in(rng, 15.0)
    places, turns = worn(np.random.default_rng(seed), np.concatenate([joints, other[0]]), np.concatenate([orientations, other[1]]), OFF)
    count = len(ASKED)
    stood = Stood.of(places[:1], turns[:1], ALL[None])
    alone, both = calibrated(CalibrationNetwork.load(), stood), fitted(stood, places[:count], turns[:count], range(count))
    return [away(known, places[count:], turns[count:], other[0]) for known in (alone, both)], both


def test_who_stands_exactly_as_asked_tells_it_nearly_all():
    found = [told(seed, 0.0) for seed in (1, 2, 3)]
    assert np.mean([after for (_, after), _ in found]) < 0.025
    assert all(known.heard == len(POSES) and abs(known.floor) < 0.02 for _, known in found)


@pytest.mark.few(1)
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_who_stands_about_as_asked_tells_much_more_than_standing_alone(seed):
    (before, after), known = told(seed, 4.0)
    assert after < 0.045 and after < 0.7 * before
    assert 0.01 < np.mean(known.unsure[1]) < OFF


def test_trackers_that_sit_near_their_joints_are_found_to():
    """Nobody tells how near; who wears them 2 cm off is not taken for somebody who wears them anyhow."""
    rng = np.random.default_rng(7)
    places, turns = worn(np.random.default_rng(7), *stood_in(rng, 3.0), 0.02)
    known = fitted(Stood.of(places[:1], turns[:1], ALL[None]), places, turns, range(len(POSES)))
    assert np.linalg.norm(known.offsets, axis=-1).mean() < 0.04 and np.mean(known.unsure[1]) < 0.06


def test_a_pose_that_was_not_as_asked_is_left_out():
    rng = np.random.default_rng(4)
    poses = np.array(ASKED)
    poses[3] = ASKED[4] @ exp(np.radians([50.0, -70.0, 40.0]))
    joints, turns = stood_in(rng, 2.0, poses)
    places, turned = worn(np.random.default_rng(4), joints, turns, OFF)
    stood = Stood.of(places[:1], turned[:1], ALL[None])
    known = fitted(stood, places, turned, range(len(POSES)))
    rest = [k for k in range(len(POSES)) if k != 3]
    assert known.heard == len(rest)
    assert np.allclose(known.offsets, fitted(stood, places[rest], turned[rest], rest).offsets)


def test_trackers_that_are_not_worn_are_never_read():
    rng, there = np.random.default_rng(5), np.array([name in ("Head", "LeftHand", "RightHand") for name in WORN])
    places, turns = worn(rng, *stood_in(rng, 3.0), OFF)
    found = []
    for unknown in (np.nan, 7.0):
        some, turned = (np.where(there.reshape(-1, *[1] * (part.ndim - 2)), part, unknown) for part in (places, turns))
        found.append(fitted(Stood.of(some[:1], turned[:1], there[None]), some, turned, range(len(POSES))))
    assert np.isfinite(found[0].offsets).all() and np.array_equal(found[0].offsets[there], found[1].offsets[there])


def test_slopes_are_those_of_what_is_told():
    """Of bones, mounts, the floor and all joints, somewhere."""
    rng = np.random.default_rng(8)
    there = np.array([name != "Head" for name in WORN])
    places, turns = worn(rng, *stood_in(rng, 3.0), OFF)
    stood = Stood.of(places[:1], turns[:1], there[None])
    likely = load_bones()
    fit = PoseFit.of(stood, places, turns, ASKED, np.arange(len(POSES)) == 7, (likely.means[0], likely.spread))
    shared, own = fit.mean + rng.normal(0.0, 0.3, fit.mean.shape), rng.normal(0.0, 0.3, fit.loose.shape)
    at = fit.told(shared, own)
    for _ in range(5):
        way, aside = rng.normal(size=shared.shape), rng.normal(size=own.shape)
        ahead, behind = (fit.told(shared + step * way, own + step * aside).found for step in (1e-6, -1e-6))
        said = at.shared @ way + np.einsum("kmo,ko->km", at.own, aside)
        assert np.allclose((ahead - behind) / 2e-6, said, rtol=1e-5, atol=1e-4 * np.abs(said).max())


def test_what_is_found_is_likelier_than_all_beside_it():
    """And as sure of what poses share as the whole problem's curvature has it, own unknowns and all."""
    rng = np.random.default_rng(9)
    places, turns = worn(rng, *stood_in(rng, 3.0), OFF)
    likely = load_bones()
    fit = PoseFit.of(Stood.of(places[:1], turns[:1], ALL[None]), places, turns, ASKED, np.arange(len(POSES)) == 7, (likely.means[0], likely.spread))
    found = fit.solved()
    for _ in range(10):
        shared, own = found.shared + 0.3 * rng.normal(size=found.shared.shape), found.own + 0.1 * fit.loose * rng.normal(size=found.own.shape)
        assert fit.cost(shared, own, fit.told(shared, own).found) > fit.cost(found.shared, found.own, fit.told(found.shared, found.own).found)
    at = fit.told(found.shared, found.own)
    count, most, wide = at.own.shape
    apart = np.zeros((count, most, count, wide))
    apart[np.arange(count), :, np.arange(count)] = at.own
    slopes = np.concatenate([at.shared, apart.reshape(count, most, -1)], -1).reshape(count * most, -1)
    curved = slopes.T @ slopes + np.diag(np.concatenate([np.zeros(len(fit.mean)), fit.loose.ravel() ** -2.0]))
    curved[:len(fit.mean), :len(fit.mean)] += fit.precision
    assert np.allclose(np.linalg.inv(curved)[:len(fit.mean), :len(fit.mean)], found.spread, rtol=1e-3, atol=1e-6)


def test_no_pose_tells_nothing():
    places, turns = stood_in(np.random.default_rng(1))
    with pytest.raises(ValueError, match="no pose"):
        fitted(Stood.of(places[:1], turns[:1], ALL[None]), places[:0], turns[:0], [])


class Wearing:
    """Somebody with trackers who does what is asked, a second late, but for some poses."""

    controls = CONTROLS

    def __init__(self, order, said, ignored=()):
        self.places, self.turned = worn(np.random.default_rng(6), *stood_in(np.random.default_rng(6), 3.0), OFF)
        self.order, self.said, self.ignored, self.now, self.since, self.asked = order, said, ignored, order[0], 0.0, 0

    def at(self, time):
        asked = sum(" of 8: " in line for line in self.said)
        if asked != self.asked:
            self.asked, self.since = asked, time
        wanted = self.order[asked] if time - self.since > 1.0 else self.now
        self.now = self.now if wanted in self.ignored else wanted
        self.turns = self.turned[self.now]
        return self.places[self.now]


@pytest.mark.few(2)
@pytest.mark.parametrize(("first", "ignored", "heard"), [(0, (), 8), (1, (), 8), (0, (3,), 8), (0, tuple(range(1, 8)), 0)])
def test_one_pose_is_asked_for_after_the_other(first, ignored, heard):
    """One that is ignored is not heard, and whoever ignores all has to move about."""
    said: list[str] = []
    order = [first, *(number for number in range(8) if number != first)]
    source = Wearing(order, said, ignored)
    place, turn = source.places[first], source.turned[first]
    assert stance(CONTROLS, place, turn) == first
    found = set_poses.worn(source, placed(place, CONTROLS, turns=turn), place, turn, (k / 6 for k in range(1800)), say=said.append)
    assert sum(" of 8: " in line for line in said) == 7
    if not heard:
        assert found is None
    else:
        assert not found.moving and found.known.heard >= heard - len(ignored)


def test_a_stream_that_ends_before_the_poses_is_no_mistake():
    said: list[str] = []
    source = Wearing([0, 1, 2, 3, 4, 5, 6, 7], said)
    assert set_poses.worn(source, placed(source.places[0], CONTROLS), source.places[0], source.turned[0], (k / 30 for k in range(20)), say=said.append) is None
    assert "too few poses" in said[-1]


def test_poses_need_a_file_to_be_written(tmp_path):
    (tmp_path / "me.toml").write_text("", encoding="utf-8")
    for more, words in (([], "--poses goes with --calibration FILE"), (["--calibration", str(tmp_path / "me.toml")], "is there already")):
        done = CliRunner().invoke(cli.app, ["reconstruct", "--stream", "osc", "-o", str(tmp_path / "o.bvh"), "--poses", *more])
        assert done.exit_code == 2 and words in " ".join(done.output.split())
