"""Where panels are drawn: an ImGui context without a window, fed with events, that gives ink."""

from __future__ import annotations

import ctypes
from pathlib import Path

import numpy as np

from ..hosts import Event, Focus, KeyEvent, MouseMove, Scroll
from ..scene import VERTEX, Ink, Stroke
from . import style
from .toolkit import imgui, implot

NOWHERE = -1e9
LEGIBLE = 0.75
"""The smallest scale: letters of 11 px, as of other text."""
BUTTONS = {"LEFT_BUTTON": 0, "RIGHT_BUTTON": 1, "MIDDLE_BUTTON": 2}
DIGITS = {str(d): str(d) for d in range(10)} | {f"KP_{d}": str(d) for d in range(10)} | {
    "PERIOD": ".", "COMMA": ".", "KP_DECIMAL": ".", "MINUS": "-", "KP_SUBTRACT": "-"}
"""What may be typed into a field of a number."""


def _keys() -> dict[str, imgui.Key]:
    same = ("TAB", "BACKSPACE", "DELETE", "ENTER", "ESCAPE", "HOME", "END")
    keys = {name: getattr(imgui.Key, name.lower()) for name in same}
    keys |= {"KP_ENTER": imgui.Key.keypad_enter}
    keys |= {name: getattr(imgui.Key, f"{name.lower()}_arrow") for name in ("LEFT", "RIGHT", "UP", "DOWN")}
    for side in ("LEFT", "RIGHT"):
        keys |= {f"{side}_CONTROL": imgui.Key.mod_ctrl, f"{side}_SHIFT": imgui.Key.mod_shift}
    return keys


KEYS = _keys()


class Canvas:
    """One ImGui context. `begin`, draw with ImGui, `end`: a frame of ink."""

    def __init__(self):
        self.context, self.plots = imgui.create_context(), implot.create_context()
        self._use()
        io = imgui.get_io()
        io.set_ini_filename("")  # places are remembered as long as the context lives, and nowhere else
        io.set_log_filename("")
        io.backend_flags |= imgui.BackendFlags_.renderer_has_textures | imgui.BackendFlags_.renderer_has_vtx_offset
        io.config_windows_move_from_title_bar_only = True
        imgui.get_platform_io().renderer_texture_max_width = 4096
        imgui.get_platform_io().renderer_texture_max_height = 4096
        fonts = Path(imgui_assets()) / "fonts" / "Roboto"
        self.letters = io.fonts.add_font_from_file_ttf(str(fonts / "Roboto-Regular.ttf"), 0.0)
        self.size, self.scale = (0, 0), 0.0
        self.sheets: dict[int, np.ndarray] = {}
        self.held: set[str] = set()

    def _use(self) -> None:
        imgui.set_current_context(self.context)
        implot.set_current_context(self.plots)

    def handle(self, event: Event) -> bool:
        """Take an event; whether it was meant for a panel, so that nobody else should mind it.

        What comes up goes to everybody: a key pressed outside and let go over a panel must not stay down.
        """
        self._use()
        io = imgui.get_io()
        match event:
            case MouseMove(x, y):
                io.add_mouse_pos_event(x * self.size[1], y * self.size[1])
                return io.want_capture_mouse and not self.held
            case Scroll(dx, dy):
                io.add_mouse_wheel_event(dx, dy)
                return io.want_capture_mouse
            case KeyEvent(key, pressed) if key in BUTTONS:
                io.add_mouse_button_event(BUTTONS[key], pressed)
                outside = pressed and not io.want_capture_mouse
                (self.held.add if outside else self.held.discard)(key)
                return pressed and not outside
            case KeyEvent(key, pressed):
                if key in KEYS:
                    io.add_key_event(KEYS[key], pressed)
                if pressed and key in DIGITS and io.want_text_input:
                    io.add_input_character(ord(DIGITS[key]))
                return pressed and io.want_text_input
            case Focus(gained):
                self.held.clear()
                if not gained:
                    io.add_mouse_pos_event(NOWHERE, NOWHERE)
        return False

    def begin(self, size: tuple[int, int], seconds: float) -> bool:
        """Start a frame for a picture of `size` pixels. Whether that size is another than before."""
        self._use()
        moved = size != self.size
        if moved:
            self.size = size
            self.scale = min(max(min(size[1] / 720.0, size[0] / 1000.0), LEGIBLE), 4.0)
            style.apply(self.scale)
        io = imgui.get_io()
        io.display_size = imgui.ImVec2(*size)
        io.delta_time = min(max(seconds, 1e-4), 0.25)
        imgui.new_frame()
        imgui.push_font(self.letters, imgui.get_style().font_size_base)
        return moved

    def end(self) -> Ink:
        """Finish the frame."""
        imgui.pop_font()
        imgui.render()
        self._keep_sheets()
        vertices, indices, strokes = [], [], []
        vertex_base = index_base = 0
        for piece in imgui.get_draw_data().cmd_lists:
            some = _copied(piece.vtx_buffer, VERTEX)
            index = _copied(piece.idx_buffer, np.dtype(f"u{imgui.INDEX_SIZE}")).astype(np.uint32)
            for command in piece.cmd_buffer:
                first, count = command.idx_offset, command.elem_count
                index[first:first + count] += command.vtx_offset + vertex_base
                clip = command.clip_rect
                strokes.append(Stroke((clip.x, clip.y, clip.z, clip.w), int(command.get_tex_id()),
                                      index_base + first, count))
            vertices.append(some)
            indices.append(index)
            vertex_base, index_base = vertex_base + len(some), index_base + len(index)
        return Ink(self.size, np.concatenate([np.zeros(0, VERTEX), *vertices]),
                   np.concatenate([np.zeros(0, np.uint32), *indices]), tuple(strokes), dict(self.sheets))

    def _keep_sheets(self) -> None:
        """Copy the images that changed: ImGui adds letters to them as they are first needed."""
        status = imgui.ImTextureStatus
        for sheet in imgui.get_platform_io().textures:
            number = sheet.unique_id + 1  # 0 means none
            if sheet.status in (status.want_create, status.want_updates):
                self.sheets[number] = np.array(sheet.get_pixels_array()).reshape(sheet.height, sheet.width, 4)
                sheet.set_tex_id(number)
                sheet.status = status.ok
            elif sheet.status == status.want_destroy:
                self.sheets.pop(number, None)
                sheet.set_tex_id(0)
                sheet.status = status.destroyed

    def release(self) -> None:
        """Give everything back."""
        self._use()
        for sheet in imgui.get_platform_io().textures:
            sheet.set_tex_id(0)
            sheet.status = imgui.ImTextureStatus.destroyed
        implot.destroy_context(self.plots)
        imgui.destroy_context(self.context)


def imgui_assets() -> str:
    """The folder of the fonts that come with imgui-bundle."""
    import imgui_bundle

    return str(Path(imgui_bundle.__file__).parent / "assets")


def _copied(buffer, dtype: np.dtype) -> np.ndarray:
    """A copy of an ImGui vector, whose memory is ImGui's and only for this frame."""
    count = buffer.size()
    if not count:
        return np.zeros(0, dtype)
    return np.frombuffer(ctypes.string_at(buffer.data_address(), count * dtype.itemsize), dtype)
