"""Hosts: a real window on a display of our own, and what is said where none can be had."""

import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import glfw
import pytest

from gambol.game.hosts.window import Pads

ROOT = Path(__file__).parents[2]
APP = '''
import sys
sys.path.insert(0, "tests/render")
from poses import STRIDE, camera, figure
from gambol.game.hosts import DisplayError, run_window
from gambol.game.scene.scene import Scene

class App:
    done, time, shown, events, sizes = False, 0.0, 0, [], set()
    full_screen = mouse_captured = wants_picture = False
    def handle(self, event): self.events.append(event)
    def tick(self, seconds):
        self.time += seconds
    def scene(self, size):
        self.sizes.add(size)
        self.shown += 1
        self.done = self.shown == 30
        return Scene(camera(), (figure(**STRIDE),), text=("hello",))
app = App()
try:
    frames = run_window(app, (320, 180), "fast", vsync=False, limit=500.0)
except DisplayError as error:
    print("refused:", error)
else:
    print("frames", frames, "simulated", round(app.time, 3), "events", [type(e).__name__ for e in app.events[:1]],
          "sizes", sorted(app.sizes), "paced", frames <= 62 * app.time + 2)
'''


def run(code, **environment):
    kept = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    return subprocess.run([sys.executable, "-c", code], cwd=ROOT, env=kept | environment, capture_output=True,
                          text=True, timeout=600)


def test_a_window_opens_runs_for_thirty_frames_and_closes(display):
    ran = run(APP, DISPLAY=display)
    assert ran.returncode == 0, ran.stderr
    assert "frames 30 " in ran.stdout, ran.stdout
    assert "['Resize']" in ran.stdout and "[(320, 180)]" in ran.stdout and "paced True" in ran.stdout, ran.stdout


@pytest.mark.few(1)
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux runs without a display server")
@pytest.mark.parametrize("environment", [{}, {"DISPLAY": ":987"}])
def test_without_a_display_the_error_says_what_to_do(environment):
    ran = run(APP, **environment)
    assert ran.returncode == 0 and "refused: no display" in ran.stdout and "gambol render" in ran.stdout, ran.stderr


def test_a_missing_library_is_named_with_its_package(monkeypatch):
    from gambol.game.hosts import offscreen

    monkeypatch.setattr(offscreen.ctypes.util, "find_library", lambda name: None)
    said = offscreen._missing()
    assert "libEGL.so.1 and libGL.so.1" in said and "apt install libegl1 libgl1" in said


def test_a_pad_at_rest_asks_for_nothing():
    from gambol.game.hosts import PadState

    pad = PadState()
    assert pad.left == pad.right == (0.0, 0.0) and pad.left_trigger == pad.right_trigger == -1.0 and not pad.buttons


class Joysticks:
    """What glfw says of joysticks: number → what is plugged in there."""

    JOYSTICK_1, JOYSTICK_LAST, PRESS = glfw.JOYSTICK_1, glfw.JOYSTICK_LAST, glfw.PRESS

    def __init__(self, **names):
        self.there = {int(number[1:]): name for number, name in names.items()}
        self.described = ""

    def joystick_is_gamepad(self, number):
        return self.there.get(number, "no pad") != "no pad"

    def get_gamepad_state(self, number):
        return SimpleNamespace(axes=[0.5, 0, 0, 0, -1, -1], buttons=[1] + [0] * 14) if self.joystick_is_gamepad(number) else None

    def get_gamepad_name(self, number):
        return self.there[number]

    def update_gamepad_mappings(self, text):
        self.described += text


def test_pads_come_and_go_and_each_keeps_its_slot():
    sticks = Joysticks(j3="A", j5="no pad")
    pads = Pads(sticks)
    def seen():
        return [(state.slot, state.name) for state in pads.read()]
    assert seen() == [(0, "A")]
    sticks.there |= {0: "B", 7: "C"}
    assert seen() == [(0, "A"), (1, "B"), (2, "C")]
    del sticks.there[3]
    assert seen() == [(0, ""), (1, "B"), (2, "C")], "told once that it went"
    assert seen() == [(1, "B"), (2, "C")]
    sticks.there |= {3: None, **{n: f"more {n}" for n in range(8, 14)}}
    assert seen() == [(0, "gamepad"), (1, "B"), (2, "C"), (3, "more 8")], "no more than there are slots"
    state = pads.read()[0]
    assert state.left == (0.5, 0) and state.buttons == {"A"}


def test_a_slot_given_up_is_taken_in_the_next_frame_by_who_waits():
    sticks = Joysticks(**{f"j{n}": f"pad {n}" for n in range(5)})
    pads = Pads(sticks)
    assert [s.name for s in pads.read()] == ["pad 0", "pad 1", "pad 2", "pad 3"]
    del sticks.there[1]
    assert [s.name for s in pads.read()] == ["pad 0", "", "pad 2", "pad 3"]
    assert [s.name for s in pads.read()] == ["pad 0", "pad 4", "pad 2", "pad 3"]


def test_pads_are_described_as_for_other_games(monkeypatch):
    sticks = Joysticks()
    monkeypatch.delenv("SDL_GAMECONTROLLERCONFIG", raising=False)
    Pads(sticks)
    assert sticks.described == ""
    monkeypatch.setenv("SDL_GAMECONTROLLERCONFIG", "0300,Stick,a:b0,platform:Linux,")
    Pads(sticks)
    assert "Stick" in sticks.described


TYPED = '''
import sys
sys.path[:0] = ["tests/render", "tests/game"]
from pathlib import Path
from poses import camera
from gambol.game.hosts import KeyEvent, MouseMove, run_window
from gambol.game.input import Keyboard, mouse_wish
from gambol.game.input.remap import load
from gambol.game.scene.scene import Scene

class App:
    """Says what it is asked for; what is pressed is done before the next tick."""
    def __init__(self):
        self.bindings, self.keyboard, self.drag = load(sys.argv[1]), Keyboard(), 0.0
        self.done = self.full_screen = self.mouse_captured = self.wants_picture = False
        self.captured = False
    def handle(self, event):
        match event:
            case KeyEvent(key, True):
                self.keyboard = self.keyboard.press(key)
                for action in self.bindings.pressed_by(key):
                    print("did", action, flush=True)
                    self.done = action == "quit"
                    self.full_screen ^= action == "full_screen"
                    self.mouse_captured ^= action == "camera_mode"
            case KeyEvent(key, False):
                self.keyboard = self.keyboard.release(key)
            case MouseMove(dx=dx, dy=dy):
                wish = mouse_wish(dx, dy, self.keyboard, self.bindings, self.mouse_captured)
                if wish.drag[0] and not self.drag:
                    print("dragged", flush=True)
                self.drag = wish.drag[0]
    def tick(self, seconds):
        print("free" if not self.captured else "captured", flush=True)  # the pointer is taken away in the next frame
        self.captured = self.mouse_captured
        wish = self.keyboard.wish(self.bindings)
        if wish.move != (0.0, 0.0):
            print("move", wish.move[0], wish.move[1], flush=True)
    def scene(self, size):
        return Scene(camera(), text=(str(size),))
run_window(App(), (320, 180), "fast", vsync=False, limit=500.0)
print("closed", flush=True)
'''


@pytest.mark.skipif(not shutil.which("xdotool"), reason="no xdotool here to press keys with")
def test_remapped_keys_and_the_mouse_do_what_the_file_says_in_a_real_window(display, tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text('keys.forward = "I"\nkeys.pause = "O"\nkeys.quit = "END"\nkeys.camera_mode = "F7"')
    kept = os.environ | {"DISPLAY": display}
    game = subprocess.Popen([sys.executable, "-c", TYPED, str(file)], cwd=ROOT, env=kept, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True)
    said = []

    def until(line):
        for text in game.stdout:
            said.append(text.strip())
            if said[-1].startswith(line):
                return
        pytest.fail(f"never said {line!r}: {said}")

    def do(*words):
        subprocess.run(["xdotool", *words], env=kept, check=True, timeout=600)
    try:
        until("free")
        do("search", "--sync", "--name", "^Gambol$", "windowfocus", "--sync")
        do("key", "w", "p")  # these do nothing any more
        do("keydown", "i")
        until("move 0.0 1.0")
        do("keyup", "i", "key", "o")
        until("did pause")
        do("mousemove", "160", "90", "mousedown", "1", "mousemove_relative", "40", "0")
        until("dragged")
        do("mouseup", "1", "mousemove_relative", "--", "-30", "0", "key", "F7")
        until("did camera_mode")
        until("captured")
        moves, before = 0, said.count("dragged")
        while said.count("dragged") == before:  # the first one only says where the mouse is
            do("mousemove_relative", "25", "0")
            until("captured")
            moves += 1
            assert moves < 1000, "a captured mouse drags nothing"
        do("key", "F11", "key", "End")
        until("closed")
        assert "did full_screen" in said and "did quit" in said
        assert sum(line == "did pause" for line in said) == 1, said
    finally:
        game.kill()
        game.communicate(timeout=600)
