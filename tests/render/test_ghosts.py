"""Ghosts: one sees through them, they cast no shadow, and hide behind the body that they are like."""

from dataclasses import replace

import numpy as np

from gambol.game.scene.scene import Box, Scene
from poses import STAND, camera, figure

WALL = Box((0.0, 1.5, -1.5), (4.0, 3.0, 0.2), tint=(0.7, 0.1, 0.1))


def test_one_sees_through_a_ghost_and_it_casts_no_shadow(draw):
    solid = figure(options={"tint": (0.1, 0.3, 0.7)}, **STAND)
    empty, ghostly, whole = (draw(Scene(camera(), people, (WALL,))).astype(int)
                             for people in ((), (replace(solid, opacity=0.3),), (solid,)))
    body = np.abs(whole - empty).max(-1) > 60
    inside = (slice(60, 110), slice(150, 170))  # the trunk
    assert body[inside].mean() > 0.9
    share = np.abs(ghostly - empty)[inside].mean() / np.abs(whole - empty)[inside].mean()
    assert 0.1 < share < 0.9
    # what a ghost changes is itself: a part of the body's own outline, and nothing on the floor beside it
    changed = np.abs(ghostly - empty).max(-1) > 6
    shadow = (np.abs(whole - empty).max(-1) > 12) & ~_grown(changed)
    assert shadow.sum() > 300


def test_a_ghost_of_the_very_same_pose_is_covered(draw):
    solid = figure(options={"tint": (0.1, 0.3, 0.7)}, **STAND)
    ghost = replace(solid, opacity=0.3, tint=(0.9, 0.6, 0.0))
    alone, both = draw(Scene(camera(), (solid,))).astype(int), draw(Scene(camera(), (ghost, solid))).astype(int)
    inside = (slice(60, 110), slice(152, 168))
    assert np.abs(alone - both)[inside].max() <= 2


def test_ghosts_are_drawn_one_behind_the_other_whatever_their_order(draw):
    near = replace(figure(at=(0.1, 0.3), **STAND), opacity=0.4, tint=(0.8, 0.1, 0.1))
    far = replace(figure(at=(0.0, -0.6), **STAND), opacity=0.4, tint=(0.1, 0.1, 0.8))
    assert np.array_equal(draw(Scene(camera(), (near, far))), draw(Scene(camera(), (far, near))))


def _grown(mask):
    """A mask and all within three pixels of it."""
    out = mask.copy()
    for dy in range(-3, 4):
        for dx in range(-3, 4):
            out |= np.roll(np.roll(mask, dy, 0), dx, 1)
    return out


def test_who_is_seen_through_keeps_colours_and_shadow(draw):
    """Unlike a ghost: at nearly its whole cover nothing can be told from the body itself, and at little the shadow is as before."""
    solid = figure(options={"tint": (0.1, 0.3, 0.7)}, **STAND)
    empty, clear, nearly, whole = (draw(Scene(camera(), people, (WALL,))).astype(int) for people in (
        (), (replace(solid, cover=0.1),), (replace(solid, cover=0.999),), (solid,)))
    assert np.abs(nearly - whole).max(-1).mean() < 0.3
    body = _grown(np.abs(clear - whole).max(-1) > 6)
    inside = (slice(60, 110), slice(150, 170))  # the trunk
    assert np.abs(clear - empty)[inside].mean() < 0.2 * np.abs(whole - empty)[inside].mean()
    shadow = (np.abs(whole - empty).max(-1) > 12) & ~body
    assert shadow.sum() > 300 and np.abs(clear - whole)[shadow].max() <= 6
