"""A network's layers with products in bfloat16, by PyTorch: more than twice as fast on processors that multiply such numbers, slower on others.

As `forward` and `backward` of `controllers/reconstruction/baselines`; sums and weights stay in single precision.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import torch
from torch import Tensor

HALF = torch.bfloat16
torch.set_num_threads(1)  # the same sums on every machine


def forward(weights: list[np.ndarray], biases: list[np.ndarray], x: np.ndarray, added: bool = False,
            kept: list[np.ndarray] | None = None) -> tuple[np.ndarray, Any, Any]:
    """What comes out (B, outputs) of x (B, inputs), and what each layer saw and gave."""
    seen, own, last = [], [], len(weights) - 1
    now = _half(x)
    for i, (w, b) in enumerate(zip(weights, biases, strict=True)):
        seen.append(now)
        y = now @ _half(w) + _half(b) if i < last else (now @ _half(w)).float() + torch.from_numpy(b)
        if i < last:
            y = y.relu_()
        own.append(y)
        now = now + y if added and 0 < i < last else y
        if kept is not None and i < last:
            now = now * _half(kept[i])
    return now.numpy(), seen, own


def backward(weights: list[np.ndarray], seen: list[Tensor], own: list[Tensor], slope: np.ndarray, added: bool = False,
             kept: list[np.ndarray] | None = None) -> list[np.ndarray]:
    """Derivatives of the loss by all weights, then all biases, from that by what came out (B, outputs)."""
    by_weights, by_biases, last = [], [], len(weights) - 1
    now = _half(slope)
    for i in range(last, -1, -1):
        if kept is not None and i < last:
            now = now * _half(kept[i])
        through = now if i == last else now * (own[i] > 0)
        by_weights.insert(0, (seen[i].T @ through).float().numpy())
        by_biases.insert(0, through.sum(0, dtype=torch.float32).numpy())
        if i > 0:
            below = through @ _half(weights[i]).T
            now = below + now if added and i < last else below
    return by_weights + by_biases


def _half(value: np.ndarray) -> Tensor:
    return torch.from_numpy(np.ascontiguousarray(value, np.float32)).to(HALF)
