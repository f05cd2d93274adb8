"""Cameras: exact at any frame rate, never inside of anything, no jumps, and the same eye through every change."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body.rotations import wrap
from gambol.game.camera.arm import angles, forward
from gambol.game.camera.dolly import dolly, fixed, on_rail
from gambol.game.camera.arm import CameraSettings
from gambol.game.camera.fly_camera import Free
from gambol.game.camera.follow_camera import BESIDE, Follow
from gambol.game.camera.player_camera import CUT, between, cycled
from gambol.game.camera.line_of_sight import FLOOR, MARGIN, above_floor, free_way, outside
from gambol.game.input import Wish
from gambol.game.scene.scene import Box, Goal, Pillar

STILL = Wish()
HERE = np.zeros(3)
QUIET = np.zeros(2)
turn = st.floats(-20, 20)
unit = st.floats(-1, 1)
boxes = st.builds(lambda x, z, y, w, h, d, heading: Box((x, y, z), (w, h, d), heading),
                  st.floats(-5, 5), st.floats(-5, 5), st.floats(0, 3), st.floats(0.2, 5), st.floats(0.2, 3),
                  st.floats(0.2, 5), st.floats(-7, 7))
pillars = st.builds(lambda x, z, r, h: Pillar((x, 0.0, z), r, h), st.floats(-5, 5), st.floats(-5, 5),
                    st.floats(0.1, 1.5), st.floats(0.3, 4))
stage = st.lists(boxes | pillars, max_size=6).map(tuple)
pair = st.tuples(unit, unit)
wishes = st.builds(Wish, move=pair, look=pair, turn=unit, orbit=pair, drag=pair, zoom=st.floats(-3, 3), pan=pair)


def orbiting(ground=HERE):
    return cycled(Follow.behind(ground), ground)


def flying(ground=HERE):
    return cycled(orbiting(ground), ground)


KINDS = pytest.mark.parametrize("start", [Follow.behind, orbiting, flying], ids=lambda f: f.__name__)


def depth(point, prop):
    """How deep a point lies in a prop [m]; negative outside. Told from the prop's own axes, one by one."""
    x, y, z = point
    if isinstance(prop, Pillar):
        return min(prop.radius - math.hypot(x - prop.foot[0], z - prop.foot[2]), y - prop.foot[1], prop.foot[1] + prop.height - y)
    x, z = x - prop.centre[0], z - prop.centre[2]
    c, s = math.cos(prop.heading), math.sin(prop.heading)
    return min(0.5 * prop.size[0] - abs(c * x - s * z), 0.5 * prop.size[1] - abs(y - prop.centre[1]),
               0.5 * prop.size[2] - abs(s * x + c * z))


def settle(camera, ground, seconds, steps, velocity=(0.0, 0.0), props=(), wish=STILL):
    for _ in range(steps):
        camera = camera.step(np.array(ground), np.array(velocity), wish, seconds / steps, props)
    return camera


def same(a, b, atol=1e-6):
    return np.allclose(a.eye, b.eye, atol=atol) and np.allclose(a.target, b.target, atol=atol)


@given(st.lists(boxes | pillars, min_size=1, max_size=4).map(tuple), st.tuples(*[st.floats(-6, 6)] * 3), turn, st.floats(-1.5, 1.5))
def test_a_ray_is_free_as_far_as_points_on_it_are(props, origin, yaw, pitch):
    """The oracle walks along the ray in small steps."""
    ray = np.array([math.cos(pitch) * math.sin(yaw), math.sin(pitch), math.cos(pitch) * math.cos(yaw)])
    free = free_way(np.array(origin), ray[None], props, margin=0.0)[0]
    for t in np.arange(0.0, 12.0, 0.05):
        deepest = max(depth(origin + t * ray, prop) for prop in props)
        assert deepest < 1e-6 if t < free else True
    if np.isfinite(free):
        assert max(depth(origin + free * ray, prop) for prop in props) == pytest.approx(0.0, abs=1e-6) or free == 0.0


@given(stage, st.tuples(*[st.floats(-6, 6)] * 3))
def test_a_point_moved_out_is_out_and_one_that_is_out_stays(props, point):
    point = above_floor(point)
    moved = outside(point, props)
    assert moved[1] >= FLOOR - 1e-9 and all(depth(moved, prop) < 1e-9 for prop in props)
    assert np.allclose(outside(moved, props), moved, atol=1e-5)


@given(stage, st.lists(st.tuples(wishes, pair, st.sampled_from([1 / 144, 1 / 60, 0.1, 1.0]), st.integers(0, 6)), max_size=12))
@settings(max_examples=80)
def test_no_eye_is_ever_in_a_prop_or_under_the_floor(props, walk):
    """Whoever walks wherever, even through walls, and whatever the hands do."""
    ground, cameras = np.zeros(3), [Follow.behind(HERE), orbiting(), flying()]
    for wish, push, dt, change in walk:
        velocity = 3.0 * np.array(push)
        ground = ground + [velocity[0] * dt, velocity[1] * dt, 0.3]
        for i, camera in enumerate(cameras):
            cameras[i] = camera = (cycled(camera, ground) if change == 0 else camera).step(ground, velocity, wish, dt, props)
            view = camera.view()
            assert np.isfinite(view.eye).all() and np.linalg.norm(view.target - view.eye) > 1e-3
            assert view.eye[1] >= FLOOR - 1e-9
            assert all(depth(view.eye, prop) < 0.0 for prop in props)


@KINDS
@given(st.lists(st.tuples(wishes, pair), max_size=20))
@settings(max_examples=50)
def test_no_eye_is_ever_in_the_character(start, walk):
    camera, ground = start(HERE), np.zeros(3)
    for wish, push in walk:
        ground = ground + [3.0 * push[0] / 60, 3.0 * push[1] / 60, 0.1]
        camera = camera.step(ground, 3.0 * np.array(push), wish, 1 / 60)
        eye = camera.view().eye
        assert math.hypot(eye[0] - ground[0], eye[2] - ground[1]) > 0.45 or eye[1] > 1.75


@pytest.mark.few(4)
@KINDS
@pytest.mark.parametrize("steps", [5, 30, 144])
def test_the_camera_arrives_at_the_same_view_at_any_frame_rate(start, steps):
    camera = start(HERE).turned(0.7, 0.2)
    if isinstance(camera, Free):  # a straight flight: pushed for a while, then let go
        def arrive(n):
            return settle(settle(start(HERE), HERE, 0.5, n, wish=Wish(move=(0.6, 0.8))), HERE, 0.5, n)
    else:
        def arrive(n):
            return settle(camera, (2.0, 1.0, 0.4), 0.5, n)
    assert same(arrive(steps).view(), arrive(1000).view())


@given(st.integers(1, 40), st.integers(1, 40), st.floats(-3, 3), st.floats(-3, 3))
def test_the_look_ahead_does_not_depend_on_the_frame_rate(a, b, x, z):
    fixed_still = replace(Follow.behind(HERE), settings=CameraSettings(rest=math.inf))
    assert same(settle(fixed_still, (1, 2, 0), 0.4, a, (x, z)).view(), settle(fixed_still, (1, 2, 0), 0.4, b, (x, z)).view())


def test_it_looks_ahead_of_a_walker():
    camera = Follow.behind(HERE)
    for i in range(300):
        camera = camera.step(np.array([0.0, 3.0 * i / 60, 0.0]), np.array([0.0, 3.0]), STILL, 1 / 60)
    assert 0.4 < camera.target[2] - 3.0 * 299 / 60 < 1.0


@KINDS
@given(st.integers(1, 4), st.lists(wishes, max_size=4), turn)
@settings(max_examples=50)
def test_changing_cameras_leaves_the_eye_where_it_is(start, times, hands, heading):
    ground = np.array([0.5, -1.0, heading])
    camera = start(HERE)
    for wish in hands:
        camera = camera.step(ground, QUIET, wish, 1 / 60)
    for _ in range(times):
        old, camera = camera, cycled(camera, ground)
        assert type(camera) is not type(old)
        first, second = old.view(), camera.view()
        def looks(view):
            return (view.target - view.eye) / np.linalg.norm(view.target - view.eye)
        assert np.allclose(first.eye, second.eye) and np.allclose(looks(first), looks(second), atol=1e-9)
        after = camera.step(ground, QUIET, STILL, 1e-4).view()
        assert np.linalg.norm(after.eye - first.eye) < 0.05
        camera = camera.step(ground, QUIET, STILL, 1 / 60)


def test_it_comes_back_to_the_character_after_a_flight():
    away = settle(flying(), HERE, 3.0, 180, wish=Wish(move=(0.5, -1.0), turn=-0.5))
    near = settle(flying(), HERE, 3.0, 180, wish=Wish(move=(0.0, 1.0)))
    assert np.linalg.norm(near.view().eye - [0, 1, 0]) < 1.5
    for flown in (away, near):
        back = settle(cycled(flown, HERE), HERE, 4.0, 240)
        assert isinstance(back, Follow) and np.allclose(back.view().target, [0, 1, 0], atol=0.01)
        assert np.linalg.norm(back.view().eye - back.view().target) == pytest.approx(Follow.distance, abs=0.01)


@given(stage, st.lists(st.tuples(pair, unit), min_size=5, max_size=40))
@settings(max_examples=40)
def test_the_eye_jumps_only_when_a_prop_comes_between(props, walk):
    """Somebody walks about outside of the props while the player turns the camera."""
    ground, camera = HERE, None
    for push, orbit in walk:
        for _ in range(6):
            there = ground + [3.0 * push[0] / 60, 3.0 * push[1] / 60, 0.05]
            chest = np.array([there[0], 1.0, there[1]])
            if np.allclose(outside(chest, props, margin=0.6), chest):
                ground = there
            camera = Follow.behind(ground) if camera is None else camera
            old, camera = camera, camera.step(ground, QUIET, Wish(orbit=(orbit, 0.0)), 1 / 60, props)
            gap = np.linalg.norm(camera.eye - old.eye)
            if gap > 0.45:
                sight = old.eye - camera.target
                assert free_way(camera.target, (sight / np.linalg.norm(sight))[None], props, 2 * MARGIN)[0] < np.linalg.norm(sight) + 0.6


def test_a_slab_at_the_chest_lifts_the_eye_and_it_stays_up():
    """On the very margin of the slab its way up is free, however the camera is turned."""
    slab = (Box((0.0, 0.875, -0.77734375), (1.0, 0.25, 0.21875)),)
    camera = settle(Follow.behind(HERE), HERE, 1.0, 60, props=slab)
    for _ in range(12):
        old, camera = camera, camera.step(HERE, QUIET, Wish(orbit=(-1.0, 0.0)), 1 / 60, slab)
        assert np.linalg.norm(camera.eye - old.eye) < 0.1 and camera.eye[1] > 1.5


def test_a_corner_shortens_the_arm_before_it_comes_between():
    pillar = Pillar((1.5, 0.0, -2.0), 0.3, 3.0)
    camera, jumps = settle(Follow.behind(HERE), HERE, 1.0, 60, props=(pillar,)), []
    for _ in range(240):
        old, camera = camera, camera.step(HERE, QUIET, Wish(orbit=(-0.25, 0.0)), 1 / 60, (pillar,))
        jumps.append(np.linalg.norm(camera.eye - old.eye))
    assert camera.yaw < -1.5 and max(jumps) < 0.25  # of the metre and a half that the pillar takes


def test_standing_in_a_corner_is_still():
    walls = (Box((0.0, 1.0, -0.6), (6, 2, 0.2)), Box((-0.6, 1.0, 0.0), (6, 2, 0.2), heading=math.pi / 2), Pillar((0.5, 0, -1), 0.3))
    camera, eyes = settle(Follow.behind(HERE), HERE, 4.0, 240, props=walls), []
    for _ in range(60):
        camera = camera.step(HERE, QUIET, STILL, 1 / 60, walls)
        eyes.append(camera.eye)
    assert np.ptp(eyes, axis=0).max() < 1e-3 and np.linalg.norm(camera.eye - camera.target) > 0.5


@pytest.mark.few(1)
@pytest.mark.parametrize("high", [0.6, 1.0, 2.4])
def test_who_walks_up_to_a_box_is_seen_from_where_he_was(high):
    """From beside, along its face: the eye went overhead, and into his belly."""
    box = (Box((0.0, 0.5 * high, 3.75), (3.0, high, 1.5)),)
    camera, jumps = Follow.behind(np.zeros(3), CameraSettings(rest=np.inf), yaw=0.5 * math.pi, distance=5.0), []
    for k in range(300):
        old, camera = camera, camera.step(np.array([0.0, min(1.4 * k / 60, 2.8), 0.0]), np.array([0.0, 1.4 * (k < 120)]), STILL, 1 / 60, box)
        jumps.append(np.linalg.norm(camera.eye - old.eye))
    assert max(jumps) < 0.3 and np.linalg.norm(camera.eye - camera.target) > 3.0


def test_it_starts_behind_and_looks_where_the_character_looks():
    view = Follow.behind(np.array([1.0, 2.0, math.pi / 2])).view()
    assert view.eye[0] < -2 and view.eye[2] == pytest.approx(2.0) and view.target == pytest.approx([1, 1, 2])


def test_it_comes_round_behind_a_walker_but_leaves_one_who_comes_towards_it():
    crossing = settle(Follow.behind(HERE), HERE, 6.0, 360, velocity=(1.3, 0.0))
    assert crossing.yaw == pytest.approx(math.pi / 2, abs=0.4)
    towards = settle(Follow.behind(HERE), HERE, 6.0, 360, velocity=(0.0, -1.3))
    assert towards.yaw == pytest.approx(0.0, abs=0.05)
    held = settle(Follow.behind(HERE).turned(0.5), HERE, 1.0, 60, velocity=(1.3, 0.0))
    assert held.yaw == pytest.approx(0.5, abs=0.01)


@KINDS
def test_recentring_goes_the_shorter_way(start):
    camera = settle(start(HERE).turned(9 * math.pi + 0.3), HERE, 1.0, 60)
    assert abs(camera.recentred(0.0).wanted_yaw - camera.yaw) <= math.pi + 1e-9


def test_a_wall_behind_the_character_shortens_the_arm():
    wall = Box((0.0, 1.0, -2.0), (10.0, 2.0, 0.2), heading=0.0)
    view = settle(Follow.behind(HERE), HERE, 1.0, 60, props=(wall,)).view()
    assert view.eye[2] > -1.9
    turned = Box((0.0, 1.0, -2.0), (0.2, 2.0, 10.0), heading=math.pi / 2)
    same_wall = settle(Follow.behind(HERE), HERE, 1.0, 60, props=(turned,)).view()
    assert np.allclose(view.eye, same_wall.eye)
    assert np.allclose(settle(Follow.behind(HERE), HERE, 1.0, 60, props=(Goal((0, 0, -2)),)).view().eye[2], -3.9, atol=0.1)


def test_a_low_roof_keeps_the_eye_under_it():
    roof = Box((0.0, 1.9, 0.0), (12.0, 0.1, 12.0))
    camera = settle(orbiting().turned(0.0, 1.4), HERE, 1.0, 60, props=(roof,))
    assert camera.eye[1] < 1.9


def test_panning_leaves_the_character_and_recentring_comes_back():
    camera = settle(orbiting(), HERE, 0.5, 30, wish=Wish(pan=(-0.02, 0.0)))
    there = camera.target
    assert there[0] < -0.5  # pushed left, the picture shows what is on the right: −x for one who looks along +z
    assert np.allclose(settle(camera, (5.0, 0.0, 0.0), 2.0, 120).target, camera.pivot, atol=1e-3)
    assert np.allclose(settle(camera.recentred(0.0), HERE, 2.0, 120).target, [0, 1, 0], atol=1e-3)


def test_flying_goes_where_it_looks():
    camera = settle(flying(), (9.0, 9.0, 0.0), 1.0, 60, wish=Wish(move=(0.0, 1.0)))
    way = camera.eye - flying().eye
    assert np.linalg.norm(way) == pytest.approx(CameraSettings.fly * (1.0 - CameraSettings.fly_halflife / math.log(2)), rel=0.02)
    looks = flying().view().target - flying().view().eye
    assert np.allclose(way / np.linalg.norm(way), looks / np.linalg.norm(looks), atol=1e-6)
    assert settle(flying(), HERE, 1.0, 60, wish=Wish(turn=-1.0)).eye[1] > flying().eye[1] + 1


def test_a_steady_walker_is_followed_without_jitter():
    camera, gaps = Follow.behind(HERE), []
    for i in range(600):
        camera = camera.step(np.array([0.0, 1.3 * i / 60, 0.0]), np.array([0.0, 1.3]), STILL, 1 / 60)
        gaps.append(1.3 * i / 60 - camera.eye[2])
    assert np.ptp(gaps[300:]) < 1e-4


@KINDS
def test_unplayable_turns_are_ignored(start):
    camera = start(HERE)
    assert camera.turned(math.nan) is camera and camera.turned(0.0, math.inf) is camera
    assert np.isfinite(camera.step(HERE, QUIET, Wish(zoom=math.nan, pan=(math.inf, 0.0)), 1 / 60).eye).all()


def test_what_lies_between_two_steps_is_in_the_middle_but_not_of_a_cut():
    a = Follow.behind(HERE)
    b = Follow.behind(np.array([0.2, 0.4, 0.0]))
    assert np.allclose(between(a, b, 0.5).eye, 0.5 * (a.eye + b.eye)) and between(a, b, 0.0).fov == a.view().fov
    far = Follow.behind(np.array([2 * CUT, 0.0, 0.0]))
    assert np.allclose(between(a, far, 0.3).eye, far.eye)


def test_rails_begin_and_end_where_they_should_and_stay_above_the_floor():
    assert np.allclose(dolly([(0, 1, 0), (4, 1, 0)], (0, 1, 5), -1).eye, (0, 1, 0))
    assert np.allclose(dolly([(0, 1, 0), (4, 1, 0)], (0, 1, 5), 2).eye, (4, 1, 0))
    assert dolly([(0, 1, 0), (4, -9, 0)], (0, 1, 5), 1).eye[1] > 0
    assert fixed((0, -3, 0), (0, 1, 5)).eye[1] > 0
    assert np.allclose(on_rail([(1, 2, 3), (1, 2, 3)], 0.5), (1, 2, 3))


@given(st.lists(st.tuples(*[st.floats(-9, 9)] * 3), min_size=2, max_size=6, unique=True))
@settings(max_examples=25)
def test_a_rail_goes_through_its_points_at_one_speed(points):
    along = np.array([on_rail(points, u) for u in np.linspace(0, 1, 2001)])
    for point in points:
        assert np.linalg.norm(along - point, axis=-1).min() < 0.05
    steps = np.linalg.norm(np.diff(along, axis=0), axis=-1)
    assert np.median(steps) >= 0.9 * steps.max()


def test_an_eye_that_props_push_onto_its_target_looks_along_its_arm():
    camera = Follow.behind(HERE, yaw=0.5)
    met = replace(camera, eye=camera.target.copy()).view()
    assert np.allclose(met.target - met.eye, forward(0.5, 0.25))


@given(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5), st.floats(-3.0, 3.0))
@settings(max_examples=16)
def test_who_looks_where_to_jump_sees_it_beside_the_body_and_the_sticks_stay_as_they_are(first, then, heading):
    camera = Follow.behind(np.array([0.0, 0.0, heading]))
    for line in (first, then):
        for _ in range(100):
            camera = camera.aimed(heading + line, 1 / 60).step(np.array([0.0, 0.0, heading]), QUIET, STILL, 1 / 60)
        yaw, pitch, _ = angles(camera.view().target - camera.view().eye)
        assert abs(wrap(heading + line - yaw)) > BESIDE - 0.02
        assert camera.yaw == pytest.approx(heading) and pitch >= camera.pitch - 1e-3
    for _ in range(300):
        camera = camera.aimed(None, 1 / 60).step(np.array([0.0, 0.0, heading]), QUIET, STILL, 1 / 60)
    assert angles(camera.view().target - camera.view().eye)[0] == pytest.approx(float(wrap(heading)), abs=0.01)


def test_a_camera_swings_to_a_jump_without_a_jerk():
    """Nor back: from one frame to the next it never turns faster or slower by more than 0.6 rad/s, where it began at once with 2.6."""
    camera, eyes, yaws = Follow.behind(HERE), [Follow.behind(HERE).eye] * 2, [0.0, 0.0]
    for tick in range(480):
        camera = camera.aimed(0.1 * math.sin(0.1 * tick) if tick < 240 else None, 1 / 60).step(HERE, QUIET, STILL, 1 / 60)
        eyes.append(camera.eye)
        yaws.append(camera.yaw + camera.aside)
    assert np.linalg.norm(np.diff(eyes, axis=0), axis=1).max() < 0.25
    assert np.abs(np.diff(yaws, 2)).max() * 60 < 0.6
