"""The legend of followers: who is which colour, and how far off, live. A panel over a game, and over films."""

from __future__ import annotations

import math
from collections.abc import Sequence

from gambol.controllers.reconstruction import NAMES

from ..explain import Row
from ..scene import Ink
from ..world import KEPT
from . import style
from .canvas import Canvas
from .toolkit import imgui

WIDTH, MARGIN = 352.0, 14.0
"""Of the panel [px at 720 lines]."""
_POINTS = {joint: point for point, joint in NAMES.items()}
GOOD, FAIR = 0.03, 0.06
"""Mean errors up to these [m] are good, fair."""


class Legend:
    """Draws the legend alone, over a game without panels. No context is made before the first."""

    def __init__(self):
        self.canvas: Canvas | None = None

    def ink(self, rows: Sequence[Row], size: tuple[int, int], title: str = "") -> Ink:
        """The legend over the top-right corner of a picture of `size` pixels."""
        if self.canvas is None:
            self.canvas = Canvas()
        self.canvas.begin(size, 1.0 / 60.0)
        window(rows, size, self.canvas.scale, title)
        return self.canvas.end()

    def release(self) -> None:
        """Give everything back."""
        if self.canvas is not None:
            self.canvas.release()
            self.canvas = None


def window(rows: Sequence[Row], size: tuple[int, int], scale: float, title: str = "", left: bool = False) -> None:
    """The legend as a window in the top-right corner of a picture of `size` pixels, or in the top-left one; none where it has no room."""
    if size[0] < (WIDTH + MARGIN) * scale:
        return
    across = MARGIN * scale if left else size[0] - (WIDTH + MARGIN) * scale
    imgui.set_next_window_pos(imgui.ImVec2(across, MARGIN * scale), imgui.Cond_.always)
    imgui.set_next_window_size(imgui.ImVec2(WIDTH * scale, 0.0), imgui.Cond_.always)
    imgui.begin("##legend", None, imgui.WindowFlags_.no_title_bar | imgui.WindowFlags_.no_resize
                | imgui.WindowFlags_.no_scrollbar | imgui.WindowFlags_.no_nav | imgui.WindowFlags_.no_inputs)
    draw(rows, scale, title)
    imgui.end()


def draw(rows: Sequence[Row], scale: float, title: str = "") -> None:
    """Fill the current window."""
    if title:
        imgui.text_colored(imgui.ImVec4(*style.ACCENT), title)
    if not imgui.begin_table("legend", 4, imgui.TableFlags_.sizing_stretch_prop):
        return
    for weight in (1.5, 0.72, 1.9, 0.72):
        imgui.table_setup_column("", 0, weight)
    imgui.table_next_row()
    for column, head in enumerate(("error, cm", "joints", "worst", "points")):
        imgui.table_set_column_index(column)
        imgui.text_disabled(head)
    for row in rows:
        _row(row, scale)
    imgui.end_table()
    _history(rows, scale)


def cells(row: Row) -> tuple[str, str, str, str]:
    """What stands in a line of the legend; lengths in centimetres."""
    told = row.errors
    if told is None:
        return row.name, "–", "–", "–"
    worst = "–" if math.isnan(told.worst) else f"{100 * told.worst:.1f} {spaced(told.joint)}"
    return row.name, _cm(told.mean), worst, _cm(told.points)


def spaced(joint: str) -> str:
    """A joint as people call it: "left wrist"."""
    point = _POINTS.get(joint, joint.lower())
    side = next((side for side in ("Left", "Right") if joint.startswith(side)), "").lower()
    return f"{side} {point[1:]}" if side and joint in _POINTS else point


def _cm(metres: float) -> str:
    return "–" if math.isnan(metres) else f"{100 * metres:.1f}"


def _row(row: Row, scale: float) -> None:
    imgui.table_next_row()
    for column, text in enumerate(cells(row)):
        imgui.table_set_column_index(column)
        if column == 0:
            at, line = imgui.get_cursor_screen_pos(), imgui.get_text_line_height()
            middle, radius = (at.x + 0.4 * line, at.y + 0.5 * line), 0.30 * line
            pen, tint = imgui.get_window_draw_list(), shown(row.tint)
            pen.add_circle_filled(middle, radius, style.packed(tint, 0.55 if row.ghost else 1.0))
            if row.ghost:
                pen.add_circle(middle, radius, style.packed(tint), 0, 1.5 * scale)
            imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + 1.1 * line)
            imgui.text(text)
        elif column == 1 and row.errors is not None and not math.isnan(row.errors.mean):
            mean = row.errors.mean
            colour = style.GOOD if mean <= GOOD else style.FAIR if mean <= FAIR else style.BAD
            imgui.text_colored(imgui.ImVec4(*colour), text)
        else:
            imgui.text_disabled(text)


def _history(rows: Sequence[Row], scale: float) -> None:
    """The errors of the last seconds as curves, one scale for all."""
    longest = max((len(row.history) for row in rows), default=0)
    known = [v for row in rows for v in row.history if math.isfinite(v)]
    if longest < 2 or not known:
        return
    pen, at = imgui.get_window_draw_list(), imgui.get_cursor_screen_pos()
    wide, high = imgui.get_content_region_avail().x, 44 * scale
    pen.add_rect_filled((at.x, at.y), (at.x + wide, at.y + high), style.packed((0.0, 0.0, 0.0, 0.22)))
    top = next((step for step in (0.05, 0.10, 0.20, 0.50, 1.0) if max(known) <= step), math.ceil(max(known)))
    for row in rows:
        points: list[imgui.ImVec2Like] = [
            (at.x + wide * (KEPT - len(row.history) + k) / (KEPT - 1), at.y + high * (1.0 - v / top))
            for k, v in enumerate(row.history) if math.isfinite(v)]
        if len(points) > 1:
            pen.add_polyline(points, style.packed(shown(row.tint)), 1.6 * scale, 0)
    pen.add_text((at.x + 4 * scale, at.y + 2 * scale), style.packed(style.DIM), f"{100 * top:g} cm")
    imgui.dummy(imgui.ImVec2(wide, high))


def shown(tint: Sequence[float]) -> tuple[float, float, float, float]:
    """A linear colour as panels have it, light enough to be read on them."""
    red, green, blue = (min(1.0, 0.12 + 1.02 * v ** (1 / 2.2)) for v in tint)
    return red, green, blue, 1.0
