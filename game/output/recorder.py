"""Recording: frames to a film or to pictures, motion to BVH.

A film is written piece by piece into `NAME.part.mp4` (`NAME.part-2.mp4` where that is there already), which plays
whenever the program is killed, and becomes `NAME.mp4` when it is complete. Pictures appear one by one, each whole.
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from contextlib import suppress
from fractions import Fraction
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from scipy.spatial.transform import Rotation

from gambol.controllers.body import Clip, Pose, Skeleton

from ..files import exclusive, named, output_file, output_folder, whole
from .coding import CODINGS, Coding, palettes

PICTURE = re.compile(r"frame_\d{5,}\.png")


class RecordingError(ValueError):
    """Something that can't be recorded, and what could be."""


class Recorder(Protocol):
    """Takes frames. Used in a `with`; leaving it without an error completes the recording.

    path: where the recording will be. part: where what there is so far lies until then.
    count: how many frames that is.
    """

    path: Path
    part: Path
    count: int

    def write(self, frame: np.ndarray) -> None:
        """Add a frame (H, W, 3 or 4) uint8, top row first."""

    def __enter__(self) -> Recorder: ...

    def __exit__(self, *error) -> None: ...


def recorder(path: str | Path, size: tuple[int, int], fps: Fraction | int) -> Recorder:
    """The recorder for a path: a file with a suffix of `CODINGS`, or a folder of PNG frames where there is no suffix.

    size: width and height in pixels. RecordingError for any other suffix, or a rate that it can't have, OutputError where nothing
    can be written.
    """
    text, path = str(path), Path(path)
    if path.suffix.lower() in CODINGS:
        return Film(path, size, fps)
    if text.endswith(("/", os.sep)) or path.is_dir() or not path.suffix:
        return Pictures(path, size)
    raise RecordingError(f"{path}: can't record {path.suffix}; name a .mp4, .webm or .gif file, a .bvh file or a folder for PNG frames")


class Film:
    """A film, coded after its suffix. size: width, height; where sides must be even, odd ones lose their last row or column, picture is what
    is left. fps: frames a second.

    OutputError where it can't be written: at once if that can be known, else when it happens.
    """

    def __init__(self, path: str | Path, size: tuple[int, int], fps: Fraction | int):
        suffix = Path(path).suffix.lower()
        self.coding = CODINGS[suffix]
        if fps > self.coding.most:
            raise RecordingError(f"{path}: has {float(fps):g} frames a second, a {suffix} at most {self.coding.most}")
        self.path = output_file(path, suffix)
        self.part = self.path.with_stem(f"{self.path.stem}.part")
        self.size, self.fps, self.count = size, Fraction(fps), 0
        self.picture = (size[0] - size[0] % 2, size[1] - size[1] % 2) if self.coding.even else size
        self._container: Any = None
        self._palettes: Any = None

    def __enter__(self) -> Film:
        import av
        from av.video.reformatter import ColorRange, Colorspace

        with named(self.part):
            self.part = exclusive(self.part)
            self._container = av.open(str(self.part), "w", format=self.coding.container, options=dict(self.coding.opened))
        self._stream = self._container.add_stream(self.coding.encoder, rate=self.fps)
        self._stream.width, self._stream.height = self.picture
        self._stream.pix_fmt = self.coding.pixels
        self._stream.options = dict(self.coding.encoded)
        self._stream.codec_context.time_base = 1 / self.fps
        if self.coding.pixels == "pal8":
            self._palettes = palettes(self.picture, 1 / self.fps)
            return self
        self._stream.gop_size = max(self.fps // 2, 1)
        # say which matrix the colours went through: players guess differently for small films
        self._stream.codec_context.colorspace = Colorspace.ITU709
        self._stream.codec_context.color_range = ColorRange.MPEG
        return self

    def write(self, frame: np.ndarray) -> None:
        """Add a frame (H, W, 3 or 4) uint8, top row first."""
        import av
        from av.video.reformatter import ColorRange, Colorspace

        _check(frame, self.size)
        width, height = self.picture
        pixels = np.ascontiguousarray(frame[:height, :width, : frame.shape[2] if self._palettes is None else 3])
        picture = av.VideoFrame.from_ndarray(pixels, format="rgba" if pixels.shape[2] == 4 else "rgb24")
        if self._palettes is None:
            picture = picture.reformat(format="yuv420p", dst_colorspace=Colorspace.ITU709,
                                       dst_color_range=ColorRange.MPEG)
        picture.pts, picture.time_base = self.count, 1 / self.fps
        if self._palettes is not None:
            self._palettes.push(picture)
            picture = self._palettes.pull()
        with named(self.part):
            self._container.mux(self._stream.encode(picture))
        self.count += 1

    def __exit__(self, kind, *rest) -> None:
        if kind is not None:
            with suppress(Exception):  # what went wrong first is what the user has to hear
                self._close()
            return
        self._close()
        with named(self.path):
            _completed(self.part, self.path, self.coding)

    def _close(self) -> None:
        with named(self.part):
            try:
                self._container.mux(self._stream.encode(None))
            finally:
                self._container.close()


class Pictures:
    """A folder of frame_00000.png, frame_00001.png, …; frames of an earlier, longer recording are removed."""

    def __init__(self, folder: str | Path, size: tuple[int, int]):
        self.path = self.part = output_folder(folder)
        self.size = self.picture = size
        self.count = 0

    def __enter__(self) -> Pictures:
        return self

    def write(self, frame: np.ndarray) -> None:
        """Add a frame (H, W, 3 or 4) uint8, top row first."""
        from PIL import Image

        _check(frame, self.size)
        with whole(self.path / f"frame_{self.count:05d}.png") as part:
            Image.fromarray(frame[..., :3]).save(part, format="png", compress_level=1)
        self.count += 1

    def __exit__(self, kind, *rest) -> None:
        if kind is None:
            kept = {f"frame_{i:05d}.png" for i in range(self.count)}
            for file in self.path.iterdir():
                if PICTURE.fullmatch(file.name) and file.name not in kept:
                    file.unlink()


def motion_clip(name: str, skeleton: Skeleton, poses: Sequence[Pose], fps: float) -> Clip:
    """A clip of poses `1 / fps` seconds apart."""
    rotations = np.stack([pose.rotations for pose in poses])
    return Clip(name, skeleton, 1.0 / fps, np.stack([pose.root for pose in poses]).astype(float),
                Rotation.from_matrix(rotations).as_quat())


def write_motion(clip: Clip, path: str | Path) -> None:
    """Write a clip as BVH; the file appears whole or not at all. OutputError where it can't be written."""
    from gambol.controllers.mocap import write_bvh

    with named(path := output_file(path, ".bvh")):
        write_bvh(clip, path)


def _completed(part: Path, path: Path, coding: Coding) -> None:
    """Rewrite a film in pieces as an ordinary one with its index in front, without coding it anew."""
    import av

    if coding.container == "gif":  # is complete as it is
        part.replace(path)
        return
    with whole(path) as done, av.open(str(part)) as source, av.open(
            str(done), "w", format=coding.container, options={"movflags": "faststart"} if coding.container == "mp4" else {}) as target:
        stream = target.add_stream_from_template(source.streams.video[0])
        for packet in source.demux(video=0):
            if packet.dts is not None:
                packet.stream = stream
                target.mux(packet)
    part.unlink()


def _check(frame: np.ndarray, size: tuple[int, int]) -> None:
    if frame.dtype != np.uint8 or frame.ndim != 3 or frame.shape[2] not in (3, 4) or frame.shape[1::-1] != size:
        raise ValueError(f"a frame must be {size[1]} × {size[0]} × 3 or 4 of uint8, "
                         f"got {' × '.join(map(str, frame.shape))} of {frame.dtype}")
