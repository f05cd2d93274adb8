"""Somebody who was lost, brought to where masks show them: what is fitted by contours begins no farther off than contours reach."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..cameras import Lens
from ..silhouettes import Surface, rendered, skinned
from ..twists import Configuration, posed
from .evidence import overlap

LEAST = 50
"""A mask of fewer pixels says nothing of where somebody's middle is."""
HELD = 1e-3
"""How firmly whoever one camera alone sees stays as far from it as they were, over what a ray says."""
TURNS = 8
"""So many ways round may they have turned meanwhile."""


def brought(surface: Surface, lenses: Sequence[Lens], masks: Sequence[np.ndarray], hiding: Sequence[np.ndarray | None],
            where: Configuration) -> Configuration | None:
    """A pose turned and shifted so that it covers best what masks (H, W) bool show; None where none shows enough.

    hiding: of each mask where others are, (H, W) bool, or None. The body's middle comes nearest to the rays through the masks' middles.
    """
    vertices = skinned(surface, *posed(surface.chain, where)[:2])
    corners = vertices[surface.triangles]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=-1)
    middle = areas @ corners.mean(1) / areas.sum()
    matrix, vector = np.zeros((3, 3)), np.zeros(3)
    for lens, mask in zip(lenses, masks):
        y, x = np.nonzero(mask)
        if len(x) < LEAST:
            continue
        ray = lens.directions(np.array([[x.mean(), y.mean()]]))[0]
        across = np.eye(3) - np.outer(ray, ray) / (ray @ ray)
        matrix += across
        vector += across @ (lens.eye - middle)
    if not matrix.any():
        return None
    there = middle + np.linalg.solve(matrix + HELD * np.eye(3), vector)
    best, most = where, -1.0
    for angle in np.arange(TURNS) * (2 * np.pi / TURNS):
        turn, root = np.eye(4), where.root.copy()
        turn[[0, 0, 2, 2], [0, 2, 0, 2]] = np.cos(angle), np.sin(angle), -np.sin(angle), np.cos(angle)
        root[:3, 3] -= middle
        root = turn @ root
        root[:3, 3] += there
        shown = (vertices - middle) @ turn[:3, :3].T + there
        covered = np.nanmean([overlap(mask, rendered(lens, shown, surface.triangles).mask, others)
                              for lens, mask, others in zip(lenses, masks, hiding) if mask.any()])
        if covered > most:
            best, most = Configuration(root, where.angles), float(covered)
    return best
