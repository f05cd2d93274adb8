"""The shortest way on a grid, A*: slower and rougher than the visibility graph, and never without a way where one is wide enough."""

from __future__ import annotations

import heapq
import math

import numpy as np

from ...compiled import kernel
from .shapes import clear, distance

CELL = 0.05
"""The grid's cells [m]."""
AROUND = 1.5
"""The grid reaches so far beyond start, goal and shapes [m]."""


def grid_way(start, goal, shapes: np.ndarray, clearance: float, cell: float = CELL) -> np.ndarray:
    """The shortest way (n, 2) [m] over cells that are a clearance away from all shapes (K, 6), straightened; (0, 2) where there is none."""
    start, goal = np.asarray(start, float), np.asarray(goal, float)
    reach = np.hypot(shapes[:, 2], shapes[:, 3]) + shapes[:, 5] + clearance
    ends = np.concatenate([[start, goal], shapes[:, :2] - reach[:, None], shapes[:, :2] + reach[:, None]])
    low = start - cell * np.ceil((start - ends.min(0) + AROUND) / cell)
    count = np.ceil((ends.max(0) + AROUND - low) / cell).astype(int)
    return _search(start, goal, low, count[0], count[1], shapes, clearance, cell)


@kernel
def _search(start, goal, low, wide, long, shapes, clearance, cell):
    """A* from the start, which is a cell's place, to any cell that sees the goal nearby."""
    cost, source, state = np.full(wide * long, np.inf), np.full(wide * long, -1), np.zeros(wide * long, np.int8)
    out = np.empty(3)
    first = int(round((start[0] - low[0]) / cell)) * long + int(round((start[1] - low[1]) / cell))
    cost[first] = 0.0
    queue = [(math.hypot(goal[0] - start[0], goal[1] - start[1]), first)]
    last = -1
    while len(queue):
        here = heapq.heappop(queue)[1]
        if state[here] == 3:
            continue
        state[here] = 3
        i, j = here // long, here % long
        x, z = low[0] + i * cell, low[1] + j * cell
        if math.hypot(goal[0] - x, goal[1] - z) < 2.0 * cell and clear(x, z, goal[0], goal[1], shapes, clearance):
            last = here
            break
        for di in range(-1, 2):
            for dj in range(-1, 2):
                p, q = i + di, j + dj
                if not (0 <= p < wide and 0 <= q < long):
                    continue
                there = p * long + q
                px, pz = low[0] + p * cell, low[1] + q * cell
                if state[there] == 0:
                    state[there] = 1
                    for k in range(shapes.shape[0]):
                        if distance(px, pz, shapes[k], out) < clearance:
                            state[there] = 3
                if state[there] == 3:
                    continue
                new = cost[here] + cell * math.hypot(di, dj)
                if new < cost[there] - 1e-12 and clear(x, z, px, pz, shapes, clearance):
                    cost[there], source[there] = new, here
                    heapq.heappush(queue, (new + math.hypot(goal[0] - px, goal[1] - pz), there))
    if last < 0:
        return np.empty((0, 2))
    count, at = 1, last
    while at >= 0:
        count, at = count + 1, source[at]
    way = np.empty((count, 2))
    way[count - 1] = goal
    at = last
    for n in range(count - 2, -1, -1):
        way[n, 0], way[n, 1] = low[0] + (at // long) * cell, low[1] + (at % long) * cell
        at = source[at]
    kept = np.empty(count, np.int64)  # straightened: each place to the farthest that it sees
    length, at = 1, 0
    kept[0] = 0
    while at < count - 1:
        seen = at + 1
        for n in range(count - 1, at + 1, -1):
            if clear(way[at, 0], way[at, 1], way[n, 0], way[n, 1], shapes, clearance):
                seen = n
                break
        kept[length] = seen
        length, at = length + 1, seen
    return way[kept[:length]]
