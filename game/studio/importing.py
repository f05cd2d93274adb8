"""Real films as footage: what calibrated cameras recorded, frame by frame, in pictures of any width. Nobody knows the truth of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np

from gambol.controllers.files import reason
from gambol.controllers.tracking.cameras import Lens

from ..files import frame_rate, plain, whole
from ..footage import FASTEST, FootageError, begun, complete, file_of, fingerprint

BORDER = 16
"""A film may have so many columns and rows fewer than its camera was calibrated with: coders cut them off at the right and below."""


def paired(films: Sequence[Path], lenses: Sequence[Lens]) -> list[Path]:
    """A film for each camera: by name where they are named after them, else in order. FootageError for another number of them, or
    where some are named after cameras and others are not."""
    if len(films) != len(lenses):
        raise FootageError(f"{len(films)} films, but {len(lenses)} cameras: {', '.join(lens.name for lens in lenses)}")
    named, names = {film.stem: film for film in films}, {lens.name for lens in lenses}
    if names & set(named) and set(named) != names:
        strange = next(film for film in films if film.stem not in names or films.count(film) > 1)
        raise FootageError(f"{strange}: is named after no camera, or twice there, while other films are; still without a film: "
                           f"{', '.join(sorted(names - set(named)))}")
    return [named[lens.name] for lens in lenses] if set(named) == names else list(films)


def imported(films: Sequence[Path], lenses: Sequence[Lens], folder: str | Path, width: int | None = None, name: str = "somebody") -> Iterator[int]:
    """Put films, one of each camera, into a folder of footage with pictures so wide; the number of each frame as it is written.

    FootageError for films that can't be read, or of other sizes than their cameras'; of the shortest one's length.
    """
    films = paired(films, lenses)
    tapes = [_pictures(film, lens) for film, lens in zip(films, lenses)]
    smaller = [lens if width is None else lens.scaled(width) for lens in lenses]
    fps = next(tapes[0])
    for tape in tapes[1:]:
        next(tape)
    about: dict[str, Any] = {"film": fingerprint([(str(film), film.stat().st_size) for film in films], [(x.size, x.numbers.tolist()) for x in smaller]),
                             "title": films[0].stem, "fps": plain(fps), "dropped": {}, "corrupted": {}}
    path, count = begun(folder, smaller, about), 0
    for number, row in enumerate(zip_longest(*tapes)):
        if any(one is None for one in row):
            break
        for lens, picture in zip(smaller, row):
            file = file_of(path, lens.name, "frame", number)
            if not file.exists():
                _kept(picture, lens.size, file)
        count = number + 1
        yield number
    if not count:
        raise FootageError(f"{films[0]}: holds no frame")
    complete(path, [name], frames=count)


def _pictures(film: Path, lens: Lens) -> Iterator[Any]:
    """Frames a second, then each picture (H, W, 3) uint8 in the camera's size."""
    import av
    from av.error import FFmpegError

    try:
        with av.open(str(film)) as file:
            if not file.streams.video:
                raise FootageError(f"{film}: holds no pictures: no film, or one that is cut short")
            stream = file.streams.video[0]
            yield _rate(film, stream.average_rate or 30)
            for frame in file.decode(stream):
                picture = frame.to_ndarray(format="rgb24")
                more = np.array(lens.size[::-1]) - picture.shape[:2]
                if more.min() < 0 or more.max() > BORDER:
                    raise FootageError(f"{film}: {picture.shape[1]} × {picture.shape[0]} pixels, but {lens.name} was calibrated with "
                                       f"{lens.size[0]} × {lens.size[1]}")
                yield np.pad(picture, ((0, more[0]), (0, more[1]), (0, 0)))
    except (FFmpegError, OSError) as fault:
        told = fault.strerror if isinstance(fault, FFmpegError) else reason(fault)
        raise FootageError(f"{film}: {str(told)[:1].lower()}{str(told)[1:]}: no film, or one that is cut short") from None


def _rate(film: Path, told: Any) -> Fraction:
    try:
        return frame_rate(told, FASTEST)
    except ValueError as fault:
        raise FootageError(f"{film}: {fault}") from None


def _kept(picture: np.ndarray, size: tuple[int, int], file: Path) -> None:
    from PIL import Image

    image = Image.fromarray(picture)
    with whole(file) as part:
        (image if image.size == size else image.resize(size, Image.Resampling.BOX)).save(part, format="png", compress_level=1)
