"""Films: cuts, captions, overlays by shot, views side by side, and cameras that no prop gets into."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.person import person
from gambol.game.camera.line_of_sight import blocked
from gambol.game.scenario import film
from gambol.game.scenario.scenario import load, shipped
from gambol.game.scenario.shots import parts
from gambol.game.scene.scene import Overlays
from scenarios import written
from stand_in import Glide

HEAD = """
title = "Test"
under = "of films"
duration = 12
fps = 20
"""
ACTORS = """
[[actors]]
name = "A"
moves = [{ for = 12, velocity = [1.2, 0.3, 0] }]
[[actors]]
name = "B"
start = [2, 0, 90]
"""
SHOTS = """
[[shots]]
kind = "dolly"
path = [[5, 2, 0], [4, 1, 2], [5, 2, 4]]
look_at = ["A", "B"]
[[shots]]
at = 4
kind = "orbit"
actor = "A"
turn = -90
caption = "Round"
under = "and round"
overlays = ["skeleton"]
[[shots]]
at = 8
caption = "Both"
[[shots.views]]
title = "wide"
kind = "fixed"
eye = [0, 1, -8]
target = [0, 1, 0]
[[shots.views]]
kind = "follow"
actor = "B"
overlays = ["mesh", "contacts"]
"""


def filmed(tmp_path, text=HEAD + SHOTS + ACTORS, fps=None, size=None, shown=None):
    scenario = load(written(tmp_path, text))
    scenario = scenario if fps is None else scenario.at_fps(fps)
    scenario = scenario if size is None else scenario.at_size(size)
    return scenario, list(film.scenes(scenario, Glide(), shown))


def test_captions_come_and_go(tmp_path):
    _, pictures = filmed(tmp_path)
    said = [(frame.time, scenes[0].caption) for frame, scenes in pictures]
    assert {c.text for t, c in said if c and t < 4} == {"Test"} and {c.under for t, c in said if c and t < 4} == {"of films"}
    assert {c.text for t, c in said if c and 4 <= t < 8} == {"Round"}
    opacity = np.array([c.opacity if c else 0.0 for _, c in said])
    assert opacity[0] == 0 and opacity.max() == 1 and np.abs(np.diff(opacity)).max() <= 1 / 20 / film.FADE + 1e-9
    assert opacity[79] == 0 and opacity[159] < 0.11  # nothing is cut off in the middle


def test_shots_and_views_have_overlays_of_their_own(tmp_path):
    _, pictures = filmed(tmp_path)
    assert pictures[0][1][0].overlays == Overlays()
    assert pictures[100][1][0].overlays == Overlays(mesh=False, skeleton=True)
    wide, close = pictures[200][1]
    assert wide.overlays == Overlays() and close.overlays == Overlays(contacts=True)
    _, pictures = filmed(tmp_path, shown=Overlays(path=True))
    assert {scene.overlays for _, scenes in pictures for scene in scenes} == {Overlays(path=True)}


def test_views_stand_side_by_side_and_the_caption_is_said_once(tmp_path):
    _, pictures = filmed(tmp_path)
    assert [len(scenes) for _, scenes in pictures] == [1] * 160 + [2] * 80
    wide, close = pictures[190][1]
    assert wide.part == (0, 0, 0.5, 1) and close.part == (0.5, 0, 0.5, 1)
    assert wide.caption.text == "Both" and close.caption is None and wide.text == ("wide",) and close.text == ()
    _, pictures = filmed(tmp_path, size=(400, 800))
    assert [scene.part for scene in pictures[190][1]] == [(0, 0, 1, 0.5), (0, 0.5, 1, 0.5)]
    assert [scene.caption is None for scene in pictures[190][1]] == [True, False]


@given(st.integers(2, 9), st.sampled_from([(1280, 720), (720, 1280)]))
def test_views_fill_the_picture_and_never_overlap(count, size):
    cells = np.zeros((360, 360), int)
    for left, top, width, height in parts(count, size):
        cells[round(top * 360):round((top + height) * 360), round(left * 360):round((left + width) * 360)] += 1
    assert len(parts(count, size)) == count and np.all(cells == 1)


def test_an_orbit_goes_as_far_round_as_it_is_told(tmp_path):
    _, pictures = filmed(tmp_path, fps=60)
    def bearing(i):
        camera = pictures[i][1][0].camera
        return np.arctan2(*(camera.target - camera.eye)[[0, 2]])
    turned = np.diff(np.unwrap([bearing(i) for i in range(240, 480)])).sum()
    assert np.degrees(turned) == pytest.approx(-90, abs=5)


@pytest.mark.parametrize("fps", [10, 30])
def test_another_frame_rate_films_from_the_same_places(tmp_path, fps):
    scenario, reference = filmed(tmp_path, fps=60)
    _, other = filmed(tmp_path, fps=fps)
    for frame, scenes in other:
        for ours, theirs in zip(scenes, reference[round(frame.time * 60)][1], strict=True):
            assert np.allclose(ours.camera.eye, theirs.camera.eye, atol=1e-9)
            assert np.allclose(ours.camera.target, theirs.camera.target, atol=1e-9)


def test_no_jump_but_at_a_cut(tmp_path):
    _, pictures = filmed(tmp_path, fps=60)
    eyes = np.array([scenes[0].camera.eye for _, scenes in pictures])
    jumps = np.linalg.norm(np.diff(eyes, axis=0), axis=1)
    assert np.all(np.delete(jumps, [239, 479]) < 0.1) and np.all(jumps[[239, 479]] > 0.1)


def test_following_cameras_keep_out_of_walls(tmp_path):
    wall = 'props = [{ centre = [0, 1.5, -2], size = [20, 3, 0.2] }, { kind = "pillar", foot = [1, 0, 3], radius = 0.5 }]'
    scenario, pictures = filmed(tmp_path, HEAD + wall + '\n[[shots]]\nkind = "orbit"\nturn = 360' + ACTORS)
    eyes = np.array([scenes[0].camera.eye for _, scenes in pictures])
    assert all(blocked(eye, scenario.stage(), margin=0.0) is None for eye in eyes)
    assert np.linalg.norm(eyes[0] - pictures[0][1][0].camera.target) < 3


@pytest.fixture(scope="module")
def walker():
    return person()


def in_picture(point, camera, aspect):
    """Where a point is seen: −1 … 1 across and up, if it is in the picture."""
    forward = (camera.target - camera.eye) / np.linalg.norm(camera.target - camera.eye)
    right = np.cross(forward, camera.up)
    right /= np.linalg.norm(right)
    way = point - camera.eye
    half = np.tan(0.5 * camera.fov) * (way @ forward)
    return way @ right / (half * aspect), way @ np.cross(right, forward) / half


@pytest.mark.parametrize("name", shipped())
def test_shipped_films_show_whom_they_are_about(name, walker, monkeypatch):
    """In every shot and view, whoever it is about is in the picture; a camera is never in a prop.

    Who follows points walks after them: what makes a body of them plays no part, and costs a hundred times as much.
    """
    monkeypatch.setattr(film, "follower_of", lambda performer, *_: walker)
    scenario = load(name).at_fps(4)
    lost = seen = 0
    for frame, scenes in film.scenes(scenario, walker):
        shot = [s for s in scenario.shots if s.at <= frame.time][-1]
        for table, scene in zip(shot.cameras, scenes, strict=True):
            assert blocked(scene.camera.eye, scenario.stage(), 0.0) is None and scene.camera.eye[1] > 0.1
            aspect = scene.part[2] * scenario.size[0] / (scene.part[3] * scenario.size[1])
            for actor in table.names or (scenario.actors[0].name,):
                feet = scene.figures[frame.after.index(actor)].positions[0] * [1, 0.1, 1]
                x, y = in_picture(feet, scene.camera, aspect)
                seen, lost = seen + 1, lost + (max(abs(x), abs(y)) > 1)
    assert lost <= 0.03 * seen, f"{lost} of {seen}"
