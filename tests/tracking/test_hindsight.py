"""Poses in hindsight: what frames say, what binds them, and tracks that look back."""

import sys
from dataclasses import replace
from itertools import accumulate
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

sys.path.insert(0, str(Path(__file__).parent))
from bodies import cameras, masks, stick_body, stride

from gambol.controllers.tracking import Tracker, TrackerSettings
from gambol.controllers.tracking.pose import Glimpse, SolverSettings, in_hindsight, observed, solve
from gambol.controllers.tracking.rivals import savitzky_golay
from gambol.controllers.tracking.twists import Configuration, adjoint, exp, inverse, log, posed, turn_log_kernel
from gambol.game.studio import late

RATE = 60.0


@pytest.fixture(scope="module")
def chain():
    return stick_body().chain


def bent(chain, t):
    """Hips that fall while they turn, knees and elbows that speed up: every acceleration stays as it is."""
    where = chain.rest()
    angles, root = where.angles.copy(), np.eye(4)
    for name, size in (("LeftLeg.x", 0.004), ("RightLeg.x", 0.002), ("LeftForeArm.y", -0.005)):
        angles[chain.names.index(name)] = 2 * size * t + size * t * t
    for k, axis in enumerate("xyz"):  # a ball at a steady pace about one axis
        angles[chain.names.index(f"LeftArm.{axis}")] = (0.02, -0.03, 0.01)[k] * t
    root[:3, :3] = Rotation.from_rotvec([0.0, 0.05 * t, 0.0]).as_matrix()
    root[:3, 3] = (0.02 * t, 1.0 - 0.001 * t * t, 3.0)
    return Configuration(root, angles)


def glimpses(chain, poses, sure):
    size = 6 + len(chain)
    return [Glimpse(pose, one * np.eye(size), np.zeros(size)) for pose, one in zip(poses, sure)]


def apart(chain, one, other):
    turned = np.empty(len(chain))
    turn_log_kernel(chain.first, chain.count, one.angles, other.angles, turned)
    return max(np.abs(log(inverse(one.root) @ other.root)).max(), np.abs(turned).max())


def test_what_keeps_its_acceleration_stays_as_it_is(chain):
    truth = [bent(chain, t) for t in range(9)]
    for one, made in zip(truth, in_hindsight(chain, glimpses(chain, truth, [1.0] * 9), RATE)):
        assert apart(chain, one, made) < 1e-6


def test_frames_that_nobody_saw_follow_from_both_sides(chain):
    truth, rng = [bent(chain, t) for t in range(12)], np.random.default_rng(0)
    lost = [replace(one, angles=np.clip(one.angles + 0.1 * rng.normal(size=len(chain)), chain.lower, chain.upper)) if t in (5, 6) else one
            for t, one in enumerate(truth)]
    made = in_hindsight(chain, glimpses(chain, lost, [0.0 if t in (5, 6) else 1e6 for t in range(12)]), RATE)
    assert max(apart(chain, lost[t], truth[t]) for t in (5, 6)) > 0.1
    assert max(apart(chain, one, other) for one, other in zip(made, truth)) < 2e-4


def test_a_degree_that_one_frame_did_not_see_follows_the_others(chain):
    """The elbow alone: its row of the matrix is empty, and the rest is as sure as ever."""
    truth, d = [bent(chain, t) for t in range(9)], chain.names.index("LeftForeArm.y")
    frames = glimpses(chain, truth, [1e6] * 9)
    angles, matrix = truth[4].angles.copy(), frames[4].matrix.copy()
    angles[d] -= 0.4
    matrix[6 + d] = matrix[:, 6 + d] = 0.0
    frames[4] = Glimpse(Configuration(truth[4].root, angles), matrix, frames[4].vector)
    made = in_hindsight(chain, frames, RATE)[4]
    assert abs(made.angles[d] - truth[4].angles[d]) < 1e-4


def test_it_is_the_least_squares_of_the_whole_window(chain):
    """Hinges, against a dense solution written out."""
    hinges = [d for d, j in enumerate(chain.joints) if chain.count[j] == 1]
    rng, size = np.random.default_rng(1), 6 + len(chain)
    values = 0.3 * np.sin(0.2 * np.arange(10))[:, None] + 0.02 * rng.normal(size=(10, len(hinges)))
    signs = np.sign(0.5 * (chain.lower + chain.upper)[hinges])
    values, poses, frames = 0.6 * signs + values, [], []
    for row in values:
        angles = chain.rest().angles.copy()
        angles[hinges] = row
        poses.append(Configuration(chain.rest().root, angles))
        half = rng.normal(size=(size, size))
        frames.append(Glimpse(poses[-1], half @ half.T * 1e4, rng.normal(size=size) * 10))
    made = in_hindsight(chain, frames, RATE)
    sigma = np.concatenate([np.full(3, 25.0), np.full(3, 110.0), np.full(len(chain), 250.0)]) / RATE**2
    weights, count = 30.0 / sigma**2, len(frames)
    third = np.diff(np.eye(count), 3, axis=0)
    whole = np.zeros((count, size, count, size))
    for t, one in enumerate(frames):
        whole[t, :, t, :] = one.matrix
    whole += np.einsum("st,ij->sitj", third.T @ third, np.diag(weights))
    begun = np.zeros((count, size))
    begun[:, [6 + d for d in hinges]] = values
    pull = np.stack([one.vector for one in frames]) - weights * (third.T @ third @ begun)
    want = begun + np.linalg.solve(whole.reshape(count * size, -1), pull.ravel()).reshape(count, size)
    got = np.stack([one.angles[hinges] for one in made])
    np.testing.assert_allclose(got, want[:, [6 + d for d in hinges]], atol=2e-4)
    assert np.abs(got - values).max() > 0.01


@pytest.fixture(scope="module")
def film():
    surface, lenses = stick_body(), cameras()
    truth = [stride(surface.chain, 0.1 + t / RATE) for t in range(16)]
    rng, seen = np.random.default_rng(5), []
    for one in truth:
        seen.append([mask ^ (_edge(mask) & (rng.random(mask.shape) < 0.5)) for mask in masks(surface, one, lenses)])
    return surface, lenses, truth, seen


def _edge(mask):
    from scipy.ndimage import binary_dilation, binary_erosion

    return binary_dilation(mask, iterations=2) ^ binary_erosion(mask)


def test_what_cameras_say_of_a_step_is_left_after_it(film):
    """One step, damped so much that most of what pulled is still there: joints' pull over their step is the damping, the same for all."""
    surface, lenses, truth, seen = film
    views = [observed(lens, mask) for lens, mask in zip(lenses, seen[3])]
    fit = solve(surface, views, truth[2], None, None, SolverSettings(outer=1, inner=1, damping=3.0))
    step = np.empty(len(surface.chain))
    turn_log_kernel(surface.chain.first, surface.chain.count, truth[2].angles, fit.where.angles, step)
    moves = np.abs(step) > 1e-4
    ratio = fit.vector[6:][moves] / step[moves]
    assert moves.sum() > 8 and ratio.min() > 0
    np.testing.assert_allclose(ratio, np.median(ratio), rtol=0.02)
    np.testing.assert_allclose(fit.matrix, fit.matrix.T)


def test_what_cameras_say_is_about_the_hips_wherever_somebody_is(film):
    """The same stage ten metres away says the same of a shift of the hips and a turn about them, where the search ends elsewhere than it began."""
    surface, lenses, truth, seen = film
    by = np.array([10.0, 0.0, -4.0])
    start = Configuration(exp([0.05, 0.0, 0.05, 0, 0, 0]) @ truth[3].root, truth[3].angles)
    away = Configuration(start.root + np.pad(by[:, None], ((0, 1), (3, 0))), start.angles)
    there = [replace(lens, translation=lens.translation - lens.rotation @ by) for lens in lenses]
    one, other = (solve(surface, [observed(lens, mask) for lens, mask in zip(those, seen[3])], begin) for those, begin in ((lenses, start), (there, away)))
    np.testing.assert_allclose(other.where.root[:3, 3] - by, one.where.root[:3, 3], atol=1e-6)
    np.testing.assert_allclose(other.matrix, one.matrix, atol=1e-4 * np.abs(one.matrix).max())
    # about where the search began, a turn would count as a shift too
    shift = np.eye(4)
    shift[:3, 3] = start.root[:3, 3] - one.where.root[:3, 3]
    assert np.linalg.norm(shift[:3, 3]) > 0.03
    carried = adjoint(shift).T @ one.matrix[:6, :6] @ adjoint(shift)
    assert np.abs(carried - one.matrix[:6, :6]).max() > 0.01 * np.abs(one.matrix[:6, :6]).max()


def test_looking_back_is_calmer_and_nearer_to_the_truth(film):
    surface, lenses, truth, seen = film
    chain = surface.chain

    def tracks(lag):
        tracker = Tracker(surface, lenses, RATE, TrackerSettings(lag=lag))
        made = accumulate(seen[2:], tracker.step, initial=tracker.start(truth[1], truth[0]))
        next(made)
        return tracker, list(made)

    def off(poses):
        return np.mean([np.linalg.norm(posed(chain, one)[0] - posed(chain, other)[0], axis=1).mean() for one, other in zip(poses, truth[2:])])

    def shake(poses):
        return np.linalg.norm(np.diff(np.stack([posed(chain, one)[0] for one in poses]), 3, axis=0), axis=-1).mean()
    (_, causal), (tracker, made) = tracks(0), tracks(3)
    for one, other in zip(causal, made):
        assert np.array_equal(one.now.angles, other.now.angles) and not one.recent, "the track itself is the same"
    now, then = [one.now for one in causal], list(late(tracker, made))
    assert len(then) == len(now) == 14 and len(made[-1].recent) <= 12
    assert off(then) < off(now) and shake(then) < 0.5 * shake(now)


def test_savitzky_golay_may_be_told_how_far_it_sees(chain):
    poses = [bent(chain, t) for t in range(9)]
    wild = [*poses[:7], Configuration(poses[7].root, poses[7].angles + 0.2), Configuration(poses[8].root, poses[8].angles + 0.2)]
    for one, other in zip(savitzky_golay(chain, poses, 4, ahead=1)[:6], savitzky_golay(chain, wild, 4, ahead=1)[:6]):
        assert np.array_equal(one.angles, other.angles)
    assert not np.array_equal(savitzky_golay(chain, poses, 4, ahead=1)[6].angles, savitzky_golay(chain, wild, 4, ahead=1)[6].angles)
