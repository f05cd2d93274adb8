"""Hosts: a real window on a display of our own, and what is said where none can be had."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
APP = '''
import sys, time
import numpy as np
sys.path.insert(0, "tests/render")
from poses import STRIDE, camera, figure
from game.hosts import DisplayError, run_window
from game.scene import Scene

class App:
    done, time, events, sizes = False, 0.0, [], set()
    def handle(self, event): self.events.append(event)
    def tick(self, seconds):
        self.time += seconds
        self.done = self.time > {seconds}
    def scene(self, size):
        self.sizes.add(size)
        return Scene(camera(), (figure(**STRIDE),), text=("hello",))
app = App()
began = time.perf_counter()
try:
    frames = run_window(app, (320, 180), "fast", vsync=False, limit=20.0)
except DisplayError as error:
    print("refused:", error)
else:
    took = time.perf_counter() - began
    print("frames", frames, "simulated", round(app.time, 3), "events", [type(e).__name__ for e in app.events[:1]],
          "sizes", sorted(app.sizes), "paced", frames <= 62 * app.time + 2)
'''


def run(code, **environment):
    kept = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    return subprocess.run([sys.executable, "-c", code], cwd=ROOT, env=kept | environment, capture_output=True,
                          text=True, timeout=60)


def test_a_window_opens_runs_for_a_second_and_closes(display):
    ran = run(APP.format(seconds=1.0), DISPLAY=display)
    assert ran.returncode == 0, ran.stderr
    assert "frames" in ran.stdout, ran.stdout
    words = ran.stdout.split()
    assert int(words[words.index("frames") + 1]) >= 5, ran.stdout
    assert "['Resize']" in ran.stdout and "[(320, 180)]" in ran.stdout and "paced True" in ran.stdout, ran.stdout


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux runs without a display server")
@pytest.mark.parametrize("environment", [{}, {"DISPLAY": ":987"}])
def test_without_a_display_the_error_says_what_to_do(environment):
    ran = run(APP.format(seconds=1.0), **environment)
    assert ran.returncode == 0 and "refused: no display" in ran.stdout and "gambol render" in ran.stdout, ran.stderr


def test_importing_touches_no_gl_and_no_window():
    ran = run("import sys, game.render, game.hosts\n"
              "print([m for m in ('moderngl', 'glfw') if m in sys.modules])")
    assert ran.stdout.strip() == "[]", ran.stdout + ran.stderr


def test_a_missing_library_is_named_with_its_package(monkeypatch):
    from game.hosts import offscreen

    monkeypatch.setattr(offscreen.ctypes.util, "find_library", lambda name: None)
    said = offscreen._missing()
    assert "libEGL.so.1 and libGL.so.1" in said and "apt install libegl1 libgl1" in said


def test_a_pad_at_rest_asks_for_nothing():
    from game.hosts import PadState

    pad = PadState()
    assert pad.left == pad.right == (0.0, 0.0) and pad.left_trigger == pad.right_trigger == -1.0 and not pad.buttons
