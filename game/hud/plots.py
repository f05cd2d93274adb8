"""The plots: velocities asked for, blended and achieved, and the feet on the floor, over ten seconds."""

from __future__ import annotations

import math

import numpy as np

from ..world import RATE
from . import style
from .history import STEPS, Signals
from .toolkit import imgui, implot

ROWS = (("forward", "m/s", 1.5), ("turning", "rad/s", 1.0), ("to the left", "m/s", 0.5))
"""Each velocity: what to call it, its unit, and the least that its axis spans either way."""
CURVES = (("asked", style.ASKED, 1.2), ("blended", style.BLENDED, 1.6), ("achieved", style.ACHIEVED, 1.6))
FEET = ("L heel", "L ball", "R heel", "R ball")
QUIET = (implot.Flags_.no_title | implot.Flags_.no_legend | implot.Flags_.no_menus | implot.Flags_.no_box_select
         | implot.Flags_.no_mouse_text | implot.Flags_.no_inputs)
SPAN = STEPS / RATE


def draw(signals: Signals, scale: float) -> None:
    """Fill the current window."""
    for number, (name, colour, _) in enumerate(CURVES):
        if number:
            imgui.same_line(0.0, 14 * scale)
        imgui.text_colored(imgui.ImVec4(*colour), "asked or planned" if name == "asked" else name)
    imgui.same_line(0.0, 14 * scale)
    imgui.text_disabled(f"last {SPAN:.0f} s")
    width, room = imgui.get_content_region_avail()
    strip = 4.6 * imgui.get_text_line_height()
    height = max((room - strip) / 3 - 2 * scale, 40 * scale)
    times = signals.seconds
    imgui.push_style_var(imgui.StyleVar_.item_spacing, imgui.ImVec2(8 * scale, 2 * scale))
    left = right = imgui.get_cursor_screen_pos().x
    if implot.begin_aligned_plots("velocities"):
        for row, (name, unit, least) in enumerate(ROWS):
            left, right = _velocity(row, name, unit, least, signals, times, (width, height), scale) or (left, right)
        implot.end_aligned_plots()
    imgui.pop_style_var()
    _feet(signals, times, left, right, scale)


def _velocity(row: int, name: str, unit: str, least: float, signals: Signals, times: np.ndarray,
              size: tuple[float, float], scale: float) -> tuple[float, float] | None:
    """One plot; where it begins and ends [px], as all that share its axis of time must. None where it is scrolled out of sight."""
    ends = None
    curves = [np.ascontiguousarray(getattr(signals, what)[::-2, row]) for what, _, _ in CURVES]
    halved = np.ascontiguousarray(times[::-2])  # as many points as there are pixels
    known = np.concatenate([c[np.isfinite(c)] for c in curves] + [[0.0]])
    low, high = 1.1 * min(float(known.min()), 0.0 if row == 0 else -least), 1.1 * max(float(known.max()), least)
    if implot.begin_plot(f"##{name}", imgui.ImVec2(*size), QUIET):
        plain = implot.AxisFlags_.no_tick_marks | implot.AxisFlags_.no_side_switch
        implot.setup_axis(implot.ImAxis_.x1, None, plain | implot.AxisFlags_.no_tick_labels)
        implot.setup_axis(implot.ImAxis_.y1, None, plain)
        implot.setup_axis_limits(implot.ImAxis_.x1, -SPAN, 0.0, implot.Cond_.always)
        implot.setup_axis_limits(implot.ImAxis_.y1, low, high, implot.Cond_.always)
        marks = ticks(low, high)
        implot.setup_axis_ticks(implot.ImAxis_.y1, marks, [f"{mark:8g}" for mark in marks])
        for (what, colour, weight), curve in zip(CURVES, curves):
            if np.isfinite(curve).any():
                implot.plot_line(what, halved, curve, spec=implot.Spec(
                    line_color=imgui.ImVec4(*colour), line_weight=weight * scale))
        corner, inset = implot.get_plot_pos(), 5 * scale
        implot.get_plot_draw_list().add_text((corner.x + inset, corner.y + inset), style.packed(style.DIM),
                                             f"{name} [{unit}]")
        ends = corner.x, corner.x + implot.get_plot_size().x
        implot.end_plot()
    return ends


def _feet(signals: Signals, times: np.ndarray, left: float, right: float, scale: float) -> None:
    """A gait diagram: when each heel and ball stood, over the phase of the gait."""
    pen, start = imgui.get_window_draw_list(), imgui.get_cursor_screen_pos()
    line, gap = imgui.get_text_line_height(), 2 * scale
    top, across = start.y + gap, (right - left) / SPAN
    bottom = top + 4 * line
    pen.add_rect_filled((left, top), (right, bottom), style.packed((0.0, 0.0, 0.0, 0.22)))
    x = right + times * across
    if np.isfinite(signals.phase).any():
        y = bottom - signals.phase * (bottom - top)
        for a, b in runs(np.concatenate([np.diff(signals.phase) >= 0.0, [False]])):  # the phase falls once a cycle
            pen.add_polyline([(x[i], y[i]) for i in range(a, b + 1)], style.packed(style.DIM, 0.5), scale, 0)
    for row, name in enumerate(FEET):
        y0, y1 = top + row * line + gap, top + (row + 1) * line - gap
        pen.add_text((start.x, top + row * line), style.packed(style.DIM), name)
        colour = style.packed(style.ACHIEVED if row < 2 else style.BLENDED, 0.9 if row % 2 else 0.6)
        for a, b in runs(signals.contacts[:, row]):
            pen.add_rect_filled((x[a], y0), (max(x[b - 1], x[a] + 1), y1), colour, 2 * scale)
    imgui.dummy(imgui.ImVec2(right - start.x, bottom - start.y + gap))
    imgui.set_item_tooltip("when each heel and ball stands, over the phase of the gait")


def ticks(low: float, high: float) -> list[float]:
    """Two to four round numbers, among them 0, from a low ≤ 0 to a high ≥ 0."""
    step = next(s for s in (0.5, 1.0, 2.0, 5.0, 10.0, 1e9) if (high - low) / s < 3.5)
    return [step * k for k in range(math.ceil(low / step), math.floor(high / step) + 1)]


def runs(mask: np.ndarray) -> list[tuple[int, int]]:
    """The stretches (first, one after the last) in which a mask (N,) holds."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(np.int8)))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]
