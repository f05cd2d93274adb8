"""The examples run, and do what they say."""

import ast
import base64
import importlib.util
import io
import re
import sys
from functools import cache
from itertools import groupby
from pathlib import Path

import numpy as np
import pytest

from gambol.controllers.body import forward_kinematics, human, log
from gambol.game.hosts import GraphicsError, offscreen_context

EXAMPLES = Path(__file__).parents[1] / "examples"


@cache
def example(name):
    """An example as a module."""
    spec = importlib.util.spec_from_file_location(f"example_{name}", EXAMPLES / f"{name}.py")
    module = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def drawing():
    """That pictures can be drawn here; else the test is skipped and says why."""
    try:
        offscreen_context().release()
    except GraphicsError as error:
        pytest.skip(str(error))


def test_each_has_its_test():
    """By name, so that no example is added without one."""
    tested = set(re.findall(r"def test_(\w+?)_example", Path(__file__).read_text("utf-8")))
    assert {file.stem for file in EXAMPLES.iterdir() if file.suffix in (".py", ".ipynb")} == tested


def test_step_example(capsys):
    state = example("step").main(seconds=5.0)
    told = capsys.readouterr().out
    assert re.search(r"\bjump$", told, re.M) and told.rstrip().endswith("locomotion")
    assert 3.0 < np.hypot(*state.ground[:2]) < 5.8 and state.ground[2] > 0.4


def test_crowd_example():
    crowd = example("crowd")
    state = crowd.main(people=300, seconds=2.0)
    before, after = crowd.square(300)[:, :2], state.ground[:, :2]
    far = np.linalg.norm(before, axis=-1)
    outer = far > 4.0
    assert np.hypot(state.velocity[:, 0], state.velocity[:, 2])[outer].mean() > 0.8
    turned = before[:, 1] * after[:, 0] - before[:, 0] * after[:, 1]  # with the crowd, round the middle
    assert (turned[outer] > 0.0).mean() > 0.9


def test_own_controller_example():
    duty, poses = example("own_controller").main(seconds=6.0)
    assert [who for who, _ in groupby(duty)] == ["locomotion", "wave", "locomotion"]
    skeleton = human()
    joints = forward_kinematics(skeleton, np.stack([pose.root for pose in poses]).astype(float),
                                np.stack([pose.rotations for pose in poses]).astype(float))[0]
    hand, shoulder = joints[:, skeleton.index("RightHand")], joints[:, skeleton.index("RightArm")]
    waving = np.array(duty) == "wave"
    settled = np.flatnonzero(waving)[40:]
    assert (hand[settled, 1] > shoulder[settled, 1]).all() and np.ptp(hand[settled, 0]) > 0.1
    assert hand[-1, 1] < shoulder[-1, 1] - 0.3, "walking has taken the arm down"
    turns = np.stack([pose.rotations for pose in poses]).astype(float)
    rate = log(np.swapaxes(turns[:-1], -1, -2) @ turns[1:])
    jerk = np.linalg.norm(rate[1:] - rate[:-1], axis=-1).max(-1)  # how much a joint's turn changes from one step to the next [rad]
    switches = np.flatnonzero(waving[1:] != waving[:-1])
    assert max(jerk[k - 2:k + 2].max() for k in switches) < 0.1, "handed over without a pop"


def test_points_example():
    assert max(example("points").main(seconds=2.0, missing=share) for share in (0.0, 0.2)) < 0.04


def test_environment_example(drawing):
    checker = pytest.importorskip("gymnasium.utils.env_checker", reason="Gymnasium is not installed: pip install -e '.[test]'")
    environment = example("environment")
    env = environment.Reach(render_mode="rgb_array", size=(96, 64))
    checker.check_env(env, skip_close_check=True)  # its renderer is still wanted
    assert np.ptp(env.render()) > 50
    env.close()
    assert all(arrived for _, arrived in environment.main(episodes=2))


def test_an_environment_tells_the_same_for_the_same_seed():
    pytest.importorskip("gymnasium", reason="Gymnasium is not installed: pip install -e '.[test]'")
    environment = example("environment")
    seen = []
    for env in (environment.Reach(), environment.Reach()):
        first, _ = env.reset(seed=5)
        seen.append(np.stack([first, *(env.step(environment.by_hand(first))[0] for _ in range(5))]))
    assert np.array_equal(*seen) and not np.array_equal(seen[0][0], seen[0][-1])


def test_export_example(tmp_path):
    found = example("export").main(tmp_path, seconds=1.5)
    assert set(found) == {"walk.glb", "walk-Ada.bvh", "walk-Ben.bvh"}
    assert len(found["walk.glb"]["joints"]) == 2 and abs(found["walk.glb"]["seconds"] - 89 / 60) < 1e-3
    for name in ("walk-Ada.bvh", "walk-Ben.bvh"):
        assert found[name]["joints"] == len(human()) and found[name]["frames"] == 90 and 0.8 < found[name]["metres"] < 2.0


def in_this_process(notebook):
    """What the cells of a notebook show as HTML, one after the other."""
    pytest.importorskip("IPython", reason="IPython is not installed: pip install -e '.[test]'")
    names = {}
    for cell in notebook.cells:
        if cell.cell_type == "code":
            *before, last = ast.parse(cell.source).body
            exec(compile(ast.Module(before if isinstance(last, ast.Expr) else [*before, last], []), "film.ipynb", "exec"), names)
            shown = eval(compile(ast.Expression(last.value), "film.ipynb", "eval"), names) if isinstance(last, ast.Expr) else None
            if hasattr(shown, "_repr_html_"):
                yield shown._repr_html_()


def in_a_kernel(notebook):
    client = pytest.importorskip("nbclient", reason="nbclient is not installed: pip install -e '.[test]'")
    client.NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
    return [output.data["text/html"] for cell in notebook.cells for output in cell.get("outputs", ())
            if output.output_type == "execute_result" and "text/html" in output.data]


@pytest.mark.parametrize("run", [in_this_process, pytest.param(in_a_kernel, marks=pytest.mark.thorough)])
def test_film_example(drawing, run):
    """The notebook from top to bottom, its parameters made small; the films in its outputs can be played."""
    nbformat = pytest.importorskip("nbformat", reason="nbformat is not installed: pip install -e '.[test]'")
    import av

    notebook = nbformat.read(EXAMPLES / "film.ipynb", 4)
    nbformat.validate(notebook)
    assert not any(cell.get("outputs") for cell in notebook.cells), "kept without outputs"
    parameters = next(cell for cell in notebook.cells if "parameters" in cell.metadata.get("tags", ()))
    parameters.source = "seconds, size, fps = 2.5, (128, 96), 10"
    films = [base64.b64decode(re.search(r"base64,([^\"]+)", html)[1]) for html in run(notebook)]
    frames = [[f.to_ndarray(format="gray") for f in av.open(io.BytesIO(film)).decode(video=0)] for film in films]
    assert [len(film) for film in frames] == [25, 25]
    assert all(np.abs(film[0].astype(int) - film[-1]).mean() > 1.0 for film in frames), "something moves"


def test_many_environments_example(capsys):
    pytest.importorskip("gymnasium")
    ended, reached = example("many_environments").main(count=40, actions=60)
    assert ended == reached > 40  # everybody arrives, and most begin anew meanwhile
    assert "at once" in capsys.readouterr().out


def test_terrain_example():
    assert example("terrain").main(seconds=5.0) < 0.06
