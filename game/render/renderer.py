"""The renderer: a scene in, or several side by side, and one picture out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..scene import Figure, Goal, Scene
from . import gl, view
from .draw_list_pass import InkPass
from .figures import Figures, drawable
from .ground import Ground, touched_floor
from .help_pass import SheetPass
from .hint_pass import HintPass
from .occlusion import Occluders
from .overlays import OverlayPass
from .presets import Preset, preset
from .props import Goals, Solids
from .sun import SUN, LightBox, figures_box, solids_box
from .text import TextPass
from .wear import dressed

FLOATS = 68
"""In the uniform block of frame.glsl."""
STAGE_TEXELS = 2048
"""Along a side of the solids' shadow map, in any preset: it is hardly ever drawn."""
GAP = (0.02, 0.022, 0.026)
"""The colour of the line between parts of a picture, and of what no part covers."""


class Renderer:
    """Draws scenes into its own framebuffer.

    ctx: a moderngl context of OpenGL 3.3 core or later. size: width, height in pixels.
    chosen: a preset or its name. Everything on the graphics card is made here, once; frames reuse it.
    """

    def __init__(self, ctx: Any, size: tuple[int, int], chosen: str | Preset = "full"):
        self.ctx, self.preset = ctx, preset(chosen)
        floor, body = self.preset.floor_taps, self.preset.body_taps
        self.target = gl.Target(ctx, size, self.preset.samples)
        self.figures_map, self.solids_map = (gl.ShadowMap(ctx, n) for n in (self.preset.shadow_size, STAGE_TEXELS))
        self._pixels = np.empty((0, 0, 4), np.uint8)  # of the last picture read, bottom row first
        self.kept: Any = None  # what the solids' map shows: solids and light box
        self.frame = ctx.buffer(reserve=4 * FLOATS, dynamic=True)
        self.occluders = Occluders(ctx)
        self.figures, self.solids, self.goals = Figures(ctx, body), Solids(ctx, floor), Goals(ctx)
        self.ground, self.overlays, self.text = Ground(ctx, floor), OverlayPass(ctx), TextPass(ctx)
        self.sheet, self.hint, self.ink = SheetPass(ctx), HintPass(ctx), InkPass(ctx)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture in pixels."""
        return self.target.size

    def resize(self, size: tuple[int, int]) -> None:
        """Draw pictures of another size from now on."""
        if size != self.size:
            replacement = gl.Target(self.ctx, size, self.preset.samples)
            self.target.release()
            self.target = replacement

    def draw(self, scenes: Scene | Sequence[Scene]) -> None:
        """Draw a scene, or several, each in its own part of the picture; `read` or `blit` then give the picture.

        ValueError for a part that lies outside the picture or has no pixels. Later parts cover earlier ones.
        """
        scenes = (scenes,) if isinstance(scenes, Scene) else tuple(scenes)
        parts = [view.part_of(scene.part, self.size) for scene in scenes]
        whole = (0, 0, *self.size)
        if parts != [(whole, whole)]:
            self.target.masked().clear(*GAP, viewport=whole)
        for scene, (framed, inside) in zip(scenes, parts):
            self._part(scene, framed, inside)
        for sheet in [scene.sheet for scene in scenes if scene.sheet is not None][-1:]:
            self.sheet.draw(sheet, self.target.masked())
        for hint in [scene.hint for scene in scenes if scene.hint is not None][-1:]:
            self.hint.draw(hint, self.target.masked())
        self.target.resolve()
        for ink in [scene.ink for scene in scenes if scene.ink is not None]:  # sharp enough without samples
            self.ink.draw(ink, self.target.resolved)

    def _part(self, scene: Scene, framed: view.Rectangle, inside: view.Rectangle) -> None:
        """Draw one scene into the pixels `inside`; a line around them fills what is left of `framed`."""
        ctx, camera, size = self.ctx, scene.camera, inside[2:]
        origin = view.origin_of(camera)
        eye = np.asarray(camera.eye, float) - origin
        marked = tuple(figure for figure in scene.figures if figure.opacity > 0.0 and drawable(figure))
        figures = dressed(marked)
        solids = tuple(prop for prop in scene.props if not isinstance(prop, Goal))
        shown = figures if scene.overlays.mesh else ()
        bodies = tuple(figure for figure in shown if figure.opacity >= 1.0)  # ghosts darken nothing
        boxes = figures_box(camera, bodies, self.preset.shadow_size), solids_box(camera, solids, STAGE_TEXELS)
        projection = view.perspective(camera.fov, size[0] / size[1])
        matrix = projection @ view.look_at(eye, np.asarray(camera.target, float) - origin, camera.up)
        self._frame(matrix, eye, origin, boxes, view.clear_air(camera), size)
        metre = size[1] / (2.0 * np.tan(0.5 * camera.fov))  # pixels, one metre away
        self.figures.prepare(shown, camera.eye, origin, [metre / least for least in self.preset.detail])
        self.solids.prepare(solids, origin)
        self.occluders.prepare(camera, bodies if boxes[0] else (), solids, origin)
        self._shadows(solids, *boxes)
        ctx.enable_only(ctx.DEPTH_TEST | ctx.CULL_FACE)
        ctx.cull_face, ctx.depth_func = "back", "<="
        # the sky and the floor cover every pixel: only the depth needs clearing, and the line around
        self.target.masked(colour=framed != inside).clear(*GAP, depth=1.0, viewport=framed)
        self.target.masked(viewport=inside)
        self.figures_map.use(gl.SAMPLERS["figures_map"], gl.SAMPLERS["figures_depth"])
        self.solids_map.use(gl.SAMPLERS["solids_map"], gl.SAMPLERS["solids_depth"])
        self.figures.draw("body")
        self.solids.draw("body")
        if scene.overlays.skeleton:
            self.overlays.draw_bones(figures, origin)
        # floor and sky last: the depth test spares what is hidden by then
        self.ground.draw(touched_floor(bodies if boxes[0] else (), solids, origin), np.linalg.inv(matrix))
        self._over(scene, marked, origin, inside, metre)

    def read(self, out: np.ndarray | None = None) -> np.ndarray:
        """The picture (H, W, 4) uint8, top row first; into `out` where one is given."""
        width, height = self.size
        if out is None:
            out = np.empty((height, width, 4), np.uint8)
        if out.shape != (height, width, 4) or out.dtype != np.uint8:
            raise ValueError(f"a picture of {width} × {height} needs ({height}, {width}, 4) uint8, "
                             f"got {out.shape} {out.dtype}")
        if self._pixels.shape != out.shape:
            self._pixels = np.empty_like(out, order="C")
        self.target.resolved.read_into(self._pixels, components=4, alignment=1)
        out[:] = self._pixels[::-1]
        return out

    def blit(self, target: Any = None) -> None:
        """Copy the picture into another framebuffer of the same size; by default the window's."""
        self.ctx.copy_framebuffer(self.ctx.screen if target is None else target, self.target.resolved)

    def release(self) -> None:
        """Give back all that was made on the graphics card."""
        for part in (self.figures, self.solids, self.goals, self.ground, self.overlays, self.text, self.sheet, self.hint, self.ink,
                     self.occluders, self.figures_map, self.solids_map, self.frame, self.target):
            part.release()

    def _frame(self, matrix: np.ndarray, eye: np.ndarray, origin: np.ndarray, boxes: Sequence[LightBox | None],
               fog: float, size: tuple[int, int]) -> None:
        """Fill the uniform block of frame.glsl."""
        data = np.zeros(FLOATS, np.float32)
        data[:16] = matrix.T.ravel()
        data[48:52], data[52:55] = (*eye, fog**-4), SUN
        data[56:60] = *size, 1.0 / size[0], 1.0 / size[1]
        for k, box in enumerate(boxes):
            if box is not None:
                data[16 + 16 * k:][:16] = box.matrix(origin).T.ravel()
                # as wide as the blur of shadow.glsl, so that nothing lit shadows itself
                margin = 1.6 * box.texel + 0.011
                data[60 + 4 * k:][:4] = *(1.0 / box.size), margin, box.top - box.bottom
        self.frame.orphan()
        self.frame.write(data.tobytes())
        self.frame.bind_to_uniform_block(gl.FRAME)

    def _shadows(self, solids: tuple, figures_light: LightBox | None, solids_light: LightBox | None) -> None:
        """Draw the shadow maps: the figures' for every frame, the solids' only where something changed."""
        ctx = self.ctx
        ctx.enable_only(ctx.DEPTH_TEST | ctx.CULL_FACE)
        # near sides: where limbs touch or a box meets the floor, no light leaks in between
        ctx.cull_face, ctx.depth_func = "back", "<="
        if figures_light is not None:
            self.figures_map.target.use()
            self.figures_map.target.clear(depth=1.0)
            self.figures.draw("shadow")
        if solids_light is not None:
            shows = solids, tuple(solids_light.corner), float(solids_light.size[0])
            if shows != self.kept:
                self.solids_map.target.use()
                self.solids_map.target.clear(depth=1.0)
                self.solids.draw("shadow")
                self.kept = shows

    def _over(self, scene: Scene, figures: tuple[Figure, ...], origin: np.ndarray, inside: view.Rectangle,
              metre: float) -> None:
        """Ghosts, marks on the floor, then text over everything."""
        ctx = self.ctx
        ctx.enable(ctx.BLEND)
        ctx.blend_func = ctx.SRC_ALPHA, ctx.ONE_MINUS_SRC_ALPHA, ctx.ZERO, ctx.ONE
        self.figures.draw_ghosts(lambda colour: self.target.masked(colour=colour, viewport=inside))
        ctx.disable(ctx.CULL_FACE)
        self.target.masked(depth=False, viewport=inside)
        self.overlays.draw_marks(figures, scene.overlays, origin, scene.camera, metre)
        self.goals.draw([prop for prop in scene.props if isinstance(prop, Goal)], origin)
        self.target.masked(viewport=inside)
        ctx.disable(ctx.DEPTH_TEST)
        self.text.draw(scene.text, scene.caption, inside[2:], scene.taken)
        ctx.disable(ctx.BLEND)
