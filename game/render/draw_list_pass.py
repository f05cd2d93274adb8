"""The pass that draws ink over the picture."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..scene import Ink
from . import gl


class InkPass:
    """Draws ink; made once per context. Sheets are uploaded when they change."""

    def __init__(self, ctx: Any):
        self.ctx, self.program = ctx, gl.program(ctx, "ink.vert", "ink.frag")
        self.program["sheet"] = 0
        self.vertices, self.indices = gl.Stream(ctx, 1 << 16), gl.Stream(ctx, 1 << 16)
        self.array = ctx.vertex_array(self.program, [(self.vertices.buffer, "2f 2f 4f1", "place", "uv", "tint")],
                                      index_buffer=self.indices.buffer, index_element_size=4)
        self.sheets: dict[int, tuple[np.ndarray, Any]] = {}

    def draw(self, ink: Ink, target: Any) -> None:
        """Draw over all of a framebuffer."""
        ctx, (width, height) = self.ctx, target.size
        across, down = width / ink.size[0], height / ink.size[1]
        self._load(ink.sheets)
        self.vertices.write(ink.vertices.tobytes())
        self.indices.write(ink.indices.astype(np.uint32, copy=False).tobytes())
        self.program["size"] = ink.size
        target.viewport = 0, 0, width, height
        target.use()
        ctx.enable_only(ctx.BLEND)
        ctx.blend_func = ctx.SRC_ALPHA, ctx.ONE_MINUS_SRC_ALPHA, ctx.ZERO, ctx.ONE
        for stroke in ink.strokes:
            left, top = max(round(stroke.clip[0] * across), 0), max(round(stroke.clip[1] * down), 0)
            right, bottom = min(round(stroke.clip[2] * across), width), min(round(stroke.clip[3] * down), height)
            if left < right and top < bottom and stroke.sheet in self.sheets:
                target.scissor = left, height - bottom, right - left, bottom - top
                self.sheets[stroke.sheet][1].use(0)
                self.array.render(mode=ctx.TRIANGLES, vertices=stroke.count, first=stroke.first)
        target.scissor = None
        ctx.disable(ctx.BLEND)

    def _load(self, sheets: Mapping[int, np.ndarray]) -> None:
        for number in [n for n, (pixels, _) in self.sheets.items() if sheets.get(n) is not pixels]:
            self.sheets.pop(number)[1].release()
        for number, pixels in sheets.items():
            if number not in self.sheets:
                texture = self.ctx.texture(pixels.shape[1::-1], 4, np.ascontiguousarray(pixels).tobytes())
                texture.repeat_x = texture.repeat_y = False
                self.sheets[number] = pixels, texture

    def release(self) -> None:
        """Give back all that was made on the graphics card."""
        for part in (self.array, self.program, self.vertices, self.indices, *(t for _, t in self.sheets.values())):
            part.release()
        self.sheets.clear()
