"""Layers of the network as they are learnt: what they give out, and derivatives by their weights.

Those between the first and the last may add to what they are given (He et al. 2016), and parts of what hidden ones give out may be
left out while it is learnt (Srivastava et al. 2014).
"""

from __future__ import annotations

import numpy as np


def forward(weights, biases, x, added=False, kept=None):
    """What comes out (B, outputs) of x (B, inputs), and what each layer saw and gave. kept: what each hidden layer's sum is multiplied by."""
    seen, own, last = [], [], len(weights) - 1
    for i, (w, b) in enumerate(zip(weights, biases, strict=True)):
        seen.append(x)
        y = x @ w + b
        own.append(np.maximum(y, 0, out=y) if i < last else y)
        x = x + y if added and 0 < i < last else y
        if kept is not None and i < last:
            x = x * kept[i]
    return x, seen, own


def backward(weights, seen, own, slope, added=False, kept=None):
    """Derivatives of the loss by all weights, then all biases, from that by what came out (B, outputs)."""
    by_weights, by_biases, last = [], [], len(weights) - 1
    for i in range(last, -1, -1):
        if kept is not None and i < last:
            slope = slope * kept[i]
        through = slope if i == last else slope * (own[i] > 0)
        by_weights.insert(0, seen[i].T @ through)
        by_biases.insert(0, through.sum(0))
        below = through @ weights[i].T
        slope = below + slope if added and 0 < i < last else below
    return by_weights + by_biases


def shares(shape: tuple[int, int], layers: int, dropped: float, rng: np.random.Generator) -> list[np.ndarray] | None:
    """What hidden layers' sums of `shape` are multiplied by: nothing for `dropped` of them, and the rest by as much more. None where all stay."""
    if not dropped:
        return None
    return [(rng.random(shape, np.float32) >= dropped).astype(np.float32) / np.float32(1.0 - dropped) for _ in range(layers)]
