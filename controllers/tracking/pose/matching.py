"""Closest points between two contours in both directions, and the sums of a Gauss-Newton step, compiled."""

from __future__ import annotations

import math

import numpy as np

from ...compiled import kernel


@kernel(nogil=True)
def closest_kernel(queries, targets, facing, stride, pairs, squares, swap, count):
    """Write for every `stride`th query (N, 4), pixel and normal, the closest target (M, 4): (query, target) from `count` on; the new count.

    targets: from the least y to the largest, so that a search from a query's own y outwards ends where nothing nearer can
    come. facing: what opposite normals count in pixels, half of it: the far side of a limb is no match. swap: write
    (target, query).
    """
    many = len(targets)
    for i in range(0, len(queries), stride):
        if many == 0 or count == len(pairs):
            break
        x, y, u, v = queries[i, 0], queries[i, 1], queries[i, 2], queries[i, 3]
        low, high = 0, many
        while low < high:
            middle = (low + high) // 2
            if targets[middle, 1] < y:
                low = middle + 1
            else:
                high = middle
        up, down = low, low - 1
        best, least = 0, np.inf
        while up < many or down >= 0:
            if up < many:
                dx, dy = targets[up, 0] - x, targets[up, 1] - y
                if dy * dy >= least:
                    up = many
                else:
                    du, dv = targets[up, 2] - u, targets[up, 3] - v
                    far = dx * dx + dy * dy + facing * facing * (du * du + dv * dv)
                    if far < least:
                        least, best = far, up
                    up += 1
            if down >= 0:
                dx, dy = targets[down, 0] - x, targets[down, 1] - y
                if dy * dy >= least:
                    down = -1
                else:
                    du, dv = targets[down, 2] - u, targets[down, 3] - v
                    far = dx * dx + dy * dy + facing * facing * (du * du + dv * dv)
                    if far < least:
                        least, best = far, down
                    down -= 1
        pairs[count, 0], pairs[count, 1] = (best, i) if swap else (i, best)
        squares[count] = least
        count += 1
    return count


@kernel(nogil=True, fastmath=True)
def model_points_kernel(pixels, depth, numbers, triangles, directions, eye, ahead, points, corners):
    """Write where pixels (N, 2) of a rendered contour lie (N, 3) [m], and their triangles' vertices (N, 3)."""
    for i in range(len(pixels)):
        x, y = int(pixels[i, 0]), int(pixels[i, 1])
        far = depth[y, x] / (directions[i, 0] * ahead[0] + directions[i, 1] * ahead[1] + directions[i, 2] * ahead[2])
        for k in range(3):
            points[i, k] = eye[k] + far * directions[i, k]
            corners[i, k] = triangles[numbers[y, x], k]


@kernel(nogil=True, fastmath=True)
def sums_kernel(points, corners, shares, columns, pairs, squares, count, eye, directions, across, pixel, gate, bend, jacobian, matrix, vector):
    """Add the rows of pairs (count, 2), model point and observed ray, to the normal equations, in place; residuals' sum and number.

    A row says across·(x − eye) = 0 in pixels: eq. (14) across the contour. columns: (D, 6). gate: what is farther off
    than so many pixels does not count. bend: beyond so many it counts less (Huber). matrix: (6 + D, 6 + D), its upper half.
    """
    total, used = 0.0, 0
    size = len(matrix)
    for p in range(count):
        if squares[p] > gate * gate:
            continue
        i, j = pairs[p, 0], pairs[p, 1]
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        u, v, w = across[j, 0], across[j, 1], across[j, 2]
        a, b, c = x - eye[0], y - eye[1], z - eye[2]
        metre = 1.0 / (pixel[j] * math.sqrt(a * a + b * b + c * c))
        u, v, w = u * metre, v * metre, w * metre
        residual = u * a + v * b + w * c
        weight = 1.0 if abs(residual) < bend else bend / abs(residual)
        jacobian[0], jacobian[1], jacobian[2] = u, v, w
        f, g, h = y * w - z * v, z * u - x * w, x * v - y * u
        jacobian[3], jacobian[4], jacobian[5] = f, g, h
        one, two, three = corners[i, 0], corners[i, 1], corners[i, 2]
        for d in range(size - 6):
            share = (shares[one, d] + shares[two, d] + shares[three, d]) / 3.0
            jacobian[6 + d] = 0.0 if share == 0.0 else share * (
                u * columns[d, 0] + v * columns[d, 1] + w * columns[d, 2] + f * columns[d, 3] + g * columns[d, 4] + h * columns[d, 5])
        for d in range(size):
            value = weight * jacobian[d]
            if value == 0.0:
                continue
            vector[d] -= value * residual
            for e in range(d, size):
                matrix[d, e] += value * jacobian[e]
        total += min(abs(residual), gate)
        used += 1
    return total, used


@kernel(nogil=True, fastmath=True)
def shift_kernel(points, corners, shares, columns, step):
    """Move points (N, 3) of a surface, in place, by a step (6 + D,), to first order."""
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        a, b, c, f, g, h = step[0], step[1], step[2], step[3], step[4], step[5]
        for d in range(len(columns)):
            share = step[6 + d] * (shares[corners[i, 0], d] + shares[corners[i, 1], d] + shares[corners[i, 2], d]) / 3.0
            if share != 0.0:
                a += share * columns[d, 0]
                b += share * columns[d, 1]
                c += share * columns[d, 2]
                f += share * columns[d, 3]
                g += share * columns[d, 4]
                h += share * columns[d, 5]
        points[i, 0], points[i, 1], points[i, 2] = x + a + g * z - h * y, y + b + h * x - f * z, z + c + f * y - g * x
