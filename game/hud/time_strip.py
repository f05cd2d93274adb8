"""The strip at the top: what the character is at and why, and the time: pause, step, slow motion, scrubbing."""

from __future__ import annotations

from ..session import SessionState
from ..world import RATE
from . import style
from .decision import family, reason
from .on_duty import acting, why
from .toolkit import imgui


def draw(now: SessionState, shown: SessionState, behind: int, kept: int, who: int, scale: float) -> tuple[int, list[str]]:
    """Fill the current window; whom to look at from now on, and what was asked for, as actions.

    shown: the moment looked at, `behind` steps before now. kept: how many steps one can look back.
    """
    chosen, actions = why(shown.after.characters[who]), []
    character = acting(shown.after.characters[who])
    gait = family(character)
    pen, at, line = imgui.get_window_draw_list(), imgui.get_cursor_screen_pos(), imgui.get_text_line_height()
    pen.add_circle_filled((at.x + 0.4 * line, at.y + 0.5 * line), 0.28 * line, style.packed(style.family_colour(gait)))
    imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + 1.1 * line)
    imgui.text(reason(shown.after.characters[who]))
    kind, controller = type(character.controller).__name__.lower(), character.controller
    fit = controller.precondition(character.state, character.intent)
    imgui.same_line()
    status = controller.status(character.state)
    told = kind if status.kind == "running" else f"{kind} {status.kind}"
    imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + max(
        imgui.get_content_region_avail().x - imgui.calc_text_size(told).x, 0.0))
    imgui.text_disabled(told)
    imgui.set_item_tooltip("the active controller" + (f": {chosen}" if chosen else "")
                           + f"; from here it could start with a fit of {fit:.0%}")

    if len(now.players) > 1:
        if imgui.button(f"player {who + 1}"):
            who = (who + 1) % len(now.players)
        imgui.set_item_tooltip("whom the panels are about")
        imgui.same_line(0.0, 5 * scale)
    for label, action, help in (("play" if now.paused else "pause", "pause", "P"), ("step", "step", "one step while paused"),
                                (f"1/{now.slow}" if now.slow > 1 else "1/1", "slowmo", "slow motion: 1/1, 1/2, 1/4, 1/10")):
        imgui.begin_disabled(action == "step" and not (now.paused or behind))
        if imgui.button(f"{label}##{action}", imgui.ImVec2(52 * scale, 0)):
            actions.append(action)
        imgui.end_disabled()
        imgui.set_item_tooltip(help)
        imgui.same_line(0.0, 5 * scale)
    resume = 84 * scale
    imgui.set_next_item_width(imgui.get_content_region_avail().x - resume - 6 * scale)
    edited, value = imgui.slider_float("##time", -behind / RATE, -max(kept, 1) / RATE, 0.0, "%.2f s",
                                       imgui.SliderFlags_.always_clamp)
    if edited:
        actions.append(f"look={round(-value * RATE)}")
    imgui.set_item_tooltip(f"look back over the last {kept / RATE:.0f} s")
    imgui.same_line(0.0, 6 * scale)
    imgui.begin_disabled(not behind)
    if imgui.button("from here", imgui.ImVec2(resume, 0)):
        actions.append("resume")
    imgui.end_disabled()
    imgui.set_item_tooltip("play on from the moment shown")
    return who, actions
