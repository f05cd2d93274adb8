"""Cameras on the stage: who is tracked, in scenarios and games; what is shown of it, and mistakes in a scenario."""

from dataclasses import replace

import numpy as np
import pytest
from scenarios import tells, written
from steady import walker  # noqa: F401, a fixture

from gambol.controllers.body import human
from gambol.controllers.contract import Intent
from gambol.game.explain import camera_views, rows, with_cameras
from gambol.game.scenario import film
from gambol.game.scenario.scenario import load, shipped
from gambol.game.scene import Ink
from gambol.game.session import begin
from gambol.game.session.actions import done
from gambol.game.world import RATE, Character, World, beginning, tracked_of, watches_of

SCENE = """
title = "Seen"
duration = 0.4
fps = 30
overlays = ["mesh", "errors", "cameras"]
[[actors]]
name = "A"
moves = [{ for = 1.0, velocity = [1, 0, 0] }]
[[actors]]
name = "B"
tracks = { actor = "A", width = 160, wrong = 0.1, rectangles = 1, beside = [1, 0, 0] }
"""


def test_an_actor_is_tracked_and_the_film_shows_what_cameras_see(tmp_path, walker):  # noqa: F811
    scenario = load(written(tmp_path, SCENE))
    frames = list(film.scenes(scenario, walker))
    one, other = frames[-1][0].after.characters
    assert other.state.active == "tracking" and len(other.told) == frames[-1][0].after.number
    away = np.linalg.norm(other.joints[0] - one.joints[0] - [1, 0, 0], axis=-1)
    assert away.mean() < 0.06 and rows(frames[-1][0].after)[0].name == "B"
    assert other.told[-1, 0] == pytest.approx(away[away < 1].mean(), abs=0.02)
    ink = frames[-1][1][0].ink
    picture = ink.sheets[-15]
    assert all((picture[..., :3] == colour).all(-1).sum() > 20 for colour in ((70, 150, 255), (255, 64, 48)))
    again = list(film.run(scenario, walker))[-1].after.characters[1]
    assert np.array_equal(again.state.pose.rotations, other.state.pose.rotations), "the same to the bit"


FAULTS = [('actor = "A", width', 'actor = "C", width', "actors[1].tracks.actor: nobody with moves is called 'C'"),
          ("width = 160", "width = 3", "actors[1].tracks.width"), ("wrong = 0.1", "wrong = 0.9", "actors[1].tracks.wrong"),
          ("wrong = 0.1", "fps = 25", "actors[1].tracks.fps"), ('name = "B"\n', 'name = "B"\nmoves = []\n', "actors[1]: who tracks has no moves"),
          ('name = "B"\n', 'name = "B"\nfollows = { actor = "A" }\n', "actors[1]: somebody either follows points or tracks")]


@pytest.mark.parametrize(("old", "new", "says"), FAULTS)
def test_a_fault_names_file_and_field(tmp_path, old, new, says):
    tells(tmp_path, SCENE, old, new, says)


def test_silhouettes_are_spoilt_as_asked_and_the_same_again():
    watches = watches_of("A", human(), 2, 128)
    still = human()
    from gambol.controllers.body import forward_kinematics

    joints = forward_kinematics(still, still.offsets[0] + [3.0, 0.0, 1.0], np.broadcast_to(np.eye(3), (len(still), 3, 3)).copy())
    clean = watches.sighting(*joints, 4)
    np.testing.assert_allclose(clean.place, [3.0, 0.0, 1.0], atol=1e-9)
    assert all(0.02 < mask.mean() < 0.3 for mask in clean.pictures)
    spoilt = replace(watches, wrong=0.15, rectangles=2)
    one, other = spoilt.sighting(*joints, 4), spoilt.sighting(*joints, 4)
    for a, b, true in zip(one.pictures, other.pictures, clean.pictures):
        assert np.array_equal(a, b) and 0 < (a != true).mean() < 0.1
    lies = replace(watches, corrupted=1.0).sighting(*joints, 4)
    assert not np.array_equal(lies.pictures[0], clean.pictures[0])


def test_a_key_brings_the_penalty_back_and_whoever_is_lost_begins_anew(walker):  # noqa: F811
    moment = done(begin(World((Character("Player 1", walker, walker.start()),))), 0, "track")
    one, other = moment.after.characters
    assert other.watches is not None and other.name == "Tracked" and len(moment.players) == 1

    def penalty(now):
        return now.after.characters[1].controller.parts["tracking"].settings.penalty
    off = done(moment, 0, "penalty")
    assert penalty(moment) and not penalty(off) and penalty(done(off, 0, "penalty"))
    lost = replace(off, after=replace(off.after, characters=(one, replace(off.after.characters[1], told=np.full((30, 4), 2.0)))))
    fresh = done(lost, 0, "penalty").after.characters[1]
    assert not len(fresh.told) and np.allclose(fresh.state.pose.root, other.state.pose.root)
    assert all(c.watches is None for c in done(off, 0, "track").after.characters)


def test_pictures_lie_over_panels():
    assert with_cameras(None, World(()), (640, 360)) is None
    ink = Ink((640, 360), np.zeros(0, [("place", "f4", 2), ("uv", "f4", 2), ("tint", "u1", 4)]), np.zeros(0, np.uint32), (), {})
    assert with_cameras(ink, World(()), (640, 360)) is ink


def test_one_is_shipped():
    scenario = load("tracked")
    assert "tracked" in shipped() and scenario.actors[1].tracks is not None and scenario.actors[2].follows.actor == "tracked"


def test_nobody_to_see_leaves_a_body_to_itself(walker):  # noqa: F811
    watches = watches_of("gone", human(), 2, 96)
    someone = tracked_of(walker, watches, RATE)
    alone = Character("T", someone, beginning(someone, walker.start(), np.zeros(3)), watches=watches)
    after = World((alone,)).step([Intent()])
    assert after.characters[0].state.active == "locomotion" and camera_views(alone, after) is None
