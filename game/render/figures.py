"""Characters: one mesh, drawn for sixteen figures at a time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..scene import Figure
from . import gl, mesh, skin
from .view import scale_of

BATCH = 16
"""Figures in a draw call: what fits the 16 KiB that every OpenGL 3.3 gives a uniform block."""
_LAYOUT = "3f 3f 4u1 4f1 1f"
_NAMES = ("position", "normal", "joints", "weights", "open")


class Figures:
    """Draws the figures of a scene; made once per context."""

    def __init__(self, ctx: Any, taps: int):
        self.programs = {"body": gl.program(ctx, "figure.vert", "figure.frag", TAPS=taps),
                         "shadow": gl.program(ctx, "figure_shadow.vert", "depth.frag")}
        self.block = ctx.buffer(reserve=BATCH * (len(skin.NAMES) * 32 + 16), dynamic=True)
        self._owned, self.arrays = [self.block], {}
        for level in mesh.LEVELS:
            shape = mesh.mannequin(level)
            vertices = ctx.buffer(shape.interleaved())
            indices = ctx.buffer(shape.triangles.astype(np.uint32).tobytes())
            self._owned += [vertices, indices]
            for kind, program in self.programs.items():
                self.arrays[level, kind] = ctx.vertex_array(
                    program, [_content(program, vertices)], index_buffer=indices, index_element_size=4)
        self.batches: list[tuple[str, bytes, int]] = []

    def prepare(self, figures: Sequence[Figure], eye: np.ndarray, origin: np.ndarray, ranges: Sequence[float]) -> None:
        """Pose what will be drawn, all of it `drawable`. ranges: how far each finer mesh serves [m]."""
        self.batches = []
        if not figures:
            return
        positions = np.stack([f.positions for f in figures]).astype(float)
        scale = scale_of(positions, skin.REST, skin.STANDARD.parents)
        motion = skin.motions(positions - origin, np.stack([f.orientations for f in figures]), scale)
        look = np.concatenate([np.array([f.tint for f in figures]), scale[:, None]], 1).astype(np.float32)
        levels = np.searchsorted(ranges, np.linalg.norm(positions[:, 0] - eye, axis=1))
        for k, level in enumerate(mesh.LEVELS):
            chosen = np.flatnonzero(levels == k)
            for start in range(0, len(chosen), BATCH):
                part = chosen[start:start + BATCH]
                # a full block each time, so that the look follows at its fixed place
                data = np.zeros((BATCH, len(skin.NAMES) * 2, 4), np.float32)
                data[:len(part)] = motion[part].reshape(len(part), -1, 4)
                looks = np.zeros((BATCH, 4), np.float32)
                looks[:len(part)] = look[part]
                self.batches.append((level, data.tobytes() + looks.tobytes(), len(part)))

    def draw(self, kind: str) -> None:
        """Draw the prepared figures: "body", or "shadow" (into the shadow map, always coarse)."""
        for level, data, count in self.batches:
            self.block.orphan()
            self.block.write(data)
            self.block.bind_to_uniform_block(gl.FIGURES)
            self.arrays["far" if kind == "shadow" else level, kind].render(instances=count)

    def release(self) -> None:
        for part in (*self.arrays.values(), *self.programs.values(), *self._owned):
            part.release()


def _content(program: Any, vertices: Any):
    """The attributes that a program reads; the rest are stepped over."""
    layout = [part if name in program else _pad(part) for part, name in zip(_LAYOUT.split(), _NAMES)]
    return (vertices, " ".join(layout), *(name for name in _NAMES if name in program))


def _pad(part: str) -> str:
    count, size = int(part[0]), 1 if part.endswith("1") else 4
    return f"{count * size}x"


def drawable(figure: Figure) -> bool:
    """Whether a figure can be shown: not if anything in its pose is infinite, undefined or flattened.

    ValueError if it has other joints than the standard human.
    """
    count = len(skin.STANDARD)
    if np.shape(figure.positions) != (count, 3) or np.shape(figure.orientations) != (count, 3, 3):
        raise ValueError(f"a figure needs {count} joints: positions ({count}, 3) and orientations ({count}, 3, 3), "
                         f"got {np.shape(figure.positions)} and {np.shape(figure.orientations)}")
    return bool(np.isfinite(figure.positions).all() and np.isfinite(figure.orientations).all()
                and np.linalg.det(figure.orientations).min() > 1e-6)
