"""Weights that people walk by: found again where they are known, fitted where they are not, and broken files are told of."""

import numpy as np
import pytest
from typer.testing import CliRunner

from gambol.controllers.navigation.identification import HumanPaths, PathsError, fit, left_out, likeness, planned_like, read_paths, straight
from gambol.controllers.navigation.planning import FREE, HUMAN, PUBLISHED, Plan, Weights, plan, read_weights
from gambol.game.cli import app
from test_plans import LIMITS

GOALS = np.array([(1.5, 1.0, 0.0), (-2.0, 2.5, 1.0), (2.5, 2.5, -1.0), (0.5, 4.0, 2.0), (-1.5, -0.5, 0.5), (3.0, 1.0, 1.5)])


def walks(weights, limits=FREE):
    """Walks that are planned with some weights, as if people had made them."""
    made = [plan(np.zeros(3), goal, weights=weights, limits=limits) for goal in GOALS]
    ground = np.array([one.sampled(200)[1] for one in made])
    return HumanPaths(np.array([f"w{n}" for n in range(len(GOALS))]), np.zeros_like(GOALS), GOALS, ground[..., :2], ground[..., 2])


def arrays(paths):
    """What a file of them holds: x ahead, y to the left."""
    return dict(name=paths.names, start=paths.starts[:, [1, 0, 2]], goal=paths.goals[:, [1, 0, 2]], xy=paths.places[..., ::-1], heading=paths.headings)


def test_plans_are_wholly_like_themselves():
    away, heading, turning = likeness(walks(PUBLISHED), planned_like(walks(PUBLISHED), PUBLISHED, FREE))
    assert away.max() < 2e-3 and heading.max() < 0.02 and turning.max() < 3.0
    assert straight(walks(PUBLISHED)).min() > 0.05
    nothing = likeness(walks(PUBLISHED), [Plan.none(np.zeros(3), goal, "no") for goal in GOALS])
    assert np.all(nothing.distance == 1.0) and np.all(nothing.heading == 1.0)


def test_weights_are_found_again():
    """As far as walks tell them: plans with the weights found are like those with the true ones."""
    true = Weights(1.0, 0.35, 0.2, 0.6, 1.2)
    paths = walks(true)
    first = likeness(paths, planned_like(paths, Weights(1.0, 0.35, 0.03, 1.0, 2.2), FREE)).means()
    found = fit(paths, FREE, trials=60)
    away, heading, _ = likeness(paths, planned_like(paths, found, FREE)).means()
    assert found[:2] == true[:2], "unit and pace are given"
    assert away < 0.25 * first[0] and away < 0.02 and heading < 0.1


def test_walks_left_out_are_each_planned_once_by_weights_of_others():
    paths = walks(PUBLISHED)
    told, each = left_out(paths, FREE, folds=2, trials=8)
    assert len(each) == 2 and np.isfinite(told.distance).all()
    rest = paths.of(np.arange(len(paths)) % 2 == 1)
    assert np.allclose(told.distance[1::2], likeness(rest, planned_like(rest, each[1], FREE)).distance)


def test_files_are_read_in_our_axes(tmp_path):
    paths = walks(PUBLISHED)
    np.savez(tmp_path / "walks.npz", **arrays(paths))
    back = read_paths(tmp_path / "walks.npz")
    for name in ("names", "starts", "goals", "places", "headings"):
        assert np.array_equal(getattr(back, name), getattr(paths, name))


@pytest.mark.parametrize(("change", "told"), [
    (dict(xy=None), "has no array 'xy'"), (dict(goal=np.zeros((2, 3))), r"goal must be numbers of shape \(6, 3\)"),
    (dict(xy=np.zeros((6, 3, 2))), "xy must be numbers of shape"), (dict(start=np.full((6, 3), np.nan)), "start of walk w0 is not finite"),
    (dict(goal=np.ones((6, 3))), "from its goal at its last place"), (dict(name=np.arange(6)), "name must be"),
    (dict(heading=np.zeros((6, 7))), "heading must be"), (dict(name=np.array(["a", {}], object)), "not a file of human paths")])
def test_broken_files_are_told_of(tmp_path, change, told):
    file = tmp_path / "walks.npz"
    np.savez(file, **{name: value for name, value in {**arrays(walks(PUBLISHED)), **change}.items() if value is not None})
    with pytest.raises(PathsError, match=told) as error:
        read_paths(file)
    assert str(file) in str(error.value)


@pytest.mark.parametrize("content", [b"", b"words", b"PK\x03\x04broken", b"\x93NUMPY\x01\x00"])
def test_what_is_no_such_file_is_told_of(tmp_path, content):
    (tmp_path / "walks.npz").write_bytes(content)
    with pytest.raises(PathsError, match="not a file of human paths"):
        read_paths(tmp_path / "walks.npz")
    with pytest.raises(PathsError, match="nowhere"):
        read_paths(tmp_path / "nowhere.npz")


def test_the_command_fits_tells_and_draws(tmp_path):
    file, out, picture = tmp_path / "walks.npz", tmp_path / "mine.toml", tmp_path / "mine.png"
    np.savez(file, **arrays(walks(HUMAN, LIMITS)))
    done = CliRunner().invoke(app, ["navigate", "fit", str(file), "-o", str(out), "--picture", str(picture), "--folds", "2", "--trials", "10"])
    assert done.exit_code == 0, done.output
    assert all(word in done.output for word in ("straight line", "published weights", "shipped weights", "walks left out (2×)"))
    assert read_weights(out).forward == 0.35 and picture.stat().st_size > 1e4
    for arguments, told in ((["--folds", "9"], "there are only 6 walks"), (["-o", str(tmp_path / "a.txt")], ".toml")):
        done = CliRunner().invoke(app, ["navigate", "fit", str(file), *arguments])
        assert done.exit_code == 2 and told in done.output
    done = CliRunner().invoke(app, ["navigate", "fit", str(tmp_path / "none.npz")])
    assert done.exit_code == 2 and "none.npz" in done.output


def test_shipped_weights_walk_as_people_do(shared):
    if not (shared / "human_paths").is_dir():
        pytest.skip("no walks of people beside the project")
    paths = read_paths(shared / "human_paths" / "human_paths.npz")
    away, heading, turning = likeness(paths, planned_like(paths, HUMAN, LIMITS)).means()
    assert away < 0.065 and np.degrees(heading) < 6 and turning < 4
    assert away < 0.65 * straight(paths).mean() and away < 0.3 * likeness(paths, planned_like(paths, PUBLISHED, LIMITS)).means()[0]
