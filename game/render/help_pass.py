"""The passes that draw rows of letters and shapes, as of `help_layout`, over a picture: the help sheet's, and others' like it."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..scene import Sheet
from . import gl
from .help_layout import layout
from .help_pages import arranged
from .text import atlas


class RowsPass:
    """Draws rows as of `layout` over a picture; made once per context."""

    def __init__(self, ctx: Any):
        self.ctx, self.program = ctx, gl.program(ctx, "sheet.vert", "sheet.frag")
        self.stream, self.texture, self.drawn = gl.Stream(ctx), None, 0
        self.array = ctx.vertex_array(self.program, [(self.stream.buffer, "4f 4f 4f 2f/i", "place", "cell", "tint", "edge")])

    def rows(self, rows: np.ndarray, letters: int, target: Any) -> None:
        """Draw rows in letters of a size [px] over a framebuffer."""
        ctx, size = self.ctx, target.size
        texture = self.texture
        if texture is None or letters != self.drawn:
            if texture is not None:
                texture.release()
            pixels = atlas(letters).pixels
            texture = ctx.texture(pixels.shape[1::-1], 2, np.ascontiguousarray(pixels).tobytes(), alignment=1)
            texture.filter = ctx.NEAREST, ctx.NEAREST
            self.texture, self.drawn = texture, letters
        target.viewport = (0, 0, *size)
        target.use()
        ctx.enable_only(ctx.BLEND)
        ctx.blend_func = ctx.SRC_ALPHA, ctx.ONE_MINUS_SRC_ALPHA, ctx.ZERO, ctx.ONE
        rows = rows.copy()
        rows[:, 4:8] /= np.tile(texture.size, 2)
        self.stream.write(rows.tobytes())
        texture.use(0)
        self.program["size"] = size
        self.array.render(mode=ctx.TRIANGLE_STRIP, vertices=4, instances=len(rows))
        ctx.disable(ctx.BLEND)

    def release(self) -> None:
        for part in (self.array, self.program, self.stream, self.texture):
            if part is not None:
                part.release()


class SheetPass(RowsPass):
    """Draws a help sheet; made once per context."""

    def __init__(self, ctx: Any):
        super().__init__(ctx)
        self.fitted: tuple | None = None
        self.letters = None

    def draw(self, sheet: Sheet, target: Any) -> None:
        """Draw the page that is open over the middle of a framebuffer."""
        size = target.size
        words = [line.cells for table in sheet.tables for line in table], [pad.caption for pad in sheet.pads], sheet.note
        if self.fitted != (size, words):  # what lights up changes no size
            self.fitted, self.letters = (size, words), None
        self.letters, pages = arranged(sheet, size, self.letters)
        self.rows(layout(pages[sheet.page % len(pages)], size, self.letters)[0], self.letters, target)
