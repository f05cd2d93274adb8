"""Eq. (15) of Rosenhahn 2007: E(Φ) = −∫ H(Φ) log p₁ + (1 − H(Φ)) log p₂ + ν∫|∇H(Φ)| + λ∫(Φ − Φ₀)², Φ > 0 inside.

As printed, ν stands inside the minus, and the contour's length would be made long; here it is added. H is a step, so all that
Φ has to say is its sign: a pixel that keeps the sign of Φ₀ keeps its value too and pays nothing, one that changes sides goes
as far as 0 and pays λΦ₀². What is left is a region u with costs c = log p₂ − log p₁ − λ sgn(Φ₀) Φ₀² and a contour, and the
best one of all can be found (`cheapest`). Densities are then taken anew, and so on.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..silhouettes import extent_of
from .local_gaussians import features_of, in_company, likelihood_ratio
from .signed_distance import signed_distance
from .total_variation import cheapest


@dataclass(frozen=True)
class Segmentation:
    """shape: λ, how firmly the model's shape holds [1/pixel²]; the paper's 0.05. length: ν [1/pixel]. reach: nobody is farther
    outside the model's silhouette [pixels], and everybody who is so deep in it. window: of the neighbourhood that statistics
    are of, squares of 4 pixels to each side of each of two boxes. floor: the least standard deviation [levels of 256].
    stray: how many pixels may have any colour. rounds: of statistics and region. steps: of each search for the region.
    lonely: pixels like no neighbour say something, too."""

    shape: float = 0.05
    length: float = 1.5
    reach: float = 18.0
    window: int = 2
    floor: float = 3.0
    stray: float = 0.05
    rounds: int = 2
    steps: int = 20
    lonely: bool = False


SEGMENTATION = Segmentation()
SPARE = 8
"""So many pixels more than one turn needs are cut out for the next."""


@dataclass(frozen=True, eq=False)
class Cutting:
    """The part of a picture where somebody is. box: left, top, right, bottom pixels. features, empty: (C, h, w) of it and of the
    picture with nobody in it, if there is one. heard: (h, w) which pixels say something; None for all."""

    box: tuple[int, int, int, int]
    features: np.ndarray
    empty: np.ndarray | None
    heard: np.ndarray | None


@dataclass(frozen=True, eq=False)
class Segmented:
    """mask: (H, W) bool. agreement: 0 … 1, how much of the prior's and of the colours' silhouette is both's; 0 for no prior.
    cut: what was looked at, for another turn with the same picture."""

    mask: np.ndarray
    agreement: float
    cut: Cutting | None = None


def segmented(picture: np.ndarray, prior: np.ndarray, plate: np.ndarray | None = None, chosen: Segmentation = SEGMENTATION,
              cut: Cutting | None = None) -> Segmented:
    """Who is in a picture (H, W, 3) or (H, W) uint8 where the model is nearly, prior (H, W) bool.

    plate: the picture with nobody in it. cut: of the same picture, from an earlier turn; what of it still fits is not made
    anew. ValueError for pictures of other sizes or kinds than each other's.
    """
    _checked(picture, prior, plate)
    out, box = np.zeros(prior.shape, bool), extent_of(prior)
    if box[0] == box[2]:
        return Segmented(out, 0.0, cut)
    cut = _cut(picture, plate, box, chosen, cut)
    left, top, right, bottom = cut.box
    part, features, empty, heard = np.s_[top:bottom, left:right], cut.features, cut.empty, cut.heard
    levels = signed_distance(prior[part], chosen.reach)
    region, agreement = prior[part].astype(np.float32), 0.0
    for k in range(chosen.rounds):
        weights = (region, 1.0 - region) if heard is None else (region * heard, heard - region * heard)
        ratio = likelihood_ratio(features, *weights, chosen.window, chosen.floor, chosen.stray, empty)
        if heard is not None:
            ratio *= heard
        if k == 0:
            agreement = _agreement(ratio, prior[part])
        region, _ = cheapest(costs_of(ratio, levels, chosen), chosen.length, chosen.steps, region)
    out[part] = region > 0.5
    return Segmented(out, agreement, cut)


def _cut(picture: np.ndarray, plate: np.ndarray | None, box: tuple[int, int, int, int], chosen: Segmentation, cut: Cutting | None) -> Cutting:
    """The cutting round a body's box, with some room for the next turn; the given one where it has that already."""
    (height, width), more = picture.shape[:2], int(chosen.reach) + 1
    left, top, right, bottom = max(box[0] - more, 0), max(box[1] - more, 0), min(box[2] + more, width), min(box[3] + more, height)
    if cut is not None and cut.box[0] <= left and cut.box[1] <= top and cut.box[2] >= right and cut.box[3] >= bottom:
        return cut
    left, top, right, bottom = max(left - SPARE, 0), max(top - SPARE, 0), min(right + SPARE, width), min(bottom + SPARE, height)
    part = np.s_[top:bottom, left:right]
    return Cutting((left, top, right, bottom), features_of(picture[part]), None if plate is None else features_of(plate[part]),
                   None if chosen.lonely else in_company(picture[part]))


def costs_of(ratio: np.ndarray, levels: np.ndarray, chosen: Segmentation = SEGMENTATION) -> np.ndarray:
    """What each pixel (H, W) costs inside, over what it costs outside. ratio: log p₁ − log p₂. levels: Φ₀."""
    costs = -ratio - chosen.shape * levels * np.abs(levels)
    far = np.abs(levels) >= chosen.reach
    costs[far] = -1e3 * np.sign(levels[far])
    return costs


def energy(levels: np.ndarray, prior: np.ndarray, ratio: np.ndarray, chosen: Segmentation = SEGMENTATION) -> float:
    """E of Φ (H, W), eq. (15), but for ∫ log p₂, which no Φ changes. prior: Φ₀. ratio: log p₁ − log p₂."""
    inside = (levels > 0).astype(float)
    dx, dy = np.zeros_like(inside), np.zeros_like(inside)
    dx[:, :-1], dy[:-1] = np.diff(inside, axis=1), np.diff(inside, axis=0)
    return float((-inside * ratio + chosen.length * np.hypot(dx, dy) + chosen.shape * (levels - prior) ** 2).sum())


def _agreement(ratio: np.ndarray, prior: np.ndarray) -> float:
    likely = ratio > 0
    return np.count_nonzero(likely & prior) / max(np.count_nonzero(likely | prior), 1)


def _checked(picture: np.ndarray, prior: np.ndarray, plate: np.ndarray | None) -> None:
    if picture.dtype != np.uint8 or picture.ndim not in (2, 3) or picture.shape[2:] not in ((), (3,)):
        raise ValueError(f"a picture needs (H, W, 3) or (H, W) levels of 0 to 255, uint8, not {picture.shape} {picture.dtype}")
    if picture.shape[:2] != prior.shape:
        raise ValueError(f"a picture of {picture.shape[1]} × {picture.shape[0]} pixels, but its camera has {prior.shape[1]} × {prior.shape[0]}")
    if plate is not None and (plate.shape != picture.shape or plate.dtype != np.uint8):
        raise ValueError(f"the picture with nobody in it is {plate.shape} {plate.dtype}, but the others are {picture.shape} uint8")
