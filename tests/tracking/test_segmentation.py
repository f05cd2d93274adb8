"""Eq. (15): what it costs, that the region found costs least, colours that differ from place to place, and shapes that are known."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import distance_transform_edt
from scipy.stats import norm

from gambol.controllers.tracking.segmentation import (SEGMENTATION, cheapest, costs_of, energy, features_of, gap, in_company,
                                                      likelihood_ratio, segmented, signed_distance)

Y, X = np.mgrid[:120, :140]
DISC, NEAR_DISC = (X - 70) ** 2 + (Y - 60) ** 2 < 32**2, (X - 75) ** 2 + (Y - 56) ** 2 < 30**2
BOX, NEAR_BOX = (abs(X - 70) < 30) & (abs(Y - 60) < 12), (abs(X - 66) < 28) & (abs(Y - 64) < 14)
COLOUR = np.array([1.0, 0.2, -0.6])


def shares(one, other):
    return np.count_nonzero(one & other) / np.count_nonzero(one | other)


def picture(mask, contrast, noise, replaced=0.0, ground=110.0, seed=0):
    rng = np.random.default_rng(seed)
    made = np.broadcast_to(np.asarray(ground)[..., None], (*mask.shape, 3)) + contrast * mask[..., None] * COLOUR
    made = made + rng.normal(size=made.shape) * noise
    wild = rng.random(mask.shape) < replaced
    made[wild] = rng.integers(0, 256, (np.count_nonzero(wild), 3))
    return np.clip(made, 0, 255).astype(np.uint8)


@pytest.mark.parametrize("mask, prior", [(DISC, NEAR_DISC), (BOX, NEAR_BOX)])
@pytest.mark.parametrize("contrast, noise, replaced, least", [(60, 2, 0.0, 0.96), (30, 12, 0.0, 0.93), (15, 10, 0.0, 0.85), (50, 10, 0.15, 0.92)])
def test_known_shapes_are_found(mask, prior, contrast, noise, replaced, least):
    found = segmented(picture(mask, contrast, noise, replaced), prior)
    assert shares(prior, mask) < 0.82 and shares(found.mask, mask) > least


def test_regions_differ_from_place_to_place():
    """A disc a little brighter than ground that runs from dark to light: no two levels tell them apart everywhere."""
    ramp = 40.0 + X
    made = picture(DISC, 18, 3, ground=ramp)
    assert made[DISC].mean() - made[~DISC].mean() < 18 < made[~DISC].std()
    assert shares(segmented(made, NEAR_DISC).mask, DISC) > 0.93


def test_where_nothing_is_to_be_seen_the_prior_stays():
    found = segmented(np.full((120, 140), 90, np.uint8), DISC)
    assert shares(found.mask, DISC) > 0.92  # a little rounder
    assert not segmented(picture(DISC, 50, 3), np.zeros_like(DISC)).mask.any()


def test_nobody_is_beyond_reach():
    far = DISC & (X > 70) | (X - 20) ** 2 + (Y - 20) ** 2 < 9**2
    found = segmented(picture(far, 60, 3), NEAR_BOX).mask
    assert not found[signed_distance(NEAR_BOX, 40.0) <= -SEGMENTATION.reach].any()


def test_a_picture_with_nobody_in_it_helps():
    """Somebody who looks like what is behind, from place to place, but is not it."""
    rng = np.random.default_rng(5)
    plate, other = (rng.integers(0, 256, (30, 35, 3), np.uint8).repeat(4, 0).repeat(4, 1) for _ in range(2))
    shown = np.where(DISC[..., None], other, plate)
    assert shares(segmented(shown, NEAR_DISC).mask, DISC) < 0.85 < shares(segmented(shown, NEAR_DISC, plate).mask, DISC)


def test_colours_tell_whether_the_prior_is_there():
    made = picture(DISC, 50, 5)
    there, aside = segmented(made, DISC).agreement, segmented(made, np.roll(DISC[:, ::-1], (20, 24), (0, 1))).agreement
    wild = segmented(np.random.default_rng(0).integers(0, 256, made.shape, np.uint8), DISC).agreement
    assert there > 0.95 and aside < 0.7 and wild < 0.5


seeds = st.integers(0, 10_000)


def trial(seed, shape=(14, 17)):
    rng = np.random.default_rng(seed)
    prior = np.clip(rng.normal(size=shape).cumsum(0) * 2, -15, 15)
    return rng, prior, rng.normal(size=shape) * 6


def levels_of(region, prior):
    """The Φ of a region that pays least: Φ₀ where signs agree, else 0 from the right side."""
    return np.where(region == (prior > 0), prior, np.where(region, 1e-9, -1e-9))


@given(seeds)
@settings(deadline=None, max_examples=30)
def test_a_region_costs_what_eq_15_says(seed):
    """Up to one constant, for every region; and no other Φ of the same signs pays less."""
    rng, prior, ratio = trial(seed)
    costs = costs_of(ratio, prior)

    def flat(region):
        dx, dy = np.zeros(prior.shape), np.zeros(prior.shape)
        dx[:, :-1], dy[:-1] = np.diff(region * 1.0, axis=1), np.diff(region * 1.0, axis=0)
        return (costs * region + SEGMENTATION.length * np.hypot(dx, dy)).sum()
    one, other = rng.random((2, *prior.shape)) < 0.5
    first, second = (energy(levels_of(region, prior), prior, ratio) for region in (one, other))
    np.testing.assert_allclose(first - second, flat(one) - flat(other), atol=1e-5)
    best = levels_of(one, prior)
    stretched = best * rng.uniform(0.2, 3.0, prior.shape)
    assert energy(stretched, prior, ratio) >= first - 1e-6


def test_costs_are_what_a_pixel_changes():
    """The energy's differences, pixel by pixel, where contours cost nothing."""
    _, prior, ratio = trial(3, (6, 7))
    free = replace(SEGMENTATION, length=0.0)
    region = prior > 0
    costs, base = costs_of(ratio, prior, free), energy(levels_of(region, prior), prior, ratio, free)
    for at in np.ndindex(region.shape):
        flipped = region.copy()
        flipped[at] ^= True
        change = energy(levels_of(flipped, prior), prior, ratio, free) - base
        assert change == pytest.approx(costs[at] if flipped[at] else -costs[at], abs=1e-5)


@given(seeds)
@settings(deadline=None, max_examples=20)
def test_the_search_ends_where_nothing_costs_less(seed):
    rng, prior, ratio = trial(seed)
    costs = costs_of(ratio, prior).astype(np.float32)
    region, field = cheapest(costs, 2.0, 1500, (prior > 0).astype(np.float32))
    assert np.hypot(*field).max() <= 2.0 + 1e-4
    assert -0.02 < gap(costs, 2.0, region, field) < 0.1
    found = energy(levels_of(region > 0.5, prior), prior, ratio)
    assert found <= energy(levels_of(prior > 0, prior), prior, ratio) + 1e-4
    for _ in range(40):  # nor does any patch that changes sides
        y, x = rng.integers(0, 12), rng.integers(0, 15)
        other = region > 0.5
        other[y:y + 3, x:x + 3] ^= True
        assert energy(levels_of(other, prior), prior, ratio) > found - 0.5


@given(seeds)
@settings(deadline=None, max_examples=10)
def test_a_line_of_pixels_against_all_of_its_regions(seed):
    costs = np.random.default_rng(seed).normal(size=(1, 10)).astype(np.float32) * 3
    region, _ = cheapest(costs, 1.5, 3000, np.zeros((1, 10), np.float32))

    def cost(u):
        return float((costs[0] * u).sum() + 1.5 * np.abs(np.diff(u)).sum())
    assert cost((region[0] > 0.5) * 1.0) == pytest.approx(min(cost(np.array(u, float)) for u in product((0, 1), repeat=10)), abs=1e-3)


def test_the_energy_falls_round_by_round():
    made = features_of(picture(DISC, 30, 10))
    prior = signed_distance(NEAR_DISC, SEGMENTATION.reach)
    region = NEAR_DISC.astype(np.float32)
    for _ in range(3):
        ratio = likelihood_ratio(made, region, 1 - region, 3, 3.0, 0.05)
        costs = costs_of(ratio, prior)
        near = np.abs(prior) < SEGMENTATION.reach
        before = energy(levels_of(region > 0.5, prior), prior, ratio)
        region, field = cheapest(costs, SEGMENTATION.length, SEGMENTATION.steps, region)
        after = energy(levels_of(region > 0.5, prior), prior, ratio)
        assert after <= before + 1e-3 and np.array_equal((region > 0.5)[~near], prior[~near] > 0)
        assert gap(costs, SEGMENTATION.length, region, field) < 0.02 * abs(after)


def test_densities_are_scipys():
    """Statistics of the whole picture, by boxes that reach across it, against scipy's normal densities."""
    made = picture(DISC, 40, 8)
    features, inside = features_of(made), DISC.astype(np.float32)
    got = likelihood_ratio(features, inside, 1 - inside, 60, 0.1, 1e-30)
    want = 0.0
    for values in features:
        a, b = values[DISC], values[~DISC]
        want = want + norm.logpdf(values, a.mean(), a.std()) - norm.logpdf(values, b.mean(), b.std())
    np.testing.assert_allclose(got, want, atol=0.02 + 0.01 * np.abs(want).max())


def test_features_keep_distances_between_colours():
    made = np.random.default_rng(1).integers(0, 256, (6, 7, 3), np.uint8)
    got = features_of(made)
    np.testing.assert_allclose(np.linalg.norm(got, axis=0), np.linalg.norm(made.astype(float), axis=-1), rtol=1e-5)
    np.testing.assert_allclose(features_of(made[..., 0])[0], made[..., 0])
    grey = features_of(np.repeat(made[..., :1], 3, -1))
    np.testing.assert_allclose(grey, np.stack([made[..., 0] * 3**0.5, 0 * grey[1], 0 * grey[2]]), atol=1e-4)


@pytest.mark.parametrize("grey", [False, True])
def test_lonely_pixels_are_told(grey):
    """Nearly all wild ones, and hardly any others, not even where two regions or thin lines meet."""
    made, rng = picture(DISC | (X % 40 < 2), 60, 8), np.random.default_rng(2)
    wild = rng.random(DISC.shape) < 0.15
    spoilt = made.copy()
    spoilt[wild] = rng.integers(0, 256, (np.count_nonzero(wild), 3))
    if grey:
        made, spoilt = made[..., 0].copy(), spoilt[..., 0].copy()
    assert in_company(made).mean() > 0.999
    told = in_company(spoilt)
    assert told[wild].mean() < (0.5 if grey else 0.15) and told[~wild].mean() > 0.97


@given(seeds)
@settings(deadline=None, max_examples=20)
def test_distances_are_scipys(seed):
    rng = np.random.default_rng(seed)
    mask = rng.random((23, 31)) < rng.choice([0.03, 0.5, 0.97])
    mask[3, 4], mask[9, 9] = True, False
    want = np.clip(np.where(mask, distance_transform_edt(mask) - 0.5, 0.5 - distance_transform_edt(~mask)), -9, 9)
    np.testing.assert_allclose(signed_distance(mask, 9.0), want, atol=1e-5)


@pytest.mark.parametrize("shown, plate, said", [
    (np.zeros((120, 141, 3), np.uint8), None, "141 × 120 pixels, but its camera has 140 × 120"),
    (np.zeros((120, 140, 4), np.uint8), None, "needs .H, W, 3. or .H, W. levels"),
    (np.zeros((120, 140, 3)), None, "uint8, not .* float64"),
    (np.zeros((120, 140, 3), np.uint8), np.zeros((120, 140), np.uint8), "nobody in it")])
def test_pictures_of_the_wrong_kind(shown, plate, said):
    with pytest.raises(ValueError, match=said):
        segmented(shown, DISC, plate)
