"""Rotations to test laws on: everywhere, and where formulas break."""

import numpy as np
from scipy.spatial.transform import Rotation

BATCHES = ((), (1,), (3, 1, 2, 1))
KINDS = ("uniform", "tangent", "near identity", "near half turn")


def rotations(kind: str, batch: tuple[int, ...], rng: np.random.Generator) -> np.ndarray:
    """Rotation matrices (*batch, 3, 3)."""
    count = int(np.prod(batch))
    axes = rng.normal(size=(count, 3))
    axes /= np.linalg.norm(axes, axis=-1, keepdims=True)
    if kind == "uniform":
        turned = Rotation.random(count, random_state=rng)
    elif kind == "tangent":
        turned = Rotation.from_rotvec(axes * rng.uniform(0, 3, (count, 1)))
    elif kind == "near identity":
        turned = Rotation.from_rotvec(axes * rng.uniform(0, 1e-7, (count, 1)))
    else:
        turned = Rotation.from_rotvec(axes * (np.pi - rng.uniform(0, 1e-6, (count, 1))))
    return turned.as_matrix().reshape(batch + (3, 3))


def angle(a: np.ndarray, b: np.ndarray) -> float:
    """The largest angle [rad] between two stacks of rotation matrices."""
    a, b = np.asarray(a, float).reshape(-1, 3, 3), np.asarray(b, float).reshape(-1, 3, 3)
    return float((Rotation.from_matrix(a).inv() * Rotation.from_matrix(b)).magnitude().max())
