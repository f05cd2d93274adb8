"""A skeleton as a product of exponentials: eq. (10), its derivative, and poses of others on it."""

import numpy as np
import pytest

from gambol.controllers.body import exp as turn, forward_kinematics, human, log as vector
from gambol.controllers.tracking.twists import (Configuration, chain_of, exp, fitted, local_turns, posed,
                                                product_of_exponentials, retract_kernel, turn_log_kernel)


@pytest.fixture(params=["paper", "full"], scope="module")
def chain(request):
    return chain_of(human(), request.param)


def somewhere(chain, seed=0, size=0.7):
    rng = np.random.default_rng(seed)
    return Configuration(exp(rng.normal(size=6)), np.clip(rng.normal(size=len(chain)) * size, chain.lower, chain.upper))


def moved(chain, where, step):
    root, angles = where.root.copy(), where.angles.copy()
    wide = np.full(len(chain), 10.0)
    retract_kernel(chain.first, chain.count, step, root, angles, -wide, wide)
    return Configuration(root, angles)


def test_the_paper_has_26_degrees_of_freedom():
    assert len(chain_of()) + 6 == 26
    assert len(chain_of(freedom="full")) + 6 == 42


def test_an_unknown_freedom_is_told():
    with pytest.raises(ValueError, match="'paper' or 'full', not 'some'"):
        chain_of(freedom="some")


@pytest.mark.parametrize("seed", range(3))
def test_the_product_of_exponentials_is_forward_kinematics(chain, seed):
    where = somewhere(chain, seed)
    positions, orientations, _ = posed(chain, where)
    pose = local_turns(chain, where)
    at, turned = forward_kinematics(chain.skeleton, pose.root, pose.rotations)
    np.testing.assert_allclose(positions, at, atol=1e-12)
    np.testing.assert_allclose(orientations, turned, atol=1e-12)
    rest, _ = forward_kinematics(chain.skeleton, np.zeros(3), np.broadcast_to(np.eye(3), (len(chain.skeleton), 3, 3)))
    for joint in range(len(chain.skeleton)):
        point = np.array([0.1, -0.2, 0.05])
        got = product_of_exponentials(chain, where, joint, (rest[joint] + point)[None])[0]
        np.testing.assert_allclose(got, positions[joint] + orientations[joint] @ point, atol=1e-12)


@pytest.mark.parametrize("size", [0.0, 0.7, 1.5])
def test_the_jacobian_is_the_derivative(chain, size):
    """Each degree's twist moves every point that hangs on it as central differences do; others stay."""
    where, epsilon = somewhere(chain, 5, size), 1e-6
    _, _, columns = posed(chain, where)
    for d in range(len(chain)):
        step = np.zeros(6 + len(chain))
        step[6 + d] = epsilon
        after, _, _ = posed(chain, moved(chain, where, step))
        before, _, _ = posed(chain, moved(chain, where, -step))
        at, _, _ = posed(chain, where)
        velocity = columns[d, :3] + np.cross(columns[d, 3:], at)
        velocity[~chain.moved[:, d]] = 0.0
        np.testing.assert_allclose((after - before) / (2 * epsilon), velocity, atol=1e-8)


def test_the_roots_twist_acts_from_the_left(chain):
    where, rng = somewhere(chain, 6), np.random.default_rng(1)
    step = np.zeros(6 + len(chain))
    step[:6] = rng.normal(size=6)
    np.testing.assert_allclose(moved(chain, where, step).root, exp(step[:6]) @ where.root, atol=1e-12)


def test_a_step_and_its_logarithm_are_inverse(chain):
    a, b = somewhere(chain, 7), somewhere(chain, 8)
    step = np.zeros(6 + len(chain))
    turn_log_kernel(chain.first, chain.count, a.angles, b.angles, step[6:])
    there = moved(chain, a, step)
    np.testing.assert_allclose(local_turns(chain, there).rotations[1:], local_turns(chain, b).rotations[1:], atol=1e-10)


def test_limits_hold(chain):
    root, angles = np.eye(4), np.zeros(len(chain))
    step = np.concatenate([np.zeros(6), np.full(len(chain), 9.0)])
    retract_kernel(chain.first, chain.count, step, root, angles, chain.lower, chain.upper)
    assert np.all(angles <= chain.upper) and np.all(angles >= chain.lower)


def test_limits_let_one_squat_on_the_heels():
    chain = chain_of()
    for side in ("Left", "Right"):
        knee, ankle = chain.names.index(f"{side}Leg.x"), chain.names.index(f"{side}Foot.x")
        assert chain.upper[knee] >= np.radians(160) and chain.lower[ankle] <= np.radians(-60)


def test_poses_that_it_can_take_are_fitted_exactly(chain):
    """Over a batch; whatever the chain can't do is left out."""
    wheres = [somewhere(chain, seed, 0.4) for seed in range(4)]
    both = Configuration(np.stack([w.root for w in wheres]), np.stack([w.angles for w in wheres]))
    pose = local_turns(chain, both)
    again = fitted(chain, pose.root, pose.rotations)
    back = local_turns(chain, again)
    np.testing.assert_allclose(back.rotations, pose.rotations, atol=1e-6)
    np.testing.assert_allclose(again.root, both.root, atol=1e-12)


def test_a_stiff_trunk_leaves_arms_where_they_point():
    skeleton = human()
    chain = chain_of(skeleton)
    local = np.broadcast_to(np.eye(3), (len(skeleton), 3, 3)).copy()
    local[skeleton.index("Spine")] = turn(np.array([0.4, 0.1, 0.0]))
    local[skeleton.index("LeftArm")] = turn(np.array([0.1, 0.5, -0.9]))
    got = local_turns(chain, fitted(chain, np.zeros(3), local))
    _, want = forward_kinematics(skeleton, np.zeros(3), local)
    _, have = forward_kinematics(skeleton, got.root, got.rotations)
    arm = skeleton.index("LeftArm")
    assert np.linalg.norm(vector(want[arm].T @ have[arm])) < 1e-9
