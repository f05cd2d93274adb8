"""Layers of the network: one for one sample, and what is left out of hidden ones while they are learnt (Srivastava et al. 2014)."""

from __future__ import annotations

import numpy as np

from ...compiled import kernel
from ..regression import EXACT


def rounded(weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Weights (inputs, outputs) as whole numbers up to 127, int8, and what those of each output are multiplied by (outputs,)."""
    scales = (np.maximum(np.abs(weights).max(0), 1e-12) / 127.0).astype(np.float32)
    return np.ascontiguousarray(np.round(weights / scales), np.int8), scales


@kernel(fastmath=EXACT, error_model="numpy")
def rounded_kernel(x, weights, scales, biases, rectified):
    """One layer (outputs,) of one sample x (inputs,), by weights as `rounded` has them: a quarter of the memory, which is what such layers wait for.
    Where a layer sees nothing, weights are not even read; four rows are taken at a time."""
    out, seen, count = np.zeros(len(biases), np.float32), np.empty(len(x), np.int64), 0
    for i in range(len(x)):
        if x[i] != 0.0:
            seen[count] = i
            count += 1
    fours = count - count % 4
    for k in range(0, fours, 4):
        a, b, c, d = seen[k], seen[k + 1], seen[k + 2], seen[k + 3]
        for j in range(len(out)):
            out[j] += (x[a] * np.float32(weights[a, j]) + x[b] * np.float32(weights[b, j])
                       + x[c] * np.float32(weights[c, j]) + x[d] * np.float32(weights[d, j]))
    for k in range(fours, count):
        for j in range(len(out)):
            out[j] += x[seen[k]] * np.float32(weights[seen[k], j])
    for j in range(len(out)):
        out[j] = out[j] * scales[j] + biases[j]
        if rectified:
            out[j] = max(out[j], np.float32(0.0))
    return out


def shares(shape: tuple[int, int], layers: int, dropped: float, rng: np.random.Generator) -> list[np.ndarray] | None:
    """What hidden layers' sums of `shape` are multiplied by: nothing for `dropped` of them, and the rest by as much more. None where all stay."""
    if not dropped:
        return None
    return [(rng.random(shape, np.float32) >= dropped).astype(np.float32) / np.float32(1.0 - dropped) for _ in range(layers)]
