"""Characters: each body's mesh, drawn for sixteen figures at a time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..scene import Figure
from . import gl, skin
from .mesh import LEVELS, Body, mannequin
from .wear import size_of

BATCH = 16
"""Figures in a draw call: what fits the 16 KiB that every OpenGL 3.3 gives a uniform block."""
BEHIND = 0.05
"""A ghost is drawn as if so far behind itself [m]: a body that is as near as that covers it, without speckles."""
KEPT = 8
"""Bodies kept on the graphics card; beyond, those that nobody wears make room."""
_LAYOUT = "3f 3f 4u1 4f1 1f 3f"
_NAMES = ("position", "normal", "joints", "weights", "open", "paint")


class Wardrobe:
    """One body on the graphics card: vertex arrays by level and kind, and its pictures."""

    def __init__(self, ctx: Any, body: Body, programs: dict[str, Any]):
        self.pictures, self._owned, self.arrays = None, [], {}
        if body.pictures is not None:
            layers, size = body.pictures.shape[:2]
            self.pictures = ctx.texture_array((size, size, layers), 4, body.pictures.tobytes())
            self.pictures.build_mipmaps()
            self.pictures.anisotropy = 8.0
            self._owned.append(self.pictures)
        made = {}  # a body may give one mesh for several levels
        for level, mesh in zip(LEVELS, body.levels):
            if id(mesh) not in made:
                made[id(mesh)] = (ctx.buffer(mesh.interleaved()), ctx.buffer(mesh.triangles.astype(np.uint32).tobytes()))
                self._owned += made[id(mesh)]
            vertices, indices = made[id(mesh)]
            for kind, program in programs.items():
                self.arrays[level, kind] = ctx.vertex_array(
                    program, [_content(program, vertices)], index_buffer=indices, index_element_size=4)

    def release(self) -> None:
        for part in (*self.arrays.values(), *self._owned):
            part.release()


class Figures:
    """Draws the figures of a scene; made once per context."""

    def __init__(self, ctx: Any, taps: int):
        self.ctx = ctx
        self.programs = {"painted": gl.program(ctx, "figure.vert", "figure.frag", TAPS=taps, PICTURES=0),
                         "shadow": gl.program(ctx, "figure_shadow.vert", "depth.frag")}
        self._taps = taps
        self.block = ctx.buffer(reserve=BATCH * (len(skin.NAMES) * 32 + 16), dynamic=True)
        self.wardrobes: dict[Body, Wardrobe] = {}
        self.batches: list[tuple[Body, str, bytes, int]] = []
        self.covered: list[tuple[Body, str, bytes, int]] = []
        self.ghosts: list[tuple[tuple[Body, str, bytes, int], float, float, float]] = []
        self._wardrobe(mannequin())

    def prepare(self, figures: Sequence[Figure], eye: np.ndarray, origin: np.ndarray, ranges: Sequence[float]) -> None:
        """Pose what will be drawn, all of it `drawable` and `dressed`. ranges: how far each finer mesh serves [m]."""
        groups: dict[Body, list[Figure]] = {}
        for figure in figures:
            groups.setdefault(figure.body or mannequin(), []).append(figure)
        solid = {body: [figure for figure in group if figure.opacity >= 1.0 and figure.cover >= 1.0] for body, group in groups.items()}
        ghosts = [figure for figure in figures if 0.0 < figure.opacity < 1.0 or figure.cover < 1.0]
        ghosts.sort(key=lambda figure: -np.linalg.norm(figure.positions[0] - eye))
        for body in [body for body in self.wardrobes if body not in groups and body is not mannequin()][KEPT:]:
            self.wardrobes.pop(body).release()
        for body in groups:
            self._wardrobe(body)
        self.batches = [batch for body, group in solid.items() if group for batch in self._posed(body, group, eye, origin, ranges)]
        self.covered, self.ghosts = [], []
        for figure in ghosts:
            batches = self._posed(figure.body or mannequin(), [figure], eye, origin, ranges)
            self.covered += batches if figure.opacity >= 1.0 else []
            # nobody's ghost stands just where somebody else is seen through
            behind = BEHIND * (1 + len(self.ghosts)) if figure.opacity < 1.0 else 0.0
            self.ghosts += [(batch, figure.opacity, figure.cover, behind) for batch in batches]

    def _posed(self, body: Body, figures: list[Figure], eye, origin, ranges) -> list[tuple[Body, str, bytes, int]]:
        positions = np.stack([f.positions for f in figures]).astype(float)
        orientations = np.stack([f.orientations for f in figures])
        scale = size_of(body, positions)
        motion = skin.motions(positions - origin, orientations, scale, body.joints)
        look = np.concatenate([np.array([f.tint for f in figures]), scale[:, None]], 1).astype(np.float32)
        levels = np.searchsorted(ranges, np.linalg.norm(positions[:, 0] - eye, axis=1))
        batches = []
        for k, level in enumerate(LEVELS):
            chosen = np.flatnonzero(levels == k)
            for start in range(0, len(chosen), BATCH):
                part = chosen[start:start + BATCH]
                # a full block each time, so that the look follows at its fixed place
                data = np.zeros((BATCH, len(skin.NAMES) * 2, 4), np.float32)
                data[:len(part)] = motion[part].reshape(len(part), -1, 4)
                looks = np.zeros((BATCH, 4), np.float32)
                looks[:len(part)] = look[part]
                batches.append((body, level, data.tobytes() + looks.tobytes(), len(part)))
        return batches

    def _wardrobe(self, body: Body) -> None:
        if body not in self.wardrobes:
            look = "painted" if body.pictures is None else "pictured"
            if look not in self.programs:
                self.programs[look] = gl.program(self.ctx, "figure.vert", "figure.frag", TAPS=self._taps, PICTURES=1)
            self.wardrobes[body] = Wardrobe(self.ctx, body, {"body": self.programs[look],
                                                             "shadow": self.programs["shadow"]})

    def draw(self, kind: str) -> None:
        """Draw the prepared figures but the ghosts: "body", or "shadow" (into the shadow map, always coarse), which who is seen
        through has, too."""
        for batch in self.batches + (self.covered if kind == "shadow" else []):
            self._draw(batch, kind)

    def draw_ghosts(self, target: Callable[[bool], Any]) -> None:
        """Draw the ghosts, and who is seen through, over all else, the farthest first. target: told whether colour is to be written.

        Of each only the front is seen: its depth comes first, then its colour where nothing of it is nearer.
        """
        for batch, *look in self.ghosts:
            for colour in (False, True):
                target(colour)
                self._draw(batch, "body", *look)

    def _draw(self, batch: tuple[Body, str, bytes, int], kind: str, opacity: float = 1.0, cover: float = 1.0,
              behind: float = 0.0) -> None:
        body, level, data, count = batch
        wardrobe = self.wardrobes[body]
        self.block.orphan()
        self.block.write(data)
        self.block.bind_to_uniform_block(gl.FIGURES)
        if kind == "body":
            program = self.programs["painted" if wardrobe.pictures is None else "pictured"]
            program["opacity"], program["cover"], program["behind"] = opacity, cover, behind
            if wardrobe.pictures is not None:
                wardrobe.pictures.use(gl.PICTURES)
        if body.thin:
            self.ctx.disable(self.ctx.CULL_FACE)
        wardrobe.arrays["far" if kind == "shadow" else level, kind].render(instances=count)
        if body.thin:
            self.ctx.enable(self.ctx.CULL_FACE)

    def release(self) -> None:
        for part in (*self.wardrobes.values(), *self.programs.values(), self.block):
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
