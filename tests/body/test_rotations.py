"""The laws of rotations, over batches and where formulas break."""

import numpy as np
import pytest
from sampling import angle, rotations

from gambol.controllers.body.rotations import between, continuous, exp, heading_of, log, mean, wrap, yaw


@pytest.fixture
def rng():
    return np.random.default_rng(7)


def test_closure_exp_of_log_is_a_rotation(kind, batch, rng):
    r = rotations(kind, batch, rng)
    back = exp(log(r))
    assert back.shape == batch + (3, 3)
    np.testing.assert_allclose(back @ np.swapaxes(back, -1, -2), np.broadcast_to(np.eye(3), back.shape), atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(back), np.ones(batch), atol=1e-12)
    np.testing.assert_allclose(back, r, atol=1e-9)


def test_log_stays_within_half_a_turn(kind, batch, rng):
    assert np.all(np.linalg.norm(log(rotations(kind, batch, rng)), axis=-1) <= np.pi + 1e-12)


def test_identity(batch):
    zero = np.zeros(batch + (3,))
    np.testing.assert_array_equal(exp(zero), np.broadcast_to(np.eye(3), batch + (3, 3)))
    np.testing.assert_array_equal(log(exp(zero)), zero)


def test_inverse_negates_the_logarithm(kind, batch, rng):
    v = log(rotations(kind, batch, rng))
    np.testing.assert_allclose(exp(v) @ exp(-v), np.broadcast_to(np.eye(3), batch + (3, 3)), atol=1e-12)


def test_associativity(kind, batch, rng):
    a, b, c = (rotations(kind, batch, rng) for _ in range(3))
    np.testing.assert_allclose((a @ b) @ c, a @ (b @ c), atol=1e-14)


def test_between_carries_one_direction_onto_the_other(batch, rng):
    a, b = rng.normal(size=batch + (3,)), rng.normal(size=batch + (3,))
    turned = np.einsum("...ij,...j->...i", between(a, b), a / np.linalg.norm(a, axis=-1, keepdims=True))
    np.testing.assert_allclose(turned, b / np.linalg.norm(b, axis=-1, keepdims=True), atol=1e-12)
    np.testing.assert_allclose(between(a, a), np.broadcast_to(np.eye(3), batch + (3, 3)), atol=1e-7)


@pytest.mark.parametrize("direction", [*np.eye(3), [1.0, 1.0, 1.0], [1e-8, 1.0, 0.0]])
def test_between_opposite_directions_is_half_a_turn(direction):
    direction = np.array(direction)
    np.testing.assert_allclose(between(direction, -direction) @ direction, -direction, atol=1e-7)


def test_yaw_turns_headings(rng):
    angles = rng.uniform(-np.pi, np.pi, (3, 1, 2, 1))
    ahead = yaw(angles) @ np.array([0.0, 0.0, 1.0])
    np.testing.assert_allclose(heading_of(ahead), angles, atol=1e-12)


def test_wrap_lies_in_its_interval_and_keeps_the_angle():
    angles = np.array([-np.pi, np.pi, 3 * np.pi, -7.0, 7.0, 0.0])
    wrapped = wrap(angles)
    assert np.all((wrapped > -np.pi) & (wrapped <= np.pi))
    np.testing.assert_allclose(np.exp(1j * wrapped), np.exp(1j * angles), atol=1e-12)


@pytest.mark.parametrize("axis", [0, 1])
def test_continuous_keeps_rotations_and_never_jumps(axis, rng):
    """Full turns about a slowly wandering axis, several times round."""
    time = np.linspace(0, 1, 400)
    axes = np.stack([np.cos(0.3 * time), np.sin(0.3 * time), 0.2 * time], -1)
    axes /= np.linalg.norm(axes, axis=-1, keepdims=True)
    spin = np.stack([axes * (k * np.pi * time + 0.1)[:, None] for k in (1, 5)], 1)  # (400, 2, 3)
    folded = log(exp(spin))
    smooth = continuous(folded if axis == 0 else np.swapaxes(folded, 0, 1), axis)
    smooth = smooth if axis == 0 else np.swapaxes(smooth, 0, 1)
    np.testing.assert_allclose(exp(smooth), exp(spin), atol=1e-9)
    assert np.abs(np.diff(smooth, axis=0)).max() < 0.1
    np.testing.assert_allclose(smooth, spin, atol=1e-6)


def test_mean_of_copies_and_of_opposites(kind, rng):
    r = rotations(kind, (), rng)
    np.testing.assert_allclose(mean(np.stack([r, r, r])), r, atol=1e-12)
    spread = exp(rng.normal(size=(50, 3)) * 0.2)
    middle = mean(np.concatenate([r @ spread, r @ np.swapaxes(spread, -1, -2)]))
    assert angle(middle, r) < 1e-6


def test_mean_is_a_rotation_even_of_scattered_ones(batch, rng):
    many = np.stack([rotations("uniform", batch, rng) for _ in range(4)])
    middle = mean(many)
    assert middle.shape == batch + (3, 3)
    np.testing.assert_allclose(np.linalg.det(middle), np.ones(batch), atol=1e-9)
