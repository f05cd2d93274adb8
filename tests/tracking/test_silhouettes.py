"""What a body covers: pixels and depth against rays, skin against the renderer's, contours against what they should be."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parent))
from bodies import cameras, ray_cast, stick_body, stride

from gambol.controllers.tracking.cameras import looking_at
from gambol.controllers.tracking.silhouettes import contour_of, rendered, skinned
from gambol.controllers.tracking.twists import Configuration, posed
from gambol.game.render import skin
from gambol.game.meshes import surface_of


def edges(mask):
    """Pixels next to a change: there a ray and a triangle's edge may round differently."""
    out = np.zeros_like(mask)
    for axis in (0, 1):
        change = np.diff(mask, axis=axis, append=np.take(mask, [-1], axis))
        out |= change | np.roll(change, 1, axis)
    return out


@pytest.mark.few(1)
@pytest.mark.parametrize("distortion", [(0, 0, 0, 0, 0), (-0.2, 0.05, 0.002, 0.001, 0)])
def test_masks_and_depth_are_what_rays_meet(distortion):
    surface = stick_body()
    positions, orientations, _ = posed(surface.chain, stride(surface.chain, 0.2))
    vertices = skinned(surface, positions, orientations)
    lens = looking_at("a", (72, 96), (1.2, 1.6, 3.0), (0, 0.9, 0), 0.75, distortion)
    got, want = rendered(lens, vertices, surface.triangles), ray_cast(lens, vertices, surface.triangles)
    assert 300 < got.mask.sum() < 3000
    np.testing.assert_array_equal(got.mask[~edges(np.isfinite(want))], np.isfinite(want)[~edges(np.isfinite(want))])
    both = got.mask & np.isfinite(want) & ~edges(got.mask)
    away = np.abs(got.depth[both] - want[both])
    # a lens bends the edges that the rasteriser leaves straight between vertices
    assert np.median(away) < (1e-5 if not any(distortion) else 2e-4) and np.percentile(away, 95) < 0.02
    left, top, right, bottom = got.box
    assert got.mask[top:bottom, left:right].sum() == got.mask.sum()


def test_what_is_behind_a_camera_or_culled_is_not_seen():
    surface = stick_body()
    positions, orientations, _ = posed(surface.chain, stride(surface.chain, 0.0))
    vertices = skinned(surface, positions, orientations)
    away = looking_at("a", (64, 64), (0, 1, 3), (0, 1, 6), 0.8)
    assert not rendered(away, vertices, surface.triangles).mask.any()
    lens = cameras(64)[0]
    inside_out = rendered(lens, vertices, surface.triangles[:, ::-1])
    outside = rendered(lens, vertices, surface.triangles)
    np.testing.assert_array_equal(inside_out.mask, outside.mask)  # a closed body has the same outline
    assert np.all(inside_out.depth[outside.mask] >= outside.depth[outside.mask])


def test_the_nearer_one_is_seen():
    surface = stick_body()
    positions, orientations, _ = posed(surface.chain, surface.chain.rest())
    vertices, lens = skinned(surface, positions, orientations), looking_at("a", (64, 64), (0, 1, 3), (0, 1, 0), 0.8)
    view = rendered(lens, vertices, surface.triangles)
    count = len(surface.triangles)
    view = rendered(lens, vertices + [0.0, 0.0, -0.5], surface.triangles, view, first=count)
    view = rendered(lens, vertices + [0.0, 0.0, 0.5], surface.triangles, view, first=2 * count)
    assert (view.triangles >= 2 * count).any()
    assert np.all(view.triangles[view.depth < 2.4] >= 2 * count)


def test_skin_is_the_renderers():
    """Dual quaternions with helpers that spread twist: the same places as what is drawn."""
    rng = np.random.default_rng(2)
    surface = surface_of(freedom="full", level="far")
    chain = surface.chain
    where = Configuration(np.eye(4), np.clip(rng.normal(size=len(chain)) * 0.6, chain.lower, chain.upper))
    positions, orientations, _ = posed(chain, where)
    motion = skin.motions(positions[None], orientations[None], np.ones(1))[0]
    want = skin.skinned(surface.vertices, surface.bones, surface.weights, motion)
    np.testing.assert_allclose(skinned(surface, positions, orientations), want, atol=1e-6)


def test_shares_say_how_vertices_move():
    """Against differences: exact for stiff skin, near where flesh is shared."""
    for surface, off in ((stick_body(), 1e-6), (surface_of(level="far"), 0.12)):
        chain, where = surface.chain, stride(surface.chain, 0.1)
        positions, orientations, columns = posed(chain, where)
        at = skinned(surface, positions, orientations)
        for d in (chain.names.index("LeftLeg.x"), chain.names.index("RightForeArm.y"), chain.names.index("LeftFoot.x")):
            angles = where.angles.copy()
            angles[d] += 1e-6
            moved = skinned(surface, *posed(chain, Configuration(where.root, angles))[:2])
            velocity = surface.shares[:, d, None] * (columns[d, :3] + np.cross(columns[d, 3:], at))
            error = np.linalg.norm((moved - at) / 1e-6 - velocity, axis=1)
            assert np.percentile(error, 99) < off, chain.names[d]


def test_a_contour_is_what_borders_on_nothing_and_its_normals_point_there():
    y, x = np.mgrid[0:80, 0:100]
    disc = (x - 50.0) ** 2 + (y - 40.0) ** 2 < 25.0**2
    contour = contour_of(disc)
    radius = np.hypot(*(contour.pixels - [50, 40]).T)
    assert np.all((radius > 23.5) & (radius < 25.0)) and len(contour) > 120
    outwards = (contour.pixels - [50, 40]) / radius[:, None]
    assert np.all((contour.normals * outwards).sum(1) > 0.97)
    assert np.all(np.diff(contour.pixels[:, 1]) >= 0), "the matching counts on rows in order"


def test_the_pictures_border_is_no_contour():
    mask = np.zeros((40, 40), bool)
    mask[10:30, 20:] = True
    contour = contour_of(mask)
    assert contour.pixels[:, 0].max() < 39 and {10.0, 29.0} <= set(contour.pixels[:, 1])
    assert len(contour_of(np.zeros((20, 20), bool))) == len(contour_of(np.ones((20, 20), bool))) == 0
