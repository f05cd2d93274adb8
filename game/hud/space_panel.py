"""The living control space: the tetrahedra of velocities, where the wish lies in them and who is blended.

Seen as from behind the character: forward is away, left is left, turning left is up. All of it is
flat lines and discs, projected here and drawn from back to front.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from gambol.controllers.locomotion import Library

from ..world import Character
from . import style
from .decision import family
from .history import weights as share_of
from .on_duty import acting, own
from .tetrahedra import Mesh, Orbit
from .toolkit import imgui

GRAB = 9.0
"""How near to a vertex [px] the mouse must be."""
TRAIL = 120
"""How many steps of the blended velocity trail behind it."""
AXES = (("forward m/s", 0, (-1.0, 0.0, 1.0, 2.0, 3.0, 4.0)), ("turning left rad/s", 1, (-2.0, -1.0, 0.0, 1.0, 2.0)),
        ("left m/s", 2, (-0.5, 0.0, 0.5)))
BARS = 4
LOW_CLOSURE, HIGH_CLOSURE = math.radians(3.0), math.radians(14.0)
"""Cycles that close as well as the first are drawn largest, as badly as the second smallest."""


@dataclass(eq=False)
class SpacePanel:
    """What the panel remembers. chosen: the primitive whose clip is watched, or None. own: `duty.own` of whom it is about."""

    orbit: Orbit = Orbit()
    chosen: int | None = None
    hovered: int | None = None
    library: Library | None = None
    meshes: tuple[Mesh, ...] = ()
    turning: bool = False
    over: bool = False
    own: np.ndarray = field(default_factory=lambda: np.ones(3))

    def draw(self, character: Character, trail: np.ndarray, dt: float, scale: float) -> None:
        """Fill the current window. trail: (N, 3) blended velocities up to now, of the character's own size."""
        self.own, character = own(character), acting(character)
        gait, weights = family(character), share_of(character)
        if weights is None:  # the library stays, for when it is walked by again
            imgui.text_disabled("the active controller blends nothing")
            return
        controller, library = character.controller, character.controller.library
        if library is not self.library:
            self.library, self.chosen = library, None
            self.meshes = tuple(m for m in (Mesh.of(controller, name) for name in ("walk", "run")) if m)
        active = next((m for m in self.meshes if m.family == gait), self.meshes[0])
        bars = np.argsort(weights)[::-1][:BARS]
        bars = [int(i) for i in bars if weights[i] > 0.005]
        corner, (width, height) = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail()
        width, height = max(width, 40.0), max(height - (BARS + 0.4) * imgui.get_text_line_height_with_spacing(), 40.0)
        imgui.invisible_button("space", imgui.ImVec2(width, height))
        self._mouse()
        self.orbit = self.orbit.towards(active.points, (width, height), dt)
        pen = imgui.get_window_draw_list()
        pen.push_clip_rect((corner.x, corner.y), (corner.x + width, corner.y + height), True)
        view = corner.x + 0.5 * width, corner.y + 0.5 * height
        for mesh in self.meshes:
            self._edges(pen, mesh, view, 1.0 if mesh is active else 0.35, scale)
        self._simplex(pen, character, active, view, scale)
        self._vertices(pen, library, weights, active, view, scale)
        self._axes(pen, active, view, (corner.x, corner.x + width, corner.y), scale)
        self._query(pen, character, active.family, trail / self.own, view, scale)
        pen.pop_clip_rect()
        self._bars(library, weights, bars, scale)

    def _mouse(self) -> None:
        """Drag turns, the wheel zooms, a double click starts afresh, a click on a vertex chooses it."""
        io = imgui.get_io()
        if imgui.is_item_hovered():
            if io.mouse_wheel:
                self.orbit = replace(self.orbit, zoom=min(max(self.orbit.zoom * 1.12 ** io.mouse_wheel, 0.4), 8.0))
            if imgui.is_mouse_double_clicked(0) and self.hovered is None:
                self.orbit = replace(Orbit(), middle=self.orbit.middle, room=self.orbit.room)
        if imgui.is_item_active() and imgui.is_mouse_dragging(0, 3.0):
            self.turning = True
            self.orbit = self.orbit.turned(io.mouse_delta.x, io.mouse_delta.y)
        elif imgui.is_item_deactivated():
            if not self.turning and self.hovered is not None:
                self.chosen = None if self.chosen == self.hovered else self.hovered
            self.turning = False
        self.over = imgui.is_item_hovered() and not self.turning

    def _axes(self, pen, mesh: Mesh, view, box: tuple[float, float, float], scale: float) -> None:
        (left, right, top), line = box, imgui.get_text_line_height()
        low, high = mesh.points.min(0), mesh.points.max(0)
        for name, axis, marks in AXES:
            marks = [m for m in marks if low[axis] - 0.3 <= m / self.own[axis] <= high[axis] + 0.3]
            ends = np.zeros((2, 3))
            ends[:, 0] = 0.0 if low[0] <= 0.0 else low[0]
            ends[:, axis] = low[axis] - 0.08 * (high - low)[axis], high[axis] + 0.2 * (high - low)[axis]
            (x0, y0, _), (x1, y1, _) = self.orbit.project(ends, view)
            pen.add_line((x0, y0), (x1, y1), style.packed(style.DIM, 0.7), scale)
            places = np.repeat(ends[:1], len(marks), 0)
            places[:, axis] = np.array(marks) / self.own[axis]
            for mark, (x, y, _) in zip(marks, self.orbit.project(places, view)):
                pen.add_circle_filled((x, y), 1.8 * scale, style.packed(style.DIM))
                if mark:
                    pen.add_text((x + 4 * scale, y), style.packed(style.DIM), f"{mark:g}")
            wide = imgui.calc_text_size(name).x
            x1 = min(max(x1 - 0.5 * wide, left), right - wide)
            _write(pen, x1, max(y1 - 1.2 * line, top), name, scale)

    def _edges(self, pen, mesh: Mesh, view, opacity: float, scale: float) -> None:
        at = self.orbit.project(mesh.points, view)
        a, b = at[mesh.edges[:, 0]], at[mesh.edges[:, 1]]
        near = np.clip(0.62 - 0.42 * 0.5 * (a[:, 2] + b[:, 2]), 0.12, 1.0)
        shade = near * np.where(mesh.outer, 0.5, 0.17) * opacity
        colour = style.family_colour(mesh.family)
        for (x0, y0, _), (x1, y1, _), opacity in zip(a.tolist(), b.tolist(), shade.tolist()):
            pen.add_line((x0, y0), (x1, y1), style.packed(colour, opacity), scale)

    def _simplex(self, pen, character: Character, mesh: Mesh, view, scale: float) -> None:
        memory = character.state.memory
        number = int(memory["simplex"][int(mesh.family == "run")])
        if not 0 <= number < len(mesh.simplices):
            return
        at = [tuple(p[:2]) for p in self.orbit.project(mesh.points[mesh.simplices[number]], view).tolist()]
        for face in ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)):
            pen.add_triangle_filled(*(at[i] for i in face), style.packed(style.TEXT, 0.07))
        for i in range(4):
            for j in range(i):
                pen.add_line(at[i], at[j], style.packed(style.TEXT, 0.6), 1.4 * scale)

    def _vertices(self, pen, library: Library, weights: np.ndarray, active: Mesh, view, scale: float) -> None:
        places, numbers, strength = [], [], []
        for mesh in self.meshes:
            places.append(self.orbit.project(mesh.points, view))
            numbers.append(mesh.members)
            strength.append(np.full(len(mesh.members), 1.0 if mesh is active else 0.45))
        at, number, strength = np.concatenate(places), np.concatenate(numbers), np.concatenate(strength)
        closure = np.array([p.closure for p in library.primitives])[number]
        fine = np.clip((HIGH_CLOSURE - closure) / (HIGH_CLOSURE - LOW_CLOSURE), 0.0, 1.0)
        mouse = imgui.get_mouse_pos()
        away = np.hypot(at[:, 0] - mouse.x, at[:, 1] - mouse.y)
        within = np.where(away < GRAB * scale, at[:, 2], np.inf)
        self.hovered = int(number[np.argmin(within)]) if self.over and np.isfinite(within.min()) else None
        for k in np.argsort(-at[:, 2]):
            x, y, depth = at[k].tolist()
            primitive, weight = int(number[k]), float(weights[number[k]])
            colour = style.family_colour(library.primitives[primitive].family)
            size = (1.5 + 2.0 * fine[k]) * scale * (1.0 - 0.25 * depth)
            if weight > 0.005:
                pen.add_circle_filled((x, y), (5.0 + 13.0 * math.sqrt(weight)) * scale, style.packed(colour, 0.35))
                pen.add_circle_filled((x, y), size + 1.5 * scale, style.packed(style.TEXT))
            pen.add_circle_filled((x, y), size, style.packed(colour, strength[k] * min(max(0.85 - 0.45 * depth, 0.3), 1.0)))
            if primitive == self.chosen or primitive == self.hovered:
                pen.add_circle((x, y), size + 5.0 * scale, style.packed(style.TEXT), 0, 1.5 * scale)
        if self.hovered is not None:
            self._tell(library, self.hovered)

    def _tell(self, library: Library, number: int) -> None:
        one, (v_f, omega, v_l) = library.primitives[number], library.velocities[number] * self.own
        imgui.set_tooltip(f"{one.label}\n{one.clip} at {one.start:.2f} s{', mirrored' if one.mirrored else ''}\n"
                          f"forward {v_f:.2f} m/s, turning {omega:.2f} rad/s, left {v_l:.2f} m/s\n"
                          f"closes to {math.degrees(one.closure):.1f}°, averaged from {one.averaged}\n"
                          + ("click to stop" if number == self.chosen else "click to watch"))

    def _query(self, pen, character: Character, gait: str, trail: np.ndarray, view, scale: float) -> None:
        controller, asked = character.controller, np.asarray(character.intent.velocity, float)
        parting = controller.settings.walk_below if gait == "run" else controller.settings.run_above
        # a wish to run is brought to where running goes, also before the feet do run
        clamped = (controller.run if asked[0] > parting else controller.walk).clamp(asked)
        (ax, ay, _), (cx, cy, _) = self.orbit.project(np.stack([asked, clamped]), view)
        trail = trail[np.isfinite(trail).all(-1)][-TRAIL:]
        if len(trail) > 1:
            path = self.orbit.project(trail, view)[:, :2].tolist()
            for k, (a, b) in enumerate(zip(path, path[1:])):
                pen.add_line(a, b, style.packed(style.TEXT, 0.7 * (k + 1) / len(path)), 1.5 * scale)
            pen.add_circle_filled(path[-1], 3.0 * scale, style.packed(style.TEXT))
        ink = style.packed(style.TEXT)
        if math.hypot(ax - cx, ay - cy) > 2 * scale:  # brought back to the hull
            pen.add_line((ax, ay), (cx, cy), style.packed(style.BAD), 2.0 * scale)
            pen.add_circle_filled((cx, cy), 4.5 * scale, style.packed(style.BAD))
        pen.add_circle((ax, ay), 7.0 * scale, ink, 0, 2.0 * scale)
        _write(pen, ax + 10 * scale, ay - 0.5 * imgui.get_text_line_height(), "asked", scale)

    def _bars(self, library: Library, weights: np.ndarray, bars: list[int], scale: float) -> None:
        pen, width = imgui.get_window_draw_list(), imgui.get_content_region_avail().x
        line = imgui.get_text_line_height()
        for number in bars:
            one, at = library.primitives[number], imgui.get_cursor_screen_pos()
            colour, weight = style.family_colour(one.family), float(weights[number])
            long = 0.28 * width
            pen.add_rect_filled((at.x, at.y + 2 * scale), (at.x + long, at.y + line), style.packed(style.FIELD), 2 * scale)
            pen.add_rect_filled((at.x, at.y + 2 * scale), (at.x + max(long * weight, 2 * scale), at.y + line),
                                style.packed(colour, 0.85), 2 * scale)
            imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + long + 8 * scale)
            imgui.text(f"{100 * weight:3.0f} %")
            imgui.same_line()
            imgui.text_disabled(f"{one.clip} {one.start:.1f} s{' mirrored' if one.mirrored else ''}")


def _write(pen, x: float, y: float, text: str, scale: float) -> None:
    """A word that stays readable over lines and discs."""
    dark = style.packed(style.SHEET)
    for dx, dy in ((-1, 0), (1, 0), (0, -1), (0, 1)):
        pen.add_text((x + dx * scale, y + dy * scale), dark, text)
    pen.add_text((x, y), style.packed(style.TEXT), text)
