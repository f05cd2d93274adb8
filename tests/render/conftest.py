"""Contexts for the drawing tests, made once; without OpenGL they skip and say why."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parent))

from gambol.game.hosts import GraphicsError, offscreen_context
from gambol.game.render import Renderer


@pytest.fixture(scope="session")
def ctx():
    """A context without a display."""
    try:
        context = offscreen_context()
    except GraphicsError as error:
        pytest.skip(str(error))
    yield context
    context.release()


@pytest.fixture(scope="session")
def draw(ctx):
    """draw(scene, preset="full", size=(320, 180)) → picture (H, W, 4); renderers are kept."""
    made = {}

    def frame(scene, preset="full", size=(320, 180)):
        if preset not in made:
            made[preset] = Renderer(ctx, size, preset)
        made[preset].resize(size)
        made[preset].draw(scene)
        return made[preset].read()
    yield frame
    for renderer in made.values():
        renderer.release()


@pytest.fixture(scope="session")
def display():
    """An X display of our own, so that no window of the tests disturbs anybody."""
    if sys.platform.startswith("linux") and shutil.which("Xvfb"):
        read, write = os.pipe()
        server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "800x600x24", "-nolisten", "tcp"],
                                  pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        number = b""
        while not number.endswith(b"\n") and (more := os.read(read, 16)):
            number += more
        if not number.strip():
            server.wait(600)
            pytest.skip("Xvfb did not start")
        yield f":{number.decode().strip()}"
        server.terminate()
        server.wait(600)
        os.close(read)
    else:
        pytest.skip("no Xvfb here to open a window on")


@pytest.fixture
def compare():
    """compare(picture, name): fail, and leave the pictures in tests/failures, if it is not the golden one.

    Neighbourhoods are compared, not pixels, as drivers round edges differently. Set GAMBOL_GOLDEN=1 to
    write the golden pictures anew.
    """
    from PIL import Image, ImageFilter

    folder, failures = Path(__file__).parent / "golden", Path(__file__).parents[1] / "failures"

    def check(picture, name, mean=0.8, outliers=0.003):
        picture, golden = Image.fromarray(picture[..., :3]), folder / f"{name}.png"
        if os.environ.get("GAMBOL_GOLDEN"):
            folder.mkdir(exist_ok=True)
            picture.save(golden, optimize=True)
        wanted = Image.open(golden).convert("RGB")
        got, want = (np.asarray(p.filter(ImageFilter.BoxBlur(1))).astype(int) for p in (picture, wanted))
        away = np.abs(got - want)
        far = (away.max(-1) > 24).mean()
        if away.mean() > mean or far > outliers:
            failures.mkdir(exist_ok=True)
            loud = np.clip(away * 4, 0, 255).astype(np.uint8)
            Image.fromarray(np.concatenate([picture, wanted, loud], 1)).save(failures / f"{name}.png")
            pytest.fail(f"{name}: {away.mean():.2f} levels off on average, {far:.1%} of the picture far off; "
                        f"see tests/failures/{name}.png (got, wanted, difference)")
    return check
