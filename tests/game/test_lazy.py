"""What a game starts without: it is loaded once it is needed, not before the first picture."""

import importlib.util
import subprocess
import sys

import pytest

from gambol import controllers, game

LATER = ("scipy.optimize", "scipy.sparse.csgraph", "concurrent.futures.process", "scipy.interpolate", "scipy.ndimage", "scipy.stats", "pydantic", "rich", "imgui_bundle", "av",
         *(f"{controllers.__name__}.{name}" for name in ("reconstruction", "mocap", "tracking")),
         *(f"{game.__name__}.{name}" for name in ("hud", "character", "scenario")))


def loaded(code):
    """The modules that a fresh interpreter has once it has run some code."""
    ran = subprocess.run([sys.executable, "-c", f"import sys\n{code}\nprint(*sys.modules)"], capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    return set(ran.stdout.split())


@pytest.fixture(scope="module")
def playing():
    return loaded("from gambol.game.cli import main\nfrom gambol.game.hosts import run_window\nfrom gambol.game.input.remap import load\n"
                  "from gambol.game.session.input_log import LogWriter\nfrom gambol.game.world.learnt_methods import methods\nfrom gambol.game.app.app import Play\n"
                  "from gambol.game.app.capture import Capture\nfrom gambol.controllers.person import person\nload()\n"
                  "from gambol.controllers.locomotion import Locomotion\ngame = Play(person(Locomotion.load()))\n"
                  "game.tick(0.1)\ngame.scene((640, 360))\ngame.close()")


@pytest.mark.parametrize("module", LATER)
def test_a_game_starts_without(playing, module):
    assert importlib.util.find_spec(module) is not None, "there is no such module to start without"
    assert module not in playing


def test_the_command_line_starts_without():
    """So that its help comes at once."""
    assert not {"numpy", "scipy", "numba", "moderngl", "glfw", controllers.__name__, "PIL"} & loaded("import gambol.game.cli")
