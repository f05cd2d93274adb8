"""Bodies from points in films: what is seen, what is told of it, mistakes in a scenario."""

import numpy as np
import pytest

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Intent
from gambol.controllers.mocap import write_bvh
from gambol.controllers.reconstruction.evaluation import metrics
from gambol.controllers.reconstruction.pose_vector import JOINTS, SKELETON
from gambol.game.explain.points import pointed, rows
from gambol.game.hud.legend import cells
from gambol.game.output.recorder import motion_clip
from gambol.game.scenario import film
from gambol.game.scenario.scenario import load, shipped
from gambol.game.scene.scene import Dot, Overlays
from gambol.game.world import learnt_methods as learning
from gambol.game.world.followers import Follows, errors, lately
from gambol.game.world.world import DT, figures
from scenarios import tells, written
from steady import SCENE, no_database, walker  # noqa: F401, fixtures


def test_a_follower_goes_where_its_points_are_and_the_legend_says_what_metrics_says(tmp_path, walker):
    scenario = load(written(tmp_path, SCENE))
    truth, found, away, last = [], [], [], None
    for frame in film.run(scenario, walker):
        performer, shadow, _ = frame.after.characters
        if frame.after is not last and frame.after.number:
            last = frame.after
            truth.append(performer.joints[0])
            found.append(shadow.joints[0] - shadow.follows.beside)
            away.append(np.linalg.norm(shadow.follows.controls.on(*shadow.joints) - shadow.intent.points, axis=-1))
    told = last.characters[1].told
    assert len(told) == len(truth) == last.number
    assert np.allclose(told[:, 0], metrics.position_error(np.array(found), np.array(truth)), atol=1e-12)
    apart = np.linalg.norm(np.array(found) - np.array(truth), axis=-1)[:, JOINTS]
    assert np.allclose(told[:, 1], apart.max(1)) and np.array_equal(told[:, 2], JOINTS[apart.argmax(1)])
    assert np.allclose(told[:, 3], np.nanmean(away, axis=1))
    assert last.characters[2].told[:, 3].max() < 0.06 and last.characters[2].state.ground[1] > 3.0  # it walks along
    row = rows(last)[0]
    assert row.errors == lately(told) and row.errors.mean == pytest.approx(told[-30:, 0].mean())
    assert cells(row)[1] == f"{100 * told[-30:, 0].mean():.1f}" and cells(row)[3] == f"{100 * told[-30:, 3].mean():.1f}"
    assert [one.name for one in rows(last)] == ["shadow", "ghost"] and [one.ghost for one in rows(last)] == [False, True]


def test_hidden_points_are_not_seen_and_the_film_is_the_same_to_the_bit(tmp_path, walker):
    scenario = load(written(tmp_path, SCENE.replace("to = 2 }] }", "to = 2 }], noise = 0.01 }")))
    first, second = (list(film.run(scenario, walker)) for _ in range(2))
    for a, b in zip(first, second, strict=True):
        for x, y in zip(a.after.characters, b.after.characters, strict=True):
            assert np.array_equal(x.state.pose.rotations, y.state.pose.rotations) and np.array_equal(x.told, y.told, equal_nan=True)
    for frame in first:
        shadow, ghost = frame.after.characters[1:]
        if frame.after.number:
            hidden = 1 - 1e-9 <= frame.after.time < 2 - 1e-9
            assert np.isfinite(shadow.intent.points).all(-1).tolist() == [not hidden, True, True, True]
            assert np.isfinite(ghost.intent.points).all()
            blur = shadow.intent.points[1:] - ghost.intent.points[1:]
            assert 0.0 < np.abs(blur).max() < 0.06


def test_a_lost_point_comes_back_without_a_pop(tmp_path, walker):
    run = [frame.after.characters[1] for frame in film.run(load(written(tmp_path, SCENE)), walker)]
    steps = np.linalg.norm(np.diff([one.joints[0] for one in run], axis=0), axis=-1).max(1)
    assert steps[20:].max() < 0.12  # 7 m/s, as fast as a wrist swings


def test_what_is_drawn_of_points(tmp_path, walker):
    scenario = load(written(tmp_path, SCENE))
    for frame in film.run(scenario, walker):
        people = pointed(figures(frame.before, frame.after, frame.alpha), frame.before, frame.after, frame.alpha, Overlays(points=True))
        dots = [[s for s in one.sketches if isinstance(s, Dot)] for one in people]
        if frame.after.number:
            # the same points of two followers are drawn once, and once on the performer
            assert [len(some) for some in dots] == [0, 8, 0]
            lost = 1 - 1e-9 <= frame.after.time < 2 - 1e-9
            assert {dot.look for dot in dots[1]} == ({"ball", "ring"} if lost else {"ball"})
            assert [one.opacity for one in people] == [1.0, 1.0, pytest.approx(0.34)]


def test_films_show_the_legend_and_a_clip_can_be_the_performer(tmp_path, walker):
    state, poses = walker.start(), []
    for _ in range(70):
        state, pose = walker.step(state, Intent(np.array([1.2, 0.0, 0.0])), DT)
        poses.append(pose)
    write_bvh(motion_clip("walk", walker.skeleton, poses, 60), tmp_path / "walk.bvh")
    scenario = load(written(tmp_path, """
title = "Clip"
duration = 1.1
overlays = ["mesh", "points", "errors"]
[[shots]]
kind = "follow"
actor = "walk"
[[actors]]
name = "shadow"
follows = { clip = "walk.bvh", points = "6", beside = [1, 0, 0] }
"""))
    seen = list(film.scenes(scenario, walker))
    assert seen[-1][1][0].ink is not None and len(seen[-1][1][0].figures) == 2
    world = seen[-1][0].after
    assert [one.name for one in world.characters] == ["shadow", "walk"]
    assert len(world.characters[0].told) == world.number and world.characters[0].told[-1, 3] < 0.05
    assert abs(world.characters[1].state.ground[2]) < 0.2 and world.characters[1].state.ground[1] > 0.8  # from the origin, ahead


FAULTS = [
    ('actor = "A", points = 4', 'actor = "B", points = 4', "actors[1].follows.actor: nobody with moves is called 'B'; there are A"),
    ('actor = "A", points = 4', 'actor = "ghost", points = 4', "actors[1].follows.actor: nobody with moves is called 'ghost'"),
    ('actor = "A", points = 4', 'points = 4', 'actors[1].follows: needs either actor = "…", another actor, or clip'),
    ('actor = "A", points = 4', 'clip = "none.bvh"', "actors[1].follows.clip: there is no file 'none.bvh' beside the scenario"),
    ("points = 4", 'points = 4, up = "z"', "actors[1].follows: up and unit go with a clip"),
    ("points = 4", 'points = "9"', "actors[1].follows.points: no control point '9': there are root,"),
    ("points = 4", 'points = "lwrist,lwrist"', "actors[1].follows.points: control point 'lwrist' is given twice"),
    ("points = 4", 'points = 4, method = "best"', "actors[1].follows.method: input should be 'trackers', 'ours', 'turning', 'lpcr'"),
    ("points = 4", "points = 4, noise = -1", "actors[1].follows.noise: input should be greater than or equal to 0"),
    ('points = "lwrist", from', 'points = "head", from', "actors[1].follows: hidden[0].points: head is none of the points that are followed"),
    ("from = 1, to = 2", "from = 2, to = 1", "actors[1].follows.hidden[0]: `from` comes before `to`"),
    ("beside = [-1.5, 0, 0.25]", "beside = [-1.5, 0]", "actors[1].follows.beside[2]: is missing, and needed"),
    ('name = "shadow"\n', 'name = "shadow"\nstart = [1, 0, 0]\n', "actors[1]: who follows points has no start"),
    ('name = "shadow"\n', 'name = "shadow"\nenters = 1\n', "actors[1]: who follows points has no enters"),
    ('name = "shadow"\n', 'name = "shadow"\nmoves = []\n', "actors[1]: who follows points has no moves"),
    ("duration = 3", 'duration = 3\ndatabase = "none.gambolmotion"', "database: there is no file 'none.gambolmotion'"),
]


@pytest.mark.parametrize(("old", "new", "says"), FAULTS)
def test_a_fault_names_file_and_field(tmp_path, old, new, says):
    tells(tmp_path, SCENE, old, new, says)


@pytest.mark.parametrize(("words", "says"), [('unit = "parsec"', "actors[1].follows: a unit is m, dm, cm"), ('up = "north"', "actors[1].follows.up: input should be 'x', 'y', 'z'")])
def test_what_a_clip_is_read_as_is_an_axis_and_a_unit(tmp_path, words, says):
    (tmp_path / "walk.bvh").touch()
    for unit in ("0.01", '"cm"', '"0.01"'):
        scene = SCENE.replace('actor = "A", points = 4', f'clip = "walk.bvh", points = 4, unit = {unit}')
        reading = load(written(tmp_path, scene)).actors[1].follows.reading()
        assert (reading.up, reading.unit) == (None, 0.01)
    tells(tmp_path, SCENE, 'actor = "A", points = 4', f'clip = "walk.bvh", points = 4, {words}', says)


def test_two_are_shipped():
    for name in ("reconstruct", "dropout"):
        assert name in shipped() and load(name).followers


def test_the_errors_of_one_moment_by_hand():
    follows = Follows("ours", learning.methods()("ours", "2")[1], "A", np.array([1.0, 0.0, 0.0]))
    still = np.broadcast_to(np.eye(3), (len(SKELETON), 3, 3))
    truth, turned = forward_kinematics(SKELETON, np.zeros(3), still)
    found = truth + [1.0, 0.0, 0.0]
    found[SKELETON.index("Head")] += [0.0, 0.19, 0.0]
    told = errors(follows, (found, turned), truth, follows.there(truth, turned) + [0.0, 0.0, 0.03])
    assert told == pytest.approx([0.01, 0.19, SKELETON.index("Head"), 0.03])
    assert lately(told[None]).joint == "Head" and lately(told[:0].reshape(0, 4)) is None
