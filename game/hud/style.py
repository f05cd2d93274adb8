"""How panels look: dark, quiet, and their colours with one meaning everywhere."""

from __future__ import annotations

from functools import lru_cache

from .toolkit import imgui, implot

Colour = tuple[float, float, float, float]

TEXT: Colour = (0.91, 0.92, 0.91, 1.0)
DIM: Colour = (0.60, 0.63, 0.66, 1.0)
SHEET: Colour = (0.055, 0.065, 0.080, 0.90)
FIELD: Colour = (0.16, 0.18, 0.21, 1.0)
LINE: Colour = (0.34, 0.37, 0.41, 1.0)
ACCENT: Colour = (0.93, 0.62, 0.33, 1.0)
WALK, RUN, REST = ACCENT, (0.38, 0.70, 0.86, 1.0), (0.66, 0.80, 0.58, 1.0)
"""The families of primitives."""
ASKED, BLENDED, ACHIEVED = (0.95, 0.95, 0.93, 1.0), (0.38, 0.70, 0.86, 1.0), ACCENT
"""The three velocities of a character."""
GOOD, FAIR, BAD = (0.56, 0.78, 0.50, 1.0), (0.92, 0.76, 0.38, 1.0), (0.93, 0.44, 0.36, 1.0)
LETTERS = 15.0
"""Height of letters [px] where the picture is 720 pixels high."""
SHADES = 64


@lru_cache(maxsize=64)
def _shades(colour: Colour) -> list[int]:
    """A colour as draw lists take it, from no opacity to all of its own in SHADES steps."""
    r, g, b = (round(255.0 * v) for v in colour[:3])
    return [round(255.0 * colour[3] * k / SHADES) << 24 | b << 16 | g << 8 | r for k in range(SHADES + 1)]


def packed(colour: Colour, opacity: float = 1.0) -> int:
    """A colour as draw lists take it, its opacity times a factor 0 … 1."""
    return _shades(colour)[int(SHADES * min(max(opacity, 0.0), 1.0) + 0.5)]


def fade(colour: Colour, opacity: float) -> Colour:
    """A colour with its opacity times a factor."""
    return *colour[:3], colour[3] * opacity


def family_colour(family: str) -> Colour:
    """The colour of a primitive's family."""
    return {"run": RUN, "rest": REST}.get(family, WALK)


def apply(scale: float) -> None:
    """Style the current context for letters LETTERS · scale pixels high."""
    imgui.style_colors_dark()
    style, old = imgui.get_style(), imgui.Style()
    for name in ("window_padding", "frame_padding", "item_spacing", "item_inner_spacing", "cell_padding"):
        value = {"window_padding": (12, 10), "frame_padding": (8, 4), "item_spacing": (8, 6)}.get(name)
        value = value or (getattr(old, name).x, getattr(old, name).y)
        setattr(style, name, imgui.ImVec2(value[0] * scale, value[1] * scale))
    style.font_size_base = round(LETTERS * scale)
    style.window_rounding, style.frame_rounding, style.grab_rounding = 8 * scale, 4 * scale, 2 * scale
    style.scrollbar_size, style.grab_min_size, style.scrollbar_rounding = 10 * scale, 5 * scale, 5 * scale
    style.window_border_size = style.frame_border_size = style.popup_border_size = 0.0
    style.window_title_align = imgui.ImVec2(0.0, 0.5)
    style.window_menu_button_position = imgui.Dir.none
    tints = {"text": TEXT, "text_disabled": DIM, "window_bg": SHEET, "popup_bg": (*SHEET[:3], 0.97), "border": LINE,
             "title_bg": SHEET, "title_bg_active": SHEET, "title_bg_collapsed": SHEET, "frame_bg": FIELD,
             "frame_bg_hovered": (0.21, 0.23, 0.27, 1.0), "frame_bg_active": (0.24, 0.27, 0.31, 1.0),
             "slider_grab": fade(ACCENT, 0.85), "slider_grab_active": ACCENT, "check_mark": ACCENT,
             "button": FIELD, "button_hovered": (0.24, 0.27, 0.31, 1.0), "button_active": fade(ACCENT, 0.8),
             "header": FIELD, "header_hovered": (0.21, 0.23, 0.27, 1.0), "header_active": (0.24, 0.27, 0.31, 1.0),
             "separator": fade(LINE, 0.5), "scrollbar_bg": (0, 0, 0, 0), "scrollbar_grab": LINE,
             "resize_grip": (0, 0, 0, 0), "resize_grip_hovered": LINE, "resize_grip_active": ACCENT,
             "text_selected_bg": fade(ACCENT, 0.4), "nav_cursor": fade(ACCENT, 0.6)}
    for name, tint in tints.items():
        style.set_color_(getattr(imgui.Col_, name), imgui.ImVec4(*tint))
    plots = implot.get_style()
    plots.plot_padding, plots.label_padding = imgui.ImVec2(4 * scale, 4 * scale), imgui.ImVec2(4 * scale, 3 * scale)
    plots.plot_min_size = imgui.ImVec2(50, 40)
    for name, tint in {"frame_bg": (0, 0, 0, 0), "plot_bg": (0, 0, 0, 0.22), "plot_border": (0, 0, 0, 0),
                       "axis_grid": fade(LINE, 0.6), "axis_text": DIM, "axis_tick": (0, 0, 0, 0),
                       "inlay_text": DIM}.items():
        plots.set_color_(getattr(implot.Col_, name), imgui.ImVec4(*tint))
