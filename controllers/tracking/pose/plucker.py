"""Points on lines, section 2.3: eq. (11) to (14) as arrays, and what is left of them across a contour.

A line is (n, m), its unit direction and its moment. The compiled solver has the same rows, written out.
"""

from __future__ import annotations

import numpy as np


def constraint(points: np.ndarray, directions: np.ndarray, moments: np.ndarray) -> np.ndarray:
    """How far (N, 3) [m] points (N, 3) are off their lines: x × n − m, eq. (11). Its length is the distance."""
    return np.cross(points, directions) - moments


def plucker_rows(points: np.ndarray, directions: np.ndarray, moments: np.ndarray, columns: np.ndarray, shares: np.ndarray
                 ) -> tuple[np.ndarray, np.ndarray]:
    """The linear constraints of eq. (13) and (14): rows (N, 3, 6 + D) and what they have to be (N, 3).

    columns: (D, 6) each degree's twist in the world. shares: (N, D) how far each point goes along with it.
    Three rows a point, of rank 2: nothing is said along the line.
    """
    twists = np.concatenate([np.eye(6), columns])
    every = np.concatenate([np.ones((len(points), 6)), shares], 1)
    velocity = twists[None, :, :3] + np.cross(twists[None, :, 3:], points[:, None])
    rows = np.cross(velocity * every[..., None], directions[:, None])
    return np.swapaxes(rows, 1, 2), -constraint(points, directions, moments)


def normal_rows(rows: np.ndarray, wanted: np.ndarray, directions: np.ndarray, across: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The part of Plücker rows that points across a contour: (N, 6 + D) and (N,) [m].

    across: (N, 3) unit, square to the lines, the contour's normal in the picture seen in the world. Along a contour one
    point looks like the next, and to pull it there would only hold it back.
    """
    picked = np.cross(across, directions)
    return np.einsum("ni,nij->nj", picked, rows), np.einsum("ni,ni->n", picked, wanted)
