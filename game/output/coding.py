"""How films are coded, by the suffix of their files, and the colours of GIFs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any


@dataclass(frozen=True)
class Coding:
    """How films of one suffix are coded. container: how libav calls it; opened, encoded: its options and the encoder's; most: frames a second."""

    container: str
    encoder: str
    pixels: str
    opened: Mapping[str, str]
    encoded: Mapping[str, str]
    most: int = 240

    @property
    def even(self) -> bool:
        """Whether its pictures need even sides: colours are kept for every other pixel."""
        return self.pixels == "yuv420p"


CODINGS = {
    # short groups of pictures and no long look-ahead: a kill costs about a second, no more
    ".mp4": Coding("mp4", "libx264", "yuv420p", {"movflags": "frag_keyframe+empty_moov+default_base_moof", "flush_packets": "1"},
                   {"crf": "18", "preset": "veryfast", "rc-lookahead": "10", "bf": "0"}),
    ".webm": Coding("webm", "libvpx-vp9", "yuv420p", {"cluster_time_limit": "500", "flush_packets": "1"},
                    {"crf": "24", "b": "0", "deadline": "good", "cpu-used": "5", "row-mt": "1", "lag-in-frames": "0"}),
    # what shows GIFs slows down those that are faster
    ".gif": Coding("gif", "gif", "pal8", {"flush_packets": "1"}, {}, most=50),
}
GIF_RATE = 25
"""Frames a second of a GIF where nobody says another."""


def palettes(size: tuple[int, int], tick: Fraction) -> Any:
    """A filter that gives each picture the 256 colours that suit it. tick: what its times count in [s]."""
    from av import VideoFormat
    from av.filter import Graph

    graph = Graph()
    source = graph.add_buffer(width=size[0], height=size[1], format=VideoFormat("rgb24"), time_base=tick)
    split, palette = graph.add("split"), graph.add("palettegen", "stats_mode=single")
    use, sink = graph.add("paletteuse", "new=1:dither=bayer:bayer_scale=4:diff_mode=rectangle"), graph.add("buffersink")
    source.link_to(split)
    split.link_to(use, 0, 0)
    split.link_to(palette, 1, 0)
    palette.link_to(use, 0, 1)
    use.link_to(sink)
    graph.configure()
    return graph
