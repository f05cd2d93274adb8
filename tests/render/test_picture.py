"""What the renderer draws: golden pictures, and what must hold of any picture."""

from dataclasses import replace

import numpy as np
import pytest
from poses import CROUCH, HUMAN, STAND, STRIDE, camera, figure

from gambol.game.hosts import Offscreen
from gambol.game.render import FULL, Renderer, preset, sun, view
from gambol.game.scene.scene import Box, Caption, Goal, Hint, Overlays, Pillar, Scene

WALKER = figure(heading=0.6, options=dict(
    contacts=np.array([1, 0, 0, 1], bool),
    trail=np.stack([-0.8 * np.linspace(2, 0, 20), np.full(20, 0.01), -np.linspace(2, 0, 20) ** 1.2], -1),
    path=np.stack([np.linspace(0, 1.2, 16), np.full(16, 0.01), np.linspace(0, 1.0, 16)], -1)), **STRIDE)
ALL = Overlays(mesh=True, skeleton=True, contacts=True, trail=True, path=True)
GOLDEN = {
    "stride": Scene(camera(), (WALKER,)),
    "crouch": Scene(camera(eye=(-2.2, 1.2, 2.4), target=(0, 0.5, 0)), (figure(**CROUCH),)),
    "overlays": Scene(camera(eye=(-2.6, 2.4, 3.0), target=(0, 0.6, 0)), (WALKER,), overlays=ALL, text=("Walk 1.2 m/s",)),
    "company": Scene(camera(eye=(0, 2.2, 6.5)), tuple(figure(heading=k, at=(k - 2, -0.8 * (k % 2)), options=dict(
        tint=(0.2 + 0.15 * k, 0.4, 0.7 - 0.12 * k)), **STAND) for k in range(5)),
        props=(Box((2.6, 0.5, -1.0), (0.6, 1.0, 0.6), 0.4), Box((-2.5, 0.1, 0.5), (1.0, 0.2, 1.0)))),
    "stage": Scene(camera(eye=(2.4, 1.6, 4.6), target=(-0.1, 0.7, -0.6)), (
        WALKER, figure(heading=-0.3, at=(-0.1, -1.5), lift=0.5, options=dict(tint=(0.2, 0.4, 0.8)), **STRIDE)), props=(
        Box((0, 0.25, -1.5), (3.0, 0.5, 1.6)), Box((2.2, 0.5, -1.2), (1.0, 1.0, 1.0), 0.4, (0.5, 0.3, 0.2)),
        Pillar((-2.0, 0, -0.4)), Pillar((-0.9, 0.5, -1.8), 0.2, 1.2), Goal((1.2, 0, 1.0)))),
}


@pytest.mark.parametrize("name", GOLDEN)
def test_golden(draw, compare, name):
    compare(draw(GOLDEN[name]), name)


def test_golden_fast(draw, compare):
    compare(draw(GOLDEN["stride"], "fast"), "stride_fast")


def test_the_same_scene_twice_gives_the_same_bytes(draw):
    first = draw(GOLDEN["overlays"])
    draw(GOLDEN["company"])
    draw(GOLDEN["crouch"])
    assert np.array_equal(first, draw(GOLDEN["overlays"]))


def test_opaque_and_top_row_first(draw):
    picture = draw(Scene(camera(eye=(0, 1.6, 5), target=(0, 1.6, 0))))
    assert (picture[..., 3] == 255).all()
    sky, floor = picture[:40, :, :3].mean((0, 1)), picture[-40:, :, :3].mean((0, 1))
    assert sky[2] > sky[0] + 10 and floor.mean() < sky.mean() - 20


def test_the_floor_meets_the_sky_without_an_edge(draw):
    """At the horizon both are fog."""
    picture = draw(Scene(camera(eye=(0, 1.6, 5), target=(0, 1.6, 0)))).astype(int)
    rows = picture[..., :3].mean(1)
    assert np.abs(np.diff(rows[85:96], axis=0)).max() < 12


def test_the_floor_does_not_shimmer_far_away(draw):
    """The pattern's contrast falls with distance instead of turning to noise."""
    picture = draw(Scene(camera(eye=(0.3, 1.6, 5), target=(0.3, 1.2, 0)))).astype(float)[..., 1]
    near, far = picture[150:170].std(1).mean(), picture[82:90].std(1).mean()
    assert near > 5.0 and far < 4.0


def test_a_figure_casts_a_shadow_and_only_one(draw):
    shot = camera(eye=(0.01, 6.0, 0.0), target=(0, 0, 0), fov=0.9)
    bare, flying = draw(Scene(shot)), draw(Scene(shot, (figure(lift=1.0, **STAND),)))
    darker = (bare.astype(int) - flying)[..., 1] > 25
    assert 0.005 < darker.mean() < 0.12
    one_shadow_each = draw(Scene(shot, (figure(lift=1.0, at=(0.4, 0), **STAND), figure(lift=1.0, at=(0.4, 0), **STAND))))
    alone = draw(Scene(shot, (figure(lift=1.0, at=(0.4, 0), **STAND),)))
    assert np.abs(one_shadow_each.astype(int) - alone)[..., :3].mean() < 1.5


def test_the_lit_floor_is_the_same_with_and_without_somebody_on_it(draw):
    """Where no shadow falls, the floor that looks for shadows equals the floor that does not."""
    shot = camera(eye=(0, 5.0, 2.0), target=(0, 0, 0), fov=0.9)
    bare, peopled = draw(Scene(shot)).astype(int), draw(Scene(shot, (figure(),))).astype(int)
    same = np.abs(bare - peopled)[..., :3].max(-1) <= 2
    assert same.mean() > 0.85


def test_the_body_does_not_shadow_itself_into_stripes(draw):
    """No acne: on the sunlit back, neighbouring pixels differ little."""
    shot = camera(eye=(1.2, 1.5, -0.6), target=(0, 1.25, 0), fov=0.25)
    picture = draw(Scene(shot, (figure(**STAND),))).astype(float)[60:110, 120:160, 1]
    assert np.abs(np.diff(picture, axis=0)).mean() < 4.0


def test_text_is_there_and_readable(draw):
    scene = Scene(camera(eye=(0, 1.6, 5), target=(0, 9.0, 0)))
    plain, lettered = draw(scene), draw(replace(scene, text=("Gambol",)))
    away = np.abs(plain.astype(int) - lettered)[..., :3].max(-1) > 60
    rows, columns = np.nonzero(away)
    assert 30 < away.sum() < 1500 and rows.max() < 40 and columns.max() < 100


def test_a_hint_stands_in_the_middle_below_and_fades(draw):
    scene = GOLDEN["stride"]
    plain = draw(scene).astype(int)
    whole, half = (np.abs(draw(replace(scene, hint=Hint((("W", True), ("to walk", False)), opacity))) - plain).max(-1)
                   for opacity in (1.0, 0.5))
    rows, columns = np.nonzero(whole)
    assert rows.min() > 0.8 * plain.shape[0] and abs(0.5 * (columns.min() + columns.max()) - 0.5 * plain.shape[1]) < 3
    assert whole.max() > 60 and 0.3 * whole.sum() < half.sum() < 0.7 * whole.sum()


def test_of_somebody_who_is_not_there_nothing_is_seen(draw):
    scene = replace(GOLDEN["overlays"], text=())
    gone = replace(scene, figures=(replace(WALKER, opacity=0.0),))
    assert np.array_equal(draw(gone), draw(replace(scene, figures=()))) and not np.array_equal(draw(gone), draw(scene))


def test_bones_show_through_the_body(draw):
    scene = GOLDEN["stride"]
    with_bones = draw(replace(scene, overlays=Overlays(skeleton=True)))
    assert (np.abs(with_bones.astype(int) - draw(scene)).max(-1) > 30).sum() > 150


def test_a_figure_that_is_not_finite_is_left_out(draw):
    broken = figure()
    broken.positions[3, 1] = np.nan
    assert np.array_equal(draw(Scene(camera(), (broken,), overlays=ALL)), draw(Scene(camera(), overlays=ALL)))


def test_a_figure_of_another_skeleton_is_refused(draw):
    odd = figure()
    with pytest.raises(ValueError, match=r"22 joints.*\(21, 3\)"):
        draw(Scene(camera(), (replace(odd, positions=odd.positions[1:]),)))


def test_far_from_the_world_origin_nothing_trembles(draw):
    here = draw(GOLDEN["stride"])
    shift = np.array([4000.0, 0.0, -2000.0])
    there = Scene(replace(GOLDEN["stride"].camera, eye=GOLDEN["stride"].camera.eye + shift,
                          target=GOLDEN["stride"].camera.target + shift),
                  (replace(WALKER, positions=WALKER.positions + shift),))
    assert np.abs(here.astype(int) - draw(there)).mean() < 0.3


def test_forty_figures_in_one_frame(draw):
    crowd = tuple(figure(at=(0.9 * (k % 8 - 4), -1.2 * (k // 8)), **STRIDE) for k in range(40))
    picture = draw(Scene(camera(eye=(0, 3, 6)), crowd), "fast")
    assert picture.std() > 20


def test_resizing_and_reading_into_a_buffer(ctx):
    renderer = Renderer(ctx, (64, 48), "fast")
    renderer.draw(GOLDEN["stride"])
    out = np.zeros((48, 64, 4), np.uint8)
    assert renderer.read(out) is out and np.array_equal(out, renderer.read()) and out.any()
    renderer.resize((33, 21))
    renderer.draw(GOLDEN["stride"])
    assert renderer.read().shape == (21, 33, 4)
    with pytest.raises(ValueError, match=r"\(21, 33, 4\)"):
        renderer.read(out)
    with pytest.raises(ValueError, match="0 × 10"):
        renderer.resize((0, 10))
    target = ctx.simple_framebuffer((33, 21), 4)
    renderer.blit(target)
    assert np.array_equal(np.frombuffer(target.read(components=4), np.uint8).reshape(21, 33, 4)[::-1], renderer.read())
    target.release()
    renderer.release()


def test_presets_by_name():
    assert preset("full") is FULL and preset(FULL) is FULL
    with pytest.raises(ValueError, match="'ultra'.*full, fast"):
        preset("ultra")


def test_each_part_shows_what_its_scene_shows_alone(draw):
    """Two players' views: aspect, shadows, fog and text are those of the part."""
    left = replace(GOLDEN["stride"], text=("Left",), part=(0.0, 0.0, 0.5, 1.0))
    right = replace(GOLDEN["company"], part=(0.5, 0.0, 0.5, 1.0))
    both = draw((left, right), size=(322, 180)).astype(int)
    for scene, columns in ((left, slice(0, 160)), (right, slice(162, 322))):
        alone = draw(replace(scene, part=(0.0, 0.0, 1.0, 1.0)), size=(160, 180))
        assert np.abs(both[:, columns] - alone).mean() < 0.3
    assert both[:, 160:162, :3].max() < 20  # the line between


@pytest.mark.parametrize("part", [(0.5, 0.0, 0.6, 1.0), (0.2, 0.2, 0.001, 0.001), (-0.1, 0.0, 0.5, 0.5)])
def test_a_part_without_pixels_or_outside_the_picture_is_refused(draw, part):
    with pytest.raises(ValueError, match="part"):
        draw(Scene(camera(), part=part))


def test_a_caption_stands_in_the_lower_third_and_fades(draw):
    scene = Scene(camera(eye=(0, 1.6, 5), target=(0, 9.0, 0)))
    plain = draw(scene).astype(int)
    shown, faint, long, gone = (np.abs(draw(replace(scene, caption=caption)) - plain)[..., :3].max(-1) for caption in (
        Caption("Corridor", "half speed"), Caption("Corridor", "half speed", 0.3), Caption("A long title " * 3),
        Caption("Corridor", opacity=0.0)))
    rows, columns = np.nonzero(shown > 40)
    assert rows.min() > 120 and rows.max() < 170 and columns.min() > 10
    assert 0 < faint.max() < 0.6 * shown.max() and gone.max() == 0
    assert np.nonzero(long > 40)[1].max() < 310


def test_two_renderers_in_one_process_do_not_mix(ctx):
    with Offscreen((64, 48), "full") as one, Offscreen((48, 32), "fast") as other:
        first = one.frame(GOLDEN["stride"])
        other.frame(GOLDEN["company"])
        assert np.array_equal(first, one.frame(GOLDEN["stride"]))
    ctx.__enter__()  # current again for the tests that follow


def shade(draw, scene, bare, at):
    """How much darker (levels) `scene` is than `bare` where the point `at` (3,) of the world is seen."""
    shot = scene.camera
    matrix = view.perspective(shot.fov, 16 / 9) @ view.look_at(shot.eye, shot.target, shot.up)
    x, y, _, w = matrix @ [*at, 1.0]
    column, row = round(160 * (1 + x / w)), round(90 * (1 - y / w))
    dark, light = (draw(s)[row - 1:row + 2, column - 1:column + 2, :3].mean() for s in (scene, bare))
    return light - dark


def test_the_floor_is_darker_close_to_feet_and_walls_also_where_the_sun_shines(draw):
    shot = camera(eye=(0.6, 1.5, 1.5), target=(0.1, 0, 0))
    bare, towards = Scene(shot), sun.SUN * [1, 0, 1]
    toe = figure(**STAND).positions[HUMAN.index("LeftToe")] * [1, 0, 1]
    near, far = (shade(draw, Scene(shot, (figure(**STAND),)), bare, toe + k * towards) for k in (0.08, 0.5))
    assert near > 3.0 and abs(far) < 1.5
    wall = Scene(shot, props=(Box((-0.3, 0.5, 0.0), (0.2, 1.0, 2.0)),))
    assert shade(draw, wall, bare, (-0.15, 0, 0)) > 5.0 and abs(shade(draw, wall, bare, (0.4, 0, 0))) < 1.5


def test_figures_and_solids_shadow_platforms_and_each_other(draw):
    shot, top = camera(eye=(0, 3.5, 2.5), target=(0, 0.5, 0)), Box((0, 0.4, 0), (4.0, 0.8, 3.0))
    bare, along = Scene(shot, props=(top,)), -sun.SUN / sun.SUN[1]
    behind = np.array([0.4, 0.8, 0.0]) + 0.8 * (along * [1, 0, 1])  # where the shadow of what is 0.8 m high ends
    post = Scene(shot, props=(top, Pillar((0.4, 0.8, 0.0), 0.1, 1.2)))
    body = Scene(shot, (figure(at=(0.4, 0.0), lift=0.8, **STAND),), (top,))
    assert shade(draw, post, bare, behind) > 30 and shade(draw, body, bare, behind) > 30
    for scene in (post, body):
        assert abs(shade(draw, scene, bare, behind * [-1, 1, 1] + [0.9, 0, 0.4])) < 2


def test_solids_that_move_take_their_shadow_along(draw):
    """Their map is kept from frame to frame."""
    shot, behind = camera(eye=(0, 5, 4), target=(0, 0, 0)), np.array([-0.5, 0, 0.18])
    for x in (-0.8, 0.8):
        moved = Scene(shot, props=(Pillar((x, 0, 0), 0.2, 1.0),))
        assert shade(draw, moved, Scene(shot), behind + [x, 0, 0]) > 30


def test_goals_cast_no_shadow_and_hide_nothing(draw):
    bare = Scene(camera(), (WALKER,))
    lit = draw(replace(bare, props=(Goal((0.3, 0, 0.4)),))).astype(int) - draw(bare)
    assert (np.abs(lit)[..., :3].max(-1) > 25).sum() > 150  # its ring
    assert lit[..., 0].min() > -30  # nowhere a shadow, which would take some 60


@pytest.mark.parametrize("name", ["full", "fast"])
def test_a_slow_dolly_does_not_shimmer(draw, name):
    """On the floor, picture minus supersampled picture hardly changes from frame to frame."""
    errors = []
    for k in range(4):
        shot = camera(eye=(0.3, 1.6, 5 - 0.006 * k), target=(0.3, 1.2, 0))
        fine = draw(Scene(shot), "fast", (1280, 720))[..., 1].reshape(180, 4, 320, 4).mean((1, 3))
        errors.append(draw(Scene(shot), name)[..., 1] - fine)
    assert np.abs(np.diff(errors, axis=0)).mean((0, 2)).max() < 3.0
