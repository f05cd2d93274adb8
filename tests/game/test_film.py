"""Films: cuts, captions, overlays by shot, views side by side, and cameras that no prop gets into."""


import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.person import person
from gambol.game.camera.line_of_sight import blocked
from gambol.game.scenario import doubts, film
from gambol.game.scenario.scenario import load
from gambol.game.scenario.shot_table import parts
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


@pytest.fixture(scope="module")
def pictures(tmp_path_factory):
    """The film above, as it is."""
    return filmed(tmp_path_factory.mktemp("film"))[1]


@pytest.fixture(scope="module")
def finely(tmp_path_factory):
    """The film above at sixty frames a second, for those who look at its cameras only."""
    return filmed(tmp_path_factory.mktemp("film"), fps=60, shown=Overlays())[1]


def test_captions_come_and_go(pictures):
    said = [(frame.time, scenes[0].caption) for frame, scenes in pictures]
    assert {c.text for t, c in said if c and t < 4} == {"Test"} and {c.under for t, c in said if c and t < 4} == {"of films"}
    assert {c.text for t, c in said if c and 4 <= t < 8} == {"Round"}
    opacity = np.array([c.opacity if c else 0.0 for _, c in said])
    assert opacity[0] == 0 and opacity.max() == 1 and np.abs(np.diff(opacity)).max() <= 1 / 20 / film.FADE + 1e-9
    assert opacity[79] == 0 and opacity[159] < 0.11  # nothing is cut off in the middle


def test_shots_and_views_have_overlays_of_their_own(tmp_path, pictures):
    assert pictures[0][1][0].overlays == Overlays()
    assert pictures[100][1][0].overlays == Overlays(mesh=False, skeleton=True)
    wide, close = pictures[200][1]
    assert wide.overlays == Overlays() and close.overlays == Overlays(contacts=True)
    _, pictures = filmed(tmp_path, fps=5, shown=Overlays(path=True))
    assert {scene.overlays for _, scenes in pictures for scene in scenes} == {Overlays(path=True)}


def test_views_stand_side_by_side_and_the_caption_is_said_once(tmp_path, pictures):
    assert [len(scenes) for _, scenes in pictures] == [1] * 160 + [2] * 80
    wide, close = pictures[190][1]
    assert wide.part == (0, 0, 0.5, 1) and close.part == (0.5, 0, 0.5, 1)
    assert wide.caption.text == "Both" and close.caption is None and wide.text == ("wide",) and close.text == ()
    _, pictures = filmed(tmp_path, fps=5, size=(400, 800), shown=Overlays())
    assert [scene.part for scene in pictures[47][1]] == [(0, 0, 1, 0.5), (0, 0.5, 1, 0.5)]
    assert [scene.caption is None for scene in pictures[47][1]] == [True, False]


@given(st.integers(2, 9), st.sampled_from([(1280, 720), (720, 1280)]))
def test_views_fill_the_picture_and_never_overlap(count, size):
    cells = np.zeros((360, 360), int)
    for left, top, width, height in parts(count, size):
        cells[round(top * 360):round((top + height) * 360), round(left * 360):round((left + width) * 360)] += 1
    assert len(parts(count, size)) == count and np.all(cells == 1)


def test_an_orbit_goes_as_far_round_as_it_is_told(finely):
    def bearing(i):
        camera = finely[i][1][0].camera
        return np.arctan2(*(camera.target - camera.eye)[[0, 2]])
    turned = np.diff(np.unwrap([bearing(i) for i in range(240, 480)])).sum()
    assert np.degrees(turned) == pytest.approx(-90, abs=5)


@pytest.mark.few(1)
@pytest.mark.parametrize("fps", [10, 30])
def test_another_frame_rate_films_from_the_same_places(tmp_path, finely, fps):
    _, other = filmed(tmp_path, fps=fps, shown=Overlays())
    for frame, scenes in other:
        for ours, theirs in zip(scenes, finely[round(frame.time * 60)][1], strict=True):
            assert np.allclose(ours.camera.eye, theirs.camera.eye, atol=1e-9)
            assert np.allclose(ours.camera.target, theirs.camera.target, atol=1e-9)


def test_no_jump_but_at_a_cut(finely):
    eyes = np.array([scenes[0].camera.eye for _, scenes in finely])
    jumps = np.linalg.norm(np.diff(eyes, axis=0), axis=1)
    assert np.all(np.delete(jumps, [239, 479]) < 0.1) and np.all(jumps[[239, 479]] > 0.1)


def test_following_cameras_keep_out_of_walls(tmp_path):
    wall = 'props = [{ centre = [0, 1.5, -2], size = [20, 3, 0.2] }, { kind = "pillar", foot = [1, 0, 3], radius = 0.5 }]'
    scenario, pictures = filmed(tmp_path, HEAD + wall + '\n[[shots]]\nkind = "orbit"\nturn = 360' + ACTORS)
    eyes = np.array([scenes[0].camera.eye for _, scenes in pictures])
    assert all(blocked(eye, scenario.stage(), margin=0.0) is None for eye in eyes)
    assert np.linalg.norm(eyes[0] - pictures[0][1][0].camera.target) < 3


def test_an_orbit_whose_distance_is_told_keeps_it_whatever_comes_between_and_is_in_nothing(tmp_path):
    """A post stands between, and a block where the camera goes."""
    shot = '\n[[shots]]\nkind = "orbit"\ntarget = [0, 0.8, 0]\ndistance = 7\nturn = 360'
    things = 'props = [{ kind = "pillar", foot = [-1.5, 0, 0], radius = 0.15, height = 1.5 }, { centre = [0, 1.5, 7], size = [1, 3, 1] }]'
    scenario, pictures = filmed(tmp_path, HEAD + things + shot + ACTORS)
    eyes = np.array([scenes[0].camera.eye for _, scenes in pictures])
    assert all(blocked(eye, scenario.stage(), margin=0.0) is None for eye in eyes)
    off = np.linalg.norm(eyes - [0.0, 0.8, 0.0], axis=1)
    assert off.min() > 6.2 and np.mean(np.abs(off - 7.0) < 1e-9) > 0.9


def test_an_actor_is_there_from_when_it_enters_until_it_leaves(tmp_path):
    """Meanwhile it moves as it would from the beginning; before and afterwards nobody sees it and it costs nothing."""
    text = HEAD + SHOTS + ACTORS
    late = text.replace('start = [2, 0, 90]', 'start = [2, 0, 90]\nmoves = [{ for = 9, velocity = [1.1, 0.2, 0] }]')
    _, early = filmed(tmp_path, late, shown=Overlays())
    _, later = filmed(tmp_path, late.replace("[2, 0, 90]", "[2, 0, 90]\nenters = 3\nleaves = 7"), shown=Overlays())
    grounds = [[frame.after.characters[1].state.ground for frame, _ in one] for one in (early, later)]
    for (frame, scenes), ground in zip(later, grounds[1]):
        there = 3.0 <= frame.time < 7.0
        assert [figure.opacity > 0.0 for figure in scenes[0].figures] == [True, there]
        assert np.array_equal(ground, grounds[1][0]) == (frame.time < 3.0)
    assert np.array_equal(grounds[1][60:140], grounds[0][:80]), "three seconds later, to the bit"
    assert all(np.array_equal(ground, grounds[1][140]) for ground in grounds[1][140:])
    assert all(np.array_equal(a[0].after.characters[0].state.ground, b[0].after.characters[0].state.ground)
               for a, b in zip(early, later)), "nobody else minds"


PANELS = """
[[shots]]
actor = "B"
[[shots]]
at = 1
actor = "B"
panels = ["space", "plots"]
[[shots]]
at = 2
"""


def test_a_shot_shows_panels_about_its_actor_the_same_in_every_run(tmp_path, walker):
    text = (HEAD + PANELS + ACTORS).replace("duration = 12\nfps = 20", "duration = 3\nfps = 10\nsize = [640, 360]").replace(
        "start = [2, 0, 90]", "start = [2, 0, 90]\nmoves = [{ for = 3, velocity = [1.3, 0.4, 0], until = [2.6, -0.2, 0] }]")
    runs = [list(film.scenes(load(written(tmp_path, text)), walker)) for _ in range(2)]
    inks = [[scenes[0].ink for _, scenes in run] for run in runs]
    assert [ink is not None for ink in inks[0]] == [False] * 10 + [True] * 10 + [False] * 10
    for one, other in zip(*(run[10:20] for run in inks)):
        assert np.array_equal(one.vertices, other.vertices) and np.array_equal(one.indices, other.indices)
        assert one.size == (640, 360) and one.vertices["place"][:, 0].min() > 0.6 * 640
    assert not np.array_equal(inks[0][10].vertices, inks[0][11].vertices), "they live"
    alone = text.replace('panels = ["space", "plots"]', 'panels = ["plots"]')
    fewer = [scenes[0].ink for _, scenes in film.scenes(load(written(tmp_path, alone)), walker)][10]
    assert 0 < len(fewer.vertices) < len(inks[0][10].vertices)
    other = text.replace('at = 1\nactor = "B"', 'at = 1\nactor = "A"')
    about = [scenes[0].ink for _, scenes in film.scenes(load(written(tmp_path, other)), walker)][10]
    assert not np.array_equal(about.vertices, inks[0][10].vertices), "about whom the shot is"


@pytest.fixture(scope="module")
def walker():
    return person()


def test_moves_that_never_begin_are_told_with_the_last_frame(tmp_path):
    text = 'title = "x"\nduration = 1\nfps = 10\n[[actors]]\nname = "A"\nmoves = [{ velocity = [1, 0, 0], for = DUR }, { stop = true, for = 9 }, { walk_to = [0, 5] }]'
    file = tmp_path / "x.toml"
    for seconds, told in (("0.2", 1), ("5", 1), ("0.2, until = [0, 0, 0] }, { stop = true, for = 0.1", 1)):
        file.write_text(text.replace("DUR", seconds))
        frames = list(film.run(load(file), Glide()))
        assert all(not frame.refused for frame in frames[:-1]) and len(frames[-1].refused) == told
        assert frames[-1].refused[0].startswith("A: the film is over after 1 s, before 1 of ")
    file.write_text(text.replace("DUR", "0.2").replace("for = 9", "for = 0.2"))
    assert not list(film.run(load(file), Glide()))[-1].refused


def test_what_was_refused_is_drawn_with_the_overlay_of_jumps_alone(tmp_path):
    text = 'title = "x"\nduration = 1\nfps = 10\n[[actors]]\nname = "A"\nmoves = [{ velocity = [1, 0, 0], for = 0.2, jump_to = [0, 9] }]'
    for shown in (None, Overlays(jump=True)):
        _, pictures = filmed(tmp_path, text, shown=shown)
        assert pictures[-1][0].refused and "".join(pictures[-1][1][0].text).startswith("A: no jump to (0, 0, 9)") == (shown is not None)


def test_what_is_hardly_meant_is_told(tmp_path):
    sound = """
        title = "x"
        duration = 5
        [[props]]
        kind = "box"
        centre = [0, 0.25, 3]
        size = [2, 0.5, 2]
        [[props]]
        kind = "pillar"
        foot = [3, 0, 3]
        radius = 0.5
        height = 0.4
        [[actors]]
        name = "A"
        moves = [{ walk_to = [0, 1], speed = 1.3 }, { jump_to = [0, 0.5, 2.5] }]
        [[actors]]
        name = "B"
        start = [1, 0, 0]
    """
    file = tmp_path / "x.toml"
    for old, new, said in (("", "", None), ("speed = 1.3", "speed = 12", "actors[0].moves[0]: 12 m/s, which is 43 km/h, is faster"),
                           ("0.5, 2.5]", "-1, 1]", "actors[0].moves[1].jump_to: (0, -1, 1) is 1.00 m below"),
                           ("0.5, 2.5]", "1.2, 2.5]", "actors[0].moves[1].jump_to: (0, 1.2, 2.5) is 0.70 m above"),
                           ("start = [1, 0, 0]", "start = [0.1, 0, 0]", "actors[1].start: B begins 0.10 m from A"),
                           ("start = [1, 0, 0]", "start = [0.1, 0, 0]\nenters = 4", None),
                           ("start = [1, 0, 0]", "start = [3.1, 3, 0]", "actors[1].start: B begins in a pillar, which nobody stands on"),
                           ("0, 0.5, 2.5]", "3, 3.2]", "actors[0].moves[1].jump_to: lies on a pillar, which nobody stands on"),
                           ("start = [1, 0, 0]", "start = [1, 0, 0]\nenters = 99", "actors[1].enters: B enters after 99 s, and the film is over")):
        file.write_text(sound.replace(old, new))
        told = list(doubts(load(file)))
        assert len(told) == (said is not None) and all(line.startswith(said) for line in told)
