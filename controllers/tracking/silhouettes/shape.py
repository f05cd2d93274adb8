"""A surface in another size and build: as tall, and limbs and trunk as wide, as somebody is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .surface import Surface


def shaped(surface: Surface, stature: float = 1.0, girth: float = 1.0) -> Surface:
    """A surface `stature` times as tall, skeleton and all, and what lies about each bone `girth` times as wide besides.

    ValueError for sizes that no body has, below 0.3 or above 3.
    """
    for name, value in (("stature", stature), ("girth", girth)):
        if not 0.3 <= value <= 3.0:
            raise ValueError(f"{name}: needs 0.3 to 3 times a body's own, not {value:g}")
    chain, rest = surface.chain, surface.rest
    skeleton = chain.skeleton
    along = np.zeros_like(rest)
    for j in range(len(skeleton)):
        below = rest[skeleton.parents == j] - rest[j]
        ends = skeleton.end_offsets[skeleton.end_parents == j]
        along[j] = np.concatenate([below, ends]).mean(0) if len(below) + len(ends) else 0.0
    along /= np.maximum(np.linalg.norm(along, axis=-1, keepdims=True), 1e-9)
    owners = np.concatenate([np.arange(len(skeleton)), surface.carriers])[surface.bones]  # (V, 4) joints
    away = surface.vertices[:, None] - rest[owners]
    ahead = (away * along[owners]).sum(-1, keepdims=True) * along[owners]
    made = np.einsum("vk,vkc->vc", surface.weights, rest[owners] + ahead + girth * (away - ahead))
    return replace(surface, chain=replace(chain, skeleton=skeleton.scaled(stature)), vertices=stature * made, rest=stature * rest)
