"""A slider for every setting, marked where it is not as shipped, with a way back."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import cache
from itertools import groupby
from typing import Any

import numpy as np

from ..session import SETTINGS, SessionState, Setting, owners
from . import style
from .on_duty import own
from .toolkit import imgui

DIAL = 0.5
"""How much of a setting's line is its slider; the rest has its digits."""


@cache
def meaning(owner: type, field: str) -> str:
    """What a class's docstring says of one of its fields: "one, other: …", or the sentence that names it."""
    text = " ".join((owner.__doc__ or "").split())
    for names, words in re.findall(r"((?:\w+, )*\w+): (.*?[^\d])(?:[.](?= |$)|$)", text):
        if field in names.split(", "):
            return words
    sentences = re.split(r"(?<=\D)[.] ", text)
    return next((s for s in sentences if re.search(rf"\b{field}\b", s)), sentences[0]).rstrip(".")


def draw(moment: SessionState, who: int, scale: float) -> list[str]:
    """Fill the current window; what was changed, as actions "name=value"."""
    actions: list[str] = []
    small = bool(np.any(own(moment.after.characters[who]) != 1.0))
    rows = [Row.of(setting, held) for held in [owners(moment, who)] for setting in SETTINGS]
    rows = [row for row in rows if row is not None]
    touched = [row for row in rows if row.differs]
    imgui.begin_disabled(not touched)
    if imgui.button("reset all"):
        actions += [row.back for row in touched]
    imgui.end_disabled()
    imgui.same_line()
    imgui.text_disabled(f"{len(touched)} not as shipped" if touched else "all as shipped")
    imgui.begin_child("settings")
    for owner, group in groupby(rows, key=lambda row: row.setting.name.partition(".")[0]):
        imgui.spacing()
        imgui.text_disabled(owner + (" of the library's body" if owner == "locomotion" and small else ""))
        for row in group:
            actions += _slider(row, scale)
    imgui.end_child()
    return actions


@dataclass(frozen=True)
class Row:
    """One setting as it stands. default: where it stands untouched. about: what its owner says of it."""

    setting: Setting
    value: float
    default: float
    about: str

    @staticmethod
    def of(setting: Setting, held: dict[str, Any]) -> Row | None:
        """A setting of the owners `held`; None where its owner has no such thing, or no finite value of it."""
        owner, _, field = setting.name.partition(".")
        value = getattr(held.get(owner), field, None)
        if value is None or not math.isfinite(value):
            return None
        kind = type(held[owner])
        return Row(setting, float(value), float(getattr(kind(), field)), meaning(kind, field))

    @property
    def differs(self) -> bool:
        """Whether it is not as shipped."""
        return abs(self.value - self.default) > 1e-6 * (self.setting.high - self.setting.low)

    @property
    def back(self) -> str:
        """The action that resets it."""
        return f"{self.setting.name}={self.default:.9g}"


def _slider(row: Row, scale: float) -> list[str]:
    setting, value = row.setting, row.value
    name = f"##{setting.name}"
    imgui.align_text_to_frame_padding()
    imgui.text_colored(imgui.ImVec4(*(style.ACCENT if row.differs else style.TEXT)),
                       setting.name.partition(".")[2].replace("_", " "))
    _tooltip(row)
    left, wide = imgui.get_cursor_pos_x(), imgui.get_content_region_avail().x
    button = 1.6 * imgui.get_font_size()
    imgui.same_line(left + 0.44 * wide)
    room = 0.56 * wide - button - 6 * scale
    if setting.whole and (setting.low, setting.high) == (0, 1):
        edited, new = imgui.checkbox(name, bool(value))
    else:
        digits = 0 if setting.whole else 3 if setting.high - setting.low < 1.0 else 2
        imgui.set_next_item_width(DIAL * room)
        edited, new = imgui.slider_float(name, value, setting.low, setting.high, "", imgui.SliderFlags_.always_clamp)
        new = round(new) if setting.whole else new
        _tooltip(row)
        imgui.same_line(0.0, 6 * scale)  # beside the knob, which would cover them
        imgui.text(f"{value:.{digits}f} {setting.unit}".rstrip())
    _tooltip(row)
    actions = [f"{setting.name}={float(new):.6g}"] if edited else []
    if row.differs:
        imgui.same_line(left + wide - button)
        if imgui.button(f"×{name}", imgui.ImVec2(button, 0)):
            actions = [row.back]
        imgui.set_item_tooltip(f"back to {row.default:g}")
    return actions


def _tooltip(row: Row) -> None:
    if imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
        unit = f" [{row.setting.unit}]" if row.setting.unit else ""
        lines = (f"{row.setting.name}{unit}", row.about, f"shipped: {row.default:g}")
        imgui.set_tooltip("\n".join(filter(None, lines)))
