"""The window: a glfw loop that feeds an app with events and time and shows its scenes."""

from __future__ import annotations

import math
import os
import sys
import time
from typing import Any

from ..input import PAD_BUTTONS
from ..render import Preset, Renderer
from .events import PADS, App, Focus, KeyEvent, MouseMove, PadState, Resize, Scroll

PACE = 1.0 / 60.0
"""Seconds between frames where the display sets no pace."""


class DisplayError(RuntimeError):
    """There is no display to open a window on; the message says what to do."""


def run_window(app: App, size: tuple[int, int] = (1280, 720), chosen: str | Preset = "full", *,
               title: str = "Gambol", vsync: bool = True, limit: float = math.inf) -> int:
    """Open a window, run the app until it is done or the window is closed, and close it again.

    size: of the window in screen units. chosen: a preset or its name. limit: seconds after which
    to end in any case. Returns the number of frames shown. Gamepads that GLFW doesn't know by itself
    are described in SDL_GAMECONTROLLERCONFIG, as for other games. DisplayError where no window can be had.
    """
    import glfw

    window = _open(glfw, size, title, vsync)
    try:
        return _Loop(glfw, window, app, chosen).run(limit)
    finally:
        glfw.destroy_window(window)
        glfw.terminate()


def _open(glfw: Any, size: tuple[int, int], title: str, vsync: bool) -> Any:
    faults: list[str] = []
    glfw.set_error_callback(lambda code, text: faults.append(text.decode() if isinstance(text, bytes) else str(text)))
    instead = "To make a film without a display: gambol render SCENARIO -o out.mp4"
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise DisplayError(f"no display: neither DISPLAY nor WAYLAND_DISPLAY is set. {instead}")
    if not glfw.init():
        raise DisplayError(f"no display can be opened ({_said(faults)}). {instead}")
    for hint, value in ((glfw.CONTEXT_VERSION_MAJOR, 3), (glfw.CONTEXT_VERSION_MINOR, 3),
                        (glfw.OPENGL_PROFILE, glfw.OPENGL_CORE_PROFILE), (glfw.OPENGL_FORWARD_COMPAT, True),
                        (glfw.SAMPLES, 0), (glfw.DEPTH_BITS, 0), (glfw.STENCIL_BITS, 0),
                        (glfw.SCALE_TO_MONITOR, True)):
        glfw.window_hint(hint, value)
    window = glfw.create_window(size[0], size[1], title, None, None)
    if not window:
        glfw.terminate()
        raise DisplayError(f"no window with OpenGL 3.3 can be opened ({_said(faults)}). {instead}")
    glfw.make_context_current(window)
    glfw.swap_interval(1 if vsync else 0)
    return window


def _said(faults: list[str]) -> str:
    return faults[-1] if faults else "the window system gave no reason"


class _Loop:
    """One run of a window."""

    def __init__(self, glfw: Any, window: Any, app: App, chosen: str | Preset):
        import moderngl

        self.glfw, self.window, self.app = glfw, window, app
        self.ctx = moderngl.create_context(require=330)
        self.size = glfw.get_framebuffer_size(window)
        self.renderer = Renderer(self.ctx, (max(self.size[0], 1), max(self.size[1], 1)), chosen)
        self.keys = _key_names(glfw)
        self.held: set[str] = set()
        self.mouse: tuple[float, float] | None = None
        self.pads = Pads(glfw)
        self.windowed: tuple[int, int, int, int] | None = None
        self._listen()
        app.handle(Resize(*self.size))

    def run(self, limit: float) -> int:
        """Until the app is done, the window closed or `limit` seconds over. Frames shown."""
        glfw, app, frames = self.glfw, self.app, 0
        start = last = time.perf_counter()
        while not (app.done or glfw.window_should_close(self.window) or last - start > limit):
            self._obey()
            glfw.poll_events()
            for pad in self.pads.read():
                app.handle(pad)
            now = time.perf_counter()
            app.tick(now - last)
            last = now
            if self._visible():
                self.renderer.draw(app.scene(self.size))
                if app.wants_picture:
                    app.take(self.renderer.read())
                self.renderer.blit()
                glfw.swap_buffers(self.window)
                frames += 1
            # vsync paces a shown frame by itself; without it, or hidden, sleep the rest
            rest = PACE - (time.perf_counter() - now) - 0.0005
            if rest > 0.0:
                time.sleep(rest)
        self.renderer.release()
        return frames

    def _visible(self) -> bool:
        self.size = self.glfw.get_framebuffer_size(self.window)
        if min(self.size) < 1 or self.glfw.get_window_attrib(self.window, self.glfw.ICONIFIED):
            return False
        if self.size != self.renderer.size:
            self.renderer.resize(self.size)
            self.ctx.screen.viewport = (0, 0, *self.size)
        return True

    def _listen(self) -> None:
        glfw, window, handle = self.glfw, self.window, self.app.handle
        names = {glfw.MOUSE_BUTTON_LEFT: "LEFT_BUTTON", glfw.MOUSE_BUTTON_RIGHT: "RIGHT_BUTTON",
                 glfw.MOUSE_BUTTON_MIDDLE: "MIDDLE_BUTTON"}

        def press(name: str | None, action: int) -> None:
            if name is None or action == glfw.REPEAT:
                return
            (self.held.add if action == glfw.PRESS else self.held.discard)(name)
            handle(KeyEvent(name, action == glfw.PRESS))

        def moved(_, x: float, y: float) -> None:
            height = max(glfw.get_window_size(window)[1], 1)
            at = (x / height, y / height)
            before, self.mouse = self.mouse or at, at
            handle(MouseMove(*at, at[0] - before[0], at[1] - before[1]))

        def focus(_, gained: int) -> None:
            if not gained:  # nobody tells us of keys let go elsewhere
                for name in sorted(self.held):
                    handle(KeyEvent(name, False))
                self.held.clear()
            self.mouse = None
            handle(Focus(bool(gained)))
        glfw.set_key_callback(window, lambda _, key, code, action, mods: press(self.keys.get(key), action))
        glfw.set_mouse_button_callback(window, lambda _, button, action, mods: press(names.get(button), action))
        glfw.set_cursor_pos_callback(window, moved)
        glfw.set_scroll_callback(window, lambda _, dx, dy: handle(Scroll(dx, dy)))
        glfw.set_window_focus_callback(window, focus)
        glfw.set_framebuffer_size_callback(
            window, lambda _, width, height: handle(Resize(width, height)) if width and height else None)

    def _obey(self) -> None:
        """Do what the app wants of the window."""
        glfw, window, app = self.glfw, self.window, self.app
        if app.full_screen != (self.windowed is not None):
            self._full_screen()
        wanted = glfw.CURSOR_DISABLED if app.mouse_captured else glfw.CURSOR_NORMAL
        if glfw.get_input_mode(window, glfw.CURSOR) != wanted:
            glfw.set_input_mode(window, glfw.CURSOR, wanted)
            self.mouse = None  # the pointer jumps meanwhile

    def _full_screen(self) -> None:
        glfw, window = self.glfw, self.window
        if self.windowed is None:
            monitor = glfw.get_primary_monitor()
            if not monitor:
                return
            self.windowed = *glfw.get_window_pos(window), *glfw.get_window_size(window)
            mode = glfw.get_video_mode(monitor)
            glfw.set_window_monitor(window, monitor, 0, 0, mode.size.width, mode.size.height, mode.refresh_rate)
        else:
            glfw.set_window_monitor(window, None, *self.windowed, glfw.DONT_CARE)
            self.windowed = None


class Pads:
    """The gamepads that are plugged in. Each keeps its slot while it is there; a new one takes the first free."""

    def __init__(self, glfw: Any):
        self.glfw = glfw
        self.slots: list[int | None] = [None] * PADS
        if described := os.environ.get("SDL_GAMECONTROLLERCONFIG"):
            glfw.update_gamepad_mappings(described)

    def read(self) -> list[PadState]:
        """The state of every pad, and a state without a name for each that has gone."""
        glfw, states = self.glfw, []
        for joystick in range(glfw.JOYSTICK_1, glfw.JOYSTICK_LAST + 1):
            if joystick not in self.slots and None in self.slots and glfw.joystick_is_gamepad(joystick):
                self.slots[self.slots.index(None)] = joystick
        for slot, joystick in enumerate(self.slots):
            if joystick is not None:
                state = glfw.get_gamepad_state(joystick)
                states.append(PadState(slot=slot) if state is None else self._state(slot, joystick, state))
                if state is None:
                    self.slots[slot] = None
        return states

    def _state(self, slot: int, joystick: int, state: Any) -> PadState:
        return PadState(self.glfw.get_gamepad_name(joystick) or "gamepad", tuple(float(v) for v in state.axes),
                        frozenset(b for b, down in zip(PAD_BUTTONS, state.buttons) if down == self.glfw.PRESS), slot)


def _key_names(glfw: Any) -> dict[int, str]:
    return {getattr(glfw, name): name[4:] for name in dir(glfw)
            if name.startswith("KEY_") and name not in ("KEY_UNKNOWN", "KEY_LAST")}
