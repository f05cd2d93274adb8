"""Small helpers over moderngl: programs from files, buffers that stream, framebuffers."""

from __future__ import annotations

import re
from typing import Any

from gambol import assets

BLOCKS = {"Frame": 0, "Figures": 1, "Occluders": 2}
"""Binding points of the uniform blocks."""
FRAME, FIGURES, OCCLUDERS = BLOCKS.values()
SAMPLERS = {"atlas": 0, "figures_map": 0, "solids_map": 1, "figures_depth": 2, "solids_depth": 3, "pictures": 4}
"""Texture units."""
PICTURES = SAMPLERS["pictures"]


def source(name: str, defines: dict[str, int]) -> str:
    """The text of a shader file with its includes, for GLSL 3.30."""
    def expand(part: str) -> str:
        text = assets.path("shaders", part).read_text(encoding="utf-8")
        return re.sub(r"^#include (\S+)$", lambda m: expand(m[1]), text, flags=re.M)
    head = "".join(f"#define {key} {value}\n" for key, value in defines.items())
    return f"#version 330 core\n{head}{expand(name)}"


def program(ctx: Any, vertex: str, fragment: str, varyings: tuple[str, ...] = (), **defines: int) -> Any:
    """A program from two files of assets/shaders, its uniform blocks and samplers bound."""
    if varyings:
        made = ctx.program(vertex_shader=source(vertex, defines), varyings=varyings)
    else:
        made = ctx.program(vertex_shader=source(vertex, defines), fragment_shader=source(fragment, defines))
    for name, binding in BLOCKS.items():
        if name in made:
            made[name].binding = binding
    for name, unit in SAMPLERS.items():
        if name in made:
            made[name] = unit
    return made


class Stream:
    """A buffer rewritten every frame. It only ever grows, and is orphaned before each write, so
    that nothing waits for a frame still being drawn."""

    def __init__(self, ctx: Any, reserve: int = 4096):
        self.buffer = ctx.buffer(reserve=reserve, dynamic=True)

    def write(self, data: bytes) -> None:
        """Replace the contents."""
        if len(data) > self.buffer.size:
            self.buffer.orphan(1 << (len(data) - 1).bit_length())
        else:
            self.buffer.orphan()
        if data:
            self.buffer.write(data)

    def release(self) -> None:
        self.buffer.release()


class ShadowMap:
    """A depth texture of `texels` a side. Shaders compare with it, filtered over four texels, or read it."""

    def __init__(self, ctx: Any, texels: int):
        self.texture = ctx.depth_texture((texels, texels))
        self.texture.compare_func = "<="
        self.texture.filter = ctx.LINEAR, ctx.LINEAR
        self.texture.repeat_x = self.texture.repeat_y = False
        self.target = ctx.framebuffer(depth_attachment=self.texture)
        nearest = ctx.NEAREST, ctx.NEAREST
        self.plain = ctx.sampler(texture=self.texture, filter=nearest, repeat_x=False, repeat_y=False)

    def use(self, compared: int, read: int) -> None:
        """Bind to these two texture units."""
        self.texture.use(compared)
        self.plain.use(read)

    def release(self) -> None:
        for part in (self.target, self.plain, self.texture):
            part.release()


class Target:
    """Where a frame is drawn: a framebuffer, multisampled if asked, and its resolved copy.

    size: width, height in pixels. ValueError for a size that no picture can have.
    """

    def __init__(self, ctx: Any, size: tuple[int, int], samples: int):
        limit = ctx.info["GL_MAX_VIEWPORT_DIMS"][0]
        if not (1 <= size[0] <= limit and 1 <= size[1] <= limit):
            raise ValueError(f"can't draw {size[0]} × {size[1]} pixels: this OpenGL draws 1 to {limit} a side")
        self.ctx, self.size = ctx, size
        samples = min(samples, ctx.max_samples)
        self.resolved_colour = ctx.renderbuffer(size, 4)
        parts = [self.resolved_colour]
        depth = ctx.depth_renderbuffer(size, samples=samples)
        parts.append(depth)
        if samples > 1:
            colour = ctx.renderbuffer(size, 4, samples=samples)
            parts.append(colour)
            self.drawn = ctx.framebuffer([colour], depth)
            self.resolved = ctx.framebuffer([self.resolved_colour])
        else:
            self.drawn = self.resolved = ctx.framebuffer([self.resolved_colour], depth)
        self._parts = parts

    def masked(self, colour: bool = True, depth: bool = True,
               viewport: tuple[int, int, int, int] | None = None) -> Any:
        """Draw here from now on, in the pixels of `viewport` (all, if none is given), but write only what is wanted."""
        self.drawn.color_mask, self.drawn.depth_mask = (colour,) * 4, depth
        self.drawn.viewport = viewport or (0, 0, *self.size)
        self.drawn.use()  # a mask takes effect only then
        return self.drawn

    def resolve(self) -> None:
        """Bring the resolved copy up to date."""
        if self.drawn is not self.resolved:
            self.ctx.copy_framebuffer(self.resolved, self.drawn)

    def release(self) -> None:
        for part in {self.drawn, self.resolved}:
            part.release()
        for part in self._parts:
            part.release()
