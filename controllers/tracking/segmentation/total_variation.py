"""The region whose pixels and contour together cost least.

A region u of 0 and 1 costs ∫ c u + ν|∇u|. With u anywhere between them that is convex, and cutting its minimum at any level
gives the best region of all (Chan, Esedoglu and Nikolova 2006): no contour has to creep anywhere, and none gets stuck.
"""

from __future__ import annotations

import numpy as np

from ...compiled import kernel

PRIMAL, DUAL = 0.2, 0.6
"""Steps of the two; their product is below 1/8, which convergence needs."""


def cheapest(costs: np.ndarray, length: float, rounds: int, start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The u (H, W), 0 … 1, that costs least, and the field (2, H, W) that shows it (Chambolle and Pock 2011).

    costs: (H, W) of each pixel. length: ν. start: (H, W) where u begins. What costs more than the contour round a single pixel
    is in no best region, and rows are searched from the first pixel that costs less to the last.
    """
    region = np.ascontiguousarray(start, np.float32).copy()
    field, costs = np.zeros((2, *region.shape), np.float32), np.ascontiguousarray(costs, np.float32)
    spans = np.empty((len(region), 2), np.int64)
    span_kernel(costs, 4.0 * length, spans, region)
    variation_kernel(costs, spans, length, rounds, PRIMAL, DUAL, region, field)
    return region, field


def gap(costs: np.ndarray, length: float, region: np.ndarray, field: np.ndarray) -> float:
    """What u costs more than the best at most: its cost less the dual's, which no u is below."""
    dx, dy = np.zeros_like(region), np.zeros_like(region)
    dx[:, :-1], dy[:-1] = np.diff(region, axis=1), np.diff(region, axis=0)
    paid = float((costs * region).sum() + length * np.hypot(dx, dy).sum())
    back = np.diff(field[0], axis=1, prepend=0) + np.diff(field[1], axis=0, prepend=0)
    return paid - float(np.minimum(costs - back, 0.0).sum())


@kernel(nogil=True)
def span_kernel(costs, most, spans, region):
    """Write from where to where (H, 2) rows, or those next to them, cost (H, W) no more than `most`; the region is emptied elsewhere."""
    height, width = costs.shape
    own = np.empty((height, 2), np.int64)
    for y in range(height):
        left, right = 0, width
        while left < right and costs[y, left] > most:
            left += 1
        while right > left and costs[y, right - 1] > most:
            right -= 1
        for x in range(left):
            region[y, x] = 0.0
        for x in range(right, width):
            region[y, x] = 0.0
        own[y, 0], own[y, 1] = (left, right) if left < right else (width, 0)
    for y in range(height):
        left, right = width, 0
        for v in range(max(y - 1, 0), min(y + 2, height)):
            left, right = min(left, own[v, 0]), max(right, own[v, 1])
        spans[y, 0], spans[y, 1] = (max(left - 1, 0), min(right + 1, width)) if left < right else (0, 0)


@kernel(nogil=True, fastmath=True, error_model="numpy")
def variation_kernel(costs, spans, length, rounds, primal, dual, region, field):
    """Go so many steps of both, in place, where rows' spans (H, 2) are. region: (H, W). field: (2, H, W), 0 at the last column and row.

    Row by row: a row's u needs the field of that row and of the one above, and the field u of that row and of the one below.
    Each has its own part of an array, from 0 on, so that many pixels are done at once.
    """
    height, width = costs.shape
    limit, up, down = np.float32(length), np.float32(dual), np.float32(primal)
    ahead, none = region.copy(), np.zeros(width, np.float32)
    zero, one = np.float32(0.0), np.float32(1.0)
    for _ in range(rounds):
        for y in range(height):
            left, right = spans[y, 0], spans[y, 1]
            if left >= right:
                continue
            last, under = min(right, width - 1), min(y + 1, height - 1)
            px, py = field[0, y, left:last], field[1, y, left:last]
            here, beside, below = ahead[y, left:last], ahead[y, left + 1:last + 1], ahead[under, left:last]
            for x in range(last - left):
                a, b = px[x] + up * (beside[x] - here[x]), py[x] + up * (below[x] - here[x])
                scale = limit / max(limit, np.sqrt(a * a + b * b))
                px[x], py[x] = a * scale, b * scale
            if right == width:
                b = field[1, y, last] + up * (ahead[under, last] - ahead[y, last])
                field[1, y, last] = min(max(b, -limit), limit)
            above = field[1, y - 1] if y > 0 else none
            if left == 0:
                old = region[y, 0]
                new = min(max(old + down * (field[0, y, 0] + field[1, y, 0] - above[0] - costs[y, 0]), zero), one)
                region[y, 0], ahead[y, 0] = new, new + new - old
                left = 1
            px, before, py, above = field[0, y, left:right], field[0, y, left - 1:right - 1], field[1, y, left:right], above[left:right]
            u, cost, here = region[y, left:right], costs[y, left:right], ahead[y, left:right]
            for x in range(right - left):
                old = u[x]
                new = min(max(old + down * (px[x] - before[x] + py[x] - above[x] - cost[x]), zero), one)
                u[x], here[x] = new, new + new - old
