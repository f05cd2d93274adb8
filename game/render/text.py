"""Text: lines at the top left and a film's titles, in the font that comes with pillow."""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from PIL import Image, ImageDraw, ImageFilter, ImageFont

from ..scene import Caption
from . import gl

WORDS = {"–": "-", "—": "-", "−": "-", "²": "2", "³": "3", "×": "x", "µ": "u", "ω": "w", "φ": "phi", "√": "sqrt",
         "≤": "<=", "≥": ">=", "•": "·", "½": "1/2", "\t": "    "}
"""What stands in for characters that the font lacks."""
ARROWS = {"→": 0, "↑": 90, "←": 180, "↓": 270}
PLAIN = "".join(map(chr, range(32, 127))) + "°·±…“”’"
INK = (0.97, 0.97, 0.95, 1.0)
NARROWEST = 8.0
"""Lines are not broken for less than so many times their own height."""
CAPTION_LEFT = 0.06
"""Captions keep this part of the picture's width free on either side."""


def spelled(line: str) -> str:
    """The line in characters that the font has; what nothing can stand in for becomes "?"."""
    out = []
    for char in line:
        for part in WORDS.get(char, char):
            if part not in PLAIN and part not in ARROWS:
                part = unicodedata.normalize("NFKD", part)[:1]
            out.append(part if part in PLAIN or part in ARROWS else "?")
    return "".join(out)


@dataclass(frozen=True, eq=False)
class Atlas:
    """Every glyph at one size.

    pixels: (H, W, 2) uint8, the glyph and its soft shadow. cells: glyph → left, top, width, height [px]
    in the atlas. advances: glyph → how far the pen moves [px]. margin: [px] around each glyph for its
    shadow. line: [px] from one line to the next.
    """

    pixels: np.ndarray
    cells: dict[str, tuple[int, int, int, int]]
    advances: dict[str, float]
    margin: int
    line: int


@lru_cache(maxsize=8)
def atlas(size: int) -> Atlas:
    """The atlas for letters of `size` pixels."""
    font = ImageFont.load_default(size=size)
    assert isinstance(font, ImageFont.FreeTypeFont)  # pillow has no other of any size
    ascent, descent = font.getmetrics()
    margin, height = max(2, size // 6), ascent + descent
    width, x, y = 32 * size, 0, 0
    cells, advances, places = {}, {}, {}
    for glyph in PLAIN + "".join(ARROWS):
        advance = float(size) if glyph in ARROWS else font.getlength(glyph)
        if glyph == " ":  # this font's own is too narrow to part words at small sizes
            advance = max(advance, 0.32 * size)
        box = int(np.ceil(advance)) + 2 * margin + 2
        if x + box > width:
            x, y = 0, y + height + 2 * margin
        cells[glyph], advances[glyph] = (x, y, box, height + 2 * margin), advance
        places[glyph] = (x + margin, y + margin)
        x += box
    sheet = Image.new("L", (width, y + height + 2 * margin))
    pen = ImageDraw.Draw(sheet)
    for glyph, place in places.items():
        if glyph in ARROWS:
            sheet.paste(_arrow(size, ascent, ARROWS[glyph]), place)
        else:
            pen.text(place, glyph, font=font, fill=255)
    shadow = sheet.filter(ImageFilter.MaxFilter(3)).filter(ImageFilter.GaussianBlur(max(size / 14, 0.8)))
    return Atlas(np.stack([np.asarray(sheet), np.asarray(shadow)], -1), cells, advances, margin,
                 round(size * 1.45))


def _arrow(size: int, ascent: int, angle: float) -> Image.Image:
    big = Image.new("L", (size * 8, size * 8))
    pen, unit = ImageDraw.Draw(big), size * 8
    pen.line([(0.14 * unit, 0.5 * unit), (0.80 * unit, 0.5 * unit)], 255, int(0.09 * unit))
    pen.polygon([(0.55 * unit, 0.27 * unit), (0.90 * unit, 0.5 * unit), (0.55 * unit, 0.73 * unit)], 255)
    whole = Image.new("L", (size, ascent + 2))
    whole.paste(big.rotate(angle).resize((size, size), Image.Resampling.BOX), (0, max(ascent - size, 0) + 1))
    return whole


def width_of(line: str, font: Atlas) -> float:
    """How wide a spelled line is [px]."""
    return sum(font.advances[c] for c in line)


def wrapped(line: str, font: Atlas, width: float | Callable[[int], float]) -> list[str]:
    """A line, spelled, in parts no wider than `width` [px] where it has spaces; those that do not break hold it together.

    width: of all parts, or of the one with that number.
    """
    first, *words = (spelled(word) for word in line.split(" "))
    parts = [first]
    for word in words:
        longer = f"{parts[-1]} {word}"
        if parts[-1].strip() and width_of(longer, font) > (width(len(parts) - 1) if callable(width) else width):
            parts.append(word)
        else:
            parts[-1] = longer
    return parts


def corner_rows(text: tuple[str, ...], font: Atlas, width: float = math.inf, taken: tuple[float, float] = (0.0, 0.0)) -> np.ndarray:
    """Rows (N, 12) of lines at the top left of a picture so wide [px]: place and cell, left, top, width, height [px], then display RGB
    and opacity. taken: width and height [px] of what lies over the top-right corner: lines end before it, or begin below it
    where too little is left."""
    rows: list[tuple] = []
    inset = round(0.8 * font.line)
    beside, top = width - taken[0] - 2 * inset, inset
    if beside < NARROWEST * font.line and taken[1] > 0.0:
        top += math.ceil(taken[1])
    number = 0
    for whole in text:
        def room(part: int, first: int = number) -> float:
            return beside if top + (first + part) * font.line < taken[1] else width - 2 * inset
        for line in wrapped(whole, font, room):
            _write(rows, line, inset, top + number * font.line, font)
            number += 1
    return np.array(rows, np.float32).reshape(-1, 12)


def caption_rows(line: str, size: tuple[int, int], base: float, font: Atlas, opacity: float) -> np.ndarray:
    """Rows as of `corner_rows` for one line of a caption whose letters end at the height `base`, 0 … 1 from the top."""
    rows: list[tuple] = []
    _write(rows, line, round(CAPTION_LEFT * size[0]), round(base * size[1]) - font.line, font)
    made = np.array(rows, np.float32).reshape(-1, 12)
    made[:, 11] *= opacity
    return made


def caption_size(line: str, size: tuple[int, int], share: float) -> int:
    """Letters [px] of a spelled caption line: `share` of the picture's height, or what its width allows."""
    wanted = round(size[1] * share)
    # a font is as wide as its letters are high, near enough
    wide = width_of(line, atlas(24)) / 24.0
    return int(np.clip(min(wanted, (1.0 - 2.0 * CAPTION_LEFT) * size[0] / max(wide, 1e-9)), 8, 256))


def _write(rows: list, line: str, x: float, y: float, font: Atlas) -> None:
    for char in line:
        if char != " ":
            cell = font.cells[char]
            rows.append((round(x) - font.margin, y - font.margin, cell[2], cell[3], *cell, *INK))
        x += font.advances[char]


@lru_cache(maxsize=16)
def layout(text: tuple[str, ...], caption: Caption | None, size: tuple[int, int], taken: tuple[float, float] = (0.0, 0.0)
           ) -> tuple[tuple[int, np.ndarray], ...]:
    """All text of a scene on `size` pixels: letter sizes [px], each with its rows as of `corner_rows`.

    Letters of the corner measure a fortieth of the shorter side or so. taken: as of `corner_rows`.
    """
    made = []
    if text:
        letters = int(np.clip(round(min(size) / 40), 11, 96))
        made.append((letters, corner_rows(text, atlas(letters), size[0], taken)))
    if caption is not None and caption.opacity > 0.0:
        for line, share, base in ((caption.text, 1 / 13, 0.855), (caption.under, 1 / 30, 0.90)):
            line = spelled(line)
            letters = caption_size(line, size, share)
            made.append((letters, caption_rows(line, size, base, atlas(letters), min(caption.opacity, 1.0))))
    return tuple((letters, rows) for letters, rows in made if len(rows))


class TextPass:
    """Draws text; made once per context. Textures of the letter sizes drawn last are kept."""

    def __init__(self, ctx: Any):
        self.ctx, self.program = ctx, gl.program(ctx, "text.vert", "text.frag")
        self.stream, self.textures = gl.Stream(ctx), {}
        self.array = ctx.vertex_array(self.program, [(self.stream.buffer, "4f 4f 4f/i", "place", "cell", "tint")])

    def draw(self, text: tuple[str, ...], caption: Caption | None, size: tuple[int, int], taken: tuple[float, float] = (0.0, 0.0)) -> None:
        """Draw over a viewport of `size` pixels. taken: as of `corner_rows`."""
        for letters, rows in layout(tuple(text), caption, size, taken):
            texture = self._texture(letters)
            rows = rows.copy()
            rows[:, 4:8] /= np.tile(texture.size, 2)
            self.stream.write(rows.tobytes())
            texture.use(0)
            self.array.render(mode=self.ctx.TRIANGLE_STRIP, vertices=4, instances=len(rows))

    def _texture(self, letters: int) -> Any:
        if letters not in self.textures:
            if len(self.textures) >= 8:
                self.textures.pop(next(iter(self.textures))).release()
            pixels = atlas(letters).pixels
            made = self.ctx.texture(pixels.shape[1::-1], 2, np.ascontiguousarray(pixels).tobytes(), alignment=1)
            made.filter = self.ctx.NEAREST, self.ctx.NEAREST
            self.textures[letters] = made
        return self.textures[letters]

    def release(self) -> None:
        for part in (self.array, self.program, self.stream, *self.textures.values()):
            part.release()
