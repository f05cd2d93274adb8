"""Footage that drives somebody: a scenario's actor, who follows four points on them, the game and its logs; and what is said of broken footage."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from logged import play
from scenarios import tells, written
from stand_in import Glide
from steady import walker  # noqa: F401, a fixture
from test_gambol_track import footage  # noqa: F401, a fixture

from gambol.controllers.contract import Intent
from gambol.game.app import Play, Teacher
from gambol.game.explain import camera_views
from gambol.game.footage import FootageError
from gambol.game.input import DEFAULT, Wish
from gambol.game.scenario import film
from gambol.game.scenario.scenario import load
from gambol.game.session.input_log import read
from gambol.game.session.log_lines import LogError
from gambol.game.session.replay import of_library, performer_of, replay, strayed
from gambol.game.world import DT, Filmed, World

SCENE = """
title = "Filmed"
duration = 0.3
fps = 30
[[shots]]
kind = "follow"
actor = "B"
[[actors]]
name = "B"
tracks = { footage = "shots", beside = [1, 0, 0] }
"""


@pytest.fixture
def shots(footage, tmp_path):  # noqa: F811
    shutil.copytree(footage.path, tmp_path / "shots")
    return tmp_path / "shots"


def joints(footage):  # noqa: F811
    return footage.truth()["joints"][:, 0].astype(float)


def test_an_actor_goes_as_somebody_was_filmed(footage, shots, tmp_path):  # noqa: F811
    """A frame of the scenario shows a frame of the footage, a metre aside; after the last one they stay."""
    frames = list(film.run(load(written(tmp_path, SCENE)), Glide()))
    true = joints(footage)
    for frame in frames[:5]:  # the footage begins with its second frame, as two are known
        at = frame.before.characters[0].joints[0] - [1, 0, 0]
        assert np.linalg.norm(at - true[frame.number + 1], axis=-1).mean() < 0.06
    ends = [frame.before.characters[0] for frame in frames[-3:]]
    assert all(one.controller.status(one.state).kind == "done" for one in ends)
    assert np.array_equal(ends[0].state.pose.root, ends[-1].state.pose.root)
    again = list(film.run(load(written(tmp_path, SCENE)), Glide()))[-1].before.characters[0]
    assert np.array_equal(again.state.pose.rotations, ends[-1].state.pose.rotations), "the same to the bit"


@pytest.mark.parametrize("masks", [False, True])
def test_cameras_show_what_was_filmed(shots, masks):
    filmed = Filmed.load(shots, Glide(), masks=masks)
    state = filmed.start()
    assert np.array_equal(filmed.enter(state, Intent()).pose.root, state.pose.root)
    for _ in range(3):
        state, pose = filmed.step(state, Intent(), DT)
    assert state.memory.number == 3 and np.array_equal(pose.root, state.pose.root)
    someone = film.opening(load(written(shots.parent, SCENE)), Glide()).characters[0]
    shown = camera_views(replace(someone, controller=filmed, state=state), World())
    found, model = ((shown == colour).all(-1).sum() for colour in ((70, 150, 255), (255, 64, 48)))
    assert shown.shape[1] > 190 and model > 100 and found > 0, "the model's contour lies over the one found, nearly everywhere"


def test_a_game_on_footage_teaches_nothing_says_when_it_is_over_and_whether_jitter_is_penalised(shots, tmp_path):
    """Nobody plays, so no hint; Z takes the penalty of the tracker away and brings it back, and a line says so."""
    game = Play(Filmed.load(shots, Glide()), teacher=Teacher.ready(DEFAULT, file=tmp_path / "hints.toml"))

    def corner():
        view = game.scene((320, 180))
        lines = (view[0] if isinstance(view, tuple) else view).text
        assert (view[0] if isinstance(view, tuple) else view).hint is None
        return " / ".join(part for group in lines for part in (group if isinstance(group, tuple) else (group,)))
    assert "film is over" not in corner() and "penalty" not in corner()
    game.do("penalty")
    for _ in range(30):
        game.tick(DT)
    assert "the film is over" in corner() and "without the penalty on jitter: Z brings it back" in corner()
    game.do("penalty")
    game.tick(DT)
    assert "penalty" not in corner()


def test_who_was_filmed_stands_where_the_game_begins_and_a_log_plays_again_to_the_bit(shots, tmp_path):
    filmed = Filmed.load(shots, Glide())
    state = filmed.start(ground=(2.0, -1.0, 0.5))
    np.testing.assert_allclose(state.ground[:2], [2.0, -1.0])
    moments = play(tmp_path / "a.gambol", [(Wish(),)] * 20, filmed, clip=shots)
    log = read(tmp_path / "a.gambol")
    performer = performer_of(log, Glide())
    assert isinstance(performer, Filmed) and of_library(log, performer) is log and log.prints
    again = list(replay(log, performer))
    for one, other in zip(moments, again[1:]):
        assert not strayed(log, other)
        a, b = one.after.characters[0].state.pose, other.after.characters[0].state.pose
        assert np.array_equal(a.root, b.root) and np.array_equal(a.rotations, b.rotations)
    Image.new("RGB", (96, 96)).save(shots / "cam1" / "frame_00003.png")
    with pytest.raises(LogError, match="was played with another clip"):
        of_library(log, performer_of(log, Glide()))
    shutil.rmtree(shots)
    with pytest.raises(LogError, match="which is not there: put it back"):
        performer_of(log, Glide())


def test_fields_of_footage_and_of_actors_do_not_mix(shots, tmp_path):
    tells(tmp_path, SCENE, 'footage = "shots"', 'footage = "none"', "actors[0].tracks.footage: there is no file 'none' beside the scenario")
    tells(tmp_path, SCENE, 'footage = "shots"', 'footage = "shots", width = 320', "actors[0].tracks: width goes with an actor")
    tells(tmp_path, SCENE, 'footage = "shots"', 'footage = "shots", actor = "B"', "actors[0].tracks: needs either actor")
    tells(tmp_path, SCENE, 'footage = "shots"', 'footage = "shots", person = "Bob"', "shows no Bob; it has Ann")
    (shots / "cameras.toml").write_text("[cam0]\nsize = [96]\n")
    tells(tmp_path, SCENE, "Filmed", "Filmed", "cameras.toml: cam0")


def test_broken_footage_is_told_before_anything_is_played_and_lost_frames_after_it(shots, tmp_path):
    frame = shots / "cam1" / "frame_00003.png"
    Image.new("RGB", (96, 80)).save(frame)
    with pytest.raises(FootageError, match=r"frame_00003.png: 96 × 80 pixels, but cam1 has 96 × 96"):
        Filmed.load(shots, Glide())
    frame.unlink()
    assert Filmed.load(shots, Glide()).footage.lost == {("cam1", "frame"): (3,)}
    told = [frame.refused for frame in film.run(load(written(tmp_path, SCENE)), Glide())]
    assert not any(told[:-1]) and told[-1] == (f"{shots / 'cam1'}: 1 of 6 frames are not there: 3",)
    assert Filmed.load(shots, Glide(), masks=True).masks
    (shots / "truth.npz").unlink()
    with pytest.raises(FootageError, match=r"truth.npz.*--start"):
        Filmed.load(shots, Glide(), masks=True)
    assert len(Filmed.load(shots, Glide(), start=Path(shots / "motion.bvh"), masks=True).poses) == 2


@pytest.mark.thorough
def test_a_log_in_which_somebody_is_tracked_plays_again_to_the_bit(tmp_path, walker):  # noqa: F811
    """Brought by a key, the penalty taken off and on: cameras see the same, and the tracker makes the same of it."""
    pressed = {3: "track", 12: "penalty", 20: "penalty"}
    ticks = [(Wish(move=(0.3, 1.0), pressed=(pressed[t],) if t in pressed else ()),) for t in range(28)]
    moments = play(tmp_path / "a.gambol", ticks, walker, every=14)
    log = read(tmp_path / "a.gambol")
    again = list(replay(log, walker))[1:]
    assert len(log.prints) == 2 and len(again) == len(moments) and len(again[-1].after.characters) == 2
    assert again[-1].after.characters[1].state.active == "tracking"
    for one, other in zip(moments, again):
        assert not strayed(log, other)
        for a, b in zip(one.after.characters, other.after.characters):
            assert np.array_equal(a.state.pose.root, b.state.pose.root) and np.array_equal(a.state.pose.rotations, b.state.pose.rotations)
