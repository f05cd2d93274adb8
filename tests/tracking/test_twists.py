"""The laws of rigid motions and their twists, over batches and where formulas break, and the paper's printed equations."""

import numpy as np
import pytest
from scipy.linalg import expm, logm

from sampling import rotations

from gambol.controllers.tracking.twists import (adjoint, bracket, exp, hat, inverse, log, twist_exp_kernel, twist_log_kernel,
                                                vee)

SIZES = (0.0, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3, 0.1, 0.199999, 0.200001, 1.0, 3.0, np.pi - 1e-3, np.pi - 1e-7)


@pytest.fixture
def rng():
    return np.random.default_rng(3)


def motions(kind, batch, rng):
    out = np.broadcast_to(np.eye(4), (*batch, 4, 4)).copy()
    out[..., :3, :3] = rotations(kind, batch, rng)
    out[..., :3, 3] = rng.normal(size=(*batch, 3)) * 2
    return out


def eye(batch, size=4):
    return np.broadcast_to(np.eye(size), (*batch, size, size))


def test_closure_and_inverse(kind, batch, rng):
    m = motions(kind, batch, rng)
    twist = log(m)
    assert twist.shape == (*batch, 6) and exp(twist).shape == m.shape
    np.testing.assert_allclose(exp(twist), m, atol=1e-9)
    np.testing.assert_allclose(exp(twist) @ exp(-twist), eye(batch), atol=1e-11)
    np.testing.assert_allclose(inverse(m) @ m, eye(batch), atol=1e-12)
    assert np.all(np.linalg.norm(twist[..., 3:], axis=-1) <= np.pi + 1e-12)


def test_identity(batch):
    zero = np.zeros((*batch, 6))
    np.testing.assert_array_equal(exp(zero), eye(batch))
    np.testing.assert_array_equal(log(eye(batch)), zero)


def test_associativity(kind, batch, rng):
    a, b, c = (motions(kind, batch, rng) for _ in range(3))
    np.testing.assert_allclose((a @ b) @ c, a @ (b @ c), atol=1e-12)


def test_the_adjoint_is_a_homomorphism_that_carries_twists(kind, batch, rng):
    a, b = motions(kind, batch, rng), motions("tangent", batch, rng)
    np.testing.assert_allclose(adjoint(a @ b), adjoint(a) @ adjoint(b), atol=1e-11)
    np.testing.assert_allclose(adjoint(inverse(a)) @ adjoint(a), eye(batch, 6), atol=1e-11)
    twist = rng.normal(size=(*batch, 6)) * 0.3
    carried = np.einsum("...ij,...j->...i", adjoint(a), twist)
    np.testing.assert_allclose(a @ exp(twist) @ inverse(a), exp(carried), atol=1e-11)
    np.testing.assert_allclose(vee(hat(carried)), carried)


def test_the_algebras_adjoint_generates_the_groups(rng):
    twist = rng.normal(size=6)
    np.testing.assert_allclose(expm(bracket(twist)), adjoint(exp(twist)), atol=1e-12)


def test_powers_of_one_motion_commute(rng):
    twist = rng.normal(size=6) * 0.4
    np.testing.assert_allclose(exp(0.3 * twist) @ exp(0.7 * twist), exp(twist), atol=1e-12)


@pytest.mark.parametrize("angle", SIZES)
def test_kernels_agree_with_scipy_at_every_size(angle, rng):
    for _ in range(20):
        axis = rng.normal(size=3)
        twist = np.concatenate([rng.normal(size=3), axis / np.linalg.norm(axis) * angle])
        made, back = np.empty((4, 4)), np.empty(6)
        twist_exp_kernel(twist, made)
        np.testing.assert_allclose(made, exp(twist), atol=1e-12)
        np.testing.assert_allclose(made, expm(hat(twist)), atol=2e-12)
        twist_log_kernel(made, back)
        np.testing.assert_allclose(back, twist, atol=1e-12 if angle < 3.1 else 1e-8)


def printed_exp(theta, v, w):
    """Eq. (4) and (5), the square of ω̂ as it is meant."""
    cross = hat(np.r_[v, w])[:3, :3]
    turn = np.eye(3) + cross * np.sin(theta) + cross @ cross * (1 - np.cos(theta))
    out = np.eye(4)
    out[:3, :3], out[:3, 3] = turn, (np.eye(3) - turn) @ np.cross(w, v) + np.outer(w, w) @ v * theta
    return out


@pytest.mark.parametrize("theta", [0.01, 0.5, 1.5, 3.0])
def test_the_papers_equations_as_printed(theta, rng):
    """Eq. (4), (8) and (9) hold for a unit axis and v per unit of θ; expm and logm are the judges."""
    w = rng.normal(size=3)
    w /= np.linalg.norm(w)
    v = rng.normal(size=3)
    motion = printed_exp(theta, v, w)
    np.testing.assert_allclose(motion, expm(theta * hat(np.r_[v, w])), atol=1e-13)
    np.testing.assert_allclose(exp(theta * np.r_[v, w]), motion, atol=1e-12)
    a = (np.eye(3) - motion[:3, :3]) @ hat(np.r_[v, w])[:3, :3] + np.outer(w, w) * theta
    np.testing.assert_allclose(np.linalg.solve(a, motion[:3, 3]), v, atol=1e-11)
    made = np.empty(6)
    twist_log_kernel(motion, made)
    np.testing.assert_allclose(made, vee(np.real(logm(motion))), atol=1e-10)
    np.testing.assert_allclose(made, theta * np.r_[v, w], atol=1e-11)


def test_near_half_a_turn_the_axis_is_not_lost(rng):
    for gap in (1e-4, 1e-6, 1e-8):
        twist = np.r_[rng.normal(size=3), np.array([0.6, -0.8, 0.0]) * (np.pi - gap)]
        made, back = np.empty((4, 4)), np.empty(6)
        twist_exp_kernel(twist, made)
        twist_log_kernel(made, back)
        np.testing.assert_allclose(back, twist, atol=1e-7)
