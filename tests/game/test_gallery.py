"""The gallery: a page of what there is after every film, nothing made twice, figures that tell a slide."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from gambol.game import hosts
from gambol.game import cli
from gambol.game.output import gallery
from gambol.game.scenario.scenario import ScenarioError, load, locate
from stand_in import Glide

TEXT = """
title = "A <b>bold</b> & slow one"
duration = 1
fps = 10
size = [64, 48]
poster = 0.5
[[actors]]
moves = [{ for = 1, velocity = [1.2, 0, 0] }]
"""


class Stage:
    """Draws frames that count; stops after `most`."""

    def __init__(self, most=1000):
        self.most, self.count = most, 0

    def frame(self, scenes):
        if self.count == self.most:
            raise KeyboardInterrupt
        self.count += 1
        return np.full((48, 64, 4), self.count, np.uint8)


@pytest.fixture
def names(tmp_path):
    for name in ("one", "two"):
        (tmp_path / f"{name}.toml").write_text(TEXT.replace("slow", name), encoding="utf-8")
    return [str(tmp_path / "one.toml"), str(tmp_path / "two.toml")]


def made(names, folder, stage=None, **options):
    plans = gallery.plan(names, folder, Glide(), "fast", **options)
    stage = stage or Stage()
    for one in plans:
        if not one.fresh:
            gallery.make(one, folder, Glide(), stage)
    return [one.fresh for one in plans]


def test_a_page_with_poster_film_and_figures(names, tmp_path):
    out, ticks = tmp_path / "out", []
    for one in gallery.plan(names, out, Glide(), "fast"):
        gallery.make(one, out, Glide(), Stage(), lambda: ticks.append(1))
    assert len(ticks) == 20 and {f.name for f in out.iterdir()} == {
        "index.html", *(f"{name}{suffix}" for name in ("one", "two") for suffix in (".mp4", ".png", ".json"))}
    page = (out / "index.html").read_text("utf-8")
    assert "2 films" in page and "0:02" in page and "A &lt;b&gt;bold&lt;/b&gt; &amp; one one" in page and "<b>" not in page
    for name in ("one", "two"):
        assert f'src="{name}.mp4"' in page and f'poster="{name}.png"' in page
    assert "http" not in page  # nothing comes from the net

    from PIL import Image

    assert np.unique(Image.open(out / "one.png")).tolist() == [6]  # the sixth frame is at 0.5 s


@pytest.mark.parametrize("moment", [0.94, 0.96, 0.999])
def test_a_poster_of_the_last_moment_is_the_last_frame(moment, tmp_path):
    """The film of a second ends with the frame at 0.9 s."""
    file = tmp_path / "late.toml"
    file.write_text(TEXT.replace("poster = 0.5", f"poster = {moment}"), encoding="utf-8")
    made([str(file)], tmp_path / "out")

    from PIL import Image

    assert np.unique(Image.open(tmp_path / "out" / "late.png")).tolist() == [10]


def test_films_of_the_same_are_not_made_again(names, tmp_path):
    out = tmp_path / "out"
    assert made(names, out) == [False, False] and made(names, out) == [True, True]
    assert made(names, out, force=True) == [False, False]
    assert made(names, out, size=(32, 32), stage=type("Small", (), {"frame": lambda *_: np.zeros((32, 32, 3), np.uint8)})()) == [False, False]
    assert made(names, out) == [False, False]
    with open(names[0], "a", encoding="utf-8") as file:
        file.write("# another thought\n")
    assert made(names, out) == [False, True]
    (out / "two.mp4").unlink()
    (out / "one.json").write_text("{")
    assert made(names, out) == [False, False]


def test_a_run_that_is_stopped_leaves_a_page_of_what_there_is(names, tmp_path):
    out = tmp_path / "out"
    with pytest.raises(KeyboardInterrupt):
        made(names, out, Stage(15))
    assert [entry.name for entry in gallery.entries(out)] == ["one"]
    page = (out / "index.html").read_text("utf-8")
    assert "1 film," in page and "two" not in page
    assert made(names, out) == [True, False] and len(gallery.entries(out)) == 2


def test_a_file_that_is_no_entry_is_no_film(tmp_path):
    (tmp_path / "notes.json").write_text(json.dumps({"name": "notes"}))
    assert gallery.entries(tmp_path) == () and "0 films" in gallery.write_page(tmp_path).read_text("utf-8")


def test_the_figures_of_a_glide(tmp_path):
    """Whoever glides along standing slides all the time."""
    file = tmp_path / "glide.toml"
    file.write_text(TEXT.replace("1.2", "0.3"), encoding="utf-8")
    figures = gallery.figures(load(file), Glide(halflife=0.01))
    assert figures.top_speed == pytest.approx(0.3, rel=0.03) and figures.distance == pytest.approx(0.3, rel=0.03)
    assert figures.skate > 0.9 and figures.worst_drift > 0.1 and figures.sunk < 0.01 and figures.real_time > 0


def test_names_that_are_none(tmp_path):
    with pytest.raises(ScenarioError, match="no scenario is called 'nowhere'"):
        gallery.plan(["nowhere"], tmp_path / "out", Glide(), "fast")
    assert not (tmp_path / "out").exists()
    assert locate("demo").is_file()


def test_two_films_of_one_name_are_refused(names, tmp_path):
    (tmp_path / "other").mkdir()
    twin = tmp_path / "other" / "one.toml"
    twin.write_text(TEXT, encoding="utf-8")
    with pytest.raises(ScenarioError, match="same name as that of .*one.toml"):
        gallery.plan([*names, str(twin)], tmp_path / "out", Glide(), "fast")
    assert len(gallery.plan([*names, *names], tmp_path / "out", Glide(), "fast")) == 2


def test_the_command_makes_what_is_missing(names, tmp_path, monkeypatch):
    class Hidden(Stage):
        def __init__(self, size, preset):
            super().__init__()

        def __enter__(self):
            return self

        def __exit__(self, *error):
            return None

    monkeypatch.setattr(hosts, "Offscreen", Hidden)
    monkeypatch.setattr("gambol.controllers.person.person", lambda *_: Glide())
    def gallery_of(*more):
        return CliRunner().invoke(cli.app, ["gallery", *more, "-o", str(tmp_path / "out"), "--preset", "fast"])
    assert "1 of 1 films made" in gallery_of(names[0]).stderr
    done = gallery_of(*names)
    assert done.exit_code == 0 and "index.html: 1 of 1 films made, 1 up to date" in done.stderr
    assert gallery_of("nowhere").exit_code == 2


def test_a_film_is_made_anew_when_a_file_that_it_names_has_changed(tmp_path):
    clip, film = tmp_path / "clip.bvh", tmp_path / "film.toml"
    clip.write_text("HIERARCHY", encoding="utf-8")
    film.write_text(TEXT + '[[actors]]\nname = "doll"\nfollows = { clip = "clip.bvh", points = "6", method = "nearest" }\n', encoding="utf-8")
    keys = [gallery.plan([str(film)], tmp_path / "out", Glide(), "fast")[0].key for _ in range(2)]
    clip.write_text("HIERARCHY and more", encoding="utf-8")
    assert keys[0] == keys[1] != gallery.plan([str(film)], tmp_path / "out", Glide(), "fast")[0].key
